/* Programs take and give variables: P(xx) positions of motors in counts, P(100+xx) their velocities; Q1 to Q9 the axes
 * A to Z, Q11 to Q19 their velocities, Q10 says whether those count. All of that are 48-bit words, so a position has 35
 * bits. */
#include "firmware/motion/kinematics.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/pq_variables.h"

enum {
  Q_POSITIONS = 1, /* A, then the others */
  Q_VELOCITIES_COUNT = 10,
  Q_VELOCITIES = 11,
  P_POSITIONS = 1, /* of motor 1 */
  P_VELOCITIES = 101,
  SUBCOUNTS = 32 /* of a position, times Ixx08 */
};

#define LARGEST_POSITION 140737488355328.0 /* 2^47 units: what position words hold */

/* What the inverse program has given last. */
static struct {
  bool known;
  double position[AXIS_COUNT];
} solved[COORDINATE_SYSTEMS];
static double at[MOTORS], velocities[MOTORS];

static double unit_of(uint32_t motor) { return (double)(SUBCOUNTS * motors[motor].position_scale); }

uint32_t kinematics_resolve(uint32_t cs, uint32_t by_program) {
  solved[cs].known = false;
  coordinate_systems[cs].kinematic = i_integer(i_cs(cs, ISX50_KINEMATICS)) != 0;
  coordinate_systems[cs].inverse_motors = coordinate_systems[cs].kinematic ? by_program : 0u;
  return coordinate_systems[cs].inverse_motors;
}

static bool execute(uint32_t cs, enum fixed_kind kind) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (s->failure != RUN_TIME_NONE) return false; /* what has failed asks no more */
  const enum run_time_error error = kinematics_execute(cs, kind);
  if (error != RUN_TIME_NONE && s->failure == RUN_TIME_NONE) s->failure = error;
  return s->failure == RUN_TIME_NONE; /* the program can set the error itself */
}

static int64_t commanded(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = motors[motor].trajectory + motor_axes_ahead(motor);
  hal_unmask(state);
  return position;
}

bool kinematics_forward(uint32_t cs, double position[AXIS_COUNT]) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    p_variable_write(P_POSITIONS + motor, (double)commanded(motor) / unit_of(motor));
    slice_pause();
  }
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    q_variable_write(cs, Q_POSITIONS + axis, position[axis]);
    slice_pause();
  }
  if (!execute(cs, FIXED_FORWARD)) return false;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    position[axis] = q_variable_read(cs, Q_POSITIONS + axis);
    slice_pause();
  }
  return true;
}

static void remember(uint32_t cs, const double position[AXIS_COUNT]) {
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) solved[cs].position[axis] = position[axis];
  solved[cs].known = true;
}

void kinematics_stand(uint32_t cs, const double position[AXIS_COUNT]) {
  for (uint32_t motor = 0, left = coordinate_systems[cs].inverse_motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) at[motor] = (double)commanded(motor);
  remember(cs, position);
}

static bool is_solved(uint32_t cs, const double position[AXIS_COUNT]) {
  if (!solved[cs].known) return false;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++)
    if (solved[cs].position[axis] != position[axis]) return false;
  return true;
}

/* Of a variable, in units of position; false: more than its words hold, as of what was divided by 0. */
static bool read_motor(uint32_t motor, uint32_t first, double scale, double* value) {
  const double read = p_variable_read(first + motor);
  const double unit = unit_of(motor);
  slice_pause();
  const double units = read * unit;
  *value = scale == 1.0 ? units : units * scale;
  slice_pause();
  return math_absolute(*value) < LARGEST_POSITION;
}

static bool solve(uint32_t cs, const double position[AXIS_COUNT], bool velocity, double time_unit) {
  struct coordinate_system* s = &coordinate_systems[cs];
  slice_pause();
  solved[cs].known = false;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    q_variable_write(cs, Q_POSITIONS + axis, position[axis]);
    slice_pause();
  }
  q_variable_write(cs, Q_VELOCITIES_COUNT, velocity ? 1.0 : 0.0);
  slice_pause();
  if (!execute(cs, FIXED_INVERSE)) return false;
  bool fits = true;
  for (uint32_t motor = 0, left = s->inverse_motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    fits = fits && read_motor(motor, P_POSITIONS, 1.0, &at[motor]);
    if (velocity) fits = fits && read_motor(motor, P_VELOCITIES, 1.0 / time_unit, &velocities[motor]);
  }
  if (!fits) s->failure = RUN_TIME_KINEMATIC;
  if (fits) remember(cs, position);
  return fits;
}

bool kinematics_inverse(uint32_t cs, const double position[AXIS_COUNT]) {
  if (coordinate_systems[cs].inverse_motors == 0 || is_solved(cs, position)) return true;
  return solve(cs, position, false, 1.0);
}

/* Velocities in units a Isx90, as behind `:`. */
bool kinematics_inverse_knot(uint32_t cs, const struct knot* knot) {
  if (coordinate_systems[cs].inverse_motors == 0) return true;
  const double time_unit = cs_real(cs, ISX90_FEEDRATE_TIME_UNIT);
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    q_variable_write(cs, Q_VELOCITIES + axis, knot->velocity[axis] * time_unit);
    slice_pause();
  }
  return solve(cs, knot->position, true, time_unit > 0.0 ? time_unit : 1.0);
}

double kinematics_at(uint32_t motor) { return at[motor]; }
double kinematics_velocity(uint32_t motor) { return velocities[motor]; }
