/* What the servo task does for each activated motor, once a servo interrupt. */
#ifndef FIRMWARE_MOTION_MOTOR_SERVO_H
#define FIRMWARE_MOTION_MOTOR_SERVO_H

void motors_servo(void);

#endif
