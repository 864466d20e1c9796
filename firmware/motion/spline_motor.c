#include "firmware/motion/spline_motor.h"

static const uint64_t SIXTH = UINT64_C(0x2AAAAAAAAAAAAAAB); /* 2^64 / 6 */

static int64_t sixth(int64_t value) {
  const uint64_t magnitude = (value < 0 ? 0u - (uint64_t)value : (uint64_t)value) + 3u;
  const int64_t part = (int64_t)fixed_multiply_high(magnitude, SIXTH);
  return value < 0 ? -part : part;
}

/* `first` and `last`: velocities at its ends, over its time. */
static struct cubic between(int64_t from, int64_t to, int64_t first, int64_t last) {
  const int64_t way = to - from;
  return (struct cubic){from, first, 3 * way - 2 * first - last, first + last - 2 * way};
}

struct spline_motor spline_motor_point(const struct spline_motor* before, int64_t point, uint32_t share,
                                       struct cubic cubics[SPLINE_PIECES]) {
  const int64_t way = point - before->point, both = before->way + way;
  const int64_t knot = before->point + sixth(way - before->way), last = point - sixth(way);
  const int64_t slope_before = fixed_part(both, share), slope = both - slope_before; /* in its two times */
  cubics[0] = between(before->knot, knot, before->slope, slope_before);
  cubics[1] = between(knot, last, slope, way / 2);
  cubics[2] = between(last, point, way / 2, 0);
  return (struct spline_motor){point, way, knot, slope};
}
