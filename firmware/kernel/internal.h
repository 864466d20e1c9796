/* What the parts of the kernel share among themselves. */
#ifndef FIRMWARE_KERNEL_INTERNAL_H
#define FIRMWARE_KERNEL_INTERNAL_H

#include <stdbool.h>
#include <stdint.h>

/* bus_setup.c */
void bus_setup_first(void); /* wait states for the clock after reset */
void bus_setup(uint32_t i52, uint32_t i37);
uint32_t bus_setup_cpu_clock(void); /* I52 in force */

/* clock_watch.c */
void clock_watch_start(void); /* waits for the first phase interrupt, ten phase periods at most */
bool clock_watch_missing(void);
bool clock_watch_close(void); /* the background polls instead of sleeping */
void clock_watch_pass(void);  /* background: looks at the age of the last phase interrupt */
void clock_watch_poll(void);  /* background without clocks: servo and real-time tasks from the cycle counter */

/* tasks.c */
void tasks_initialize(void);
#define TASK_DURATIONS 0x000037u /* Y: servo task, X: phase task, in half CPU cycles */

/* phase_task.c */
void phase_task_initialize(void);            /* from the motor variables, with interrupts off */
extern volatile uint32_t kernel_phase_stamp; /* cycle counter at the last phase interrupt, written by image/trap.S */
extern volatile uint32_t
    kernel_phase_work; /* bit n-1: motor n is commutated. Not zero: image/trap.S calls kernel_phase_interrupt */

/* saved_data.c */
typedef enum { SAVED_NONE, SAVED_GOOD, SAVED_DAMAGED } saved_t;
saved_t saved_data_restore_variables(uint32_t* initial_ics); /* I; and the ICs found at the last re-initialisation */
void saved_data_restore_user_memory(void); /* P, Q, M of the data just accepted, into cleared memory */
void saved_data_write(uint32_t initial_ics);

/* kernel.c: status bits of the first global word */
void kernel_status_set(uint32_t bits); /* any task */

#endif
