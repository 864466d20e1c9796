/* How fast a part of a path can be gone through within the acceleration limits of its motors (motion:7.4). With u the
 * part's share that is behind, ' for d/du, x the path of a motor over the program time T and w the square of the rate,
 * which changes linearly from w0 to w1, the acceleration is
 *
 *   q(u) = (x'' w + x' w' / 2) / T^2      x'' linear, x' quadratic in u: q is quadratic in u, and linear in w0 and w1
 *
 * Its values at both ends and the middle Bernstein coefficients of its four quarters bound q from outside: each asks
 * |c0 w0 + c1 w1| <= 1 for all motors. Integers; one part at a time. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_LOOKAHEAD_LIMITS_H
#define FIRMWARE_MOTION_LOOKAHEAD_LIMITS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/lookahead_buffer.h"

enum { RATE_BITS = 30, BEND_BITS = 14 }; /* w: 2^30 is 1. x'/(A T^2), x''/(A T^2): 2^14 is 1, within +-2^13 */

#define RATE_FULL (1 << RATE_BITS)
#define BEND_MOST (INT32_C(1) << 27)

enum limits_end { LIMITS_FIRST, LIMITS_SECOND };

/* Of the motors at the knots about a segment; and from one sixteenth of it to another. */
void limits_load(const struct lookahead_motor* at, const struct lookahead_motor* next, uint32_t motor_count);
void limits_load_part(const struct lookahead_motor* at, const struct lookahead_motor* next, uint32_t motor_count,
                      uint32_t first, uint32_t last);
/* The largest and the smallest w at one end, at most `most`, when it is `w` at the other. Below 0: there is none. */
int32_t limits_most(enum limits_end end, int32_t w, int32_t most);
int32_t limits_least(enum limits_end end, int32_t w, int32_t most);
/* How much w may change over a part whose bends ask for more than the limits anyway: by what is gained along it alone.
 */
int32_t limits_change(void);
/* The largest w at one end, at most `most`, with some w of at most `other` at the other. */
int32_t limits_reach(enum limits_end end, int32_t other, int32_t most);

#endif
