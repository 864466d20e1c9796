/* Date and time of day: seconds since 2000-01-01 00:00:00, where every power-up and reset begins. Background task. */
#ifndef FIRMWARE_KERNEL_CALENDAR_H
#define FIRMWARE_KERNEL_CALENDAR_H

#include <stdint.h>

void calendar_initialize(void); /* once the CPU clock is set */
uint32_t calendar_seconds(void);
void calendar_set(uint32_t seconds);

#endif
