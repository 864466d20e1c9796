#include "firmware/motion/motor_variables.h"

#include "firmware/motion/desired_position.h"
#include "firmware/motion/motor_output.h"
#include "firmware/motion/position_loop.h"
#include "firmware/motion/protection.h"

void motor_variables_initialize(void) {}

void motor_variables_changed(uint32_t motor) {
  desired_position_motor_changed(motor);
  position_loop_motor_changed(motor);
  motor_output_motor_changed(motor);
  protection_motor_changed(motor);
}
