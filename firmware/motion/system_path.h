/* Servo task of the coordinate systems: each busy one's time base, then its ring of pieces, by which its motors go.
 * Integer arithmetic only. */
#ifndef FIRMWARE_MOTION_SYSTEM_PATH_H
#define FIRMWARE_MOTION_SYSTEM_PATH_H

void system_path_servo(void);

#endif
