#include "firmware/motion/path.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"

struct path paths[COORDINATE_SYSTEMS];

/* S-curves keep their share of a change that is shorter than it should be. */
static double s_part(const struct path_move* m, double length) {
  if (m->s_curve == 0.0 || length >= m->acceleration) return m->s_curve;
  return m->s_curve * length / m->acceleration;
}

/* Way after `t` of a velocity that rises from 0 to 1 during `length`, with S-parts of `s` at both ends. */
static double risen(double t, double length, double s) {
  if (t <= 0.0) return 0.0;
  const double half = length / 2.0;
  if (t >= length) return t - half;
  if (t > half) {
    slice_pause();
    return t - half + risen(length - t, length, s);
  }
  slice_pause();
  const double slope = 1.0 / (length - s);
  slice_pause();
  if (t < s) {
    const double square = t * t * slope;
    slice_pause();
    return square * t / (6.0 * s);
  }
  const double straight = t - s;
  slice_pause();
  return slope * (s * s / 6.0 + straight * (s + straight) / 2.0);
}

double path_corner(struct path* p, uint32_t ahead) {
  double corner = 0.0;
  for (uint32_t i = 0; i < ahead; i++) corner += path_of(p, i)->time;
  return corner;
}

double path_begins(struct path* p, uint32_t ahead) {
  slice_pause();
  return path_corner(p, ahead) - path_of(p, ahead)->change / 2.0;
}

/* Of the last one before a stop: as at its beginning, as far as there is room behind that. */
static double stop_length(const struct path_move* m) {
  const double room = 2.0 * m->time - m->change;
  return m->acceleration < room ? m->acceleration : room;
}

double path_ends(struct path* p, uint32_t count) {
  slice_pause();
  return path_corner(p, count) + stop_length(path_of(p, count - 1u)) / 2.0;
}

void path_blend(struct path* p, uint32_t ahead, double now) {
  struct path_move *m = path_of(p, ahead), *before = path_of(p, ahead - 1u);
  const double corner = path_corner(p, ahead);
  slice_pause();
  const double left = 2.0 * (corner - now), room = 2.0 * before->time - before->change;
  m->change = m->acceleration;
  slice_pause();
  if (m->change > room) m->change = room;
  if (m->change > left) m->change = left > 0.0 ? left : 0.0;
}

/* What `progress` of its time has made of it, added to `position`. */
static void add(const struct path_move* m, double progress, double position[AXIS_COUNT]) {
  if (progress <= 0.0) return;
  const double part = progress < m->time ? progress / m->time : 1.0;
  slice_pause();
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    const bool by_circle = m->is_arc && axis >= AXIS_X && axis <= AXIS_Z;
    if (by_circle && part < 1.0) continue;
    if (m->delta[axis] != 0.0) position[axis] += m->delta[axis] * part;
    slice_pause();
  }
  if (!m->is_arc || part >= 1.0) return;
  double on[CIRCLE_AXES];
  circle_at(&m->circle, part, on);
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    position[AXIS_X + i] += on[i] - m->start[AXIS_X + i];
    slice_pause();
  }
}

void path_at(struct path* p, struct path_reach reach, double time, double position[AXIS_COUNT]) {
  double corner = 0.0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) position[axis] = path_of(p, 0)->start[axis];
  for (uint32_t i = 0; i < reach.count; i++) {
    const struct path_move* m = path_of(p, i);
    const bool last = i + 1u == reach.count;
    const struct path_move* next = last ? 0 : path_of(p, i + 1u);
    const double in = m->change, out = !last ? next->change : reach.stops ? stop_length(m) : 0.0;
    slice_pause();
    double progress = risen(time - corner + in / 2.0, in, s_part(m, in));
    corner += m->time;
    slice_pause();
    if (!last || reach.stops) progress -= risen(time - corner + out / 2.0, out, s_part(last ? m : next, out));
    slice_pause();
    add(m, progress, position);
  }
}

double path_pop(struct path* p) {
  const double time = path_of(p, 0)->time;
  p->first = (p->first + 1u) % PATH_MOVES;
  p->count--;
  return time;
}
