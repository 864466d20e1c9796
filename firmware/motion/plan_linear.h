/* LINEAR moves, DELAY and DWELL. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_LINEAR_H
#define FIRMWARE_MOTION_PLAN_LINEAR_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/language/word.h"

double plan_feed(uint32_t cs, double fastest); /* F within its limits; at most `fastest`, if that is above 0 */
/* Tm in ms of a move of the axes in `moving` by such a feedrate. False: it goes by that, and it is none. */
bool plan_feed_time(uint32_t cs, const double delta[AXIS_COUNT], uint32_t moving, double feed, double* time);
bool plan_linear(uint32_t cs); /* false: it would need a feedrate, and that is not above 0 */
/* RATE_DWELL stops blending and is timed by the servo clock alone; RATE_DELAY is a move of no distance. */
void plan_wait(uint32_t cs, enum rate kind, double milliseconds);

#endif
