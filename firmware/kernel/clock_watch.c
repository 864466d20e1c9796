/* Watches for phase interrupts. Ten phase periods without one mean that no IC drives the clocks (global status bit 3):
 * then no motor may be enabled, and the background runs the servo and real-time tasks from the CPU's cycle counter, so
 * that the host can still repair the set-up. */
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/internal.h"
#include "firmware/kernel/kernel.h"
#include "firmware/variables/variables.h"

enum { PERIODS = 10, DEFAULT_MAX_PHASE = 6527, DEFAULT_SERVO_DIVIDER = 3 };

static bool missing;
static bool watching; /* a set-up was changed at `changed` */
static uint32_t changed;
static uint32_t last_tick; /* cycle counter at the last servo task run without clocks */

/* Number of the first I-variable of the IC that drives the clocks; I19's when there is none. */
static uint32_t source_variables(void) {
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
    const uint32_t direction = gate_ic_direction_variable(ic);
    if (gate_ic_present(ic) && i_integer(direction) == 0) return direction - 7u;
  }
  return (uint32_t)i_integer(19) - 7u;
}

/* (2 I7m00 + 3)(I7m01 + 1) periods of the 117.9648 MHz clock, (I52 + 1) / 12 CPU cycles each. */
uint32_t kernel_phase_period(void) {
  const uint32_t first = source_variables();
  const unsigned ic = gate_ic_of_direction(first + 7u);
  const bool known = ic < GATE_IC_COUNT && gate_ic_present(ic);
  const uint32_t max_phase = known ? (uint32_t)i_integer(first) : DEFAULT_MAX_PHASE;
  const uint32_t divider = known ? (uint32_t)i_integer(first + 1u) + 1u : 1u;
  return (2u * max_phase + 3u) * divider * (bus_setup_cpu_clock() + 1u) / 12u;
}

bool clock_watch_missing(void) { return missing; }
bool clock_watch_close(void) { return missing || watching; }

void kernel_clock_changed(void) {
  watching = true;
  changed = hal_cycles();
}

void clock_watch_start(void) {
  const uint32_t limit = PERIODS * kernel_phase_period();
  const uint32_t start = hal_cycles();
  kernel_phase_stamp = start;
  while (kernel_phase_stamp == start && hal_cycles() - start < limit) {}
  missing = kernel_phase_stamp == start;
  watching = false;
  last_tick = hal_cycles();
}

void clock_watch_pass(void) {
  const uint32_t stamp = kernel_phase_stamp; /* before the counter: the age cannot come out negative */
  const uint32_t now = hal_cycles();
  const uint32_t limit = PERIODS * kernel_phase_period();
  const bool old = now - stamp > limit;
  if (old && !missing) last_tick = now;
  if (watching && (old || now - changed > limit + limit / 2u)) watching = false;
  missing = old;
}

void clock_watch_poll(void) {
  const uint32_t period = kernel_phase_period() * (DEFAULT_SERVO_DIVIDER + 1u);
  clock_watch_pass();
  if (!missing || hal_cycles() - last_tick < period) return;
  last_tick += period;
  const uint32_t state = hal_mask_servo();
  kernel_servo_interrupt();
  hal_unmask(state);
}
