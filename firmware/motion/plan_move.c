#include "firmware/motion/plan_move.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/system_motors.h"

int64_t plan_units(double milliseconds) {
  const double time = milliseconds < TRAJECTORY_LONGEST_MS ? milliseconds : TRAJECTORY_LONGEST_MS;
  return (math_to_integer(math_scale(time, TRAJECTORY_FRACTION_BITS + 1)) + 1) >> 1;
}

double plan_milliseconds(int64_t time) { return math_scale((double)time, -TRAJECTORY_FRACTION_BITS); }

struct move* plan_begin(uint32_t cs, enum move_kind kind) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move* m = &s->moves[s->executing ^ 1u];
  m->kind = kind;
  m->s_curve = m->acceleration = m->stop_length = 0;
  m->is_sharp = false;
  m->has_dwell = true;
  return m;
}

void plan_targets(uint32_t cs, struct move* m, double target[AXIS_COUNT]) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->delta[axis] = 0.0;
    target[axis] = s->position[axis];
    if (((s->pending_axes >> axis) & 1u) == 0) continue;
    target[axis] = s->pending[axis];
    if (((s->pending_absolute >> axis) & 1u) != 0)
      target[axis] = system_motors_turn(cs, axis, s->position[axis], target[axis]);
    m->delta[axis] = target[axis] - s->position[axis];
    slice_pause();
  }
}

void plan_finish(uint32_t cs, struct move* m, bool blends, const double target[AXIS_COUNT]) {
  struct coordinate_system* s = &coordinate_systems[cs];
  m->joins = blends && s->may_join;
  m->line = s->line;
  m->waited = s->waited;
  s->waited = false;
  m->time_before = s->last_time;
  s->last_time = m->time;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->delta_before[axis] = s->last_delta[axis];
    s->last_delta[axis] = m->delta[axis];
    m->start[axis] = s->position[axis];
    s->position[axis] = target[axis];
  }
  s->pending_axes = s->pending_triggers = s->pending_velocities = s->pending_vectors = 0;
  s->may_join = blends;
  s->was_matched = false;
  s->planned++;
  s->next_valid = true;
}
