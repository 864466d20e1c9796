/* Planning of moves (motion:5, docs/moves.md): a line of axes becomes the move of its system that is not executing.
 * Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_H
#define FIRMWARE_MOTION_PLAN_H

#include <stdbool.h>
#include <stdint.h>

/* To the pending axis targets, as the mode has it; false: it would need a feedrate, and that is not above 0. */
bool plan_line(uint32_t cs);

#endif
