/* Background variable buffers in the dual-ported RAM (host-bus:6.7): words of memory that the host has listed are shown
 * to it, or written by it, while I55 = 1. Background task. */
#ifndef FIRMWARE_HOST_DPRAM_VARIABLES_H
#define FIRMWARE_HOST_DPRAM_VARIABLES_H

void dpram_variables_initialize(void);
void dpram_variables_pass(void);

#endif
