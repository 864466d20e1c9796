/* Watches for phase interrupts. Ten phase periods without one mean that no IC drives the clocks (global status bit 3):
 * then no motor may be enabled, and the background runs the servo and real-time tasks from the CPU's cycle counter, so
 * that the host can still repair the set-up. */
#include "firmware/kernel/clock_watch.h"

#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/tasks.h"

enum { PERIODS = 10, DEFAULT_SERVO_DIVIDER = 3 };

static bool missing;
static bool watching; /* a set-up was changed at `changed` */
static uint32_t changed;
static uint32_t last_limit; /* cycles without a phase interrupt, at the last look at the set-up */
static uint32_t last_tick;  /* cycle counter at the last servo task run without clocks */

static void show_missing(bool now) {
  missing = now;
  status_show(STATUS_NO_PHASE_CLOCK, now);
}

bool clock_watch_close(void) { return missing || watching; }

void clock_watch_changed(void) {
  watching = true;
  changed = hal_cycles();
}

void clock_watch_start(void) {
  const uint32_t limit = PERIODS * task_hooks.phase_period();
  const uint32_t start = hal_cycles();
  last_limit = limit;
  tasks_phase_stamp = start;
  while (tasks_phase_stamp == start && hal_cycles() - start < limit) {}
  show_missing(tasks_phase_stamp == start);
  watching = false;
  last_tick = hal_cycles();
}

void clock_watch_pass(void) {
  const uint32_t stamp = tasks_phase_stamp; /* before the counter: the age cannot come out negative */
  const uint32_t now = hal_cycles();
  if (!clock_watch_close() && now - stamp <= last_limit) return; /* the usual case, before each line of the host */
  const uint32_t limit = PERIODS * task_hooks.phase_period();
  last_limit = limit;
  const bool old = now - stamp > limit;
  if (old && !missing) last_tick = now;
  if (watching && (old || now - changed > limit + limit / 2u)) watching = false;
  if (old != missing) show_missing(old);
}

void clock_watch_poll(void) {
  const uint32_t period = task_hooks.phase_period() * (DEFAULT_SERVO_DIVIDER + 1u);
  clock_watch_pass();
  if (!missing || hal_cycles() - last_tick < period) return;
  last_tick += period;
  const uint32_t state = hal_mask_servo();
  tasks_servo_interrupt();
  hal_unmask(state);
}
