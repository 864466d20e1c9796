/* Planning of moves (firmware:7.5), real-time task, in slices: an abort forgets what is half planned, so only what an
 * abort sets anyway is written before the last pause. RAPID moves are planned as unblended LINEAR moves at the
 * feedrate: their own speeds (Ixx19 to Ixx21, Ixx22) belong to motors, and the axes are virtual. */
#include "firmware/motion/plan.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/place.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

/* Rounded to the nearest 2^-23 ms. */
static int64_t units(double milliseconds) {
  return (math_to_integer(math_scale(milliseconds, TRAJECTORY_FRACTION_BITS + 1)) + 1) >> 1;
}

static double larger(double a, double b) { return a > b ? a : b; }

static struct move* next_move(struct coordinate_system* s) { return &s->moves[s->executing ^ 1u]; }

/* Tm in ms of a feed-specified move of the axes in `moving`. False: it goes by a feedrate, and that is none. */
static bool feed_time(uint32_t cs, const struct coordinate_system* s, const double delta[AXIS_COUNT], uint32_t moving,
                      double* time) {
  double unit = cs_real(cs, ISX90_FEEDRATE_TIME_UNIT), feed = cs_real(cs, ISX89_FEEDRATE);
  double limit = cs_real(cs, ISX98_FEEDRATE_LIMIT), alternate = cs_real(cs, ISX86_ALTERNATE_FEEDRATE);
  double square = 0.0, other = 0.0, single = 0.0;
  uint32_t axes = 0;
  const bool follows = !(alternate > 0.0); /* what is no feedrate axis */
  *time = 0.0;
  if (moving == 0) return true;
  if (limit > 0.0 && feed > limit) feed = limit;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    if (((moving >> axis) & 1u) == 0) continue;
    slice_pause();
    if (((s->feedrate_axes >> axis) & 1u) == 0) {
      other = larger(other, math_absolute(delta[axis]));
      continue;
    }
    axes++;
    single = math_absolute(delta[axis]);
    square += delta[axis] * delta[axis];
  }
  if (!(unit > 0.0) || (!(feed > 0.0) && (axes != 0 || follows))) return false;
  if (axes == 0) {
    *time = other / (follows ? feed : alternate) * unit;
    return true;
  }
  double length = axes == 1 ? single : math_square_root(square);
  slice_pause();
  *time = length / feed * unit;
  slice_pause();
  if (!follows) *time = larger(*time, other / alternate * unit);
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
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    moves[motor].from = system_motor_at(motor, s->position);
    moves[motor].to = system_motor_at(motor, target);
    slice_pause();
    const double distance = math_absolute(moves[motor].to - moves[motor].from);
    moves[motor].velocity = 0.0;
    if (distance == 0.0) continue;
    const double velocity = system_motor_velocity(motor), acceleration = system_motor_acceleration(motor);
    slice_pause();
    if (velocity > 0.0) found.least = larger(found.least, distance / velocity);
    slice_pause();
    if (acceleration > 0.0) found.square = larger(found.square, distance / acceleration);
    slice_pause();
  }
  return found;
}

static void set_velocities(uint32_t cs, int64_t time) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  struct motor_move* moves = motor_moves[s->executing ^ 1u];
  const double milliseconds = math_scale((double)time, -TRAJECTORY_FRACTION_BITS);
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
  m->acceleration = units(larger(cs_variable(cs, ISX87_ACCELERATION_TIME), 2.0 * ts)) & ~INT64_C(1);
  slice_pause();
  m->s_curve = units(ts);
  milliseconds = larger(milliseconds, limits->least);
  if (limits->square > 0.0) {
    const double root = math_square_root(ts * ts + 4.0 * limits->square);
    milliseconds = larger(milliseconds, (ts + root) / 2.0);
  }
  slice_pause();
  m->time = units(milliseconds < TRAJECTORY_LONGEST_MS ? milliseconds : TRAJECTORY_LONGEST_MS);
  int64_t least = m->acceleration > 0 ? m->acceleration : MOVE_MINIMUM_UNITS;
  if (m->time < least) m->time = least;
  slice_pause();
  m->stop_length = m->acceleration;
  if (limits->square > 0.0) {
    const double time = math_scale((double)m->time, -TRAJECTORY_FRACTION_BITS);
    const int64_t stop = (units(limits->square / time + ts) + 1) & ~INT64_C(1);
    if (m->stop_length < stop) m->stop_length = stop < m->time ? stop : m->time & ~INT64_C(1);
  }
  slice_pause();
  set_velocities(cs, m->time);
}

/* The axes in `moving` are those whose delta is not 0. */
static void finish(uint32_t cs, struct move* m, bool blends, uint32_t moving, const double target[AXIS_COUNT]) {
  struct coordinate_system* s = &coordinate_systems[cs];
  m->joins = blends && s->may_join;
  m->line = s->line;
  m->time_before = s->last_time;
  s->last_time = m->time;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->delta_before[axis] = s->last_delta[axis];
    s->last_delta[axis] = m->delta[axis];
    m->start[axis] = s->position[axis];
    if (((moving >> axis) & 1u) != 0) s->position[axis] = target[axis];
  }
  s->pending_axes = 0;
  s->may_join = blends;
  s->planned++;
  s->next_valid = true;
  if (s->motors == 0) (void)move_place(cs); /* else it takes its time: calculation places it next */
}

bool plan_line(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move* m = next_move(s);
  uint32_t moving = 0;
  double time, target[AXIS_COUNT];
  slice_pause();
  m->kind = MOVE_LINEAR;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->delta[axis] = 0.0;
    target[axis] = s->position[axis];
    if (((s->pending_axes >> axis) & 1u) == 0) continue;
    m->delta[axis] = s->pending[axis] - s->position[axis];
    target[axis] = s->pending[axis];
    if (m->delta[axis] != 0.0) moving |= 1u << axis;
    slice_pause();
  }
  if (s->time_mode)
    time = cs_real(cs, ISX89_FEEDRATE);
  else if (!feed_time(cs, s, m->delta, moving, &time))
    return false;
  const struct limits limits = motor_limits(cs, target);
  set_times(cs, m, time, &limits);
  finish(cs, m, s->mode == MODE_LINEAR && cs_variable(cs, ISX92_BLEND_DISABLE) == 0.0, moving, target);
  return true;
}

/* DWELL stops blending and is timed by the servo clock alone; DELAY is a move of no distance. */
void plan_wait(uint32_t cs, enum rate kind, double milliseconds) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move* m = next_move(s);
  double length = milliseconds > 0.0 ? milliseconds : 0.0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) m->delta[axis] = 0.0;
  m->kind = kind == RATE_DWELL ? MOVE_DWELL : MOVE_LINEAR;
  if (kind == RATE_DWELL) {
    m->acceleration = m->s_curve = m->stop_length = 0;
    m->time = units(length < TRAJECTORY_LONGEST_MS ? length : TRAJECTORY_LONGEST_MS);
    finish(cs, m, false, 0, s->position);
  } else {
    const struct limits limits = motor_limits(cs, s->position);
    set_times(cs, m, length, &limits);
    finish(cs, m, s->mode == MODE_LINEAR && cs_variable(cs, ISX92_BLEND_DISABLE) == 0.0, 0, s->position);
  }
}
