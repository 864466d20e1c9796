/* Execution of PLCs (firmware:7.2, firmware:8.1). PLC 0 makes a whole scan in each real-time interrupt, however long it
 * takes; PLCs 1 to 31 take turns in the background, a scan a turn, which ends at the program's end or where a WHILE
 * loop goes back: there it goes on at its next turn. I5 says which of both run. */
#ifndef FIRMWARE_RUN_PLC_H
#define FIRMWARE_RUN_PLC_H

#include <stdbool.h>

void plc_initialize(void);     /* programs are there: all PLCs enabled, PLC 1 is the first */
void plc_real_time(void);      /* real-time task: PLC 0 */
bool plc_background_any(void); /* one of PLCs 1 to 31 has something to do, or PLC 0 is to be prepared */
void plc_background(void);     /* the next of them */

#endif
