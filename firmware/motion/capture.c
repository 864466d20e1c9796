#include "firmware/motion/capture.h"

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/position_loop.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum {
  POSITION_REGISTER = 3, /* X, behind the status word; reading it arms the next capture */
  CAPTURED = 1u << 11,   /* in the status word */
  FRACTION_SHIFT = 12,   /* Y of the status word, upper half: 1/4096 count */
  MODE_SOFTWARE = 1,     /* Ixx97 */
  MODE_ERROR = 2,
  FLAG_FINE_COUNTS = 1u << 11, /* Ixx24: the table has 10 bits below a count of the hardware, not 5 */
  FLAG_FRACTION = 1u << 12,    /* Ixx24: the captured fraction counts */
  COUNT_BITS = 5,
  FINE_COUNT_BITS = 10
};

/* Of Ixx25 = 0 there is none. */
static volatile uint32_t* word(bool x, uint32_t flags, uint32_t which) {
  const uint32_t address = flags + which;
  if (flags == 0u || !word_exists(x, address)) return 0;
  return x ? hal_x(address) : hal_y(address);
}

struct capture capture_make(uint32_t motor) {
  const uint32_t flags = (uint32_t)i_integer(i_motor(motor + 1u, IXX25_FLAG_ADDRESS));
  const uint32_t mode = (uint32_t)i_integer(i_motor(motor + 1u, IXX97_CAPTURE_MODE));
  const uint32_t flag_mode = (uint32_t)i_integer(i_motor(motor + 1u, IXX24_FLAG_MODE));
  struct capture c = {.on_error = (mode & MODE_ERROR) != 0u, .in_software = mode != 0u};
  c.status = word(true, flags, 0);
  c.position = word(true, flags, POSITION_REGISTER);
  c.fraction = word(false, flags, 0);
  c.with_fraction = (flag_mode & FLAG_FRACTION) != 0u;
  c.count_bits = (flag_mode & FLAG_FINE_COUNTS) != 0u ? FINE_COUNT_BITS : COUNT_BITS;
  return c;
}

void capture_arm(const struct capture* c) {
  if (c->position != 0) (void)*c->position;
}

/* The table's result is a count with bits below it; so becomes what was captured, and the actual position is left by
 * the difference. 24 bits wrap: the capture is less than 2^18 counts away. */
static int64_t captured_position(uint32_t motor, const struct capture* c) {
  const struct motor* m = &motors[motor];
  if (c->in_software || c->position == 0) return position_loop_measured(motor);
  const uint32_t fraction = c->with_fraction && c->fraction != 0 ? *c->fraction >> FRACTION_SHIFT : 0u; /* of 4096 */
  const uint32_t counter = *c->position, whole = counter << c->count_bits;
  const int32_t beyond = hal_signed((position_loop_reading(motor) - whole) & HAL_WORD_MASK);
  *hal_y(MEMORY_MOTOR_WORDS * (motor + 1u) + MEMORY_MOTOR_CAPTURE) = counter & HAL_WORD_MASK;
  const int64_t below = ((int64_t)fraction * m->position_scale) >> (FRACTION_SHIFT - c->count_bits);
  return m->actual - (int64_t)beyond * m->position_scale + below;
}

static bool came(uint32_t motor, const struct capture* c) {
  if (c->on_error) return motors[motor].found.warning_error;
  return c->status != 0 && (*c->status & CAPTURED) != 0u;
}

bool capture_servo(uint32_t motor, const struct capture* c, int64_t* position) {
  if (!came(motor, c)) return false;
  *position = captured_position(motor, c);
  return true;
}
