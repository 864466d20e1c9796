/* From the output of the servo loop to the word of Ixx02, or to commutation. */
#ifndef FIRMWARE_MOTION_MOTOR_OUTPUT_H
#define FIRMWARE_MOTION_MOTOR_OUTPUT_H

#include <stdint.h>

#include "firmware/motion/commutation.h"
#include "firmware/motion/motor.h"

void motor_output_initialize(void);              /* start-up, before variables are taken over */
void motor_output_motor_changed(uint32_t motor); /* 1..32: a variable of it was written */
void motor_output_write(uint32_t motor);         /* 0..31: the word of one that is not commutated */

extern uint32_t motor_output_commutated; /* bit n: motor n, by Ixx01 */

/* 0..31, servo task */
static inline void motor_output_servo(uint32_t motor) {
  if ((motor_output_commutated >> motor & 1u) != 0u)
    commutation_command(motor, motors[motor].output);
  else
    motor_output_write(motor);
}

#endif
