/* The servo task counts, runs timers, the watchdog counter and the trajectories, and every I8+1 cycles requests the
 * real-time task, which plans moves and strobes the hardware watchdog. When real-time interrupts are meant to be rare
 * (I8 up to 255, slow clocks), the servo task strobes between them: the hardware allows 25 ms only. The phase task
 * works every I7+1 phase interrupts; without a commutated motor image/trap.S only notes the time and does not come
 * here. */
#include "firmware/kernel/tasks.h"

#include <stdbool.h>

#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/watchdog.h"

enum { LONGEST_SLICE_MS = 5 }; /* the watchdog is not strobed meanwhile */
enum { TRAP_CYCLES = 122 };    /* entry and return of image/trap.S, which a handler does not see */

volatile uint32_t tasks_phase_stamp;

static volatile uint32_t real_time_period; /* I8. B or R */
static volatile uint32_t servo_count;      /* S */
static uint32_t real_time_prescaler;       /* S */
static volatile bool real_time_due;        /* S sets, R clears: not one that a control character asked for */
static volatile bool real_time_active;     /* R: one that was due */
static volatile bool real_time_late;       /* S sets, R clears: due again before it was done */
static uint32_t real_time_began;           /* R, cycle counter */
static uint32_t real_time_spent;           /* R, cycles since one was due */
static uint32_t servo_began;               /* S, cycle counter */
static volatile uint32_t servo_period;     /* S, cycles between the last two */

void tasks_initialize(void) {
  servo_count = 0;
  real_time_prescaler = 0;
  real_time_due = real_time_active = real_time_late = false;
  real_time_spent = 0;
  servo_period = 0;
  servo_began = hal_cycles();
  watchdog_initialize();
}

void tasks_set_real_time_period(uint32_t i8) { real_time_period = i8; }
uint32_t tasks_servo_count(void) { return servo_count; }
bool tasks_real_time_is_periodic(void) { return real_time_active; }

/* Half of the time from one real-time interrupt to the next: the background has the rest. */
uint32_t tasks_real_time_slice(void) {
  const uint32_t longest = LONGEST_SLICE_MS * hal_cycles_per_ms(), period = servo_period;
  if (period > 2u * longest) return longest; /* no overflow below: I8 is 255 at most */
  const uint32_t half = period * (real_time_period + 1u) / 2u;
  return half < longest ? half : longest;
}

uint32_t tasks_real_time_left(void) {
  const uint32_t slice = tasks_real_time_slice(), spent = hal_cycles() - real_time_began;
  return spent < slice ? slice - spent : 0u;
}

/* In half CPU cycles, with the interrupts above it: clients take those out again (docs/firmware.md, Task load). */
static void show_duration(volatile uint32_t* word, uint32_t cycles) { *word = (cycles / 2u) & HAL_WORD_MASK; }

/* Late is one that runs, and one that the tasks above have not let begin. */
static void request_real_time(void) {
  if (real_time_active || real_time_due) {
    real_time_late = true;
    status_set(STATUS_REAL_TIME_REENTRY | STATUS_REAL_TIME_WARNING);
  }
  real_time_due = true;
  hal_request_real_time();
}

void tasks_servo_interrupt(void) {
  const uint32_t began = hal_cycles();
  const uint32_t count = servo_count + 1u;
  servo_count = count;
  servo_period = began - servo_began;
  servo_began = began;
  *hal_x(MEMORY_SERVO_COUNT) = count & HAL_WORD_MASK;
  watchdog_count();
  task_hooks.servo();
  if (++real_time_prescaler > real_time_period) {
    real_time_prescaler = 0;
    request_real_time();
  } else if (watchdog_strobe_is_old(began) && !real_time_active && !hal_real_time_pending()) {
    watchdog_strobe(began); /* the real-time task has done its duty, the next is not due yet */
  }
  show_duration(hal_y(MEMORY_TASK_DURATIONS), hal_cycles() - began + TRAP_CYCLES);
  if (hal_servo_pending()) status_set(STATUS_SERVO_ERROR);
}

/* A period may have several: control characters ask for one, and a slice that gave way goes on. The words tell what the
 * period took. A host may write the longest, to have it found anew. */
static void show_real_time(uint32_t took, bool due) {
  real_time_spent = due ? took : real_time_spent + took;
  volatile uint32_t *last = hal_x(MEMORY_REAL_TIME_DURATIONS), *longest = hal_y(MEMORY_REAL_TIME_DURATIONS);
  show_duration(last, real_time_spent);
  if (*last > *longest) *longest = *last;
}

/* The warning is about the last one, re-entry stays. */
static void judge_real_time(void) {
  if (!real_time_late && (status_word() & STATUS_REAL_TIME_WARNING) != 0u) status_clear(STATUS_REAL_TIME_WARNING);
  real_time_late = false;
}

void tasks_real_time_interrupt(void) {
  const uint32_t began = hal_cycles();
  const bool due = real_time_due;
  real_time_began = began;
  real_time_active = due;
  if (due) real_time_due = false; /* else the servo task may just have asked */
  task_hooks.real_time();
  watchdog_strobe(began);
  background_wake();
  real_time_active = false;
  if (due) judge_real_time();
  show_real_time(hal_cycles() - began + TRAP_CYCLES, due);
}
