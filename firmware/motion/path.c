#include "firmware/motion/path.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"

struct path paths[COORDINATE_SYSTEMS];

int64_t path_time(double milliseconds) { return math_to_integer(math_scale(milliseconds, PATH_TIME_BITS)); }

void path_set_time(struct path_move* m, int64_t time) {
  m->time = time;
  slice_pause();
  m->by_time = fixed_divide_by((uint64_t)time);
}

void path_set_times(struct path_move* m, double time, double acceleration, double s_curve) {
  path_set_time(m, path_time(time));
  m->acceleration = m->change = path_time(acceleration);
  m->s_curve = path_time(s_curve);
}

/* S-curves keep their share of a change that is shorter than it should be. */
static int64_t s_part(const struct path_move* m, int64_t length) {
  if (m->s_curve == 0 || length >= m->acceleration) return m->s_curve;
  return fixed_share(m->s_curve, fixed_ratio(length, m->acceleration));
}

/* Way after `t` of a velocity that rises from 0 to 1 during `length`, with S-parts of `s` at both ends: t^3 / (6 s (l -
 * s)) in the first of them, then (s^2 / 6 + (t - s) t / 2) / (l - s) up to the middle. */
static int64_t risen(int64_t t, int64_t length, int64_t s) {
  const int64_t half = length / 2;
  if (t <= 0) return 0;
  if (t >= length) return t - half;
  if (t > half) return t - half + risen(length - t, length, s);
  slice_pause();
  const struct fixed_divisor by = fixed_divide_by((uint64_t)(length - s));
  const int64_t part = fixed_part_of(&by, t);
  slice_pause();
  if (t < s) {
    const int64_t square = fixed_share(t, part), cube = fixed_share(square, fixed_ratio(t, s));
    return cube / 6;
  }
  return fixed_share(s, fixed_part_of(&by, s)) / 6 + fixed_share(t - s, part) / 2;
}

int64_t path_corner(struct path* p, uint32_t ahead) {
  int64_t corner = 0;
  for (uint32_t i = 0; i < ahead; i++) corner += path_of(p, i)->time;
  return corner;
}

int64_t path_begins(struct path* p, uint32_t ahead) { return path_corner(p, ahead) - path_of(p, ahead)->change / 2; }

/* Of the last one before a stop: as at its beginning, as far as there is room behind that. */
static int64_t stop_length(const struct path_move* m) {
  const int64_t room = 2 * m->time - m->change;
  return fixed_smaller(m->acceleration, room);
}

int64_t path_ends(struct path* p, uint32_t count) {
  return path_corner(p, count) + stop_length(path_of(p, count - 1u)) / 2;
}

void path_blend(struct path* p, uint32_t ahead, int64_t now) {
  struct path_move *m = path_of(p, ahead), *before = path_of(p, ahead - 1u);
  const int64_t left = 2 * (path_corner(p, ahead) - now), room = 2 * before->time - before->change;
  m->change = fixed_smaller(fixed_smaller(m->acceleration, room), fixed_larger(left, 0));
}

static int64_t part_of(const struct path_move* m, int64_t progress) {
  if (progress <= 0) return 0; /* of most: no division */
  return progress >= m->time ? PATH_WHOLE : fixed_part_of(&m->by_time, progress);
}

/* What the velocity of one move loses about a corner the next one gains. */
void path_at(struct path* p, struct path_reach reach, int64_t time, struct path_point* point) {
  const struct path_move* m = path_of(p, 0);
  int64_t begun = risen(time + m->change / 2, m->change, s_part(m, m->change)), corner = 0;
  point->count = reach.count;
  for (uint32_t i = 0; i < reach.count; i++) {
    const struct path_move* next = i + 1u < reach.count ? path_of(p, i + 1u) : m;
    const int64_t length = next != m ? next->change : reach.stops ? stop_length(m) : 0;
    int64_t over = 0;
    corner += m->time;
    if ((next != m || reach.stops) && time > corner - length / 2)
      over = risen(time - corner + length / 2, length, s_part(next, length));
    slice_pause();
    point->parts[i] = part_of(m, begun - over);
    begun = over;
    m = next;
  }
}

/* What `part` of a move has made of it, added to `position`. */
static void add(const struct path_move* m, double part, double position[AXIS_COUNT]) {
  const bool turns = m->is_arc && part < 1.0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    const bool by_circle = turns && axis >= AXIS_X && axis <= AXIS_Z;
    if (!by_circle && m->delta[axis] != 0.0) position[axis] += m->delta[axis] * part;
    slice_pause();
  }
  if (!turns) return;
  double on[CIRCLE_AXES];
  circle_at(&m->circle, part, on);
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    position[AXIS_X + i] += on[i] - m->start[AXIS_X + i];
    slice_pause();
  }
}

void path_axes_at(struct path* p, const struct path_point* point, double position[AXIS_COUNT]) {
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) position[axis] = path_of(p, 0)->start[axis];
  for (uint32_t i = 0; i < point->count; i++) {
    const int64_t part = point->parts[i];
    if (part == 0) continue;
    slice_pause();
    if (part != PATH_WHOLE) add(path_of(p, i), math_scale((double)part, -62), position);
    for (uint32_t axis = 0; part == PATH_WHOLE && axis < AXIS_COUNT; axis++) position[axis] = path_of(p, i)->end[axis];
  }
}

void path_at_end(uint32_t count, struct path_point* point) {
  point->count = count;
  for (uint32_t i = 0; i < count; i++) point->parts[i] = PATH_WHOLE;
}

void path_direction(const struct path_move* m, double part, double direction[AXIS_COUNT]) {
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) direction[axis] = m->stands ? 0.0 : m->delta[axis];
  slice_pause();
  if (m->is_arc) circle_direction(&m->circle, part, &direction[AXIS_X]);
}

int64_t path_pop(struct path* p) {
  const int64_t time = path_of(p, 0)->time;
  p->first = (p->first + 1u) % PATH_MOVES;
  p->count--;
  return time;
}
