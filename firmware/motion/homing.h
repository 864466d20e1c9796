/* Home of a motor: the search, `HMZ`, and the absolute position at power-on (datasheet/motion.md, section 4). Loops are
 * closed by who calls. Background and real-time task. */
#ifndef FIRMWARE_MOTION_HOMING_H
#define FIRMWARE_MOTION_HOMING_H

#include <stdbool.h>
#include <stdint.h>

bool homing_begin(uint32_t motor);   /* HM: at Ixx23 to the trigger, then to Ixx26 behind it; false: loop not closed */
void homing_here(uint32_t motor);    /* HMZ: the commanded position is 0 */
bool homing_is_over(uint32_t motor); /* for who waits: nothing moves it any more, found or not (jog_is_homed) */

#endif
