#include "firmware/motion/segment_piece.h"

/* value / 6, rounded to nearest; most are differences that 32 bits hold. */
static int64_t sixth(int64_t value) {
  const int64_t shifted = value >= 0 ? value + 3 : value - 3;
  if (shifted <= INT32_MAX && shifted >= INT32_MIN) return (int32_t)shifted / 6;
  return shifted / 6;
}

/* What is lost by rounding of the inner coefficients is the linear one's: ends are knots. */
struct cubic segment_cubic(const int64_t points[SPLINE_POINTS]) {
  const int64_t way = points[2] - points[1];
  const int64_t bend = way - (points[1] - points[0]), next = points[3] - points[2] - way;
  const int64_t out = sixth(bend), in = sixth(next);
  struct cubic c = {.start = points[1] + out};
  c.square = bend / 2;
  c.cube = sixth(next - bend);
  c.linear = way + in - out - c.square - c.cube;
  return c;
}
