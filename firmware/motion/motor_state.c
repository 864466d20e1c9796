#include "firmware/motion/motor_state.h"

#include "firmware/motion/motor.h"

bool motor_may_close(uint32_t motor) { return !motors[motor].status.reference_missing; }

bool motor_close(uint32_t motor) {
  if (!motor_may_close(motor)) return false;
  motors[motor].loop = LOOP_CLOSED;
  return true;
}

void motor_open(uint32_t motor, int32_t output) {
  motors[motor].open_output = output;
  motors[motor].loop = LOOP_OPEN;
}

void motor_kill(uint32_t motor) { motors[motor].loop = LOOP_KILLED; }
