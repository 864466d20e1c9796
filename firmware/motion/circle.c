#include "firmware/motion/circle.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"

#define PI 3.14159265358979323846
#define TURN (2.0 * PI)
#define LEAST_ARC 9.5367431640625e-7 /* 2^-20, of pi, when Isx97 is 0 */
#define LEAST_RADIUS 1e-9            /* of the distance of the ends: below it the radius is 0 */

enum { SPIRAL_STEPS = 16, DRIFT_STEPS = 32 }; /* of a turn, even */
enum { NO_DRIFT = -40, NO_SPIRAL = -10 };     /* 2^that of an arc: less is rounding; lengthens it by 2^-21 at most */

static double product(const double a[CIRCLE_AXES], const double b[CIRCLE_AXES]) {
  double sum = 0.0;
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    if (a[i] != 0.0 && b[i] != 0.0) sum += a[i] * b[i];
    slice_pause();
  }
  return sum;
}

static double plus_product(double sum, double a, double b) {
  sum += a * b;
  slice_pause();
  return sum;
}

static void cross(const double a[CIRCLE_AXES], const double b[CIRCLE_AXES], double out[CIRCLE_AXES]) {
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    const uint32_t j = (i + 1u) % CIRCLE_AXES, k = (i + 2u) % CIRCLE_AXES;
    out[i] = a[j] * b[k] - a[k] * b[j];
    slice_pause();
  }
}

static double length(const double a[CIRCLE_AXES]) {
  const double square = product(a, a);
  return math_square_root(square);
}

static double hypotenuse(double a, double b) {
  const double square = plus_product(plus_product(0.0, a, a), b, b);
  const double root = math_square_root(square);
  return root;
}

/* from + by * direction */
static void go(const double from[CIRCLE_AXES], double by, const double direction[CIRCLE_AXES],
               double out[CIRCLE_AXES]) {
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    out[i] = from[i] + by * direction[i];
    slice_pause();
  }
}

/* The axis of the rotation: NORMAL for CIRCLE1, against it for CIRCLE2. False: it has no direction. */
static bool rotation(const struct circle_line* line, double axis[CIRCLE_AXES]) {
  const double size = length(line->normal);
  if (!(size > 0.0)) return false;
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    axis[i] = line->normal[i] / (line->counter ? -size : size);
    slice_pause();
  }
  return true;
}

/* Of `chord`, which lies in the plane: the centre is to its left for the short way, half a turn at most. However short
 * that is, the angle is right: not from directions, whose rounding could make a turn of it. */
static enum circle_kind centre_by_radius(const struct circle_line* line, const double axis[CIRCLE_AXES],
                                         const double chord[CIRCLE_AXES], struct circle* c) {
  const double size = length(chord), radius = math_absolute(line->radius), half = size / 2.0;
  double left[CIRCLE_AXES];
  if (!(size > 0.0)) return CIRCLE_STRAIGHT;
  if (!(radius > 0.0)) return CIRCLE_IMPOSSIBLE;
  go(line->start, 0.5, chord, c->centre);
  const double excess = size - radius - radius;
  c->angle = PI;
  if (excess > 0.0) return line->most > 0.0 && excess > line->most ? CIRCLE_IMPOSSIBLE : CIRCLE_ARC;
  cross(axis, chord, left);
  const double beside = math_square_root(radius * radius - half * half);
  const double height = beside / size;
  c->angle = 2.0 * math_arc_tangent2(half, beside, false);
  if (line->radius < 0.0) c->angle = TURN - c->angle;
  go(c->centre, line->radius > 0.0 ? height : -height, left, c->centre);
  return CIRCLE_ARC;
}

static void centre_by_vector(const struct circle_line* line, struct circle* c) {
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    const bool given = ((line->vectors >> i) & 1u) != 0;
    c->centre[i] = line->start[i];
    if (!given) continue;
    c->centre[i] = line->absolute ? line->vector[i] : line->start[i] + line->vector[i];
    slice_pause();
  }
}

/* From the centre to a point, in the plane. */
static double arm(const struct circle* c, const double axis[CIRCLE_AXES], const double point[CIRCLE_AXES],
                  double out[CIRCLE_AXES]) {
  go(point, -1.0, c->centre, out);
  go(out, -product(out, axis), axis, out);
  return length(out);
}

static enum circle_kind turn(const struct circle_line* line, const double axis[CIRCLE_AXES], double distance,
                             struct circle* c) {
  double to_start[CIRCLE_AXES], to_end[CIRCLE_AXES];
  const double start = arm(c, axis, line->start, to_start), end = arm(c, axis, line->end, to_end);
  const double least = LEAST_RADIUS * distance, smallest = line->least > 0.0 ? line->least : LEAST_ARC;
  if (!(start > least) || !(end > least)) return CIRCLE_IMPOSSIBLE;
  c->radius = start;
  c->growth = end - start;
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    c->first[i] = to_start[i] / start;
    slice_pause();
  }
  cross(axis, c->first, c->second);
  /* The centre may lie anywhere along the axis: the arc begins at the start. */
  go(line->start, -start, c->first, c->centre);
  if (line->by_radius) return CIRCLE_ARC; /* its angle is known */
  const double across = product(to_end, c->second), straight = product(to_end, c->first);
  c->angle = math_arc_tangent2(across, straight, false);
  if (c->angle < 0.0) c->angle += 2.0 * PI;
  if (c->angle < smallest * PI) c->angle += 2.0 * PI;
  return CIRCLE_ARC;
}

enum circle_kind circle_of(const struct circle_line* line, struct circle* c) {
  double axis[CIRCLE_AXES], way[CIRCLE_AXES], chord[CIRCLE_AXES];
  if ((line->vectors == 0 && !line->by_radius) || !rotation(line, axis)) return CIRCLE_STRAIGHT;
  go(line->end, -1.0, line->start, way);
  const double height = product(way, axis);
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    c->along[i] = height * axis[i];
    chord[i] = way[i] - c->along[i];
    slice_pause();
  }
  if (line->by_radius) {
    const enum circle_kind kind = centre_by_radius(line, axis, chord, c);
    if (kind != CIRCLE_ARC) return kind;
  } else {
    centre_by_vector(line, c);
  }
  return turn(line, axis, length(chord), c);
}

/* d/d(part) in the plane: outwards at the start, and a quarter of a turn on. */
static void velocity(const struct circle* c, double part, double* outward, double* onward) {
  const double angle = c->angle * part;
  const double now = c->radius + c->growth * part;
  slice_pause();
  const double radius = now * c->angle;
  const double cosine = math_cosine(angle, false), sine = math_sine(angle, false);
  slice_pause();
  *outward = c->growth * cosine - radius * sine;
  slice_pause();
  *onward = c->growth * sine + radius * cosine;
  slice_pause();
}

/* By Simpson's rule, in directions that turn with the arm. `across` and `on`: what goes evenly in the plane, outwards
 * at the start and a quarter of a turn on. */
static double of_curve(const struct circle* c, double across, double on) {
  const bool drifts = across != 0.0 || on != 0.0;
  const uint32_t turns = c->angle > TURN + LEAST_ARC ? 2u : 1u;
  const uint32_t steps = turns * (drifts ? DRIFT_STEPS : SPIRAL_STEPS);
  double sum = 0.0;
  for (uint32_t i = 0; i <= steps; i++) {
    const double part = (double)i / (double)steps;
    const double radius = c->radius + c->growth * part;
    double outward = c->growth, onward = radius * c->angle;
    if (drifts) {
      const double angle = c->angle * part;
      slice_pause();
      const double cosine = math_cosine(angle, false), sine = math_sine(angle, false);
      slice_pause();
      outward = plus_product(plus_product(outward, across, cosine), on, sine);
      onward = plus_product(plus_product(onward, on, cosine), -across, sine);
    }
    const double speed = hypotenuse(outward, onward);
    sum = plus_product(sum, speed, i == 0 || i == steps ? 1.0 : (double)(2u + 2u * (i & 1u)));
  }
  return sum / (double)(3u * steps);
}

double circle_length(const struct circle* c, double beside[CIRCLE_AXES]) {
  const double mean = c->radius + c->growth * 0.5;
  slice_pause();
  const double round = mean * c->angle;
  const double none = math_scale(round, NO_DRIFT);
  double across = product(c->along, c->first), on = product(c->along, c->second);
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) beside[i] = c->along[i];
  slice_pause();
  if (math_absolute(across) <= none && math_absolute(on) <= none) {
    if (math_absolute(c->growth) <= math_scale(round, NO_SPIRAL)) return round;
    across = on = 0.0;
  } else {
    go(beside, -across, c->first, beside);
    go(beside, -on, c->second, beside);
  }
  const double length = of_curve(c, across, on);
  return length;
}

double circle_least_radius(const struct circle* c) { return c->growth < 0.0 ? c->radius + c->growth : c->radius; }

void circle_at(const struct circle* c, double part, double position[CIRCLE_AXES]) {
  const double angle = c->angle * part;
  slice_pause();
  const double radius = c->radius + c->growth * part;
  const double x = radius * math_cosine(angle, false);
  const double y = radius * math_sine(angle, false);
  slice_pause();
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    double at = c->centre[i];
    if (c->first[i] != 0.0) at += c->first[i] * x;
    if (c->second[i] != 0.0) at += c->second[i] * y;
    slice_pause();
    if (c->along[i] != 0.0) at += c->along[i] * part;
    position[i] = at;
  }
}

void circle_direction(const struct circle* c, double part, double direction[CIRCLE_AXES]) {
  double outward, onward;
  velocity(c, part, &outward, &onward);
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    const double in_plane = c->first[i] * outward + c->second[i] * onward;
    slice_pause();
    direction[i] = in_plane + c->along[i];
    slice_pause();
  }
}
