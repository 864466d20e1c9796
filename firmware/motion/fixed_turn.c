#include "firmware/motion/fixed_turn.h"

#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"

enum { TERMS = 7, QUARTER_BITS = FIXED_TURN_BITS - 2 };

#define PART_ONE (INT64_C(1) << 62)
#define EIGHTH_TURN INT64_C(3622009729038561280) /* pi / 4 */

/* (-1)^k / (2 k)! and (-1)^k / (2 k + 1)!, k from 1 on */
static const int64_t cosine_terms[TERMS] = {
    INT64_C(-2305843009213693952), INT64_C(192153584101141152), INT64_C(-6405119470038039), INT64_C(114377133393536),
    INT64_C(-1270857037706),       INT64_C(9627704831),         INT64_C(-52899477)};
static const int64_t sine_terms[TERMS] = {
    INT64_C(-768614336404564608), INT64_C(38430716820228232), INT64_C(-915017067148291), INT64_C(12708570377060),
    INT64_C(-115532457973),       INT64_C(740592679),         INT64_C(-3526632)};

static int64_t product(int64_t a, int64_t b) { return fixed_share(a / 4, b) * 4; }

static int64_t series(const int64_t terms[TERMS], int64_t square) {
  int64_t sum = terms[TERMS - 1];
  for (uint32_t i = TERMS - 1; i-- > 0;) sum = terms[i] + product(sum, square);
  slice_pause();
  return PART_ONE + product(sum, square);
}

/* Within an eighth of a turn about one of its quarters by the series. */
struct fixed_direction fixed_direction_of(int64_t angle) {
  const int64_t from_eighth = angle + (INT64_C(1) << (QUARTER_BITS - 1));
  const uint32_t quarter = (uint32_t)(from_eighth >> QUARTER_BITS) % 4u;
  const int64_t rest = angle - ((from_eighth >> QUARTER_BITS) << QUARTER_BITS); /* half a quarter to either side */
  const int64_t radian = product(rest * 128, EIGHTH_TURN);
  const int64_t square = product(radian, radian);
  const int64_t cosine = series(cosine_terms, square), sine = product(series(sine_terms, square), radian);
  slice_pause();
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
