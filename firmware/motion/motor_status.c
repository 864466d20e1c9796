/* Made from I-variables and axis definitions when somebody asks: no loop is closed, so no other bit has a cause. */
#include "firmware/motion/motor_status.h"

#include <stdbool.h>

#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/variables/i_variables.h"

enum {
  M1_ACTIVATED = 23,
  M1_EXTENDED_ALGORITHM = 20,
  M1_OPEN_LOOP = 18,
  M1_INTEGRATION_MODE = 16,
  M1_DWELL = 15,
  M1_USER_SERVO = 8, /* and user phase */
  M1_ALTERNATE_SOURCE = 7,
  M1_PHASED = 6,
  M1_FOLLOWING = 4,    /* and offset mode */
  M1_CAPTURE_MODE = 2, /* and error trigger */
  M1_OUTPUT_MODE = 0,  /* and integrator in the velocity loop */
  M2_COORDINATE_SYSTEM = 20,
  M2_AXIS = 16,
  M2_ASSIGNED = 15,
  M2_HOME_COMPLETE = 10,
  M2_PHASE_REFERENCE_ERROR = 8
};

enum { CODE_KINEMATIC = 5, COMMUTATED = 1, Y_SOURCE = 2, TWO_BITS = 3 };

static uint32_t without_reference; /* bit per motor that was commutated at the start: `$` finds no reference */
static uint32_t homed;             /* bit per motor; background */

static uint32_t variable(uint32_t motor, enum i_name ixxnn) { return (uint32_t)i_integer(i_motor(motor + 1u, ixxnn)); }
static uint32_t bit(bool value, unsigned position) { return value ? 1u << position : 0u; }

void motor_status_initialize(void) {
  without_reference = homed = 0;
  for (uint32_t motor = 0; motor < MOTORS; ++motor)
    without_reference |= bit((variable(motor, IXX01_COMMUTATION_ENABLE) & COMMUTATED) != 0u, motor);
}

void motor_status_show_home(uint32_t motor, bool complete) {
  homed = complete ? homed | 1u << motor : homed & ~(1u << motor);
}

static bool dwells(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  const struct coordinate_system* s = &coordinate_systems[d->cs];
  return d->assigned && s->active && s->moves[s->executing].kind == MOVE_DWELL;
}

static uint32_t status1(uint32_t motor) {
  const uint32_t commutation = variable(motor, IXX01_COMMUTATION_ENABLE);
  return bit(variable(motor, IXX00_ACTIVATED) != 0u, M1_ACTIVATED) |
         bit(i_integer(i_esa(motor + 1u, IYY00_EXTENDED_SERVO)) != 0, M1_EXTENDED_ALGORITHM) | bit(true, M1_OPEN_LOOP) |
         bit(variable(motor, IXX34_INTEGRATION_MODE) != 0u, M1_INTEGRATION_MODE) | bit(dwells(motor), M1_DWELL) |
         (variable(motor, IXX59_USER_SERVO_ENABLE) & TWO_BITS) << M1_USER_SERVO |
         bit((commutation & Y_SOURCE) != 0u, M1_ALTERNATE_SOURCE) | bit((commutation & COMMUTATED) != 0u, M1_PHASED) |
         (variable(motor, IXX06_FOLLOWING_MODE) & TWO_BITS) << M1_FOLLOWING |
         (variable(motor, IXX97_CAPTURE_MODE) & TWO_BITS) << M1_CAPTURE_MODE |
         (variable(motor, IXX96_OUTPUT_MODE) & TWO_BITS) << M1_OUTPUT_MODE;
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
  const uint32_t word = bit(((without_reference >> motor) & 1u) != 0u, M2_PHASE_REFERENCE_ERROR) |
                        bit(((homed >> motor) & 1u) != 0u, M2_HOME_COMPLETE);
  if (!d->assigned) return word;
  return word | d->cs << M2_COORDINATE_SYSTEM | axis_code(d) << M2_AXIS | bit(true, M2_ASSIGNED);
}

uint32_t motor_status(uint32_t motor, unsigned word) { return word == 0u ? status1(motor) : status2(motor); }
