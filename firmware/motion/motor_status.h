/* Status words of the motors (firmware:5.2, firmware:5.3). */
#ifndef FIRMWARE_MOTION_MOTOR_STATUS_H
#define FIRMWARE_MOTION_MOTOR_STATUS_H

#include <stdbool.h>
#include <stdint.h>

void motor_status_initialize(void);                   /* power-up, $$$ and $$$***, after the I-variables */
uint32_t motor_status(uint32_t motor, unsigned word); /* motor 0..31, words 0 and 1 of ? */

void motor_status_show_home(uint32_t motor, bool complete);

#endif
