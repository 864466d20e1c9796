/* LINEAR moves (firmware:7.5, motion:5.2), and what waits. */
#include "firmware/motion/plan_linear.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/corner.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/plan_move.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

struct feedrate plan_feedrate(uint32_t cs, double fastest) {
  struct feedrate f = {.feed = cs_real(cs, ISX89_FEEDRATE), .axes = coordinate_systems[cs].feedrate_axes};
  if (fastest > 0.0 && f.feed > fastest) f.feed = fastest;
  f.unit = cs_real(cs, ISX90_FEEDRATE_TIME_UNIT);
  if (i_integer(i_cs(cs, ISX13_SEGMENTATION_TIME)) != 0) f.alternate = cs_real(cs, ISX86_ALTERNATE_FEEDRATE);
  return f;
}

bool plan_feed_time(const struct feedrate* f, const double delta[AXIS_COUNT], double* time) {
  double square = 0.0, other = 0.0, single = 0.0;
  uint32_t axes = 0;
  const bool follows = !(f->alternate > 0.0); /* what is no feedrate axis */
  *time = 0.0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    if (delta[axis] == 0.0) continue;
    slice_pause();
    if (((f->axes >> axis) & 1u) == 0) {
      other = plan_larger(other, math_absolute(delta[axis]));
      continue;
    }
    axes++;
    single = math_absolute(delta[axis]);
    square += delta[axis] * delta[axis];
  }
  if (axes == 0 && other == 0.0) return true;
  if (!(f->unit > 0.0) || (!(f->feed > 0.0) && (axes != 0 || follows))) return false;
  if (axes == 0) {
    *time = other / (follows ? f->feed : f->alternate) * f->unit;
    return true;
  }
  slice_pause();
  double length = axes == 1 ? single : math_square_root(square);
  *time = length / f->feed * f->unit;
  slice_pause();
  if (!follows) *time = plan_larger(*time, other / f->alternate * f->unit);
  return true;
}

/* What the limits of the motors ask for, in ms: the least time of the move by Ixx16, and the greatest of distance /
 * Ixx17, of which times for acceleration follow. */
struct limits {
  double least, square;
};

static struct limits motor_limits(uint32_t cs, const double target[AXIS_COUNT]) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  struct motor_move* moves = motor_moves[s->executing ^ 1u];
  struct limits found = {0.0, 0.0};
  system_motors_solve(cs, s->position);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    moves[motor].from = system_motor_from(motor, s->position);
  }
  system_motors_solve(cs, target);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    moves[motor].to = system_motor_at(motor, target);
    const double distance = math_absolute(moves[motor].to - moves[motor].from);
    moves[motor].velocity = 0.0;
    if (distance == 0.0) continue;
    const double velocity = system_motor_velocity(motor), acceleration = system_motor_acceleration(motor);
    slice_pause();
    if (velocity > 0.0) found.least = plan_larger(found.least, distance / velocity);
    if (acceleration > 0.0) found.square = plan_larger(found.square, distance / acceleration);
  }
  return found;
}

static void set_velocities(uint32_t cs, int64_t time) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  struct motor_move* moves = motor_moves[s->executing ^ 1u];
  const double milliseconds = plan_milliseconds(time);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0 || moves[motor].to == moves[motor].from) continue;
    moves[motor].velocity = (moves[motor].to - moves[motor].from) / milliseconds;
    slice_pause();
  }
}

/* Acceleration and the least move time that it allows; both 0: 0.5 ms. With Ixx17 the change to rest takes
 * distance / (Ixx17 Tm) + TS, and a move is long enough to stop within itself. */
static void set_times(uint32_t cs, struct move* m, double milliseconds, const struct limits* limits) {
  slice_pause();
  double ts = cs_variable(cs, ISX88_S_CURVE_TIME);
  m->acceleration = plan_units(plan_larger(cs_variable(cs, ISX87_ACCELERATION_TIME), 2.0 * ts)) & ~INT64_C(1);
  m->s_curve = plan_units(ts);
  milliseconds = plan_larger(milliseconds, limits->least);
  if (limits->square > 0.0) {
    const double root = math_square_root(ts * ts + 4.0 * limits->square);
    milliseconds = plan_larger(milliseconds, (ts + root) / 2.0);
  }
  m->time = plan_units(milliseconds);
  int64_t least = m->acceleration > 0 ? m->acceleration : MOVE_MINIMUM_UNITS;
  m->time = fixed_larger(m->time, least);
  m->stop_length = m->acceleration;
  if (limits->square > 0.0) {
    const double time = plan_milliseconds(m->time);
    const int64_t stop = (plan_units(limits->square / time + ts) + 1) & ~INT64_C(1);
    if (m->stop_length < stop) m->stop_length = stop < m->time ? stop : m->time & ~INT64_C(1);
  }
  slice_pause();
  set_velocities(cs, m->time);
}

static bool may_blend(const struct coordinate_system* s) { return s->mode != MODE_RAPID && !s->unblended; }

bool plan_linear(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  double time, target[AXIS_COUNT];
  struct move* m = plan_begin(cs, MOVE_LINEAR);
  plan_targets(cs, m, target);
  const struct feedrate feedrate = plan_feedrate(cs, 0.0);
  if (s->time_mode)
    time = cs_real(cs, ISX89_FEEDRATE);
  else if (!plan_feed_time(&feedrate, m->delta, &time))
    return false;
  const struct limits limits = motor_limits(cs, target);
  set_times(cs, m, time, &limits);
  corner_plan(cs, m);
  plan_finish(cs, m, may_blend(s), target);
  return true;
}

static void delay(uint32_t cs, double milliseconds) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move* m = plan_begin(cs, MOVE_LINEAR);
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) m->delta[axis] = 0.0;
  const struct limits limits = motor_limits(cs, s->position);
  set_times(cs, m, milliseconds, &limits);
  plan_finish(cs, m, may_blend(s), s->position);
}

static void dwell(uint32_t cs, double milliseconds) {
  struct move* m = plan_begin(cs, MOVE_DWELL);
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) m->delta[axis] = 0.0;
  m->time = plan_units(milliseconds);
  plan_finish(cs, m, false, coordinate_systems[cs].position);
}

void plan_wait(uint32_t cs, enum rate kind, double milliseconds) {
  const double length = plan_larger(milliseconds, 0.0);
  if (kind == RATE_DWELL)
    dwell(cs, length);
  else
    delay(cs, length);
}
