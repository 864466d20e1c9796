/* Planning of moves whose paths are made of segments (motion:7.1): into the queue of motion/path.h. Real-time task, in
 * slices. */
#ifndef FIRMWARE_MOTION_PLAN_PATH_H
#define FIRMWARE_MOTION_PLAN_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/coordinate_system.h"

bool plan_by_segments(uint32_t cs);         /* a line of LINEAR or CIRCLE is to be planned here */
enum run_time_error plan_path(uint32_t cs); /* to the pending targets */
/* Moves that have been planned and not begun: there, and in the time of their ways. It becomes where they end. */
void plan_path_begin_at(uint32_t cs, double position[AXIS_COUNT]);
void plan_path_delay(uint32_t cs, double milliseconds);

#endif
