/* The servo and the real-time task (firmware:8.1): when they run and how long they took. What they do stands in higher
 * layers and is reached through task_hooks. The phase task is motion's own (motion/phase_task.h). */
#ifndef FIRMWARE_KERNEL_TASKS_H
#define FIRMWARE_KERNEL_TASKS_H

#include <stdbool.h>
#include <stdint.h>

/* What the kernel calls; image/tables.c fills it in. */
struct task_hooks {
  void (*servo)(void); /* integer arithmetic only */
  void (*real_time)(void);
  uint32_t (*phase_period)(void); /* nominal, CPU cycles */
};
extern const struct task_hooks task_hooks;

/* Interrupt handlers, called by image/trap.S. */
void tasks_servo_interrupt(void);
void tasks_real_time_interrupt(void);

extern volatile uint32_t tasks_phase_stamp; /* cycle counter at the last phase interrupt, written by image/trap.S */

void tasks_initialize(void);
uint32_t tasks_servo_count(void);             /* servo interrupts since start, 32 bits */
bool tasks_real_time_is_periodic(void);       /* real-time task: not one that a control character asked for */
uint32_t tasks_real_time_slice(void);         /* CPU cycles that the real-time task may calculate at once */
uint32_t tasks_real_time_left(void);          /* and what is left of them in this interrupt */
void tasks_set_real_time_period(uint32_t i8); /* I8: servo interrupts between real-time tasks, less one. Any task */

#endif
