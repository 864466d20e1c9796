/* Where the present motion of a motor ends: D:+$47 of its registers (motion:1.3/3). */
#ifndef FIRMWARE_MOTION_MOTOR_TARGET_H
#define FIRMWARE_MOTION_MOTOR_TARGET_H

#include <stdint.h>

int64_t motor_target(uint32_t motor); /* 0..31; position. Any task but phase */

#endif
