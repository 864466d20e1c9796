/* The shape of a change of velocity: over its length, with an S-curve of the given time at each end, it is up to three
 * cubics. With t the part of the length that has passed, the way is v0 t + (v1 - v0) risen(t), times the length. */
#ifndef FIRMWARE_MOTION_VELOCITY_CHANGE_H
#define FIRMWARE_MOTION_VELOCITY_CHANGE_H

#include <stdint.h>

enum { VELOCITY_PARTS = 3 };

struct velocity_part {
  int64_t time;        /* trajectory time, above 0 */
  double at, risen;    /* t and risen(t) at its end */
  double square, cube; /* of risen over this part, in the parameter of its cubic */
};

/* Parts of a change of `length`; none if that is 0. */
uint32_t velocity_change(int64_t length, int64_t s_curve, struct velocity_part parts[VELOCITY_PARTS]);

#endif
