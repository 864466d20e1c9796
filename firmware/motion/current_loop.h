/* Current loop with field orientation and three PWM commands (motion:3.4). */
#ifndef FIRMWARE_MOTION_CURRENT_LOOP_H
#define FIRMWARE_MOTION_CURRENT_LOOP_H

#include <stdint.h>

#include "firmware/motion/phase_motor.h"

/* Phase task. `words`: address of the motor's registers, where currents and integrators are shown. */
void current_loop(struct phase_motor* m, uint32_t angle, uint32_t words);

#endif
