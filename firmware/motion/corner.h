/* Corners at which moves do not blend (motion:5.3): which are too sharp for it (Isx83), and what passes between the
 * stop and the next move: motors come into position (Isx81), a pause (Isx82, Isx85). Real-time task. */
#ifndef FIRMWARE_MOTION_CORNER_H
#define FIRMWARE_MOTION_CORNER_H

#include <stdbool.h>

#include "firmware/motion/coordinate_system.h"

/* Whether a way is too sharp behind the one before it to blend; then also whether Isx82 counts. In slices. */
bool corner_is_sharp(uint32_t cs, const double before[AXIS_COUNT], const double after[AXIS_COUNT], bool* has_dwell);
void corner_plan(uint32_t cs, struct move* m); /* of a LINEAR move, its deltas known; in slices */
bool corner_waits(uint32_t cs);                /* before the calculated move, which does not blend */

#endif
