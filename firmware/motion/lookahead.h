/* Lookahead (motion:7.3, motion:7.4): segments are kept in the buffer of DEFINE LOOKAHEAD before they are handed to the
 * servo task, and the square w of the rate at which each knot between two of them is passed is chosen so that no motor
 * exceeds Ixx16 and Ixx17.
 *
 *   oldest            front                              end: the last knot that is known
 *     |  executed       |  w at the front is fixed         |  w = 0, unless the sequence ends there
 *     +--+--+--+--+--+--+--+--+--+--+--+--+--+--+--+--+--+-+
 *                       |-->  forward: the largest w       |
 *                              that the sweep allows    <--|  sweep: the largest w from which it can stop
 *
 * A sweep goes back from the end to the front. It is made when the front has come to where the last one was still
 * about its own end, a quarter of Isx20 on. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_LOOKAHEAD_H
#define FIRMWARE_MOTION_LOOKAHEAD_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/lookahead_buffer.h"
#include "firmware/motion/lookahead_order.h"
#include "firmware/motion/path.h"
#include "firmware/motion/segment_piece.h"

/* A piece for the servo task: from one sixteenth of a segment to another, backwards too. */
struct lookahead_piece {
  uint32_t segment, first, last;
  int32_t rate; /* w at its begin */
  int64_t time; /* trajectory time */
  int32_t warp; /* as piece.warp */
  uint32_t number;
  struct path_line line;
};

/* A sequence of segments of `period` ms begins: whether it is looked ahead. */
bool lookahead_begin(uint32_t cs, uint32_t period);
bool lookahead_is_full(uint32_t cs);
/* The next control point, the last ones of the motors by number; move and line at it. */
void lookahead_add(uint32_t cs, const int64_t control[][SPLINE_POINTS], uint32_t number, const struct path_line* line);
void lookahead_close(uint32_t cs); /* the points so far are all */
/* Of a segment: its control points, each of all motors in their order. */
void lookahead_points(uint32_t cs, uint32_t segment, const struct lookahead_motor* points[SPLINE_POINTS]);

#endif
