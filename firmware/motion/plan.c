/* Planning of moves (firmware:7.5), real-time task, in slices: an abort forgets what is half planned, so only what an
 * abort sets anyway is written before the last pause. RAPID moves are planned as unblended LINEAR moves at the
 * feedrate: their own speeds (Ixx19 to Ixx21, Ixx22) belong to motors, and the axes are virtual. */
#include "firmware/motion/plan.h"

#include <stdatomic.h>

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
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

/* Acceleration and the least move time that it allows; both 0: 0.5 ms. */
static void set_times(uint32_t cs, struct move* m, double milliseconds) {
  slice_pause();
  double ts = cs_variable(cs, ISX88_S_CURVE_TIME);
  m->acceleration = units(larger(cs_variable(cs, ISX87_ACCELERATION_TIME), 2.0 * ts)) & ~INT64_C(1);
  slice_pause();
  m->s_curve = units(ts);
  m->time = units(milliseconds < TRAJECTORY_LONGEST_MS ? milliseconds : TRAJECTORY_LONGEST_MS);
  int64_t least = m->acceleration > 0 ? m->acceleration : MOVE_MINIMUM_UNITS;
  if (m->time < least) m->time = least;
  slice_pause();
}

/* The axes in `moving` are those whose delta is not 0. */
static void finish(uint32_t cs, struct move* m, bool blends, uint32_t moving) {
  struct coordinate_system* s = &coordinate_systems[cs];
  m->joins = blends && s->may_join;
  m->line = s->line;
  m->time_before = s->last_time;
  s->last_time = m->time;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->delta_before[axis] = s->last_delta[axis];
    s->last_delta[axis] = m->delta[axis];
    m->start[axis] = s->position[axis];
    if (((moving >> axis) & 1u) != 0) s->position[axis] += m->delta[axis];
  }
  s->pending_axes = 0;
  s->may_join = blends;
  s->planned++;
  atomic_signal_fence(memory_order_release);
  s->next_valid = true; /* last: from here on the servo task may start it */
  cs_busy |= 1u << cs;
}

bool plan_line(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move* m = next_move(s);
  uint32_t moving = 0;
  double time;
  slice_pause();
  m->kind = MOVE_LINEAR;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->delta[axis] = 0.0;
    if (((s->pending_axes >> axis) & 1u) == 0) continue;
    m->delta[axis] = s->pending[axis] - s->position[axis];
    if (m->delta[axis] != 0.0) moving |= 1u << axis;
    slice_pause();
  }
  if (s->time_mode)
    time = cs_real(cs, ISX89_FEEDRATE);
  else if (!feed_time(cs, s, m->delta, moving, &time))
    return false;
  set_times(cs, m, time);
  finish(cs, m, s->mode == MODE_LINEAR && cs_variable(cs, ISX92_BLEND_DISABLE) == 0.0, moving);
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
    m->acceleration = m->s_curve = 0;
    m->time = units(length < TRAJECTORY_LONGEST_MS ? length : TRAJECTORY_LONGEST_MS);
    finish(cs, m, false, 0);
  } else {
    set_times(cs, m, length);
    finish(cs, m, s->mode == MODE_LINEAR && cs_variable(cs, ISX92_BLEND_DISABLE) == 0.0, 0);
  }
}
