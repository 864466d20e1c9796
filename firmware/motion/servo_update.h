/* What the servo task does about motion, once a servo interrupt. */
#ifndef FIRMWARE_MOTION_SERVO_UPDATE_H
#define FIRMWARE_MOTION_SERVO_UPDATE_H

void servo_update(void);

#endif
