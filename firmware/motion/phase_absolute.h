/* Phase position from an absolute sensor: hall sensors, or a parallel word (motion:3.5; Ixx81, Ixx91). */
#ifndef FIRMWARE_MOTION_PHASE_ABSOLUTE_H
#define FIRMWARE_MOTION_PHASE_ABSOLUTE_H

#include <stdbool.h>
#include <stdint.h>

/* In units of Ixx71, motor 0..31. False: there is no sensor, its format is none of these, or the halls show what they
 * cannot. Background, real-time task. */
bool phase_absolute_read(uint32_t motor, int32_t* position);
bool phase_absolute_is_set(uint32_t motor); /* Ixx81 is not 0 */

#endif
