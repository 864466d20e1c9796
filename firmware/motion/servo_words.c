#include "firmware/motion/servo_words.h"

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/commutation.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_target.h"
#include "firmware/motion/position_loop.h"
#include "firmware/variables/i_variables.h"

enum { PREVIOUS_STEP = 0x07, INTEGRAL = 0x1E, PID_RESULT = 0x2E, CURRENT = 0x39 };
enum { HALF_X = 1, HALF_Y = 2, BOTH = 3, LONG_X_SHIFT = 24, LONG_UNUSED_BITS = 16, OUTPUT_LIMIT_SHIFT = 8 };

/* Variables that are words of the loop. */
static const struct alias {
  uint8_t offset, half, variable;
} ALIASES[] = {
    {0x09, HALF_Y, IXX08_POSITION_SCALE},
    {0x1C, HALF_Y, IXX09_VELOCITY_SCALE},
    {0x19, HALF_Y, IXX30_PROPORTIONAL_GAIN},
    {0x12, HALF_X, IXX31_DERIVATIVE_GAIN},
    {0x0F, HALF_X, IXX32_VELOCITY_FEEDFORWARD},
    {0x1F, HALF_X, IXX33_INTEGRAL_GAIN},
    {0x13, HALF_Y, IXX35_ACCELERATION_FEEDFORWARD},
    {0x1F, HALF_Y, IXX63_INTEGRATION_LIMIT},
    {0x2E, HALF_Y, IXX69_OUTPUT_LIMIT},
    {0x0F, HALF_Y, IXX60_SERVO_CYCLE_EXTENSION},
};
enum { ALIAS_COUNT = sizeof ALIASES / sizeof ALIASES[0] };

/* Gathering reads words at each servo interrupt: those that are none of these have no use for the list. */
static bool is_alias(uint32_t offset) {
  switch (offset) {
    case 0x09:
    case 0x0F:
    case 0x12:
    case 0x13:
    case 0x19:
    case 0x1C:
    case 0x1F:
    case 0x2E:
      return true;
    default:
      return false;
  }
}

static int shift_of(const struct alias* alias) {
  return alias->variable == IXX69_OUTPUT_LIMIT ? OUTPUT_LIMIT_SHIFT : 0;
}

static uint32_t number_of(uint32_t motor, const struct alias* alias) {
  return I_MOTOR_BLOCK * (motor + 1u) + alias->variable;
}

static int64_t* position_of(uint32_t motor, uint32_t offset) {
  switch (offset) {
    case MEMORY_MOTOR_MASTER:
      return &motors[motor].master;
    case MEMORY_MOTOR_COMPENSATION:
      return &motors[motor].compensation;
    case MEMORY_MOTOR_BIAS:
      return &motors[motor].bias;
    default:
      return 0;
  }
}

static unsigned put_long(int64_t value, uint32_t* x, uint32_t* y) {
  *x = (uint32_t)(value >> LONG_X_SHIFT) & HAL_WORD_MASK;
  *y = (uint32_t)value & HAL_WORD_MASK;
  return BOTH;
}

/* What the word does not show of it. */
static int64_t hidden_of(uint32_t motor, uint32_t offset) {
  return offset == MEMORY_MOTOR_MASTER ? motors[motor].held_back : 0;
}

static unsigned read_position(uint32_t motor, uint32_t offset, uint32_t* x, uint32_t* y) {
  const int64_t* position = position_of(motor, offset);
  if (position == 0) return 0;
  const uint32_t state = hal_mask_servo();
  const int64_t value = *position - hidden_of(motor, offset);
  hal_unmask(state);
  return put_long(value, x, y);
}

static unsigned read_state(uint32_t motor, uint32_t offset, uint32_t* x, uint32_t* y) {
  switch (offset) {
    case PREVIOUS_STEP:
      return put_long(position_loop_step(motor), x, y);
    case INTEGRAL:
      return put_long(position_loop_integral(motor), x, y);
    case PID_RESULT:
      *x = (uint32_t)position_loop_filtered(motor) & HAL_WORD_MASK;
      return HALF_X;
    case CURRENT:
      *x = (uint32_t)commutation_current(motor).q & HAL_WORD_MASK;
      *y = (uint32_t)commutation_current(motor).d & HAL_WORD_MASK;
      return BOTH;
    case MEMORY_MOTOR_TARGET:
      return put_long(motor_target(motor), x, y);
    case MEMORY_MOTOR_AVERAGE_VELOCITY:
      return put_long(average_velocity(motor), x, y);
    default:
      return read_position(motor, offset, x, y);
  }
}

static unsigned aliases_at(uint32_t offset) {
  unsigned halves = 0;
  for (const struct alias* alias = ALIASES; alias < ALIASES + ALIAS_COUNT; ++alias)
    if (alias->offset == offset) halves |= alias->half;
  return halves;
}

void servo_words_motor_changed(uint32_t motor) {
  const uint32_t words = MEMORY_MOTOR_WORDS * motor;
  for (const struct alias* alias = ALIASES; alias < ALIASES + ALIAS_COUNT; ++alias)
    *(alias->half == HALF_X ? hal_x(words + alias->offset) : hal_y(words + alias->offset)) =
        (uint32_t)i_integer(number_of(motor - 1u, alias)) << shift_of(alias) & HAL_WORD_MASK;
}

unsigned servo_word_read(uint32_t motor, uint32_t offset, uint32_t* x, uint32_t* y) {
  return (is_alias(offset) ? aliases_at(offset) : 0u) | read_state(motor, offset, x, y);
}

/* False: there is none. What a write leaves of it is read in one piece with it: the servo task moves it. */
static bool write_position(uint32_t motor, uint32_t offset, uint64_t mask, uint64_t bits) {
  int64_t* position = position_of(motor, offset);
  if (position == 0) return false;
  const uint32_t state = hal_mask_servo();
  const int64_t hidden = hidden_of(motor, offset);
  const uint64_t word = ((uint64_t)(*position - hidden) & ~mask) | bits;
  *position = ((int64_t)(word << LONG_UNUSED_BITS) >> LONG_UNUSED_BITS) + hidden;
  hal_unmask(state);
  return true;
}

void servo_word_write(uint32_t motor, uint32_t offset, bool x, uint32_t mask, uint32_t bits) {
  for (const struct alias* alias = ALIASES; alias < ALIASES + ALIAS_COUNT; ++alias)
    if (alias->offset == offset && (alias->half == HALF_X) == x)
      i_variable_write_part(number_of(motor, alias), mask >> shift_of(alias), bits >> shift_of(alias));
  const int half = x ? LONG_X_SHIFT : 0;
  (void)write_position(motor, offset, (uint64_t)mask << half, (uint64_t)bits << half);
}

/* Opening a loop says it anew. */
void servo_word_write_output(uint32_t motor, uint32_t mask, uint32_t bits) {
  struct motor* m = &motors[motor];
  const uint32_t state = hal_mask_servo();
  m->open_output = hal_signed(((uint32_t)m->open_output & ~mask) | bits);
  hal_unmask(state);
}

bool servo_word_write_long(uint32_t motor, uint32_t offset, uint32_t x, uint32_t y) {
  return write_position(motor, offset, ~0ull, (uint64_t)x << LONG_X_SHIFT | y);
}
