/* The time between two phase interrupts, as the I-variables of the IC that drives the clocks have it. */
#ifndef FIRMWARE_VARIABLES_PHASE_PERIOD_H
#define FIRMWARE_VARIABLES_PHASE_PERIOD_H

#include <stdint.h>

uint32_t phase_period(void); /* nominal, CPU cycles */

#endif
