/* Moves on which each motor goes for itself (motion:5.5), at the rate of the system: RAPID, and HOME in a program. They
 * begin and end at rest. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_OWN_H
#define FIRMWARE_MOTION_PLAN_OWN_H

#include <stdint.h>

void plan_rapid(uint32_t cs);
void plan_home(uint32_t cs, uint32_t motors);
void plan_own_begin(uint32_t cs); /* of the calculated one, at rest: its motors are asked to go */

#endif
