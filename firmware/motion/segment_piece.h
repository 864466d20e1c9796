/* Pieces of the uniform cubic B-spline of a system's control points (motion:7.1/3), in integers. */
#ifndef FIRMWARE_MOTION_SEGMENT_PIECE_H
#define FIRMWARE_MOTION_SEGMENT_PIECE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/piece.h"

enum { SPLINE_POINTS = 4 };
enum { SEGMENT_SMALL = 1 << 27 }; /* of most segments all differences are */

/* value / 6, rounded to nearest. */
static inline int64_t segment_sixth(int64_t value) { return (value >= 0 ? value + 3 : value - 3) / 6; }

/* The compiler would divide, for 20 cycles. */
static inline int32_t segment_small_sixth(int32_t value) { return fixed_high(value + 3, 715827883); }

static inline bool segment_is_small(int64_t difference) {
  return difference <= SEGMENT_SMALL && difference >= -SEGMENT_SMALL;
}

/* From the knot about the second of its points to that about the third: (P[-1] + 4 P[0] + P[+1]) / 6, rounded. What is
 * lost by rounding of the inner coefficients is the linear one's: ends are knots. */
static inline void segment_cubic(int64_t before, int64_t first, int64_t second, int64_t after, struct cubic* c) {
  const int64_t ways[] = {first - before, second - first, after - second};
  if (segment_is_small(ways[0]) && segment_is_small(ways[1]) && segment_is_small(ways[2])) {
    /* the same in half of the time */
    const int32_t way = (int32_t)ways[1], bend = way - (int32_t)ways[0], next = (int32_t)ways[2] - way;
    const int32_t out = segment_small_sixth(bend), in = segment_small_sixth(next), square = bend / 2;
    const int32_t cube = segment_small_sixth(next - bend);
    c->start = first + out;
    c->linear = way + in - out - square - cube;
    c->square = square;
    c->cube = cube;
    return;
  }
  const int64_t way = ways[1], bend = way - ways[0], next = ways[2] - way;
  const int64_t out = segment_sixth(bend), in = segment_sixth(next), square = bend / 2;
  const int64_t cube = segment_sixth(next - bend);
  c->start = first + out;
  c->linear = way + in - out - square - cube;
  c->square = square;
  c->cube = cube;
}

#endif
