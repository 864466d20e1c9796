/* What the servo task does for the coordinate systems. */
#ifndef FIRMWARE_MOTION_SERVO_UPDATE_H
#define FIRMWARE_MOTION_SERVO_UPDATE_H

void servo_update(void); /* once a servo interrupt: advances trajectory time, goes from move to move; integers only */

#endif
