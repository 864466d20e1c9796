/* Moves of a path that have been planned and wait behind a stop, when the motors are somewhere else at the start that
 * follows (motion:7.1/8). Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_ANEW_H
#define FIRMWARE_MOTION_PLAN_ANEW_H

#include <stdint.h>

#include "firmware/motion/coordinate_system.h"

/* They begin at `position`, which becomes where they end. */
void plan_anew(uint32_t cs, double position[AXIS_COUNT]);

#endif
