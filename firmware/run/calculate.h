/* Execution of program words. */
#ifndef FIRMWARE_RUN_CALCULATE_H
#define FIRMWARE_RUN_CALCULATE_H

void calculate_programs(void); /* real-time task: running programs, as far ahead as their moves allow */

#endif
