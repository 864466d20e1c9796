/* Which PLCs are to run; nothing executes them yet. A mask has a bit a PLC. Background task. */
#ifndef FIRMWARE_RUN_PLC_CONTROL_H
#define FIRMWARE_RUN_PLC_CONTROL_H

#include <stdint.h>

void plc_control_initialize(void); /* all that there are come up enabled */
void plc_enable(uint32_t plcs);    /* from the top; resumes what was paused */
void plc_disable(uint32_t plcs);
void plc_pause(uint32_t plcs);
void plc_resume(uint32_t plcs);
uint32_t plc_enabled(void); /* and not paused */

#endif
