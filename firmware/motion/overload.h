/* Integrated overload of a motor, I2T (motion:6.3): current above the continuous limit Ixx57, summed up to Ixx58. */
#ifndef FIRMWARE_MOTION_OVERLOAD_H
#define FIRMWARE_MOTION_OVERLOAD_H

#include <stdbool.h>
#include <stdint.h>

void overload_initialize(void);                /* start-up, before variables are taken over */
void overload_motor_changed(uint32_t motor);   /* 1..32 */
void overload_servo(uint32_t motor);           /* 0..31, servo task */
bool overload_is_too_much(uint32_t motor);     /* 0..31: the sum is above Ixx58; */
bool overload_is_too_much_now(uint32_t motor); /* in the servo task */
extern uint32_t overload_watched;              /* bit n: motor n has an Ixx58 */

#endif
