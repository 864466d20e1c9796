/* Motor data in the dual-ported RAM (host-bus:6.4): by the servo task every I47 cycles while I48 = 1, else by the
 * background every I50 while I57 = 1. Each motor's block is of one moment; a set of more than a few motors is written
 * in parts, so that no task is held up for long. */
#ifndef FIRMWARE_HOST_DPRAM_MOTORS_H
#define FIRMWARE_HOST_DPRAM_MOTORS_H

#include <stdbool.h>

void dpram_motors_initialize(void);
bool dpram_motors_servo(void); /* servo task; false: it has nothing to do until I47 or I48 are written */
void dpram_motors_pass(void);  /* background */

#endif
