#include "firmware/motion/system_findings.h"

#include "firmware/buffers/buffer_request.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"

static uint32_t shown; /* R: signals that are on */

void system_findings_initialize(void) { shown = 0; }

bool motor_in_position(uint32_t motor) { return motors[motor].found.in_position && !jog_is_moving(motor); }

/* What all have in common. */
struct findings {
  bool in_position, fatal, warning; /* of all, of one, of one */
};

static struct findings findings_of(uint32_t cs) {
  const uint32_t of = axis_motors[cs];
  struct findings all = {.in_position = of != 0u};
  for (uint32_t motor = 0, left = of; left != 0u; ++motor, left >>= 1) {
    if ((left & 1u) == 0u) continue;
    const struct motor_findings* found = &motors[motor].found;
    all.in_position &= motor_in_position(motor);
    if ((motors_active >> motor & 1u) == 0u) continue;
    all.fatal |= found->fatal_error;
    all.warning |= found->warning_error;
  }
  return all;
}

bool system_in_position(uint32_t cs) { return findings_of(cs).in_position; }

void system_findings_show(void) {
  const uint32_t cs = buffer_request_selected();
  uint32_t on = 0;
  if (cs < COORDINATE_SYSTEMS) {
    const struct findings all = findings_of(cs);
    if (all.in_position) on |= HAL_SIGNAL_IPOS;
    if (all.fatal) on |= HAL_SIGNAL_EROR;
    if (all.warning) on |= HAL_SIGNAL_F1ER;
  }
  if (on != shown) hal_host_signals(on, shown & ~on);
  shown = on;
}
