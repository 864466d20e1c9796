/* Where the axes of a coordinate system are at the present trajectory time. */
#ifndef FIRMWARE_MOTION_POSITION_H
#define FIRMWARE_MOTION_POSITION_H

#include "firmware/motion/coordinate_system.h"

/* Real-time task, in slices, while `settling` makes the servo task leave the system alone. */
void cs_present_position(const struct coordinate_system* s, double position[AXIS_COUNT]);

#endif
