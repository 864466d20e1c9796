/* Actual position and servo loop of a motor (motion:1.1), every Ixx60 + 1 servo interrupts. */
#ifndef FIRMWARE_MOTION_POSITION_LOOP_H
#define FIRMWARE_MOTION_POSITION_LOOP_H

#include <stdint.h>

void position_loop_motor_changed(uint32_t motor); /* 1..32: a variable of it was written */
void position_loop_servo(uint32_t motor);         /* 0..31, servo task: commanded -> actual, velocity, output */
void position_loop_restart(uint32_t motor);       /* 0..31, servo task held off: no integral, no history */
/* The word of Ixx03 that the actual position was last made of; any task. */
uint32_t position_loop_reading(uint32_t motor);
/* Servo task held off, or in it: the actual position is `by` more; the encoder's counter jumps, which is no movement.
 */
void position_loop_shift(uint32_t motor, int64_t by);
void position_loop_forget_movement(uint32_t motor);

#endif
