/* The controller's 48-bit floating-point word: 36-bit two's-complement mantissa m / 2^35 in [0.5, 1) or [-1, -0.5), and
 * a 12-bit exponent E; value = m * 2^(E - 2047). X holds mantissa bits 35..12, Y bits 23..12 the rest of it and 11..0
 * E. Converted bit by bit to and from IEEE double: no floating-point arithmetic, because every P and Q access comes
 * here. */
#include "firmware/base/float48.h"

#include "firmware/hal/hal.h"

enum { DOUBLE_BIAS = 1022, WORD_BIAS = 2047 };

union double_bits {
  double value;
  uint64_t bits;
};

struct float48 float48_pack(double value) {
  const union double_bits u = {.value = value};
  const struct float48 zero = {0, 0};
  int32_t exponent = (int32_t)((u.bits >> 52) & 0x7FFu);
  if (exponent == 0) return zero; /* zero, and denormals that are far below any use */
  exponent += WORD_BIAS - DOUBLE_BIAS;
  /* 53 significant bits to 35, rounded half up. */
  uint64_t mantissa = (u.bits & 0xFFFFFFFFFFFFFull) | 0x10000000000000ull;
  mantissa = (mantissa + (1ull << 17)) >> 18;
  if (mantissa >> 35 != 0u) {
    mantissa >>= 1;
    ++exponent;
  }
  if (u.bits >> 63 != 0u) {
    if (mantissa == 1ull << 34) { /* -0.5 is written as -1 x 2^-1 */
      mantissa <<= 1;
      --exponent;
    }
    mantissa = 0u - mantissa;
  }
  if (exponent > 4095) exponent = 4095;
  const struct float48 word = {(uint32_t)(mantissa >> 12) & HAL_WORD_MASK,
                               ((uint32_t)(mantissa & 0xFFFu) << 12) | ((uint32_t)exponent & 0xFFFu)};
  return word;
}

double float48_unpack(struct float48 word) {
  int64_t mantissa = ((int64_t)hal_signed(word.x) * 4096) + (int64_t)((word.y >> 12) & 0xFFFu);
  union double_bits u = {.bits = 0};
  if (mantissa == 0) return 0.0;
  if (mantissa < 0) {
    u.bits = 1ull << 63;
    mantissa = -mantissa;
  }
  int32_t exponent = (int32_t)(word.y & 0xFFFu) - WORD_BIAS + DOUBLE_BIAS;
  /* The mantissa stands for m / 2^35; bring its leading one to bit 52. Unnormalised words are accepted. */
  uint64_t magnitude = (uint64_t)mantissa << 18;
  while (magnitude < (1ull << 52)) {
    magnitude <<= 1;
    --exponent;
  }
  if (magnitude >> 53 != 0u) {
    magnitude >>= 1;
    ++exponent;
  }
  if (exponent <= 0) return 0.0;
  if (exponent >= 0x7FF) exponent = 0x7FE;
  u.bits |= ((uint64_t)exponent << 52) | (magnitude & 0xFFFFFFFFFFFFFull);
  return u.value;
}

double float48_round(double value) { return float48_unpack(float48_pack(value)); }
