/* The phase task (firmware:8.1), every I7+1 phase interrupts: follows the phase position of each commutated motor. No
 * current is read and nothing is put out yet. Without a commutated motor image/trap.S only notes the time and does not
 * come here.
 *
 * Motor n's present phase position is X:$80n+$34, counts times Ixx70 modulo Ixx71, in -Ixx71/2 .. Ixx71/2-1. It lives
 * in that word alone, so that a user may write it: that is how a phase reference is set.
 *
 * The phase task cannot be interrupted by those that write here, so they clear a motor's bit in phase_task_work
 * before they touch its entry and set it afterwards. */
#include "firmware/motion/phase_task.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/tasks.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum { PHASE_POSITION = 0x34 };
enum { COMMUTATED = 1, SOURCE_IS_Y = 2 }; /* Ixx01 */
enum { SHORT_PATH_CYCLES = 28 };          /* of image/trap.S without work, with entry and return */
enum { TRAP_CYCLES = 92 }; /* of its entry and return with work, as far as the stamp does not count them */

volatile uint32_t phase_task_work;

static volatile struct phase_motor {
  const volatile uint32_t* source; /* the word that Ixx83 points to */
  uint32_t previous;               /* what it read */
} motors[MOTORS];                  /* 0 = motor 1 */

static uint32_t prescaler;           /* phase task: interrupts since it last worked */
static const volatile uint32_t none; /* Ixx83 points to nothing */

/* The largest sum, 2^23 counts times 255 and a position of 2^23, just fits. A cycle of 0 counts leaves the 24 bits of
 * the word. */
static uint32_t into_cycle(int32_t position, int32_t cycle) {
  const int32_t half = cycle / 2;
  if (cycle > 0 && (position < -half || position >= cycle - half)) {
    position %= cycle;
    if (position < -half) position += cycle;
    if (position >= cycle - half) position -= cycle;
  }
  return (uint32_t)position & HAL_WORD_MASK;
}

static void follow(uint32_t index) {
  const uint32_t motor = index + 1u;
  const uint32_t reading = *motors[index].source;
  const int32_t counts = hal_signed(reading - motors[index].previous); /* the counter wraps at 24 bits */
  motors[index].previous = reading;
  const int32_t moved = counts * i_integer(i_motor(motor, IXX70_COMMUTATION_CYCLES));
  volatile uint32_t* position = hal_x(MEMORY_MOTOR_WORDS * motor + PHASE_POSITION);
  *position = into_cycle(hal_signed(*position) + moved, i_integer(i_motor(motor, IXX71_COMMUTATION_COUNTS)));
}

/* A smaller I7 acts at once: the count may be beyond it already. */
void phase_task_interrupt(void) {
  if (++prescaler <= (uint32_t)i_integer(I7_PHASE_CYCLE_EXTENSION)) return;
  prescaler = 0;
  uint32_t left = phase_task_work;
  for (uint32_t index = 0; left != 0u; ++index, left >>= 1)
    if ((left & 1u) != 0u) follow(index);
  *hal_x(MEMORY_TASK_DURATIONS) = ((hal_cycles() - tasks_phase_stamp + TRAP_CYCLES) / 2u) & HAL_WORD_MASK;
}

static const volatile uint32_t* source_of(uint32_t motor, bool y) {
  const uint32_t address = (uint32_t)i_integer(i_motor(motor, IXX83_COMMUTATION_ADDRESS));
  if (!word_exists(!y, address)) return &none;
  return y ? hal_y(address) : hal_x(address);
}

void phase_task_motor_changed(uint32_t motor) {
  const uint32_t index = motor - 1u, bit = 1u << index;
  const uint32_t state = hal_mask_real_time();
  const uint32_t mode = (uint32_t)i_integer(i_motor(motor, IXX01_COMMUTATION_ENABLE));
  const bool works = i_integer(i_motor(motor, IXX00_ACTIVATED)) != 0 && (mode & COMMUTATED) != 0u;
  const volatile uint32_t* source = source_of(motor, (mode & SOURCE_IS_Y) != 0u);
  const bool worked = (phase_task_work & bit) != 0u;
  if (works != worked || (works && source != motors[index].source)) {
    phase_task_work &= ~bit;
    if (works) {
      motors[index].source = source;
      motors[index].previous = *source; /* where it stands now is no movement */
      phase_task_work |= bit;
    } else if (phase_task_work == 0u) {
      *hal_x(MEMORY_TASK_DURATIONS) = SHORT_PATH_CYCLES / 2;
    }
  }
  hal_unmask(state);
}

void phase_task_initialize(void) {
  phase_task_work = 0;
  prescaler = 0;
  *hal_x(MEMORY_TASK_DURATIONS) = SHORT_PATH_CYCLES / 2;
  for (uint32_t motor = 1; motor <= MOTORS; ++motor) phase_task_motor_changed(motor);
}
