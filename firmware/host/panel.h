/* The control panel port JPAN of Turbo PMAC boards (docs/boards.md). Other boards have none: nothing is ever active
 * there. */
#ifndef FIRMWARE_HOST_PANEL_H
#define FIRMWARE_HOST_PANEL_H

#include <stdint.h>

void panel_initialize(void); /* start-up: inputs that are low already ask for nothing */
void panel_changed(void);    /* I2 was written, any task */
void panel_select(void);     /* real-time task: FPDn/ select whose BREQ the host sees, while bit 0 of I2 is 0 */
void panel_pass(void);       /* background: the other inputs */
uint32_t panel_cs(void);     /* selected by FPDn/ and I59: 0..15; COORDINATE_SYSTEMS when it is none. Any task */

#endif
