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
  /* V */
  int32_t continuous; /* Ixx57 */
  int32_t allowed;    /* its square */
  int64_t most, last; /* trips above `most`; `last` is as far as it goes: it has tripped long ago */
  /* S */
  int64_t sum;
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
  o->allowed = o->continuous * o->continuous;
  o->last = 2 * o->most;
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

static inline uint64_t current_squared(uint32_t motor) {
  if (!commutation_is_used(motor)) return square(motors[motor].output);
  const struct motor_current now = commutation_current(motor);
  return square(now.q) + square(now.d);
}

static inline void add(struct overload* o, int64_t more) {
  const int64_t sum = o->sum + more;
  o->sum = sum < 0 ? 0 : sum > o->last ? o->last : sum;
}

static __attribute__((noinline)) void add_linear(struct overload* o, uint64_t current) {
  add(o, ((int64_t)square_root(current) + o->continuous) * (1 << LINEAR_BITS));
}

/* The call is the last thing, so that what does not need it saves no registers. */
void overload_servo(uint32_t motor) {
  struct overload* o = &overloads[motor];
  FIXED_IN_REGISTER(o);
  const uint64_t current = current_squared(motor);
  if (o->continuous >= 0)
    add(o, (int64_t)current - o->allowed);
  else
    add_linear(o, current);
}

bool overload_is_too_much_now(uint32_t motor) {
  const struct overload* o = &overloads[motor];
  return o->most != 0 && o->sum > o->most;
}

bool overload_is_too_much(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const bool too_much = overload_is_too_much_now(motor);
  hal_unmask(state);
  return too_much;
}
