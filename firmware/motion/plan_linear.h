/* LINEAR moves, DELAY and DWELL. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_LINEAR_H
#define FIRMWARE_MOTION_PLAN_LINEAR_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/language/word.h"

/* Tm in ms of a feed-specified move of the axes in `moving`, its feedrate at most `fastest` if that is above 0. False:
 * it goes by a feedrate, and that is none. */
bool plan_feed_time(uint32_t cs, const double delta[AXIS_COUNT], uint32_t moving, double fastest, double* time);
bool plan_linear(uint32_t cs); /* false: it would need a feedrate, and that is not above 0 */
/* RATE_DWELL stops blending and is timed by the servo clock alone; RATE_DELAY is a move of no distance. */
void plan_wait(uint32_t cs, enum rate kind, double milliseconds);

#endif
