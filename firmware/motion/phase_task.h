/* The phase task: commutation and current loops. */
#ifndef FIRMWARE_MOTION_PHASE_TASK_H
#define FIRMWARE_MOTION_PHASE_TASK_H

#include <stdint.h>

void phase_task_initialize(void);         /* from the motor variables, with interrupts off */
void phase_task_interrupt(void);          /* handler, called by image/trap.S when phase_task_work is not 0 */
extern volatile uint32_t phase_task_work; /* bit n-1: motor n is commutated */

/* A variable that the phase task uses was written, of motor 1..32. Background and real-time tasks. */
void phase_task_motor_changed(uint32_t motor);

#endif
