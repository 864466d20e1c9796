/* Closed, open, killed: the loop of a motor (0..31) and its amplifier. Any task but servo and phase; the servo task is
 * held off meanwhile. Rings of jogs are not touched: motion/jog.h says where a closed loop goes. */
#ifndef FIRMWARE_MOTION_MOTOR_STATE_H
#define FIRMWARE_MOTION_MOTOR_STATE_H

#include <stdbool.h>
#include <stdint.h>

/* Closes at the actual position and enables; nothing to do if it is closed. False: it may not, because it is not
 * activated, the clocks are missing, it has no phase reference or its feedback is not built. */
bool motor_close(uint32_t motor);
bool motor_may_close(uint32_t motor);            /* what motor_close would say */
bool motor_may_enable(uint32_t motor);           /* activated, and no clock is missing */
bool motor_open(uint32_t motor, int32_t output); /* enables, with a fixed output (motion/fixed_point.h) */
void motor_kill(uint32_t motor);                 /* disables, output to its bias */

#endif
