/* Rotary axes (motion:4.4/4): a turn of A, B or C is Ixx27 counts, and an absolute move of a program goes to its target
 * within one. Jogs and reported positions know nothing of it. Floating point. */
#ifndef FIRMWARE_MOTION_ROLLOVER_H
#define FIRMWARE_MOTION_ROLLOVER_H

#include <stdbool.h>
#include <stdint.h>

/* Counts. Where motor (0..31) has to go to from `from`, when its program says `to`: with Ixx27 above 0 the shortest
 * way, below 0 in the direction that the sign of `to` gives (`negative`, as -0 has none): -90 degrees are 270, from
 * above. Ixx27 = 0: to `to`. */
double rollover_target(uint32_t motor, double from, double to, bool negative);

#endif
