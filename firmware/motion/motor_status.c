/* Made from variables, axis definitions and what each module knows of a motor when somebody asks. */
#include "firmware/motion/motor_status.h"

#include <stdbool.h>

#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/system_findings.h"
#include "firmware/variables/i_variables.h"

enum {
  M1_ACTIVATED = 23,
  M1_NEGATIVE_LIMIT = 22,
  M1_POSITIVE_LIMIT = 21,
  M1_EXTENDED_ALGORITHM = 20,
  M1_AMPLIFIER_ENABLED = 19,
  M1_OPEN_LOOP = 18,
  M1_MOVE_TIMER = 17,
  M1_INTEGRATION_MODE = 16,
  M1_DWELL = 15,
  M1_DATA_BLOCK_ERROR = 14,
  M1_DESIRED_VELOCITY_ZERO = 13,
  M1_ABORT_DECELERATION = 12,
  M1_SEARCH = 10,    /* for a trigger */
  M1_USER_SERVO = 8, /* and user phase */
  M1_ALTERNATE_SOURCE = 7,
  M1_PHASED = 6,
  M1_FOLLOWING = 4,    /* and offset mode */
  M1_CAPTURE_MODE = 2, /* and error trigger */
  M1_OUTPUT_MODE = 0,  /* and integrator in the velocity loop */
  M2_COORDINATE_SYSTEM = 20,
  M2_AXIS = 16,
  M2_ASSIGNED = 15,
  M2_AMPLIFIER_ENABLED = 14,
  M2_FOREGROUND_IN_POSITION = 13,
  M2_STOPPED_ON_DESIRED_LIMIT = 12,
  M2_STOPPED_ON_LIMIT = 11,
  M2_HOME_COMPLETE = 10,
  M2_PHASING = 9,
  M2_PHASE_REFERENCE_ERROR = 8,
  M2_TRIGGER_MOVE = 7,
  M2_INTEGRATED_ERROR = 6,
  M2_OVERLOAD = 5,
  M2_BACKLASH_DIRECTION = 4,
  M2_AMPLIFIER_FAULT = 3,
  M2_FATAL_ERROR = 2,
  M2_WARNING_ERROR = 1,
  M2_IN_POSITION = 0
};

enum { CODE_KINEMATIC = 5, COMMUTATED = 1, Y_SOURCE = 2, TWO_BITS = 3 };

static uint32_t variable(uint32_t motor, enum i_name ixxnn) { return (uint32_t)i_integer(i_motor(motor + 1u, ixxnn)); }
static uint32_t bit(bool value, unsigned position) { return value ? 1u << position : 0u; }

static bool dwells(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  const struct coordinate_system* s = &coordinate_systems[d->cs];
  return d->assigned && s->active && s->moves[s->executing].kind == MOVE_DWELL;
}

/* The next move of its program did not come in time; until that is started again. */
static bool had_no_data(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  const struct coordinate_system* s = &coordinate_systems[d->cs];
  return d->assigned && s->error == RUN_TIME_LATE && (s->motors >> motor & 1u) != 0u;
}

/* A move of a program is timed, and so is one of a jog whose end is known. */
static bool is_timed(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  const bool of_system = d->assigned && motors[motor].path == PATH_SYSTEM;
  return motors[motor].status.timed_move || (of_system && coordinate_systems[d->cs].active);
}

static uint32_t of_variables(uint32_t motor) {
  const uint32_t commutation = variable(motor, IXX01_COMMUTATION_ENABLE);
  return bit(variable(motor, IXX00_ACTIVATED) != 0u, M1_ACTIVATED) |
         bit(i_integer(i_esa(motor + 1u, IYY00_EXTENDED_SERVO)) != 0, M1_EXTENDED_ALGORITHM) |
         bit(variable(motor, IXX34_INTEGRATION_MODE) != 0u, M1_INTEGRATION_MODE) |
         (variable(motor, IXX59_USER_SERVO_ENABLE) & TWO_BITS) << M1_USER_SERVO |
         bit((commutation & Y_SOURCE) != 0u, M1_ALTERNATE_SOURCE) | bit((commutation & COMMUTATED) != 0u, M1_PHASED) |
         (variable(motor, IXX06_FOLLOWING_MODE) & TWO_BITS) << M1_FOLLOWING |
         (variable(motor, IXX97_CAPTURE_MODE) & TWO_BITS) << M1_CAPTURE_MODE |
         (variable(motor, IXX96_OUTPUT_MODE) & TWO_BITS) << M1_OUTPUT_MODE;
}

static uint32_t status1(uint32_t motor) {
  const struct motor* m = &motors[motor];
  const bool closed = m->loop == LOOP_CLOSED;
  return of_variables(motor) | bit(m->found.negative_limit, M1_NEGATIVE_LIMIT) |
         bit(m->found.positive_limit, M1_POSITIVE_LIMIT) | bit(m->loop != LOOP_KILLED, M1_AMPLIFIER_ENABLED) |
         bit(!closed, M1_OPEN_LOOP) | bit(is_timed(motor), M1_MOVE_TIMER) | bit(dwells(motor), M1_DWELL) |
         bit(had_no_data(motor), M1_DATA_BLOCK_ERROR) | bit(closed && m->desired_step == 0, M1_DESIRED_VELOCITY_ZERO) |
         bit(motors[motor].status.aborting, M1_ABORT_DECELERATION) | bit(motors[motor].status.home_search, M1_SEARCH);
}

/* 1 to 3: A, B, C; 4: U, V, W; 5: by inverse kinematics; 7: X, Y, Z. */
static uint32_t axis_code(const struct axis_definition* d) {
  static const uint8_t CODE[AXIS_COUNT] = {1, 2, 3, 4, 4, 4, 7, 7, 7};
  if (d->kinematic) return CODE_KINEMATIC;
  for (uint32_t axis = 0; axis < AXIS_COUNT; ++axis)
    if (d->scale[axis] != 0.0) return CODE[axis];
  return 0;
}

static uint32_t status2(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  const struct motor* m = &motors[motor];
  const struct motor_findings* found = &m->found;
  const uint32_t word =
      bit(m->loop != LOOP_KILLED, M2_AMPLIFIER_ENABLED) |
      bit(found->foreground_in_position && i_variable_foreground_in_position(), M2_FOREGROUND_IN_POSITION) |
      bit(found->on_desired_limit, M2_STOPPED_ON_DESIRED_LIMIT) | bit(found->on_limit, M2_STOPPED_ON_LIMIT) |
      bit(motors[motor].status.home_complete, M2_HOME_COMPLETE) | bit(phasing_is_searched(motor), M2_PHASING) |
      bit(phasing_is_missing(motor), M2_PHASE_REFERENCE_ERROR) |
      bit(motors[motor].status.trigger_move, M2_TRIGGER_MOVE) | bit(found->integrated_error, M2_INTEGRATED_ERROR) |
      bit(found->integrated_current, M2_OVERLOAD) |
      bit(desired_position_backlash_is_down(motor), M2_BACKLASH_DIRECTION) |
      bit(found->amplifier_fault, M2_AMPLIFIER_FAULT) | bit(found->fatal_error, M2_FATAL_ERROR) |
      bit(found->warning_error, M2_WARNING_ERROR) | bit(motor_in_position(motor), M2_IN_POSITION);
  if (!d->assigned) return word;
  return word | d->cs << M2_COORDINATE_SYSTEM | axis_code(d) << M2_AXIS | bit(true, M2_ASSIGNED);
}

uint32_t motor_status(uint32_t motor, unsigned word) { return word == 0u ? status1(motor) : status2(motor); }
