#include "firmware/motion/desired_position.h"

#include "firmware/motion/motor.h"

void desired_position_motor_changed(uint32_t motor) { (void)motor; }
void desired_position_tables_changed(void) {}
void desired_position_servo(uint32_t motor) { motors[motor].commanded = motors[motor].trajectory; }
void desired_position_take_actual(uint32_t motor) { motors[motor].trajectory = motors[motor].actual; }

void desired_position_shift(uint32_t motor, int64_t by) {
  motors[motor].trajectory += by;
  motors[motor].commanded += by;
  motors[motor].actual += by;
}
