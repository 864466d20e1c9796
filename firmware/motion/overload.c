/* The sum is kept in 2^-30 of a servo cycle at full current, so that a square of 16-bit outputs is added as it is. */
#include "firmware/motion/overload.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/commutation.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"

enum { SUM_BITS = 30, LINEAR_BITS = 15, ROUND = 1 << (OUTPUT_FRACTION_BITS - 1) };
enum { MOST_BITS = 18 }; /* of a vector of measured currents: each up to four times full scale */

static struct overload {
  int32_t continuous; /* Ixx57, V */
  int64_t most;       /* V */
  int64_t sum;        /* S */
} overloads[MOTORS];

uint32_t overload_watched;

void overload_initialize(void) {
  __builtin_memset(overloads, 0, sizeof overloads);
  overload_watched = 0;
}

void overload_motor_changed(uint32_t motor) {
  struct overload* o = &overloads[motor - 1u];
  const uint32_t bit = 1u << (motor - 1u);
  const uint32_t state = hal_mask_servo();
  o->continuous = i_integer(i_motor(motor, IXX57_CONTINUOUS_CURRENT));
  o->most = (int64_t)i_integer(i_motor(motor, IXX58_INTEGRATED_CURRENT)) << SUM_BITS;
  overload_watched = o->most != 0 ? overload_watched | bit : overload_watched & ~bit;
  if (o->most == 0) o->sum = 0;
  hal_unmask(state);
}

static uint32_t square_root(uint64_t square) {
  uint32_t root = 0;
  for (uint32_t bit = 1u << (MOST_BITS - 1); bit != 0u; bit >>= 1)
    if ((uint64_t)(root | bit) * (root | bit) <= square) root |= bit;
  return root;
}

static uint64_t square(int32_t output) {
  const int64_t current = (output + ROUND) >> OUTPUT_FRACTION_BITS;
  return (uint64_t)(current * current);
}

void overload_servo(uint32_t motor) {
  struct overload* o = &overloads[motor];
  uint64_t current; /* squared */
  if (commutation_is_used(motor)) {
    const struct motor_current now = commutation_current(motor);
    current = square(now.q) + square(now.d);
  } else {
    current = square(motors[motor].output);
  }
  if (o->continuous >= 0)
    o->sum += (int64_t)current - o->continuous * o->continuous;
  else
    o->sum += ((int64_t)square_root(current) + o->continuous) * (1 << LINEAR_BITS);
  if (o->sum < 0) o->sum = 0;
  if (o->sum > 2 * o->most) o->sum = 2 * o->most; /* it has tripped long ago */
}

bool overload_is_too_much(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const bool too_much = overloads[motor].most != 0 && overloads[motor].sum > overloads[motor].most;
  hal_unmask(state);
  return too_much;
}
