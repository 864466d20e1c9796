/* The phase task (firmware:8.1), every I7+1 phase interrupts, for each commutated motor: phase position, angle,
 * outputs. Integers only. Without a commutated motor image/trap.S only notes the time and does not come here.
 *
 * Motor n's present phase position is X:$80n+$34, counts times Ixx70 modulo Ixx71, in -Ixx71/2 .. Ixx71/2-1, its
 * fraction Y of the same address, what it read through Ixx83 Y:$80n+$32. They live in those words alone, so that a user
 * may write them: that is how a phase reference is set.
 *
 * The phase task cannot be interrupted by those that write here, so they clear a motor's bit in phase_task_work
 * before they touch its settings and set it afterwards. */
#include "firmware/motion/phase_task.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/tasks.h"
#include "firmware/motion/current_loop.h"
#include "firmware/motion/phase_motor.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/sine_output.h"
#include "firmware/variables/i_variables.h"

enum { READING = 0x32, PHASE_POSITION = 0x34 };
enum { COMMUTATED = 1 };         /* Ixx01 */
enum { FRACTION_BITS = 24 };     /* of the phase position */
enum { SHORT_PATH_CYCLES = 32 }; /* of image/trap.S without work, with entry and return */
enum { TRAP_CYCLES = 92 };       /* of its entry and return with work, as far as the stamp does not count them */

volatile uint32_t phase_task_work;

static uint32_t prescaler; /* phase task: interrupts since it last worked */

/* The largest sum, 2^23 counts times 255 and a position of 2^23, just fits. A cycle of 0 counts leaves the 24 bits of
 * the word. */
static __attribute__((noinline)) int32_t into_cycle(int32_t position, int32_t cycle, int32_t half) {
  if (cycle == 0) return hal_signed((uint32_t)position);
  position %= cycle;
  if (position < -half) position += cycle;
  if (position >= cycle - half) position -= cycle;
  return position;
}

static inline int32_t within(int32_t position, const struct phase_settings* s) {
  return position >= -s->half && position < s->cycle - s->half ? position : into_cycle(position, s->cycle, s->half);
}

/* What it moves by itself: slip, or micro-steps. */
static __attribute__((noinline)) int32_t stepped(int32_t position, const struct phase_motor* m, uint32_t words) {
  volatile uint32_t* fraction = hal_y(words + PHASE_POSITION);
  const uint32_t sum = (*fraction & HAL_WORD_MASK) + m->step_parts;
  *fraction = sum & HAL_WORD_MASK;
  return within(position + m->step + (int32_t)(sum >> FRACTION_BITS), &m->settings);
}

static inline int32_t follow(const struct phase_motor* m, uint32_t words) {
  volatile uint32_t *position = hal_x(words + PHASE_POSITION), *previous = hal_y(words + READING);
  const uint32_t reading = *m->settings.source;
  const int32_t counts = hal_signed(reading - *previous); /* the counter wraps at 24 bits */
  *previous = reading & HAL_WORD_MASK;
  int32_t present = within(hal_signed(*position) + counts * m->settings.multiplier, &m->settings);
  if (m->step != 0 || m->step_parts != 0u) present = stepped(present, m, words);
  *position = (uint32_t)present & HAL_WORD_MASK;
  return present;
}

static inline void commutate(struct phase_motor* m, uint32_t words) {
  const int32_t position = follow(m, words);
  uint32_t angle = m->advance;
  if (!m->held) angle += phase_angle(&m->settings, position);
  if (m->settings.current_loop)
    current_loop(m, angle, words);
  else
    sine_output(m, angle);
}

/* A smaller I7 acts at once: the count may be beyond it already. */
void phase_task_interrupt(void) {
  if (++prescaler <= (uint32_t)i_integer(I7_PHASE_CYCLE_EXTENSION)) return;
  prescaler = 0;
  struct phase_motor* m = phase_motors;
  uint32_t words = MEMORY_MOTOR_WORDS;
  for (uint32_t left = phase_task_work; left != 0u; left >>= 1, ++m, words += MEMORY_MOTOR_WORDS)
    if ((left & 1u) != 0u) commutate(m, words);
  *hal_x(MEMORY_TASK_DURATIONS) = ((hal_cycles() - tasks_phase_stamp + TRAP_CYCLES) / 2u) & HAL_WORD_MASK;
}

static bool is_commutated(uint32_t motor) {
  return i_integer(i_motor(motor, IXX00_ACTIVATED)) != 0 &&
         ((uint32_t)i_integer(i_motor(motor, IXX01_COMMUTATION_ENABLE)) & COMMUTATED) != 0u;
}

static void stop_motor(uint32_t bit) {
  phase_task_work &= ~bit;
  if (phase_task_work == 0u) *hal_x(MEMORY_TASK_DURATIONS) = SHORT_PATH_CYCLES / 2;
}

static void run_motor(uint32_t motor, uint32_t bit) {
  struct phase_motor* m = &phase_motors[motor - 1u];
  const struct phase_settings settings = phase_motor_resolve(motor);
  if ((phase_task_work & bit) == 0u || settings.source != m->settings.source) /* where it stands is no movement */
    *hal_y(MEMORY_MOTOR_WORDS * motor + READING) = *settings.source & HAL_WORD_MASK;
  phase_task_work &= ~bit;
  m->settings = settings;
  phase_task_work |= bit;
}

void phase_task_motor_changed(uint32_t motor) {
  const uint32_t bit = 1u << (motor - 1u);
  const uint32_t state = hal_mask_real_time();
  if (is_commutated(motor))
    run_motor(motor, bit);
  else if ((phase_task_work & bit) != 0u)
    stop_motor(bit);
  hal_unmask(state);
  phasing_motor_changed(motor);
}

void phase_task_initialize(void) {
  phase_task_work = 0;
  prescaler = 0;
  __builtin_memset(phase_motors, 0, sizeof phase_motors);
  *hal_x(MEMORY_TASK_DURATIONS) = SHORT_PATH_CYCLES / 2;
  for (uint32_t motor = 1; motor <= MOTORS; ++motor) phase_task_motor_changed(motor);
}
