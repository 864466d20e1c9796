/* Averaged velocity of the motors, D:+$6F of their registers (motion:1.3/4). */
#ifndef FIRMWARE_MOTION_AVERAGE_VELOCITY_H
#define FIRMWARE_MOTION_AVERAGE_VELOCITY_H

#include <stdint.h>

void average_velocity_initialize(void);                  /* start-up */
void average_velocity_changed(uint32_t instance);        /* I60 was written */
void average_velocity_servo(void);                       /* servo task, behind all motors */
void average_velocity_shift(uint32_t motor, int64_t by); /* positions are counted from elsewhere. Servo task held off */
void average_velocity_restart(uint32_t motor);           /* it is activated: it has not moved. Servo task held off */
int64_t average_velocity(uint32_t motor);                /* 0..31; 1/(32 Ixx09) count a servo interrupt */
uint32_t average_velocity_word(uint32_t motor);          /* the same in 24 bits, which saturate */

#endif
