/* The servo task's part of jogs (motion/jog.h): along the path, over to a new one when it begins, triggers. */
#ifndef FIRMWARE_MOTION_JOG_SERVO_H
#define FIRMWARE_MOTION_JOG_SERVO_H

#include <stdint.h>

#include "firmware/motion/motor.h"

void jog_move(uint32_t motor);

/* The trajectory of a motor on PATH_OWN, and whether it gets one. */
static inline void jog_servo(uint32_t motor) {
  if ((jogs_busy >> motor & 1u) != 0u) jog_move(motor);
}

#endif
