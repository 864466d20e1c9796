/* Planning of moves whose paths are made of segments (motion:7.1): into the queue of motion/path.h. Real-time task, in
 * slices. */
#ifndef FIRMWARE_MOTION_PLAN_PATH_H
#define FIRMWARE_MOTION_PLAN_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/path.h"

#define PATH_LEAST_MS 0.5 /* of a move without acceleration time */

bool plan_by_segments(uint32_t cs);         /* a line of LINEAR or CIRCLE is to be planned here */
enum run_time_error plan_path(uint32_t cs); /* to the pending targets */
void plan_path_delay(uint32_t cs, double milliseconds);
bool plan_path_time(const struct path_move* m, double* time); /* ms, by F. False: that is none */

#endif
