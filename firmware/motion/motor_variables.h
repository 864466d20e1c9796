/* One effect for all variables of a motor that the servo task uses: each module makes its integers of them. */
#ifndef FIRMWARE_MOTION_MOTOR_VARIABLES_H
#define FIRMWARE_MOTION_MOTOR_VARIABLES_H

#include <stdint.h>

void motor_variables_initialize(void);        /* start-up: all motors, killed */
void motor_variables_changed(uint32_t motor); /* 1..32. Background, real-time task */

#endif
