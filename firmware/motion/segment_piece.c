#include "firmware/motion/segment_piece.h"

/* value / 6, rounded to nearest; most are differences that 32 bits hold. */
static int64_t sixth(int64_t value) {
  const int64_t shifted = value >= 0 ? value + 3 : value - 3;
  if (shifted <= INT32_MAX && shifted >= INT32_MIN) return (int32_t)shifted / 6;
  return shifted / 6;
}

static int64_t knot(int64_t before, int64_t at, int64_t after) { return at + sixth((before - at) + (after - at)); }

/* What is lost by rounding of the inner coefficients is the linear one's: ends are knots. */
struct cubic segment_cubic(const int64_t points[SPLINE_POINTS]) {
  const int64_t first = points[1] - points[0], second = points[2] - points[1], third = points[3] - points[2];
  struct cubic c = {.start = knot(points[0], points[1], points[2])};
  c.square = (second - first) / 2;
  c.cube = sixth((third - second) - (second - first));
  c.linear = knot(points[1], points[2], points[3]) - c.start - c.square - c.cube;
  return c;
}
