#include "firmware/motion/fixed_ratio.h"

#include "firmware/motion/fixed_point.h"

enum { ROOT_STEPS = 4 };
#define ROOT_ONE (UINT32_C(1) << 30)
#define ROOT_LINE UINT32_C(2287070085) /* 2.13 */

static uint32_t high(uint32_t a, uint32_t b) { return (uint32_t)((uint64_t)a * b >> 32); }

/* 2^63 / by, which has bit 31 set. Newton: each step doubles the bits that are right, 16 to begin with. */
static inline uint32_t inverse_of(uint32_t by) {
  const uint32_t inverse = (UINT32_MAX / (by >> 16)) << 15;
  return high(inverse, 0u - high(by, inverse)) << 1;
}

struct fixed_divisor fixed_divide_by(uint64_t by) {
  const uint32_t shift = (uint32_t)__builtin_clzll(by);
  const uint64_t normal = by << shift;
  const uint64_t found = (uint64_t)inverse_of((uint32_t)(normal >> 32)) << 31;
  const uint64_t better = fixed_multiply_high(found, (UINT64_C(1) << 63) - fixed_multiply_high(normal, found)) << 2;
  return (struct fixed_divisor){better, shift};
}

int64_t fixed_part_of(const struct fixed_divisor* by, int64_t value) {
  return (int64_t)fixed_multiply_high((uint64_t)value << by->shift, by->inverse);
}

int64_t fixed_ratio(int64_t value, int64_t by) {
  const struct fixed_divisor divisor = fixed_divide_by((uint64_t)by);
  return fixed_part_of(&divisor, value);
}

uint32_t fixed_fraction(uint32_t value, uint32_t by) {
  const uint32_t shift = (uint32_t)__builtin_clz(by);
  return high(value << shift, inverse_of(by << shift)) << 1;
}

/* By Newton for 1 / root of m, a quarter to 1, from a line that is within an eleventh of it. */
uint32_t fixed_root(uint32_t square) {
  if (square >= ROOT_ONE) return ROOT_ONE;
  if (square == 0u) return 0u;
  const uint32_t half = ((uint32_t)__builtin_clz(square) - 2u) / 2u, m = square << (2u * half);
  uint32_t inverse = ROOT_LINE - m - m / 32u * 7u; /* 2^30 is 1 */
  for (uint32_t i = 0; i < ROOT_STEPS; i++) {
    const uint32_t left = (UINT32_C(3) << 28) - high(m << 2, high(inverse, inverse));
    inverse = high(inverse, left << 2) << 1;
  }
  return high(m << 2, inverse) >> half;
}
