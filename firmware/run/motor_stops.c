#include "firmware/run/motor_stops.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"

enum { I36_ABORT_ENABLES_NOT = I35_LATE_OPTIONS + 1 };

static bool is_active(uint32_t motor) { return i_integer(i_motor(motor + 1u, IXX00_ACTIVATED)) != 0; }
static bool is_of(uint32_t motor, uint32_t cs) {
  return axis_definitions[motor].assigned && axis_definitions[motor].cs == cs;
}

/* A motor that may not be enabled stays as it is. */
static void close_loop(uint32_t motor) {
  if (is_active(motor) && motors[motor].loop != LOOP_CLOSED) (void)motor_close(motor);
}

static void close_after_abort(uint32_t motor) {
  const bool killed_too = i_integer((uint32_t)I36_ABORT_ENABLES_NOT) == 0;
  if (motors[motor].loop == LOOP_OPEN || killed_too) close_loop(motor);
}

void motors_abort(uint32_t cs) {
  run_abort(cs);
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if (is_of(motor, cs)) close_after_abort(motor);
}

void motors_enable(uint32_t cs) {
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if (is_of(motor, cs)) close_loop(motor);
}

void motors_abort_all(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) run_abort(cs);
  for (uint32_t motor = 0; motor < MOTORS; motor++) {
    if (!is_active(motor)) continue;
    if (!axis_definitions[motor].assigned)
      (void)jog_stop_at(motor, i_variable_read(I_MOTOR_BLOCK * (motor + 1u) + (uint32_t)IXX15_ABORT_DECELERATION));
    close_after_abort(motor);
  }
}

/* Outputs first. */
void motors_kill_all(void) {
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if (is_active(motor)) motor_kill(motor);
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) run_abort(cs);
}
