#include "firmware/motion/jog.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/motor.h"

void jog_initialize(void) {}

bool jog_continuous(uint32_t motor, int direction) {
  (void)direction;
  return motors[motor].loop == LOOP_CLOSED;
}
bool jog_stop(uint32_t motor) { return motors[motor].loop == LOOP_CLOSED; }
bool jog_to(uint32_t motor, int64_t target) {
  (void)target;
  return motors[motor].loop == LOOP_CLOSED;
}
bool jog_until(uint32_t motor, int64_t target, int64_t distance) {
  (void)distance;
  return jog_to(motor, target);
}
bool jog_rapid(uint32_t motor, int64_t target, double speed) {
  (void)speed;
  return jog_to(motor, target);
}
bool jog_rapid_until(uint32_t motor, int64_t target, double speed, int64_t distance) {
  (void)distance;
  return jog_rapid(motor, target, speed);
}
bool jog_home(uint32_t motor, double velocity, int64_t offset) {
  (void)velocity;
  return jog_to(motor, offset);
}
bool jog_stop_at(uint32_t motor, double deceleration) {
  (void)deceleration;
  return jog_stop(motor);
}
void jog_drop(uint32_t motor) { motors[motor].path = PATH_STANDS; }
void jog_program_takes(uint32_t motor) { motors[motor].path = PATH_SYSTEM; }
bool jog_is_moving(uint32_t motor) { return motors[motor].path == PATH_OWN; }
bool jog_is_timed(uint32_t motor) { return jog_is_moving(motor); }
bool jog_is_searching(uint32_t motor) { return (void)motor, false; }
bool jog_is_homing(uint32_t motor) { return (void)motor, false; }
bool jog_is_aborting(uint32_t motor) { return (void)motor, false; }
bool jog_trigger_missed(uint32_t motor) { return (void)motor, false; }
bool jog_is_homed(uint32_t motor) { return (void)motor, false; }
void jog_set_homed(uint32_t motor, bool homed) { (void)motor, (void)homed; }
int64_t jog_position_before(uint32_t motor) { return motors[motor].trajectory; }
void jog_set_position_before(uint32_t motor, int64_t position) { (void)motor, (void)position; }
int64_t jog_commanded(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = motors[motor].trajectory;
  hal_unmask(state);
  return position;
}
void jog_servo(uint32_t motor) { (void)motor; }
bool jog_plan(void) { return false; }
