#include "firmware/motion/plan_path.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/axis_matrix.h"
#include "firmware/motion/circle.h"
#include "firmware/motion/corner.h"
#include "firmware/motion/path.h"
#include "firmware/motion/plan_linear.h"
#include "firmware/motion/plan_move.h"
#include "firmware/variables/i_variables.h"

enum { ISX97 = 1 }; /* behind Isx96 */

/* The move under way, and its direction at its ends for the corner rules. One: there is one planner. */
static struct path_move planning;
static struct move corner_move;
static double last_direction[AXIS_COUNT];

/* Axes that are virtual have no path. */
bool plan_by_segments(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (s->motors == 0 || i_integer(i_cs(cs, ISX13_SEGMENTATION_TIME)) == 0) return false;
  return s->mode == MODE_LINEAR || s->mode == MODE_CIRCLE1 || s->mode == MODE_CIRCLE2;
}

static enum circle_kind find_circle(uint32_t cs, struct path_move* m) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  static struct circle_line line;
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    line.start[i] = s->position[AXIS_X + i];
    line.end[i] = m->end[AXIS_X + i];
    line.vector[i] = s->pending_vector[i];
    line.normal[i] = s->normal[i];
  }
  axis_matrix_normal(cs, line.normal);
  line.vectors = s->pending_vectors & (ARC_RADIUS_BIT - 1u);
  line.absolute = s->vector_absolute;
  line.by_radius = (s->pending_vectors & ARC_RADIUS_BIT) != 0;
  line.radius = s->pending_vector[CIRCLE_AXES];
  line.counter = s->mode == MODE_CIRCLE2;
  line.most = cs_real(cs, ISX96_ARC_LIMITS);
  line.least = i_variable_read(i_cs_real(cs, ISX96_ARC_LIMITS) + ISX97);
  return circle_of(&line, &m->circle);
}

/* The length of an arc counts as the way of one feedrate axis of X, Y, Z. */
static void arc_ways(const struct path_move* m, double way[AXIS_COUNT]) {
  const double length = circle_length(&m->circle, &way[AXIS_X]);
  bool counted = false;
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    const uint32_t axis = AXIS_X + i, axes = m->feedrate.axes;
    if (!counted && ((axes >> axis & 1u) != 0 || ((axes & AXIS_XYZ) == 0 && i == 0))) {
      if (way[axis] != 0.0) {
        const double of_arc = length * length;
        const double square = of_arc + way[axis] * way[axis];
        slice_pause();
        way[axis] = math_square_root(square);
      } else {
        way[axis] = length;
      }
      counted = true;
    }
    slice_pause();
  }
}

static struct feedrate feedrate_of(uint32_t cs, const struct path_move* m) {
  const double centripetal = m->is_arc ? cs_real(cs, ISX78_CENTRIPETAL_LIMIT) : 0.0;
  if (!(centripetal > 0.0)) return plan_feedrate(cs, 0.0);
  return plan_feedrate(cs, math_square_root(centripetal * circle_least_radius(&m->circle)));
}

bool plan_path_time(const struct path_move* m, double* time) {
  double way[AXIS_COUNT];
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) way[axis] = m->delta[axis];
  if (m->is_arc) arc_ways(m, way);
  return plan_feed_time(&m->feedrate, way, time);
}

static void set_times(uint32_t cs, struct path_move* m, double time) {
  const double s_curve = cs_variable(cs, ISX88_S_CURVE_TIME);
  const double acceleration = plan_larger(cs_variable(cs, ISX87_ACCELERATION_TIME), s_curve + s_curve);
  time = plan_larger(time, acceleration > 0.0 ? acceleration : PATH_LEAST_MS);
  path_set_times(m, time < TRAJECTORY_LONGEST_MS ? time : TRAJECTORY_LONGEST_MS, acceleration, s_curve);
}

/* Directions at its ends. */
static void set_corner(uint32_t cs, struct path_move* m) {
  path_direction(m, 0.0, corner_move.delta);
  path_direction(m, 1.0, last_direction);
  corner_move.is_sharp = false;
  corner_move.has_dwell = true;
  corner_plan(cs, &corner_move);
  m->sharp = corner_move.is_sharp;
  m->dwells = corner_move.has_dwell;
}

static void push(uint32_t cs, const struct path_move* m) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct path* p = &paths[cs];
  const bool blends = !s->unblended;
  struct path_move* in = path_of(p, p->count);
  *in = *m;
  in->joins = blends && s->may_join;
  in->stands = false;
  in->line = (struct path_line){s->line.places[0], s->line.places[s->line.depth], s->line.depth != 0};
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    in->start[axis] = s->position[axis];
    s->last_delta[axis] = last_direction[axis];
    s->position[axis] = m->end[axis];
  }
  s->pending_axes = s->pending_triggers = s->pending_velocities = s->pending_vectors = 0;
  s->may_join = blends;
  s->was_matched = false;
  in->number = ++s->planned;
  p->count++;
}

enum run_time_error plan_path(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct path_move* m = &planning;
  double time;
  plan_targets(cs, &corner_move, m->end);
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) m->delta[axis] = corner_move.delta[axis];
  const enum circle_kind kind = s->mode == MODE_LINEAR ? CIRCLE_STRAIGHT : find_circle(cs, m);
  if (kind == CIRCLE_IMPOSSIBLE) return RUN_TIME_RADIUS;
  m->is_arc = kind == CIRCLE_ARC;
  m->absolute = s->pending_axes & s->pending_absolute;
  for (uint32_t axis = AXIS_A; axis <= AXIS_C; axis++) m->told[axis] = s->pending[axis];
  m->timed = s->time_mode;
  if (m->timed) {
    time = cs_real(cs, ISX89_FEEDRATE);
  } else {
    m->feedrate = feedrate_of(cs, m);
    if (!plan_path_time(m, &time)) return RUN_TIME_FEEDRATE;
  }
  set_times(cs, m, time);
  set_corner(cs, m);
  push(cs, m);
  return RUN_TIME_NONE;
}

void plan_path_delay(uint32_t cs, double milliseconds) {
  struct path_move* m = &planning;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    m->delta[axis] = last_direction[axis] = 0.0;
    m->end[axis] = coordinate_systems[cs].position[axis];
  }
  m->is_arc = m->sharp = false;
  m->absolute = 0;
  m->dwells = true;
  set_times(cs, m, milliseconds);
  push(cs, m);
}
