/* The counter stands in user memory, where a host may watch it; what counts is kept here. */
#include "firmware/kernel/watchdog.h"

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/background.h"

enum { DEFAULT_RELOAD = 4095, STROBE_GAP_MS = 10, LOWEST_COUNT = -8388607 };

static volatile int32_t counter;     /* S decrements, B reloads with S held off */
static int32_t reload_in_force;      /* B, with S held off */
static int32_t lowest;               /* S */
static volatile uint32_t reload_i40; /* B or R */
static uint32_t strobe_gap;          /* cycles */
static volatile uint32_t strobed;    /* cycle count at the last strobe. S and R */

void watchdog_initialize(void) {
  watchdog_reload();
  lowest = counter;
  *hal_x(MEMORY_WATCHDOG_COUNT) = (uint32_t)lowest;
  strobe_gap = STROBE_GAP_MS * hal_cycles_per_ms();
  strobed = hal_cycles();
}

void watchdog_set_reload(uint32_t i40) { reload_i40 = i40; }

void watchdog_reload(void) {
  const int32_t reload = (int32_t)reload_i40;
  const uint32_t state = hal_mask_servo();
  counter = reload_in_force = reload == 0 ? DEFAULT_RELOAD : reload;
  *hal_y(MEMORY_WATCHDOG_COUNT) = (uint32_t)counter;
  hal_unmask(state);
}

/* The background sleeps between real-time interrupts, which may be further apart than I40 cycles: it is woken in time
 * to reload. */
void watchdog_count(void) {
  const int32_t left = counter - 1;
  if (left < LOWEST_COUNT) return;
  counter = left;
  if (left <= reload_in_force / 2) background_wake();
  *hal_y(MEMORY_WATCHDOG_COUNT) = (uint32_t)left & HAL_WORD_MASK;
  if (left >= lowest) return;
  lowest = left;
  *hal_x(MEMORY_WATCHDOG_COUNT) = (uint32_t)left & HAL_WORD_MASK;
}

void watchdog_strobe(uint32_t now) {
  strobed = now;
  if (counter >= 0) hal_watchdog_strobe();
}

bool watchdog_strobe_is_old(uint32_t now) { return now - strobed > strobe_gap; }
