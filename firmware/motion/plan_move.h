/* What planning of every mode shares. Real-time task, in slices: an abort forgets what is half planned, so only what an
 * abort sets anyway is written before the last pause. */
#ifndef FIRMWARE_MOTION_PLAN_MOVE_H
#define FIRMWARE_MOTION_PLAN_MOVE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/coordinate_system.h"

static inline double plan_larger(double a, double b) { return a > b ? a : b; }

int64_t plan_units(double milliseconds); /* rounded to the nearest 2^-23 ms, at most the longest time */
double plan_milliseconds(int64_t time);
struct move* plan_begin(uint32_t cs, enum move_kind kind); /* the move that is not the executing one */

/* Where the line goes: pending targets, other axes as they are. And the move's deltas. */
void plan_targets(uint32_t cs, struct move* m, double target[AXIS_COUNT]);
/* The move is calculated and ends at `target`, to be placed next (motion/place.h); `blends`: with the next one, if that
 * does too. */
void plan_finish(uint32_t cs, struct move* m, bool blends, const double target[AXIS_COUNT]);

#endif
