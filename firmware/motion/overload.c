/* The sum is kept in 2^-30 of a servo cycle at full current, so that a square of 16-bit outputs is added as it is. */
#include "firmware/motion/overload.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/commutation.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"

enum { SUM_BITS = 30, LINEAR_BITS = 15, ROUND = 1 << (OUTPUT_FRACTION_BITS - 1) };
enum { MOST_BITS = 18, FULL_SCALE = 32768 }; /* of a vector of measured currents: each up to four times full scale */

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

/* Its length, rounded downwards. Within 7 % by sight; each step leaves half the square of that, and never less than the
 * length. */
static uint32_t length(uint32_t a, uint32_t b) {
  const uint32_t most = a > b ? a : b, least = a > b ? b : a;
  if (most > FULL_SCALE) return square_root((uint64_t)a * a + (uint64_t)b * b);
  if (least == 0u) return most;
  const uint32_t square = a * a + b * b;
  uint32_t root = most + (least >> 2) + (least >> 3);
  root = (root + square / root) >> 1;
  root = (root + square / root) >> 1;
  return root * root > square ? root - 1u : root;
}

/* Of 16 bits. */
static inline int32_t rounded(int32_t output) { return (output + ROUND) >> OUTPUT_FRACTION_BITS; }

static inline struct motor_current current_of(uint32_t motor) {
  if (!commutation_is_used(motor)) return (struct motor_current){.q = rounded(motors[motor].output)};
  const struct motor_current now = commutation_current(motor);
  return (struct motor_current){rounded(now.q), rounded(now.d)};
}

static inline int64_t square(int32_t current) { return (int64_t)current * current; }

static inline uint32_t magnitude(int32_t current) { return current < 0 ? 0u - (uint32_t)current : (uint32_t)current; }

static inline void add(struct overload* o, int64_t more) {
  const int64_t sum = o->sum + more;
  o->sum = sum < 0 ? 0 : sum > o->last ? o->last : sum;
}

static __attribute__((noinline)) void add_linear(struct overload* o, struct motor_current current) {
  add(o, ((int64_t)length(magnitude(current.q), magnitude(current.d)) + o->continuous) * (1 << LINEAR_BITS));
}

/* The call is the last thing, so that what does not need it saves no registers. */
void overload_servo(uint32_t motor) {
  struct overload* o = &overloads[motor];
  FIXED_IN_REGISTER(o);
  const struct motor_current current = current_of(motor);
  if (o->continuous >= 0)
    add(o, square(current.q) + square(current.d) - o->allowed);
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
