/* Pieces of moves that motors follow (motion/place.h). */
#ifndef FIRMWARE_MOTION_PLACE_MOTORS_H
#define FIRMWARE_MOTION_PLACE_MOTORS_H

#include <stdbool.h>
#include <stdint.h>

bool move_place_motors(uint32_t cs); /* false: no room now, or too late for what it goes on with */

#endif
