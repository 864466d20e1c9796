/* The automatic functions of the dual-ported RAM in the turns of the tasks. While all are off, a turn is one look: they
 * stand between a line of the host and BREQ. */
#ifndef FIRMWARE_HOST_DPRAM_FUNCTIONS_H
#define FIRMWARE_HOST_DPRAM_FUNCTIONS_H

#include <stdint.h>

void dpram_functions_initialize(void);
void dpram_functions_changed(uint32_t instance); /* a variable that turns one on or off was written. Any task */
void dpram_functions_pass(void);                 /* background */
void dpram_functions_servo(void);                /* servo task */

#endif
