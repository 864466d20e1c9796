#include "firmware/motion/plan_cubic.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/plan_move.h"
#include "firmware/variables/i_variables.h"

#define LONGEST_MS 4095.9998
#define STEPS_A_MS 4000.0 /* of 1/4 us */
#define OVERRUN_MS 200.0  /* that a PVT move goes on at its last velocity while the stop is planned */

/* T: the move time, or with I42 the acceleration time, which has whole ms. */
static int64_t cubic_time(uint32_t cs) {
  double time =
      i_integer(I42_PVT_TIME_SOURCE) != 0 ? cs_variable(cs, ISX87_ACCELERATION_TIME) : cs_real(cs, ISX89_FEEDRATE);
  if (time > LONGEST_MS) time = LONGEST_MS;
  const double steps = math_floor(time * STEPS_A_MS + 0.5);
  slice_pause();
  const int64_t units = plan_units(steps / STEPS_A_MS);
  return fixed_larger(units, MOVE_MINIMUM_UNITS);
}

/* Of the velocity behind `:`, units a Isx90. */
static double end_velocity(uint32_t cs, uint32_t axis) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const double unit = cs_real(cs, ISX90_FEEDRATE_TIME_UNIT);
  if (((s->pending_velocities >> axis) & 1u) == 0 || s->pending_velocity[axis] == 0.0 || !(unit > 0.0)) return 0.0;
  return s->pending_velocity[axis] / unit;
}

/* A PVT move begins with the velocity at which the one before it ends, at once behind it. */
void plan_pvt(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* before = &s->moves[s->executing];
  const bool goes_on = s->may_join && before->kind == MOVE_PVT;
  double target[AXIS_COUNT];
  struct move* m = plan_begin(cs, MOVE_PVT);
  plan_targets(cs, m, target);
  m->time = m->knot_time[0] = cubic_time(cs);
  m->knot_time[1] = plan_units(OVERRUN_MS);
  m->overruns = false;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    const double velocity = end_velocity(cs, axis);
    slice_pause();
    m->knots[0].position[axis] = s->position[axis];
    m->knots[0].velocity[axis] = goes_on ? before->knots[1].velocity[axis] : 0.0;
    m->knots[1].position[axis] = m->knots[2].position[axis] = target[axis];
    m->knots[1].velocity[axis] = m->knots[2].velocity[axis] = velocity;
    if (velocity == 0.0) continue;
    m->overruns = s->motors != 0;
    m->knots[2].position[axis] += velocity * OVERRUN_MS;
  }
  m->knot_count = m->overruns ? 3 : 2;
  plan_finish(cs, m, true, target);
}

/* The move of point n is the way to way point n - 1, which point n makes known. What comes behind it, to point n, is
 * the end of the sequence as long as there is no further point. From rest that way begins at point n - 1. Points are
 * kept alone: motors have their own way points (motion/spline_motor.h), where axes are is seldom asked. */
static void set_points(const struct move* before, struct move* m, const double start[AXIS_COUNT],
                       const double target[AXIS_COUNT]) {
  m->time_ahead = before != 0 ? before->knot_time[0] : m->time;
  m->knot_time[0] = before != 0 ? before->time : m->time;
  m->knot_time[1] = m->knot_time[2] = m->time;
  m->knot_count = KNOTS;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->knots[0].position[axis] = before != 0 ? before->knots[1].position[axis] : start[axis];
    m->knots[1].position[axis] = before != 0 ? before->knots[2].position[axis] : start[axis];
    m->knots[2].position[axis] = start[axis];
    m->knots[3].position[axis] = target[axis];
  }
  slice_pause();
}

/* In SPLINE1 another time ends the sequence: this move begins a new one behind it. */
void plan_spline(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* before = &s->moves[s->executing];
  double target[AXIS_COUNT];
  struct move* m = plan_begin(cs, MOVE_SPLINE);
  plan_targets(cs, m, target);
  m->time = cubic_time(cs);
  if (before->kind != MOVE_SPLINE || (s->mode == MODE_SPLINE1 && before->time != m->time)) s->may_join = false;
  m->overruns = false;
  set_points(s->may_join ? before : 0, m, s->position, target);
  plan_finish(cs, m, true, target);
}

void plan_spline_anew(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move* m = &s->moves[s->executing ^ 1u];
  m->joins = false;
  set_points(0, m, m->start, s->position);
}
