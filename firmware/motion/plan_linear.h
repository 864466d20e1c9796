/* LINEAR moves, DELAY and DWELL. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_LINEAR_H
#define FIRMWARE_MOTION_PLAN_LINEAR_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/language/word.h"

bool plan_linear(uint32_t cs); /* false: it would need a feedrate, and that is not above 0 */
/* RATE_DWELL stops blending and is timed by the servo clock alone; RATE_DELAY is a move of no distance. */
void plan_wait(uint32_t cs, enum rate kind, double milliseconds);

#endif
