/* The time to BREQ (host-bus:5.7, T_FALL) is made of these statements: integers only, no division, and one look at each
 * character. A constant has up to nine digits, four of them behind the point, and is divided to 33 bits. The way by
 * floating point rounds twice, to 53 bits and then to 33, and comes to the same: n / 10^4 is a tie of 33 bits or at
 * least 2^-48 of its size away from one. Nor does it round up to a power of two: it is one, or at least 2^-30 of its
 * size away from it. */
#include "firmware/language/axis_constant.h"

enum { LONGEST = 9, DECIMALS = 4, PART_BITS = 16, WORD_BITS = 32 };

static const uint8_t AXIS_OF[26] = {1, 2, 3, ['U' - 'A'] = 4, 5, 6, 7, 8, 9}; /* one more than enum axis; 0: none */

/* n / divisor is n * reciprocal / 2^(32 + shift) for every n of 32 bits. */
static const struct power {
  uint32_t divisor, reciprocal, shift;
} POWER_OF_TEN[DECIMALS + 1] = {
    {1, 0, 0}, {10, 0xCCCCCCCDu, 3}, {100, 0x51EB851Fu, 5}, {1000, 0x10624DD3u, 6}, {10000, 0xD1B71759u, 13}};

static inline uint32_t divide(uint32_t* n, const struct power* power) { /* leaves the rest in *n */
  const uint32_t quotient = (uint32_t)((uint64_t)*n * power->reciprocal >> WORD_BITS) >> power->shift;
  *n -= quotient * power->divisor;
  return quotient;
}

static inline uint32_t next_part(uint32_t* rest, const struct power* power) {
  *rest <<= PART_BITS; /* it is below 10^4 */
  return divide(rest, power);
}

/* digits / 10^decimals as m / 2^32 x 2^exponent with the highest bit of m set, rounded half up. */
static __attribute__((noinline)) uint32_t fraction(uint32_t digits, uint32_t decimals, int32_t* exponent) {
  const struct power* power = &POWER_OF_TEN[decimals];
  uint32_t rest = digits, high = divide(&rest, power);
  uint32_t low = next_part(&rest, power) << PART_BITS;
  low |= next_part(&rest, power);
  *exponent = WORD_BITS;
  if (high == 0u) { /* 10^-4 at least: its first bit is in `low` */
    high = low;
    low = next_part(&rest, power) << PART_BITS;
    *exponent = 0;
  }
  const uint32_t zeros = (uint32_t)__builtin_clz(high);
  *exponent -= (int32_t)zeros;
  if (zeros != 0u) {
    high = high << zeros | low >> (WORD_BITS - zeros);
    low <<= zeros;
  }
  return high + (low >> (WORD_BITS - 1));
}

static inline const char* skip_blanks(const char* at) {
  while (*at == ' ' || *at == '\t') ++at;
  return at;
}

/* The digits and, behind a point, the decimals at *at. False: no number, or a longer one. */
static inline bool scan(const char** at, uint32_t* digits, uint32_t* decimals) {
  const char *text = *at, *const begin = text;
  uint32_t sum = 0, digit, points = 0;
  for (; (digit = (uint32_t)(uint8_t)*text - '0') <= 9u; ++text) sum = sum * 10u + digit;
  *decimals = 0;
  if (*text == '.' && text[1] != '.') { /* two points are a range */
    const char* const point = ++text;
    for (; (digit = (uint32_t)(uint8_t)*text - '0') <= 9u; ++text) sum = sum * 10u + digit;
    *decimals = (uint32_t)(text - point);
    points = 1;
  }
  *digits = sum;
  *at = text;
  return (uint32_t)(text - begin) - points - 1u < LONGEST && *decimals <= DECIMALS;
}

uint32_t axis_constants(const char** at, const char* boundary, word48_t* words, uint32_t most) {
  uint32_t count = 0, digits, decimals;
  while (count < most) {
    const char* text = skip_blanks(*at);
    if (boundary != 0 && text >= boundary) break; /* what stands there may still come */
    const uint32_t letter = (uint32_t)(uint8_t)*text - 'A';
    if (letter >= 26u || AXIS_OF[letter] == 0u) break;
    text = skip_blanks(text + 1);
    const char sign = *text;
    if (sign == '-' || sign == '+') text = skip_blanks(text + 1);
    if (!scan(&text, &digits, &decimals)) break;
    text = skip_blanks(text);
    if (*text == '^' || *text == ':') break; /* a second value follows */
    int32_t exponent = 0;
    uint32_t mantissa = digits;
    if (digits != 0u && decimals != 0u) {
      mantissa = fraction(digits, decimals, &exponent);
    } else if (digits != 0u) {
      const int zeros = __builtin_clz(digits);
      exponent = WORD_BITS - zeros;
      mantissa <<= zeros;
    }
    words[count++] = word_axis(AXIS_OF[letter] - 1u, sign == '-', mantissa, exponent);
    *at = text;
  }
  return count;
}
