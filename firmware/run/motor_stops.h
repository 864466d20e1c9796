/* Commands that stop motors with their programs, from a host line, a program, the panel and control characters alike:
 * background and real-time task. */
#ifndef FIRMWARE_RUN_MOTOR_STOPS_H
#define FIRMWARE_RUN_MOTOR_STOPS_H

#include <stdint.h>

void motors_abort(uint32_t cs);  /* A: ramps to rest; loops that are open are closed, killed ones too unless I36 = 1 */
void motors_enable(uint32_t cs); /* E: loops are closed, where motors are */
void motors_abort_all(void);     /* ^A: motors of no coordinate system too */
void motors_kill_all(void);      /* ^K */

#endif
