/* The servo task's part of jogs (motion/jog.h): along the path, over to a new one when it begins, triggers. */
#ifndef FIRMWARE_MOTION_JOG_SERVO_H
#define FIRMWARE_MOTION_JOG_SERVO_H

#include <stdint.h>

void jog_servo(uint32_t motor); /* the trajectory of a motor on PATH_OWN, and whether it gets one */

#endif
