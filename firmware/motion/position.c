/* Where the virtual axes of a coordinate system are: the executing move's profile evaluated at the present trajectory
 * time. Used when a program is aborted: the trajectory stands still meanwhile. */
#include "firmware/motion/position.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"

/* Distance covered while the velocity rises from 0 to 1 during `length` with S-parts of `s` at both ends, after `t`.
 * At once without a length (TA0 TS0). */
static double rise(double t, double length, double s) {
  if (t <= 0.0) return 0.0;
  if (t >= length) return t - length / 2.0;
  if (t > length / 2.0) return t - length / 2.0 + rise(length - t, length, s);
  double slope = 1.0 / (length - s);
  slice_pause();
  if (t < s) {
    double cube = slope * t * t * t;
    return cube / (6.0 * s);
  }
  double straight = t - s, begun = s * s / 6.0;
  slice_pause();
  return slope * (begun + s * straight / 2.0 + straight * straight / 2.0);
}

static double s_part(const struct move* m, double length) {
  if (m->acceleration == 0) return 0.0;
  double s = (double)m->s_curve * length / (double)m->acceleration;
  slice_pause();
  return s > length / 2.0 ? length / 2.0 : s;
}

/* Most axes stand still in most moves: nothing is calculated for them. */
static double velocity(double delta, double time) { return delta == 0.0 ? 0.0 : delta / time; }

/* Of a spline, from its points: (before + 4 at + after) / 6, and the velocity there, (after - before) / the time of
 * both (motion:5.4/4). Behind the last point there is none, at it everything stands. */
static void way_point(const struct move* m, uint32_t i, uint32_t axis, double* position, double* velocity) {
  const uint32_t last = KNOTS - 1u, here = i < last ? i + 1u : last, behind = here < last ? here + 1u : last;
  const double at = m->knots[here].position[axis];
  *position = at;
  *velocity = 0.0;
  if (i == last) return;
  const double back = m->knots[i].position[axis] - at, ahead = m->knots[behind].position[axis] - at;
  if (back == 0.0 && ahead == 0.0) return;
  const int64_t both = i == 0 ? m->time_ahead + m->knot_time[0] : m->knot_time[i - 1u] + m->time;
  slice_pause();
  *position = at + (back + ahead) / 6.0;
  *velocity = (ahead - back) / math_scale((double)both, -TRAJECTORY_FRACTION_BITS);
  slice_pause();
}

static void knot_of(const struct move* m, uint32_t i, uint32_t axis, double* position, double* velocity) {
  if (m->kind == MOVE_SPLINE) {
    way_point(m, i, axis, position, velocity);
  } else {
    *position = m->knots[i].position[axis];
    *velocity = m->knots[i].velocity[axis];
  }
}

/* Of PVT and SPLINE moves. */
static void on_cubics(const struct move* m, int64_t elapsed, double position[AXIS_COUNT]) {
  uint32_t i = 0;
  while (i + 2u < m->knot_count && elapsed > m->knot_time[i]) elapsed -= m->knot_time[i++];
  const double time = math_scale((double)m->knot_time[i], -TRAJECTORY_FRACTION_BITS);
  const double u = elapsed < m->knot_time[i] ? (double)elapsed / (double)m->knot_time[i] : 1.0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    slice_pause();
    double from, to, first, second;
    knot_of(m, i, axis, &from, &first);
    knot_of(m, i + 1u, axis, &to, &second);
    const double way = to - from;
    position[axis] = from;
    if (way == 0.0 && first == 0.0 && second == 0.0) continue;
    const double v0 = first * time, v1 = second * time;
    const double cube = (v0 + v1 - way - way) * u;
    slice_pause();
    position[axis] += (v0 + (3.0 * way - v0 - v0 - v1 + cube) * u) * u;
  }
}

static void on_line(const struct coordinate_system* s, double position[AXIS_COUNT]) {
  const struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  const bool goes_on = s->next_valid && s->placed && next->blended;
  double t = (double)s->elapsed, in = (double)m->blend_in, out = (double)m->stop_length, half = in / 2.0;
  double time = (double)m->time, stop = t - (half + time - out / 2.0);
  double begun = rise(t, in, s_part(m, in));
  slice_pause();
  double ended = goes_on ? 0.0 : rise(stop, out, s_part(m, out));
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    slice_pause();
    double before = m->blended ? velocity(m->delta_before[axis], (double)m->time_before) : 0.0;
    double now = velocity(m->delta[axis], time);
    position[axis] = m->start[axis];
    if (before == 0.0 && now == 0.0) continue;
    double x = m->start[axis] + before * (t - half) + (now - before) * begun;
    position[axis] = x - now * ended;
  }
}

void cs_present_position(const struct coordinate_system* s, double position[AXIS_COUNT]) {
  const struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  const double* stands = m->start; /* while it waits, or motors go for themselves */
  if (!s->active) stands = s->next_valid ? next->start : s->position;
  if (s->active && m->kind == MOVE_LINEAR) {
    on_line(s, position);
  } else if (s->active && (m->kind == MOVE_PVT || m->kind == MOVE_SPLINE)) {
    on_cubics(m, s->elapsed, position);
  } else {
    for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) position[axis] = stands[axis];
  }
}
