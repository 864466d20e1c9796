/* Kept in one word; read-modify-write holds the tasks off. */
#include "firmware/base/status.h"

#include "firmware/hal/hal.h"

static volatile uint32_t status; /* any task, under the mask */

void status_initialize(void) { status = 0; }

void status_show(uint32_t bits, bool on) {
  const uint32_t state = hal_mask_servo();
  status = on ? status | bits : status & ~bits;
  hal_unmask(state);
}

void status_set(uint32_t bits) { status_show(bits, true); }

void status_clear(uint32_t bits) {
  status_show(bits & (STATUS_REAL_TIME_REENTRY | STATUS_SERVO_ERROR | STATUS_REAL_TIME_WARNING), false);
}

uint32_t status_word(void) { return status; }

bool status_motors_may_enable(void) { return (status & (STATUS_NO_PHASE_CLOCK | STATUS_CONFIGURATION)) == 0u; }
