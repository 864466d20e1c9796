/* Two sine commands for an amplifier that closes its own current loop (motion:3.3). */
#ifndef FIRMWARE_MOTION_SINE_OUTPUT_H
#define FIRMWARE_MOTION_SINE_OUTPUT_H

#include <stdint.h>

#include "firmware/motion/phase_motor.h"

void sine_output(struct phase_motor* m, uint32_t angle); /* phase task */

#endif
