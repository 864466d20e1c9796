/* Home of a motor: the search, `HMZ`, and the absolute position at power-on (motion:4.3). Loops are
 * closed by who calls. Background and real-time task. */
#ifndef FIRMWARE_MOTION_HOMING_H
#define FIRMWARE_MOTION_HOMING_H

#include <stdbool.h>
#include <stdint.h>

bool homing_begin(uint32_t motor, uint32_t together); /* HM: at Ixx23 to the trigger, then to Ixx26 behind it */
void homing_here(uint32_t motor);                     /* HMZ: the commanded position is 0 */

#endif
