/* Actual position and servo loop of a motor (motion:1.1), every Ixx60 + 1 servo interrupts. */
#ifndef FIRMWARE_MOTION_POSITION_LOOP_H
#define FIRMWARE_MOTION_POSITION_LOOP_H

#include <stdbool.h>
#include <stdint.h>

void position_loop_initialize(void);              /* start-up, before variables are taken over */
void position_loop_begin(uint32_t motor);         /* 1..32, a start: its position counts from here, activated or not */
void position_loop_motor_changed(uint32_t motor); /* 1..32: a variable of it was written */
void position_loop_servo(uint32_t motor);         /* 0..31, servo task: commanded -> actual, velocity, output */
void position_loop_restart(uint32_t motor);       /* 0..31, servo task held off: no integral, no history */
/* Servo task held off: what the encoder does until the end of the next interrupt but one is no movement, because its
 * counter is cleared. */
void position_loop_forget_movement(uint32_t motor);

void position_loop_show(uint32_t motor); /* any task: its registers are as its positions are now */

/* 0..31, any task: what registers and protection show, and captures go by. */
uint32_t position_loop_reading(uint32_t motor); /* word of Ixx03 that the actual position was last made of */
int64_t position_loop_measured(uint32_t motor); /* the actual position with the movement since then; S */
int32_t position_loop_filtered(uint32_t motor); /* output of the PID before the notch, 24 bits */
int64_t position_loop_integral(uint32_t motor); /* position */
int64_t position_loop_step(uint32_t motor);     /* how far the desired position went at the last closure */
bool position_loop_is_limited(uint32_t motor);  /* the integral is at Ixx63 */

#endif
