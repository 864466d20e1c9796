#include "firmware/motion/motor_state.h"

#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/commutation.h"
#include "firmware/motion/conversion_table.h"
#include "firmware/motion/desired_path.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_flags.h"
#include "firmware/motion/motor_output.h"
#include "firmware/motion/notch.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/position_loop.h"
#include "firmware/variables/i_variables.h"

static bool is_activated(uint32_t motor) { return ((motors_active >> motor) & 1u) != 0u; }

bool motor_may_enable(uint32_t motor) { return is_activated(motor) && status_motors_may_enable(); }

bool motor_may_close(uint32_t motor) {
  const uint32_t first = i_motor(motor + 1u, IXX03_FEEDBACK_ADDRESS); /* then velocity */
  return motor_may_enable(motor) && !phasing_is_missing(motor) && !phasing_is_searched(motor) &&
         i_integer(i_esa(motor + 1u, IYY00_EXTENDED_SERVO)) == 0 &&
         !conversion_table_is_not_built((uint32_t)i_integer(first)) &&
         !conversion_table_is_not_built((uint32_t)i_integer(first + 1u));
}

/* Faults are forgotten; those that last are found again by the next pass of protection. The servo task looks at none of
 * it while the loop is not closed. */
static void forget(uint32_t motor) {
  motors[motor].found = (struct motor_findings){.warning_error = false};
  notch_restart(motor);
}

static void enable(uint32_t motor, enum motor_loop loop) {
  jog_drop(motor);
  motors[motor].loop = loop;
  motors_enabled |= 1u << motor;
  commutation_enable(motor, true);
  motor_flags_enable(motor, true);
}

/* The real-time task may have taken the motor away since it was looked at. Servo task held off. */
static bool is_still_there(uint32_t motor) {
  return ((motors_active & ~phasing_missing & ~phasing_searched) >> motor & 1u) != 0u;
}

bool motor_close(uint32_t motor) {
  if (motors[motor].loop == LOOP_CLOSED) return true;
  if (!motor_may_close(motor)) return false;
  forget(motor);
  desired_path_look_at_tables(motor);
  const uint32_t state = hal_mask_servo();
  const bool there = is_still_there(motor);
  if (there) {
    desired_path_stand(motor);
    position_loop_restart(motor);
    enable(motor, LOOP_CLOSED);
  }
  hal_unmask(state);
  return there;
}

/* A loop that a search for a phase reference has opened is opened anew, which ends that. */
bool motor_open(uint32_t motor, int32_t output) {
  const bool opens = motors[motor].loop != LOOP_OPEN || phasing_is_searched(motor);
  if (!motor_may_enable(motor)) return false;
  if (opens) forget(motor);
  const uint32_t state = hal_mask_servo();
  const bool may = is_activated(motor); /* the real-time task may have taken it away */
  if (may) motors[motor].open_output = output;
  if (may && opens) enable(motor, LOOP_OPEN);
  hal_unmask(state);
  return may;
}

/* Whatever there is of it, a search for a phase reference too. */
void motor_kill(uint32_t motor) {
  if (!is_activated(motor)) return;
  const uint32_t state = hal_mask_servo();
  motor_flags_enable(motor, false);
  motors[motor].loop = LOOP_KILLED;
  motors_enabled &= ~(1u << motor);
  motors[motor].output = 0;
  motors[motor].found.in_position = false;
  commutation_enable(motor, false);
  motor_output_servo(motor); /* no command stands until the next servo interrupt */
  jog_drop(motor);
  hal_unmask(state);
}
