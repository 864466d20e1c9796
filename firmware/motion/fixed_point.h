/* Formats of the numbers that the phase and servo tasks calculate with, which have no floating point. One place for
 * each, with its range and resolution.
 *
 * | name            | type     | unit                                   | range                                      |
 * | position        | int64_t  | 1/(32 Ixx08) count; 48 bits are shown  | +-2^62                                     |
 * | table result    | 24 bits  | 1/32 count                             | wraps                                      |
 * | raw velocity    | int32_t  | 1/(32 Ixx09) count a servo cycle       | saturates at 32 bits; 24 are shown         |
 * | trajectory time | int64_t  | 2^-23 ms, the unit of I10              | to 2^47: 2^23 ms                           |
 * | fraction        | uint32_t | 2^-32 of a piece                       | 0 <= u < 1                                 |
 * | output          | int32_t  | 2^-8 of a 16-bit output                | +-2^23                                     |
 * | angle           | uint32_t | 2^-32 of an electrical cycle           | wraps                                      |
 * | sine            | int32_t  | 2^-31; 24 bits of it                   | -1 <= x < 1                                |
 * | current         | int32_t  | 2^-28 of full scale                    | +-4: sums of two phases and their biases   |
 * | voltage         | int32_t  | 2^-23 of full voltage                  | +-256                                      |
 * | current gain    | int32_t  | 2^-27                                  | +-8                                        |
 * | part            | int64_t  | 2^-62                                  | -1 <= x <= 1                               |
 */
#ifndef FIRMWARE_MOTION_FIXED_POINT_H
#define FIRMWARE_MOTION_FIXED_POINT_H

#include <stdint.h>

enum { POSITION_SUBCOUNT = 32, OUTPUT_FRACTION_BITS = 8 };
enum { CURRENT_FRACTION_BITS = 28, VOLTAGE_FRACTION_BITS = 23, CURRENT_GAIN_FRACTION_BITS = 27 };

/* An address that the compiler keeps in a register: it would work out that of an element anew at every use, which costs
 * the servo task a tenth of its time. */
#define FIXED_IN_REGISTER(address) __asm__("" : "+r"(address))

/* What is next to `value` of -`most` to `most`. */
static inline int32_t fixed_within(int32_t value, int32_t most) {
  return value > most ? most : value < -most ? -most : value;
}
static inline int64_t fixed_within_long(int64_t value, int64_t most) {
  return value > most ? most : value < -most ? -most : value;
}
static inline int64_t fixed_smaller(int64_t a, int64_t b) { return a < b ? a : b; }
static inline int64_t fixed_larger(int64_t a, int64_t b) { return a > b ? a : b; }

/* Upper 64 of the 128 bits. */
static inline uint64_t fixed_multiply_high(uint64_t a, uint64_t b) {
  const uint64_t al = (uint32_t)a, ah = a >> 32, bl = (uint32_t)b, bh = b >> 32;
  const uint64_t middle = ah * bl + (al * bl >> 32), other = al * bh + (uint32_t)middle;
  return ah * bh + (middle >> 32) + (other >> 32);
}

/* Upper 32 of the 64 bits, rounded downwards. Where the compiler believes to know a sign it makes four instructions of
 * this one. */
static inline int32_t fixed_high(int32_t a, int32_t b) {
#ifdef BRICK_NATIVE
  return (int32_t)(((int64_t)a * b) >> 32);
#else
  int32_t high;
  __asm__("mulh %0, %1, %2" : "=r"(high) : "r"(a), "r"(b));
  return high;
#endif
}

/* The same of a number without a sign. */
static inline int32_t fixed_high_mixed(int32_t a, uint32_t b) {
#ifdef BRICK_NATIVE
  return (int32_t)(((int64_t)a * (int64_t)b) >> 32);
#else
  int32_t high;
  __asm__("mulhsu %0, %1, %2" : "=r"(high) : "r"(a), "r"(b));
  return high;
#endif
}

/* value * fraction, rounded downwards. */
static inline int64_t fixed_part(int64_t value, uint32_t fraction) {
  const int32_t high = (int32_t)(value >> 32);
  const uint32_t least = (uint32_t)((uint64_t)(uint32_t)value * fraction >> 32);
  const uint64_t product = (uint64_t)(uint32_t)fixed_high_mixed(high, fraction) << 32 | (uint32_t)high * fraction;
  return (int64_t)(product + least);
}

/* value * part, rounded to nearest; |value| < 2^61. */
static inline int64_t fixed_share(int64_t value, int64_t part) {
  const int64_t scaled = value * 4;
  const uint32_t a0 = (uint32_t)scaled, b0 = (uint32_t)part;
  const int32_t a1 = (int32_t)(scaled >> 32), b1 = (int32_t)(part >> 32);
  const uint32_t one = (uint32_t)b1 * a0, other = (uint32_t)a1 * b0;
  uint32_t low = (uint32_t)((uint64_t)a0 * b0 >> 32) + one;
  uint32_t carry = low < one ? 1u : 0u;
  low += other;
  carry += (low < other ? 1u : 0u) + (low >> 31);
  return (int64_t)a1 * b1 + fixed_high_mixed(b1, a0) + fixed_high_mixed(a1, b0) + (int64_t)carry;
}

#endif
