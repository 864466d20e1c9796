/* From the output of the servo loop to the word of Ixx02, or to commutation. */
#ifndef FIRMWARE_MOTION_MOTOR_OUTPUT_H
#define FIRMWARE_MOTION_MOTOR_OUTPUT_H

#include <stdint.h>

void motor_output_initialize(void);              /* start-up, before variables are taken over */
void motor_output_motor_changed(uint32_t motor); /* 1..32: a variable of it was written */
void motor_output_servo(uint32_t motor);         /* 0..31, servo task */

#endif
