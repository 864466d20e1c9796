#include "firmware/motion/speed_profile.h"

#include <stdbool.h>

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"

#define LONGEST_MS 8388608.0 /* 2^23: no change takes longer, however small Ixx19 is */

static double larger(double a, double b) { return a > b ? a : b; }

struct speed_limits speed_limits_make(double acceleration, double time, double s_curve) {
  return (struct speed_limits){.shortest = larger(larger(time, 2.0 * s_curve), 1.0),
                               .s_curve = s_curve,
                               .acceleration = acceleration > 0.0 ? acceleration : 0.0};
}

double speed_change_time(const struct speed_limits* l, double from, double to) {
  if (from == to) return 0.0;
  slice_pause();
  const double needed = math_divide(math_absolute(to - from), l->acceleration) + l->s_curve;
  return needed < LONGEST_MS ? larger(l->shortest, needed) : LONGEST_MS;
}

/* Symmetric: the mean speed is that of its ends. */
static double change_distance(const struct speed_limits* l, double from, double to) {
  const double time = speed_change_time(l, from, to);
  slice_pause();
  const double mean = (from + to) / 2.0;
  slice_pause();
  const double distance = mean * time;
  slice_pause();
  return distance;
}

/* From `from` over `to` to rest, without a stay. */
static double shortest_distance(const struct speed_limits* l, double from, double to) {
  return change_distance(l, from, to) + change_distance(l, to, 0.0);
}

/* The speed v above `from` and 0 at which both changes cover `distance`. Each is half of (v - from)(v + from)/Ixx19 +
 * Ixx21 (v + from) or, while it has to last Ixx20, half of Ixx20 (v + from): together square v^2 + linear v + rest. */
static double peak_speed(const struct speed_limits* l, double from, double distance) {
  slice_pause();
  const double slow = l->acceleration * (l->shortest - l->s_curve); /* changes up to it last `shortest` */
  slice_pause();
  const double begin = from > 0.0 ? from : 0.0, first = from + slow > begin ? from + slow : begin;
  const bool second_slow = slow <= begin ? false : distance <= shortest_distance(l, from, slow);
  const bool first_slow = first <= begin ? false : distance <= shortest_distance(l, from, first);
  slice_pause();
  const double time = (first_slow ? l->shortest : l->s_curve) / 2.0;
  const double linear = time + (second_slow ? l->shortest : l->s_curve) / 2.0;
  slice_pause();
  double square = 0.0, rest = time * from - distance;
  slice_pause();
  if (!first_slow || !second_slow) {
    const double half = 0.5 / l->acceleration;
    slice_pause();
    if (!second_slow) square = half;
    if (!first_slow) {
      square += half;
      const double squared = from * from;
      slice_pause();
      rest -= squared * half;
    }
  }
  slice_pause();
  const double product = 4.0 * square * rest;
  slice_pause();
  const double inside = linear * linear - product;
  const double root = math_square_root(larger(inside, 0.0));
  const double below = linear + root;
  slice_pause();
  const double speed = -2.0 * rest / below;
  slice_pause();
  return speed;
}

/* At `speed` as long as the rest of a distance takes. */
static struct speed_plan stay_for(double speed, double rest) {
  slice_pause();
  const struct speed_plan plan = {speed, rest / speed};
  slice_pause();
  return plan;
}

/* `distance` beyond where it would stop, `from` upwards or downwards, `top` above 0. */
static struct speed_plan plan_forward(const struct speed_limits* l, double from, double distance, double top) {
  const double at_top = shortest_distance(l, from, top);
  slice_pause();
  if (distance >= at_top) return stay_for(top, distance - at_top);
  /* Too near to change the speed and back: it is kept until it is time to stop. */
  if (from > 0.0) {
    const double stop = change_distance(l, from, 0.0);
    const double kept = from * l->shortest;
    slice_pause();
    if (from >= top || distance < stop + kept) return stay_for(from, distance - stop);
  }
  return (struct speed_plan){peak_speed(l, from, distance), 0.0};
}

struct speed_plan speed_plan_to(const struct speed_limits* l, double from, double distance, double top) {
  const double beyond = distance - change_distance(l, from, 0.0);
  if (math_absolute(beyond) < 0.5 || !(top > 0.0)) return (struct speed_plan){0.0, 0.0};
  if (beyond > 0.0) return plan_forward(l, from, distance, top);
  const struct speed_plan mirrored = plan_forward(l, -from, -distance, top);
  return (struct speed_plan){-mirrored.speed, mirrored.cruise};
}
