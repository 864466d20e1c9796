/* Planning of moves (motion:5, docs/moves.md): a line of axes becomes the move of its system that is not executing.
 * Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_H
#define FIRMWARE_MOTION_PLAN_H

#include <stdint.h>

#include "firmware/motion/coordinate_system.h"

/* To the pending axis targets, as the mode has it. NONE, or why it cannot be: then nothing of it is planned. */
enum run_time_error plan_line(uint32_t cs);

#endif
