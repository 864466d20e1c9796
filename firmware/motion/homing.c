#include "firmware/motion/homing.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/desired_path.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/position_loop.h"
#include "firmware/variables/i_variables.h"

#define OFFSET_UNITS 16.0 /* of Ixx26 in a count */

bool homing_begin(uint32_t motor, uint32_t together) {
  const double velocity = i_variable_read((uint32_t)IXX22_JOG_SPEED + I_MOTOR_BLOCK * (motor + 1u) + 1u);
  const double offset = i_variable_read(i_motor(motor + 1u, IXX26_HOME_OFFSET)) / OFFSET_UNITS;
  return jog_home(motor, velocity, motor_position_of(motor, offset), together);
}

void homing_here(uint32_t motor) {
  const struct motor* m = &motors[motor];
  int64_t corrections;
  const uint32_t state = desired_path_hold(motor, 0, &corrections);
  jog_count_from(motor, m->loop == LOOP_CLOSED ? m->trajectory + motor_followed(motor) : m->actual, corrections);
  motors[motor].status.home_complete = true;
  hal_unmask(state);
  position_loop_show(motor); /* who asks behind `HMZ` is told 0 */
}
