/* Execution of program words. */
#ifndef FIRMWARE_RUN_CALCULATE_H
#define FIRMWARE_RUN_CALCULATE_H

#include <stdint.h>

void calculate_initialize(void);
void calculate_programs(void);      /* real-time task: a slice; running programs, as far ahead as their moves allow */
void calculate_go_on(void);         /* the same: the rest of a slice that was left before its time was over */
void calculate_forget(uint32_t cs); /* what is half calculated for it; real-time task held off, or outside of a slice */

#endif
