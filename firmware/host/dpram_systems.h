/* Global status and coordinate systems in the dual-ported RAM (host-bus:6.5), by the background every I50 servo cycles
 * while I49 = 1, a coordinate system a pass. */
#ifndef FIRMWARE_HOST_DPRAM_SYSTEMS_H
#define FIRMWARE_HOST_DPRAM_SYSTEMS_H

void dpram_systems_initialize(void);
void dpram_systems_pass(void);

#endif
