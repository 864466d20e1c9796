/* (2 I7m00 + 3)(I7m01 + 1) periods of the 117.9648 MHz clock, (I52 + 1) / 12 CPU cycles each. */
#include "firmware/variables/phase_period.h"

#include <stdbool.h>

#include "firmware/hal/gate_ic.h"
#include "firmware/kernel/bus_setup.h"
#include "firmware/variables/i_variables.h"

enum { DEFAULT_MAX_PHASE = 6527 };

/* Number of the first I-variable of the IC that drives the clocks; I19's when there is none. */
static uint32_t source_variables(void) {
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
    const uint32_t direction = gate_ic_direction_variable(ic);
    if (gate_ic_present(ic) && i_integer(direction) == 0) return direction - I7M07_CLOCK_DIRECTION;
  }
  return (uint32_t)i_integer(I19_CLOCK_SOURCE) - I7M07_CLOCK_DIRECTION;
}

uint32_t phase_period(void) {
  const uint32_t first = source_variables();
  const unsigned ic = gate_ic_of_direction(first + I7M07_CLOCK_DIRECTION);
  const bool known = ic < GATE_IC_COUNT && gate_ic_present(ic);
  const uint32_t max_phase = known ? (uint32_t)i_integer(first + I7M00_MAX_PHASE) : DEFAULT_MAX_PHASE;
  const uint32_t divider = known ? (uint32_t)i_integer(first + I7M01_PHASE_DIVIDER) + 1u : 1u;
  return (2u * max_phase + 3u) * divider * (bus_setup_cpu_clock() + 1u) / 12u;
}
