/* Counted by the CPU's cycle counter, so it costs nothing while nobody asks. */
#include "firmware/kernel/calendar.h"

#include "firmware/hal/hal.h"

static uint64_t began; /* cycle at which it was `first` */
static uint32_t first;

void calendar_initialize(void) { calendar_set(0); }

void calendar_set(uint32_t seconds) {
  began = hal_long_cycles();
  first = seconds;
}

uint32_t calendar_seconds(void) {
  return first + (uint32_t)((hal_long_cycles() - began) / ((uint64_t)hal_cycles_per_ms() * 1000u));
}
