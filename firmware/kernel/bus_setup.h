/* CPU clock and Port A wait states (host-bus:2.4, host-bus:2.5). Both take effect at power-up and reset only. */
#ifndef FIRMWARE_KERNEL_BUS_SETUP_H
#define FIRMWARE_KERNEL_BUS_SETUP_H

#include <stdint.h>

void bus_setup_first(void); /* wait states for the clock after reset; before the first device access */
void bus_setup(uint32_t i52, uint32_t i37);
uint32_t bus_setup_cpu_clock(void); /* I52 in force */

#endif
