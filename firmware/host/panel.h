/* The control panel port JPAN of Turbo PMAC boards (docs/boards.md). Other boards have none: nothing is ever active
 * there. */
#ifndef FIRMWARE_HOST_PANEL_H
#define FIRMWARE_HOST_PANEL_H

#include <stdbool.h>
#include <stdint.h>

void panel_initialize(void); /* start-up: inputs that are low already ask for nothing */
void panel_select(void);     /* real-time task: the number of FPDn/ */
void panel_pass(void);       /* background: the other inputs */
bool panel_active(void);     /* fitted, and bit 0 of I2 is 0: the panel selects whose signals the host sees. Any task */
uint32_t panel_cs(void);     /* selected by FPDn/ and I59: 0..15; COORDINATE_SYSTEMS when it is none. Any task */

#endif
