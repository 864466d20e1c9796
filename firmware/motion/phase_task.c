/* The phase task (firmware:8.1), every I7+1 phase interrupts: follows the phase position of each commutated motor. No
 * current is read and nothing is put out yet. Without a commutated motor image/trap.S only notes the time and does not
 * come here.
 *
 * Motor n's present phase position is X:$80n+$34, counts times Ixx70 modulo Ixx71, in -Ixx71/2 .. Ixx71/2-1. It lives
 * in that word alone, so that a user may write it: that is how a phase reference is set.
 *
 * The phase task cannot be interrupted by those that write here, so they clear a motor's bit in kernel_phase_work
 * before they touch its entry and set it afterwards. */
#include "firmware/hal/hal.h"
#include "firmware/kernel/internal.h"
#include "firmware/kernel/kernel.h"
#include "firmware/variables/variables.h"
#include "firmware/variables/words.h"

enum { MOTORS = 32, MOTOR_WORDS = 0x80, PHASE_POSITION = 0x34 };
enum { COMMUTATED = 1, SOURCE_IS_Y = 2 }; /* Ixx01 */
enum { SHORT_PATH_CYCLES = 40 };          /* of image/trap.S without work, with entry and return */

volatile uint32_t kernel_phase_stamp, kernel_phase_work;

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
  const uint32_t variables = 100u * (index + 1u);
  const uint32_t reading = *motors[index].source;
  const int32_t counts = hal_signed(reading - motors[index].previous); /* the counter wraps at 24 bits */
  motors[index].previous = reading;
  const int32_t moved = counts * i_integer(variables + 70u);
  volatile uint32_t* position = hal_x(MOTOR_WORDS * (index + 1u) + PHASE_POSITION);
  *position = into_cycle(hal_signed(*position) + moved, i_integer(variables + 71u));
}

/* A smaller I7 acts at once: the count may be beyond it already. */
void kernel_phase_interrupt(void) {
  if (++prescaler <= (uint32_t)i_integer(7)) return;
  prescaler = 0;
  uint32_t left = kernel_phase_work;
  for (uint32_t index = 0; left != 0u; ++index, left >>= 1)
    if ((left & 1u) != 0u) follow(index);
  *hal_x(TASK_DURATIONS) = ((hal_cycles() - kernel_phase_stamp) / 2u) & HAL_WORD_MASK;
}

static const volatile uint32_t* source_of(uint32_t motor, bool y) {
  const uint32_t address = (uint32_t)i_integer(100u * motor + 83u);
  if (!word_exists(!y, address)) return &none;
  return y ? hal_y(address) : hal_x(address);
}

void kernel_phase_motor_changed(uint32_t motor) {
  const uint32_t index = motor - 1u, bit = 1u << index;
  const uint32_t state = hal_mask_real_time();
  const uint32_t mode = (uint32_t)i_integer(100u * motor + 1u);
  const bool works = i_integer(100u * motor) != 0 && (mode & COMMUTATED) != 0u;
  const volatile uint32_t* source = source_of(motor, (mode & SOURCE_IS_Y) != 0u);
  const bool worked = (kernel_phase_work & bit) != 0u;
  if (works != worked || (works && source != motors[index].source)) {
    kernel_phase_work &= ~bit;
    if (works) {
      motors[index].source = source;
      motors[index].previous = *source; /* where it stands now is no movement */
      kernel_phase_work |= bit;
    } else if (kernel_phase_work == 0u) {
      *hal_x(TASK_DURATIONS) = SHORT_PATH_CYCLES / 2;
    }
  }
  hal_unmask(state);
}

void phase_task_initialize(void) {
  kernel_phase_work = 0;
  prescaler = 0;
  *hal_x(TASK_DURATIONS) = SHORT_PATH_CYCLES / 2;
  for (uint32_t motor = 1; motor <= MOTORS; ++motor) kernel_phase_motor_changed(motor);
}
