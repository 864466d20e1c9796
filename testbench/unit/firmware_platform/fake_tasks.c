/* Tasks on the fake hardware. A task is held off by critical sections and by the tasks above it, as by mie; both are
 * levels, because each of them holds off what is below. */
#include "testbench/unit/firmware_platform/fake_tasks.h"

#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#include <stddef.h>
#include <ucontext.h>

#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/kernel/tasks.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/phase_task.h"
#include "rtl/regs/brick_regs.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_interrupts.h"

static enum fake_task mask, level; /* highest task that a section, that the running task holds off */
static bool ignored, interrupts_on, real_time;
static uint32_t masked_since, longest_mask;

bool fake_hal_masked(void) { return mask != FAKE_BACKGROUND; }
void fake_tasks_ignore_masks(bool ignore) { ignored = ignore; }

uint32_t fake_hal_longest_mask(void) {
  const uint32_t longest = longest_mask;
  longest_mask = 0;
  return longest;
}

static uint32_t hold_off(enum fake_task highest) {
  fake_interrupts_mend();
  const enum fake_task held = mask;
  if (held == FAKE_BACKGROUND) masked_since = (uint32_t)hal_long_cycles();
  if (highest > mask) mask = highest;
  if (ignored) fake_interrupts_soon();
  return held;
}

uint32_t hal_mask_real_time(void) { return hold_off(FAKE_REAL_TIME); }
uint32_t hal_mask_servo(void) { return hold_off(FAKE_SERVO); }
uint32_t hal_mask_all(void) { return hold_off(FAKE_HOST); }

static void (*on_unmask)(void);
void fake_hal_on_unmask(void (*action)(void)) { on_unmask = action; }

void hal_unmask(uint32_t state) {
  fake_interrupts_mend();
  mask = (enum fake_task)state;
  const uint32_t held = (uint32_t)hal_long_cycles() - masked_since;
  if (mask == FAKE_BACKGROUND && held > longest_mask) longest_mask = held;
  if (mask == FAKE_BACKGROUND && level == FAKE_BACKGROUND && on_unmask != NULL) on_unmask();
}

void hal_interrupts_off(void) { real_time = interrupts_on = false; }
void hal_interrupts_on(void) { interrupts_on = true; }

/* Servo interrupts from one that asked for the real-time task to the next; how many there were since the last. */
static unsigned servo_period, servo_count;
static bool real_time_runs;

void hal_request_real_time(void) {
  real_time = true;
  if (level != FAKE_SERVO) return;
  servo_period = servo_count;
  servo_count = 0;
}

static bool comes_too_soon(void) { return (real_time || real_time_runs) && servo_count + 1u >= servo_period; }

static bool servo_waits;
void fake_tasks_servo_waits(bool waits) { servo_waits = waits; }
bool hal_servo_pending(void) { return servo_waits; }

/* The host's side of the port. ----------------------------------------------------------------------------------- */

enum { INPUT_SIZE = 1 << 16 };
static uint8_t input[INPUT_SIZE];
static uint32_t input_first, input_last; /* run freely */
static char output[1 << 20];
static uint32_t output_length;
static bool receives, transmits; /* HRIE, HTIE */

void fake_host_input(uint8_t c) { input[input_last++ % INPUT_SIZE] = c; }
bool fake_host_input_waits(void) { return input_first != input_last; }
void hal_host_interrupts(bool receive, bool transmit) { receives = receive, transmits = transmit; }

static void host_reads(void) {
  const enum fake_task interrupted = level;
  uint8_t c;
  level = FAKE_HOST; /* the host's interrupt would read the same character */
  while (output_length < sizeof output && host_port_next_output(&c)) output[output_length++] = (char)c;
  level = interrupted;
}

const char* fake_host_output(uint32_t* length) {
  fake_interrupts_mend();
  host_reads();
  *length = output_length;
  output_length = 0;
  return output;
}

static bool host_interrupts(void) { return (receives && fake_host_input_waits()) || transmits; }

/* Reading HORX takes the character: known from what becomes of it. What is sent is known from the word, because nothing
 * else is less than a character. */
static void host_port(void) {
  enum { NOTHING = 1 << 23 };
  const bool had = fake_host_input_waits();
  *hal_x(HI08_X_HSR) = (had ? HI08_HSR_HRDF_MASK : 0u) | HI08_HSR_HTDE_MASK;
  *hal_x(HI08_X_HORX) = input[input_first % INPUT_SIZE];
  *hal_x(HI08_X_HOTX) = NOTHING;
  const uint32_t received = host_port_received_count + host_port_flushes();
  host_port_interrupt();
  if (host_port_received_count + host_port_flushes() != received) ++input_first; /* else the queue is full */
  const uint32_t sent = *hal_x(HI08_X_HOTX);
  if (sent != NOTHING && output_length < sizeof output) output[output_length++] = (char)sent;
}

/* What image/trap.S does in each phase interrupt (motion:1.6). */
static void renew_pace(void) {
  if (motors_enabled == 0u) return;
  host_port_granted = 0;
  host_port_renewed = 1;
  if (host_port_held == 0u) return;
  host_port_held = 0;
  hal_host_interrupts((host_port_enables & HI08_HCR_HRIE_MASK) != 0u, (host_port_enables & HI08_HCR_HTIE_MASK) != 0u);
}

static void (*on_wait)(void);

void fake_hal_on_wait(void (*action)(void)) { on_wait = action; }

void hal_idle(const volatile uint32_t* work) {
  (void)work;
  if (on_wait == NULL) {
    host_reads();
    return;
  }
  fake_hal_pass(hal_cycles_per_ms());
  on_wait();
}

/* Tasks. ------------------------------------------------------------------------------------------------------------
 */

static void run(enum fake_task task) {
  const enum fake_task interrupted = level;
  const struct fake_word word = fake_hal_leave_word();
  level = task;
  fake_interrupts_taken(task);
  switch (task) {
    case FAKE_REAL_TIME:
      real_time = false;
      real_time_runs = true;
      tasks_real_time_interrupt();
      real_time_runs = false;
      break;
    case FAKE_SERVO:
      ++servo_count;
      tasks_servo_interrupt();
      break;
    case FAKE_PHASE:
      tasks_phase_stamp = (uint32_t)hal_long_cycles();
      renew_pace();
      if (phase_task_work != 0u) phase_task_interrupt();
      break;
    default:
      host_port();
  }
  fake_interrupts_mend();
  level = interrupted;
  fake_hal_return_to_word(word);
}

bool fake_task_take(enum fake_task task) {
  if (!interrupts_on || task <= level || (task <= mask && !ignored)) return false;
  if (task == FAKE_REAL_TIME && !real_time) return false;
  if (task == FAKE_HOST && !host_interrupts()) return false;
  if (task == FAKE_SERVO && fake_interrupts_time_is_left() && comes_too_soon()) return false;
  run(task);
  return true;
}

void fake_task_run_servo(void) { run(FAKE_SERVO); }
void fake_task_run_real_time(void) { run(FAKE_REAL_TIME); }

/* Work in slices: a stack of its own, as on the target. -------------------------------------------------------------
 */

/* The sanitizer clears what it knows of the whole stack at each change: of a large one with calls of the system, which
 * were half the time of the tests with interrupts. */
static char side_stack[1 << 17] __attribute__((aligned(16)));
static ucontext_t side, main_side;
static void (*side_task)(void);
static void (*on_pause)(void);
static bool leaves, on_side, is_new, is_left;

void fake_hal_on_pause(void (*action)(void)) { on_pause = action; }
void fake_hal_slices_leave(bool leave) { leaves = leave; }
bool fake_hal_slice_is_left(void) { return is_left; }
bool hal_real_time_pending(void) { return real_time || on_pause != NULL; } /* so slices end as soon as they may */

/* The sanitizer is told which stack is the present one. */
static const void* main_bottom;
static size_t main_size;

static void change_to_side(void) {
  void* kept;
  __sanitizer_start_switch_fiber(&kept, side_stack, sizeof side_stack);
  (void)swapcontext(&main_side, &side);
  __sanitizer_finish_switch_fiber(kept, NULL, NULL);
}

static void change_to_main(void) {
  void* kept;
  __sanitizer_start_switch_fiber(&kept, main_bottom, main_size);
  (void)swapcontext(&side, &main_side);
  __sanitizer_finish_switch_fiber(kept, &main_bottom, &main_size);
}

static void side_main(void) {
  __sanitizer_finish_switch_fiber(NULL, &main_bottom, &main_size);
  for (;;) {
    is_left = true;
    side_task();
    is_left = false;
    change_to_main();
  }
}

void hal_side_begin(void (*task)(void)) {
  side_task = task;
  is_new = true;
  is_left = false;
}

static bool in_pause;

void hal_side_change(void) {
  fake_interrupts_mend();
  if (on_side) {
    if (leaves)
      change_to_main();
    else if (on_pause != NULL && !in_pause) {
      in_pause = true; /* as the background, in which nothing pauses */
      on_pause();
      in_pause = false;
    }
    return;
  }
  if (is_new) {
    __asan_unpoison_memory_region(side_stack, sizeof side_stack); /* of functions that were never left */
    (void)getcontext(&side);
    side.uc_stack.ss_sp = side_stack;
    side.uc_stack.ss_size = sizeof side_stack;
    makecontext(&side, side_main, 0);
    is_new = false;
  }
  on_side = true;
  change_to_side();
  on_side = false;
}

void fake_tasks_power_on(void) {
  mask = level = FAKE_BACKGROUND;
  real_time = interrupts_on = ignored = servo_waits = false;
  longest_mask = 0;
  input_first = input_last = output_length = 0;
}
