/* `$*` (motion:4.4): the position of a motor that nobody has moved yet, 0 or that of an absolute sensor
 * (Ixx10, Ixx95). */
#ifndef FIRMWARE_MOTION_POWER_ON_POSITION_H
#define FIRMWARE_MOTION_POWER_ON_POSITION_H

#include <stdbool.h>
#include <stdint.h>

void power_on_positions_read(void); /* behind a start: sensors, but where Ixx80 bit 2 says not to */
/* Kills the motor (0..31), counts its encoder from 0, sets its position. False: its format is not built. Background. */
bool power_on_position_read(uint32_t motor);

#endif
