#include "firmware/base/soft_double.h"

#include <stdbool.h>
#include <stdint.h>

enum { EXPONENT_BIAS = 1023, EXPONENT_MOST = 2047, FRACTION_BITS = 52, SPARE_BITS = 11 };
enum { DIGIT_BITS = 27, DIVISOR_BITS = 61, ESTIMATE_BITS = 4 };

#define SIGN (UINT64_C(1) << 63)
#define ONE (UINT64_C(1) << FRACTION_BITS)
#define INFINITE ((uint64_t)EXPONENT_MOST << FRACTION_BITS)
#define NO_NUMBER (INFINITE | ONE >> 1)

union bits {
  double value;
  uint64_t word;
};

static double value_of(uint64_t word) { return (union bits){.word = word}.value; }

/* To nearest, ties to even, without what is spare; a carry goes on into the exponent. */
static inline uint64_t nearest(uint64_t exponent, uint64_t significand) {
  const uint32_t rest = (uint32_t)significand & ((1u << SPARE_BITS) - 1u), half = 1u << (SPARE_BITS - 1);
  const uint64_t word = (significand >> SPARE_BITS) + exponent;
  return rest + ((uint32_t)word & 1u) > half ? word + 1u : word;
}

/* Too large, or below the smallest that has all of its bits. */
static __attribute__((noinline)) uint64_t extreme(int32_t exponent, uint64_t significand) {
  if (exponent > 0) return INFINITE;
  const uint32_t shift = (uint32_t)(1 - exponent);
  if (shift > 63u) return 0;
  return nearest(0, significand >> shift | (significand << (64u - shift) != 0 ? 1u : 0u));
}

/* Bit 63 of `significand` is 1; the lowest of them tells whether there is anything behind. That bit is one of the
 * exponent's when it has come down to its place. */
static inline double rounded(uint64_t sign, int32_t exponent, uint64_t significand) {
  const uint32_t below = (uint32_t)exponent - 1u;
  if (below >= EXPONENT_MOST - 1u) return value_of(sign | extreme(exponent, significand));
  return value_of(sign | nearest((uint64_t)below << FRACTION_BITS, significand));
}

/* Exponent and, in bits 52 to 0, significand of one that is not 0 and finite. */
static inline int32_t taken_apart(uint64_t word, uint64_t* significand) {
  const int32_t exponent = (int32_t)(word >> FRACTION_BITS) & EXPONENT_MOST;
  *significand = (word & (ONE - 1u)) | ONE;
  if (exponent != 0) return exponent;
  const uint64_t fraction = word & (ONE - 1u);
  const uint32_t shift = (uint32_t)__builtin_clzll(fraction) - SPARE_BITS;
  *significand = fraction << shift;
  return 1 - (int32_t)shift;
}

/* 0, infinite, or no number. */
static inline bool is_special(uint64_t word) { return (word << 1) - 1u >= (INFINITE << 1) - 1u; }
static bool is_zero(uint64_t word) { return word << 1 == 0; }
static bool is_no_number(uint64_t word) { return word << 1 > INFINITE << 1; }

static double special_product(uint64_t a, uint64_t b) {
  const uint64_t sign = (a ^ b) & SIGN;
  if (is_no_number(a) || is_no_number(b)) return value_of(NO_NUMBER);
  if (!is_zero(a) && !is_zero(b)) return value_of(sign | INFINITE);
  const bool other_is_infinite = (a << 1 == INFINITE << 1) || (b << 1 == INFINITE << 1);
  return value_of(other_is_infinite ? NO_NUMBER : sign);
}

double soft_double_product(double a, double b) {
  const uint64_t first = (union bits){a}.word, second = (union bits){b}.word;
  if (is_special(first) || is_special(second)) return special_product(first, second);
  uint64_t x, y;
  int32_t exponent = taken_apart(first, &x) + taken_apart(second, &y) - EXPONENT_BIAS + 1;
  x <<= SPARE_BITS;
  y <<= SPARE_BITS;
  const uint32_t xl = (uint32_t)x, xh = (uint32_t)(x >> 32), yl = (uint32_t)y, yh = (uint32_t)(y >> 32);
  const uint64_t low = (uint64_t)xl * yl, one = (uint64_t)xh * yl, other = (uint64_t)xl * yh;
  const uint64_t middle = (low >> 32) + (uint32_t)one + (uint32_t)other;
  uint64_t product = (uint64_t)xh * yh + (one >> 32) + (other >> 32) + (middle >> 32);
  if (product >> 63 == 0) {
    product <<= 1;
    exponent--;
  }
  if (((uint32_t)low | (uint32_t)middle) != 0) product |= 1u;
  return rounded((first ^ second) & SIGN, exponent, product);
}

static double special_quotient(uint64_t a, uint64_t b) {
  const uint64_t sign = (a ^ b) & SIGN;
  const bool no_number = is_no_number(a) || is_no_number(b) || (is_zero(a) && is_zero(b));
  if (no_number || (a << 1 == INFINITE << 1 && b << 1 == INFINITE << 1)) return value_of(NO_NUMBER);
  return value_of(is_zero(b) || a << 1 == INFINITE << 1 ? sign | INFINITE : sign);
}

static inline uint32_t high(uint32_t a, uint32_t b) { return (uint32_t)((uint64_t)a * b >> 32); }

/* 2^63 / by, which has bit 31 set, to 2^-28 of it: a step of Newton from 16 bits. */
static inline uint32_t inverse_of(uint32_t by) {
  const uint32_t inverse = (UINT32_MAX / (by >> 16)) << 15;
  return high(inverse, 0u - high(by, inverse)) << 1;
}

/* The next DIGIT_BITS of rest / by, which is below 1. The estimate is one too large at most, so one less is too small
 * by no more than a little. */
static inline uint32_t digit(uint64_t* rest, uint64_t by, uint32_t inverse) {
  uint32_t found = high((uint32_t)(*rest >> (DIVISOR_BITS - 32)), inverse) >> ESTIMATE_BITS;
  if (found != 0) found--;
  *rest = (*rest << DIGIT_BITS) - by * found; /* below 4 `by`, so 64 bits have it */
  for (; *rest >= by; found++) *rest -= by;
  return found;
}

double soft_double_quotient(double a, double b) {
  const uint64_t first = (union bits){a}.word, second = (union bits){b}.word;
  if (is_special(first) || is_special(second)) return special_quotient(first, second);
  uint64_t rest, by;
  int32_t exponent = taken_apart(first, &rest);
  exponent += EXPONENT_BIAS - taken_apart(second, &by);
  if (rest < by) {
    rest <<= 1;
    exponent--;
  }
  /* from 1 to 2; half of it is below 1 */
  rest <<= DIVISOR_BITS - FRACTION_BITS - 2;
  by <<= DIVISOR_BITS - FRACTION_BITS - 1;
  const uint32_t inverse = inverse_of((uint32_t)(by >> (DIVISOR_BITS - 32)));
  const uint64_t upper = digit(&rest, by, inverse), lower = digit(&rest, by, inverse);
  const uint64_t quotient = (upper << DIGIT_BITS) + lower;
  return rounded((first ^ second) & SIGN, exponent, quotient << (64 - 2 * DIGIT_BITS) | (rest != 0 ? 1u : 0u));
}
