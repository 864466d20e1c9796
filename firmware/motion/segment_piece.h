/* Pieces of the uniform cubic B-spline of a system's control points (motion:7.1/3), in integers. Real-time task, in
 * slices. */
#ifndef FIRMWARE_MOTION_SEGMENT_PIECE_H
#define FIRMWARE_MOTION_SEGMENT_PIECE_H

#include <stdint.h>

#include "firmware/motion/piece.h"

enum { SPLINE_POINTS = 4 };

/* From the knot about the second of its points to that about the third: (P[-1] + 4 P[0] + P[+1]) / 6, rounded. */
struct cubic segment_cubic(const int64_t points[SPLINE_POINTS]);

#endif
