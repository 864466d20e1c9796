#include "firmware/motion/system_motors.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/kinematics.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/rollover.h"
#include "firmware/motion/time_base.h"
#include "firmware/variables/i_variables.h"

enum { AXES_OF_A_MOTOR = 3 };

#define LEAST_PIVOT 1e-9 /* of the largest scale: below it a motor says nothing new about the axes */

struct motor_move motor_moves[2][MOTORS];

/* What a motor stands beside where its axes have it, at the start of a program. */
static double aside[MOTORS];

/* How axes make a motor's position. */
static struct {
  bool by_program; /* motion/kinematics.h; else the sum of: */
  uint32_t count;
  uint8_t axis[AXES_OF_A_MOTOR];
  double scale[AXES_OF_A_MOTOR]; /* position a user unit */
  double offset, unit;           /* `unit`: position a count */
} maps[MOTORS];

static void resolve(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  maps[motor].unit = (double)(POSITION_SUBCOUNT * motors[motor].position_scale);
  maps[motor].by_program = d->kinematic;
  maps[motor].offset = d->offset * maps[motor].unit;
  maps[motor].count = 0;
  for (uint32_t axis = 0; axis < AXIS_COUNT && maps[motor].count < AXES_OF_A_MOTOR; axis++) {
    if (d->scale[axis] == 0.0) continue;
    const uint32_t i = maps[motor].count++;
    maps[motor].axis[i] = (uint8_t)axis;
    maps[motor].scale[i] = d->scale[axis] * maps[motor].unit;
  }
}

void system_motors_resolve(uint32_t cs) {
  uint32_t mask = 0, by_program = 0;
  for (uint32_t motor = 0; motor < MOTORS; motor++) {
    const struct axis_definition* d = &axis_definitions[motor];
    if (!d->assigned || d->cs != cs) continue;
    *(d->kinematic ? &by_program : &mask) |= 1u << motor;
    resolve(motor);
  }
  coordinate_systems[cs].motors = mask | kinematics_resolve(cs, by_program);
}

static int64_t bias_of(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t value = motor_axes_ahead(motor);
  hal_unmask(state);
  return value;
}

double system_motor_solved(uint32_t motor) {
  const int64_t bias = bias_of(motor);
  return bias == 0 ? kinematics_at(motor) : kinematics_at(motor) - (double)bias;
}

double system_motor_at(uint32_t motor, const double position[AXIS_COUNT]) {
  slice_pause();
  if (maps[motor].by_program) return system_motor_solved(motor);
  const int64_t bias = bias_of(motor);
  double sum = maps[motor].offset;
  if (bias != 0) sum -= (double)bias;
  for (uint32_t i = 0; i < maps[motor].count; i++) {
    sum += maps[motor].scale[i] * position[maps[motor].axis[i]];
    slice_pause();
  }
  return sum;
}

double system_motor_from(uint32_t motor, const double position[AXIS_COUNT]) {
  return system_motor_at(motor, position) + aside[motor];
}

double system_motor_aside(uint32_t motor) { return aside[motor]; }

void system_motors_come_along(uint32_t cs) {
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) aside[motor] = 0.0;
}

void system_motor_stands_aside(uint32_t motor, int64_t by) { aside[motor] = (double)by; }

/* The first motor that carries it alone tells the turn. */
double system_motors_turn(uint32_t cs, uint32_t axis, double from, double target) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  for (uint32_t motor = 0, left = axis <= AXIS_C ? s->motors : 0u; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0 || maps[motor].count != 1u || maps[motor].axis[0] != axis) continue;
    if (i_variable_read(i_motor_real(motor + 1u, IXX27_ROLLOVER)) == 0.0) return target;
    slice_pause();
    const double scale = math_absolute(axis_definitions[motor].scale[axis]); /* directions are those of the axis */
    const double counts = from * scale;
    const double told = target * scale;
    slice_pause();
    const double turned = rollover_target(motor, counts, told, target < 0.0);
    const double place = turned / scale;
    slice_pause();
    return place;
  }
  return target;
}

double system_motor_velocity_at(uint32_t motor, const double velocity[AXIS_COUNT]) {
  if (maps[motor].by_program) return kinematics_velocity(motor);
  double sum = 0.0;
  for (uint32_t i = 0; i < maps[motor].count; i++) {
    const double of_axis = velocity[maps[motor].axis[i]];
    if (of_axis != 0.0) sum += maps[motor].scale[i] * of_axis;
    slice_pause();
  }
  return sum;
}

uint32_t system_motor_axes(uint32_t motor) {
  uint32_t axes = 0;
  for (uint32_t i = 0; i < maps[motor].count; i++) axes |= 1u << maps[motor].axis[i];
  return axes;
}

double system_motor_counts(uint32_t motor, int64_t distance) { return (double)distance / maps[motor].unit; }

bool system_motor_behind(uint32_t motor, uint32_t axes, const double distance[AXIS_COUNT], int64_t* behind) {
  double sum = 0.0;
  bool any = false;
  for (uint32_t i = 0; i < maps[motor].count; i++) {
    const uint32_t axis = maps[motor].axis[i];
    if (((axes >> axis) & 1u) == 0) continue;
    any = true;
    sum += maps[motor].scale[i] * distance[axis];
  }
  *behind = math_nearest(sum);
  return any;
}

static double limit(uint32_t motor, enum i_real_name ixxnn) {
  const double value = i_variable_read(i_motor_real(motor + 1u, ixxnn));
  return value > 0.0 ? value * maps[motor].unit : 0.0;
}

double system_motor_velocity(uint32_t motor) { return limit(motor, IXX16_VELOCITY_LIMIT); }
double system_motor_acceleration(uint32_t motor) { return limit(motor, IXX17_ACCELERATION_LIMIT); }

/* Where the motor is without its offset: the sum of its axes times their scales. */
static int64_t commanded(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = motors[motor].trajectory;
  hal_unmask(state);
  return position;
}

static int64_t beside(uint32_t motor, const double position[AXIS_COUNT]) {
  return commanded(motor) - math_nearest(system_motor_at(motor, position));
}

/* Equations of motors in the axes, each reduced by those before it, for Gaussian elimination. */
struct equations {
  uint32_t count;
  uint32_t pivot[AXIS_COUNT];
  double row[AXIS_COUNT][AXIS_COUNT + 1]; /* the sum last */
};

static void add_equation(struct equations* e, uint32_t motor) {
  double row[AXIS_COUNT + 1] = {0}, largest = 0.0;
  if (e->count == AXIS_COUNT) return;
  for (uint32_t i = 0; i < maps[motor].count; i++) {
    row[maps[motor].axis[i]] = maps[motor].scale[i];
    if (math_absolute(maps[motor].scale[i]) > largest) largest = math_absolute(maps[motor].scale[i]);
  }
  row[AXIS_COUNT] = (double)commanded(motor) + (double)bias_of(motor) - maps[motor].offset;
  for (uint32_t k = 0; k < e->count; k++) {
    const double factor = row[e->pivot[k]];
    if (factor == 0.0) continue;
    for (uint32_t column = 0; column <= AXIS_COUNT; column++) {
      if (e->row[k][column] != 0.0) row[column] -= factor * e->row[k][column];
      slice_pause();
    }
    row[e->pivot[k]] = 0.0;
  }
  uint32_t pivot = 0;
  for (uint32_t axis = 1; axis < AXIS_COUNT; axis++) {
    if (math_absolute(row[axis]) > math_absolute(row[pivot])) pivot = axis;
    slice_pause();
  }
  if (!(math_absolute(row[pivot]) > largest * LEAST_PIVOT)) return;
  const double by = row[pivot];
  for (uint32_t column = 0; column <= AXIS_COUNT; column++) {
    e->row[e->count][column] = row[column] == 0.0 ? 0.0 : row[column] / by;
    slice_pause();
  }
  e->pivot[e->count++] = pivot;
}

/* An axis that no motor tells stays where it is. */
static void solve(const struct equations* e, double position[AXIS_COUNT]) {
  for (uint32_t k = e->count; k-- > 0;) {
    double value = e->row[k][AXIS_COUNT];
    for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
      slice_pause();
      if (axis == e->pivot[k] || e->row[k][axis] == 0.0) continue;
      value -= e->row[k][axis] * position[axis];
    }
    position[e->pivot[k]] = value;
  }
}

static void take_followed(uint32_t cs) {
  const uint32_t state = hal_mask_servo();
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) motors[motor].matched = motor_followed(motor);
  hal_unmask(state);
}

/* Those whose definitions are sums of axes. */
static uint32_t defined(const struct coordinate_system* s) { return s->motors & ~s->inverse_motors; }

static bool any_beside(const struct coordinate_system* s) {
  for (uint32_t motor = 0, left = defined(s); left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0 && beside(motor, s->position) != 0) return true;
  return false;
}

static void match_definitions(struct coordinate_system* s) {
  static struct equations e;
  e.count = 0;
  for (uint32_t motor = 0, left = defined(s); left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) add_equation(&e, motor);
  solve(&e, s->position);
}

/* Axes that it does not tell are as the definitions have them. */
static bool match_program(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  double position[AXIS_COUNT];
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) position[axis] = s->position[axis];
  if (!kinematics_forward(cs, position)) return false;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) s->position[axis] = position[axis];
  kinematics_stand(cs, position);
  return true;
}

bool system_motors_match(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  system_motors_come_along(cs);
  take_followed(cs);
  const bool moved = any_beside(s);
  if (moved) match_definitions(s);
  if (s->kinematic && !match_program(cs)) return false;
  if (!moved && !s->kinematic) return true;
  for (uint32_t motor = 0, left = defined(s); left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) aside[motor] = (double)beside(motor, s->position);
  return true;
}

void system_motors_solve(uint32_t cs, const double position[AXIS_COUNT]) { (void)kinematics_inverse(cs, position); }

void system_motors_solve_knot(uint32_t cs, const struct knot* knot) { (void)kinematics_inverse_knot(cs, knot); }

void system_motors_take(uint32_t cs) {
  const uint32_t state = hal_mask_servo();
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0 || jog_is_of_program(motor)) continue;
    jog_program_takes(motor);
    motors[motor].of_system = motors[motor].trajectory;
  }
  hal_unmask(state);
}

void system_motors_begin(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  s->matching_anew = false;
  if (!system_motors_match(cs) || s->matching_anew) return;
  system_motors_take(cs);
  s->matching = s->starting = false;
  s->was_matched = true;
}

bool system_motors_leave(uint32_t cs) {
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0 && jog_is_moving(motor) && (motors[motor].path == PATH_SYSTEM || jog_is_to_ramp(motor)))
      return true;
  return false;
}

bool system_motors_are_away(uint32_t cs) {
  bool away = false;
  const uint32_t state = hal_mask_servo();
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0 && !jog_is_of_program(motor) && motors[motor].trajectory != motors[motor].of_system)
      away = true;
  hal_unmask(state);
  return away;
}

/* The move begins for its motors before the servo task starts it. */
uint32_t system_motors_alone(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* m = s->active ? &s->moves[s->executing] : cs_next_move(s);
  return m != 0 && m->kind == MOVE_OWN ? m->own : 0u;
}

static bool moves_alone(uint32_t cs, uint32_t motor) {
  const uint32_t state = hal_mask_servo(), of = system_motors_alone(cs);
  hal_unmask(state);
  return (of >> motor & 1u) != 0;
}

uint32_t system_motor_mover(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  if (d->assigned && moves_alone(d->cs, motor)) return d->cs;
  for (uint32_t left = cs_awake; left != 0; left &= left - 1u)
    if (moves_alone((uint32_t)__builtin_ctz(left), motor)) return (uint32_t)__builtin_ctz(left);
  return COORDINATE_SYSTEMS;
}

static bool is_moved_by(uint32_t cs, uint32_t motor) {
  return jog_is_of_program(motor) && system_motor_mover(motor) == cs;
}

static void ramp(uint32_t motor) {
  (void)jog_stop_at(motor, i_variable_read(i_motor_real(motor + 1u, IXX15_ABORT_DECELERATION)));
}

void system_motors_ramp(uint32_t cs) {
  time_base_stay(cs);
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if ((axis_definitions[motor].assigned && axis_definitions[motor].cs == cs) || is_moved_by(cs, motor)) ramp(motor);
}

/* The real-time task may have forgotten whose they are; another's they are only when it moves them. */
void system_motors_ramp_rest(uint32_t cs, uint32_t of) {
  for (uint32_t left = of; left != 0; left &= left - 1u) {
    const uint32_t motor = (uint32_t)__builtin_ctz(left), mover = system_motor_mover(motor);
    if (jog_is_of_program(motor) && (mover == cs || mover == COORDINATE_SYSTEMS)) ramp(motor);
  }
}

void system_motors_set_position(uint32_t cs, uint32_t axes, const double position[AXIS_COUNT]) {
  struct coordinate_system* s = &coordinate_systems[cs];
  double now[AXIS_COUNT];
  static double was[MOTORS];
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++)
    now[axis] = ((axes >> axis) & 1u) != 0 ? position[axis] : s->position[axis];
  system_motors_solve(cs, s->position);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) was[motor] = system_motor_at(motor, s->position);
  system_motors_solve(cs, now);
  if (s->failure != RUN_TIME_NONE) return;
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    const int64_t shift = math_nearest(system_motor_at(motor, now) - was[motor]);
    slice_pause();
    const uint32_t state = hal_mask_servo();
    motors[motor].bias += shift;
    hal_unmask(state);
  }
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) s->position[axis] = now[axis];
}
