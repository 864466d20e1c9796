/* LINEAR moves, DELAY and DWELL. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_LINEAR_H
#define FIRMWARE_MOTION_PLAN_LINEAR_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/language/word.h"

/* What the time of a line by F follows from. */
struct feedrate {
  double feed, unit; /* user units in so many ms */
  double alternate;  /* of axes that are not among `axes`; 0: they follow those */
  uint32_t axes;
};

struct feedrate plan_feedrate(uint32_t cs, double fastest); /* as it is now; at most `fastest`, if that is above 0 */
/* Tm in ms of a move. False: it goes by the feedrate, and that is none. */
bool plan_feed_time(const struct feedrate* f, const double delta[AXIS_COUNT], double* time);
bool plan_linear(uint32_t cs); /* false: it would need a feedrate, and that is not above 0 */
/* RATE_DWELL stops blending and is timed by the servo clock alone; RATE_DELAY is a move of no distance. */
void plan_wait(uint32_t cs, enum rate kind, double milliseconds);

#endif
