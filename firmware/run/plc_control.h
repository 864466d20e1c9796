/* Which PLCs run (firmware:4.3). A mask has a bit a PLC. Background and real-time task. Clients read the state of PLC n
 * in Y:$3100+n: bit 22 is 0 while it runs. */
#ifndef FIRMWARE_RUN_PLC_CONTROL_H
#define FIRMWARE_RUN_PLC_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#define PLC_ALL 0xFFFFFFFFu

void plc_control_initialize(void); /* all that there are come up enabled. User memory is there */
void plc_enable(uint32_t plcs);    /* from the top, but one that runs goes on */
void plc_disable(uint32_t plcs);   /* a scan under way is ended */
void plc_pause(uint32_t plcs);     /* a scan under way is left behind its statement ... */
void plc_resume(uint32_t plcs);    /* ... and gone on with */
uint32_t plc_enabled(void);        /* and not paused */
bool plc_is_paused(uint32_t plc);
bool plc_begins(uint32_t plc); /* it was enabled since the last call: its scan begins at the top */

#endif
