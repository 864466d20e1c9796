/* Status words of the coordinate systems and of the buffers (firmware:5.4 to firmware:5.6, firmware:5.8). */
#ifndef FIRMWARE_MOTION_MOTION_STATUS_H
#define FIRMWARE_MOTION_MOTION_STATUS_H

#include <stdint.h>

uint32_t motion_cs_status(uint32_t cs, unsigned word); /* words 0..2 of ?? */
uint32_t motion_global_status2(void);                  /* the second word of ??? */

#endif
