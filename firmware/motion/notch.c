/* Coefficients have 30 fraction bits. */
#include "firmware/motion/notch.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/variables/i_variables.h"

enum { COEFFICIENTS = 4, COEFFICIENT_BITS = 30 };
#define STATE_MOST (INT64_C(1) << 54)

enum { N1, N2, D1, D2 };

static struct filter {
  int32_t coefficient[COEFFICIENTS]; /* V */
  int64_t past[COEFFICIENTS];        /* S: inputs, the last and the one before, then outputs */
} filters[MOTORS];

uint32_t notches_used; /* V */

static int32_t coefficient_of(double value) {
  const int64_t fixed = math_to_integer(math_scale(value, COEFFICIENT_BITS) + 0.5);
  if (fixed > INT32_MAX) return INT32_MAX;
  return fixed < INT32_MIN ? INT32_MIN : (int32_t)fixed;
}

void notch_initialize(void) {
  __builtin_memset(filters, 0, sizeof filters);
  notches_used = 0;
}

void notch_restart(uint32_t motor) {
  for (uint32_t i = 0; i < COEFFICIENTS; ++i) filters[motor].past[i] = 0;
}

void notch_motor_changed(uint32_t motor) {
  struct filter* f = &filters[motor - 1u];
  const bool was_used = notch_is_used(motor - 1u);
  int32_t coefficient[COEFFICIENTS];
  uint32_t used = 0;
  for (uint32_t i = 0; i < COEFFICIENTS; ++i) {
    const double value = i_variable_read(I_MOTOR_BLOCK * motor + (uint32_t)IXX36_NOTCH_FILTER + i);
    coefficient[i] = value == 0.0 ? 0 : coefficient_of(value);
    if (coefficient[i] != 0) used = 1u << (motor - 1u);
  }
  const uint32_t state = hal_mask_servo();
  for (uint32_t i = 0; i < COEFFICIENTS; ++i) f->coefficient[i] = coefficient[i];
  notches_used = (notches_used & ~(1u << (motor - 1u))) | used;
  if (!was_used) notch_restart(motor - 1u);
  hal_unmask(state);
}

/* value * coefficient, for |value| up to STATE_MOST. */
static int64_t part(int64_t value, int32_t coefficient) {
  const int64_t high = (int64_t)(int32_t)(value >> 32) * coefficient;
  const int64_t low = (int64_t)coefficient * (int64_t)(uint32_t)value;
  return high * (1 << (32 - COEFFICIENT_BITS)) + (low >> COEFFICIENT_BITS);
}

int64_t notch(uint32_t motor, int64_t output) {
  struct filter* f = &filters[motor];
  const int64_t in = fixed_within_long(output, STATE_MOST);
  const int64_t out =
      fixed_within_long(in + part(f->past[N1], f->coefficient[N1]) + part(f->past[N2], f->coefficient[N2]) -
                            part(f->past[D1], f->coefficient[D1]) - part(f->past[D2], f->coefficient[D2]),
                        STATE_MOST);
  f->past[N2] = f->past[N1];
  f->past[N1] = in;
  f->past[D2] = f->past[D1];
  f->past[D1] = out;
  return out;
}
