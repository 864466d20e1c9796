#include "firmware/motion/motor.h"

#include "firmware/base/mathematics.h"
#include "firmware/motion/fixed_point.h"

struct motor motors[MOTORS];
volatile uint32_t motors_active, motors_enabled, jogs_busy;

int64_t motor_position_of(uint32_t motor, double counts) {
  return math_to_integer(counts * (double)POSITION_SUBCOUNT * (double)motors[motor].position_scale + 0.5);
}

double motor_counts_of(uint32_t motor, int64_t position) {
  return (double)position / ((double)POSITION_SUBCOUNT * (double)motors[motor].position_scale);
}
