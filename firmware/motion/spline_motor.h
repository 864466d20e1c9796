/* A motor along one point of a spline (motion:5.4/4), in integers: positions of motion/fixed_point.h. A point makes the
 * way to the way point before it known; behind that comes the end of the sequence, for want of a further point. */
#ifndef FIRMWARE_MOTION_SPLINE_MOTOR_H
#define FIRMWARE_MOTION_SPLINE_MOTOR_H

#include <stdint.h>

#include "firmware/motion/piece.h"

enum { SPLINE_PIECES = 3 }; /* to way point n - 1, to that of the last point, to the last point itself */

/* What the next point goes on with. At rest: both positions where the motor is, the rest 0. */
struct spline_motor {
  int64_t point, way;  /* the last point, and from the one before it */
  int64_t knot, slope; /* the way point before it, and the velocity there over the time of the last point */
};

/* On to `point`. `share`: of the time of the point before in the sum of both times, 2^-32. */
struct spline_motor spline_motor_point(const struct spline_motor* before, int64_t point, uint32_t share,
                                       struct cubic cubics[SPLINE_PIECES]);

#endif
