#include "firmware/motion/fixed_turn.h"

#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"

enum { TERMS = 5, QUARTER_BITS = FIXED_TURN_BITS - 2 };

#define PART_ONE (INT64_C(1) << 62)
#define EIGHTH_TURN INT64_C(3622009729038561280) /* pi / 4 */

/* 1 + first x + second x^2 + x^3 (...): what is behind it is small enough for 32 bits, the smallest term first. */
struct series {
  int64_t first, second;
  int32_t rest[TERMS];
  int32_t bits; /* what 1 is in them */
};
static const struct series cosine_series = {
    INT64_C(-2305843009213693952), INT64_C(192153584101141152), {-13, 2295, -302996, 27269634, -1527099483}, 40};
static const struct series sine_series = {
    INT64_C(-768614336404564608), INT64_C(38430716820228232), {-7, 1413, -220361, 24239674, -1745256552}, 43};

static int64_t product(int64_t a, int64_t b) { return fixed_share(a >> 2, b) * 4; }

static int64_t value(const struct series* s, int64_t square) {
  const int32_t by = (int32_t)(square >> 31);
  int32_t rest = s->rest[0];
  for (uint32_t i = 1; i < TERMS; i++) rest = s->rest[i] + fixed_high(rest, by) * 2;
  const int64_t behind = s->second + product(rest * (INT64_C(1) << (62 - s->bits)), square);
  slice_pause();
  return PART_ONE + product(s->first + product(behind, square), square);
}

/* Within an eighth of a turn about one of its quarters by the series. */
struct fixed_direction fixed_direction_of(int64_t angle) {
  const int64_t from_eighth = angle + (INT64_C(1) << (QUARTER_BITS - 1));
  const uint32_t quarter = (uint32_t)(from_eighth >> QUARTER_BITS) % 4u;
  const int64_t rest = angle - ((from_eighth >> QUARTER_BITS) << QUARTER_BITS); /* half a quarter to either side */
  const int64_t radian = product(rest * 128, EIGHTH_TURN);
  const int64_t square = product(radian, radian);
  const int64_t cosine = value(&cosine_series, square), sine = product(value(&sine_series, square), radian);
  switch (quarter) {
    case 0:
      return (struct fixed_direction){cosine, sine};
    case 1:
      return (struct fixed_direction){-sine, cosine};
    case 2:
      return (struct fixed_direction){-cosine, -sine};
    default:
      return (struct fixed_direction){sine, -cosine};
  }
}
