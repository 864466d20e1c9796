#include "firmware/motion/plan_anew.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/corner.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/path.h"
#include "firmware/motion/plan_move.h"
#include "firmware/motion/plan_path.h"
#include "firmware/motion/system_motors.h"

enum { SAME_WAY = -20 }; /* 2^that of a move's way: less is what a forward program rounds, no other way */

/* Of each waiting move; of one that stands the next before it, or else behind it, that does not: its own is none as
 * long as it would be nothing beside those at its corners. */
static double longest[PATH_MOVES];

/* An arc reaches as far as its radius. */
static double reach_of(const struct path_move* m) {
  double reach = m->is_arc ? m->circle.radius : 0.0;
  for (uint32_t axis = 0; axis < AXIS_COUNT && !m->stands; axis++) {
    reach = plan_larger(reach, math_absolute(m->delta[axis]));
    slice_pause();
  }
  return reach;
}

static void measure(uint32_t cs) {
  struct path* p = &paths[cs];
  for (uint32_t i = 0; i < p->count; i++) {
    struct path_move* m = path_of(p, i);
    longest[i] = reach_of(m);
    m->stands = longest[i] == 0.0;
    if (m->stands && i != 0) longest[i] = longest[i - 1u];
  }
  for (uint32_t i = p->count - 1u; i-- != 0;)
    if (longest[i] == 0.0) longest[i] = longest[i + 1u];
}

/* An axis goes the ways that it was to go, up to the first move that takes it to its end all the same: an arc as it is,
 * and evenly what that leaves. A rotary one comes into another turn by that. Which moves go another way, a bit each. */
static uint32_t shift_axis(uint32_t cs, uint32_t axis, double shift) {
  const bool turns = axis >= AXIS_X && axis <= AXIS_Z;
  uint32_t changed = 0;
  for (uint32_t i = 0; shift != 0.0 && i < paths[cs].count; i++) {
    struct path_move* m = path_of(&paths[cs], i);
    m->start[axis] += shift;
    slice_pause();
    if (turns) m->circle.centre[axis - AXIS_X] += shift;
    slice_pause();
    if (((m->absolute >> axis) & 1u) == 0) {
      m->end[axis] += shift;
      continue;
    }
    const double was = m->end[axis];
    if (axis <= AXIS_C) m->end[axis] = system_motors_turn(cs, axis, m->start[axis], m->told[axis]);
    const double by = m->end[axis] - was - shift;
    slice_pause();
    if (math_absolute(by) > math_scale(longest[i], SAME_WAY)) {
      changed |= 1u << i;
      m->stands = false;
    }
    slice_pause();
    m->delta[axis] += by;
    if (turns) m->circle.along[axis - AXIS_X] += by;
    shift = m->end[axis] - was;
    slice_pause();
  }
  return changed;
}

static void set_time(uint32_t cs, struct path_move* m) {
  const int64_t least = m->acceleration > 0 ? m->acceleration : path_time(PATH_LEAST_MS);
  double time;
  if (m->timed) return;
  if (!plan_path_time(m, &time)) {
    coordinate_systems[cs].failure = RUN_TIME_FEEDRATE;
    return;
  }
  const int64_t wanted = path_time(time < TRAJECTORY_LONGEST_MS ? time : TRAJECTORY_LONGEST_MS);
  path_set_time(m, fixed_larger(wanted, least));
}

/* What blends there, or would but for the corner. */
static void judge_corner(uint32_t cs, uint32_t ahead) {
  static double before[AXIS_COUNT], after[AXIS_COUNT];
  struct path_move* m = path_of(&paths[cs], ahead);
  if (!m->joins && !m->sharp) return;
  path_direction(path_of(&paths[cs], ahead - 1u), 1.0, before);
  path_direction(m, 0.0, after);
  slice_pause();
  m->sharp = corner_is_sharp(cs, before, after, &m->dwells);
  m->joins = !m->sharp;
}

void plan_anew(uint32_t cs, double position[AXIS_COUNT]) {
  struct path* p = &paths[cs];
  uint32_t changed = 0;
  measure(cs);
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    changed |= shift_axis(cs, axis, position[axis] - path_of(p, 0)->start[axis]);
    position[axis] = path_of(p, p->count - 1u)->end[axis];
    slice_pause();
  }
  for (uint32_t i = 0; i < p->count; i++) {
    if (((changed >> i) & 1u) != 0) set_time(cs, path_of(p, i));
    if (i != 0 && ((changed | changed << 1) >> i & 1u) != 0) judge_corner(cs, i);
  }
  path_direction(path_of(p, p->count - 1u), 1.0, coordinate_systems[cs].last_delta);
}
