/* Status words of the motors (firmware:5.2, firmware:5.3). */
#ifndef FIRMWARE_MOTION_MOTOR_STATUS_H
#define FIRMWARE_MOTION_MOTOR_STATUS_H

#include <stdint.h>

uint32_t motor_status(uint32_t motor, unsigned word); /* motor 0..31, words 0 and 1 of ? */

#endif
