/* Program execution and motion of the 16 coordinate systems, called by the kernel's tasks. */
#ifndef FIRMWARE_MOTION_MOTION_H
#define FIRMWARE_MOTION_MOTION_H

#include <stdbool.h>
#include <stdint.h>

void motion_initialize(void);        /* power-up, $$$ and $$$***: buffers empty, coordinate systems idle */
void motion_servo_update(void);      /* servo task, once per servo interrupt: integer arithmetic, timers */
void motion_real_time_update(void);  /* real-time task: plans moves, consumes rotary lines, evaluates BREQ */
void motion_background_update(void); /* background pass: status bits, in position */
uint32_t motion_cs_status(uint32_t cs, unsigned word); /* words 0..2 of ?? */
uint32_t motion_global_status2(void);                  /* bits of the second ??? word that buffers own */
bool motion_any_running(void);

/* Host signals, written only by the real-time and background tasks through buffers/buffer_request.c */
void buffer_request_evaluate(void); /* addressed C.S., I16 or I17 changed: pin shows the selected C.S. */

#endif
