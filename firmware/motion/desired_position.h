/* Net desired position (motion:1.2): trajectory, master that is followed, compensation, backlash, filter. */
#ifndef FIRMWARE_MOTION_DESIRED_POSITION_H
#define FIRMWARE_MOTION_DESIRED_POSITION_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/compensation.h"
#include "firmware/motion/motor.h"

void desired_position_initialize(void);              /* start-up, before variables are taken over */
void desired_position_motor_changed(uint32_t motor); /* 1..32: a variable of it was written */
extern uint32_t desired_position_extras; /* V; bit n: motor n follows, holds back, or has a filter or backlash */
void desired_position_with_extras(uint32_t motor);
static inline void desired_position_servo(uint32_t motor) { /* 0..31, servo task: trajectory -> commanded, its step */
  struct motor* m = &motors[motor];
  if (m->loop != LOOP_CLOSED) return; /* the loop keeps it where the motor is */
  if (((desired_position_extras | compensation_of_position) >> motor & 1u) != 0u)
    return desired_position_with_extras(motor);
  const int64_t wanted = m->trajectory + m->master + m->compensation, step = wanted - m->commanded;
  m->commanded = wanted;
  m->desired_step = step == (int32_t)step ? (int32_t)step : step > 0 ? INT32_MAX : INT32_MIN;
}
void desired_position_pass(void); /* background: backlash may move on by Ixx85 */
/* 0..31, servo task held off, or in it: positions are counted from elsewhere, the trajectory is `by` more. A loop that
 * is closed is not sent elsewhere by its tables: its other positions are more by that, too, by which `corrections`,
 * what they add there (desired_path_corrections), are more than what they have added. */
void desired_position_shift(uint32_t motor, int64_t by, int64_t corrections);
bool desired_position_backlash_is_down(uint32_t motor); /* status word 2, bit 4 */

#endif
