/* Speeds of a motor that moves on its own (motion:4.1). Its speed changes along an S: the
 * acceleration rises linearly for `s_curve`, stays, and falls again, and the whole takes
 *
 *     Ta(change) = max(Ixx20, 2 Ixx21, change / Ixx19 + Ixx21)
 *
 * Distances are 1/(32 Ixx08) counts, times ms; floating point, real-time task in slices. */
#ifndef FIRMWARE_MOTION_SPEED_PROFILE_H
#define FIRMWARE_MOTION_SPEED_PROFILE_H

struct speed_limits {
  double shortest;     /* ms: max(Ixx20, 2 Ixx21), at least 1 */
  double s_curve;      /* ms: Ixx21 */
  double acceleration; /* Ixx19, above 0 */
};

/* From the present speed to `speed`, on for `cruise` ms, then to rest. */
struct speed_plan {
  double speed, cruise;
};

struct speed_limits speed_limits_make(double acceleration, double time, double s_curve);
double speed_change_time(const struct speed_limits* limits, double from, double to); /* ms, 0 if they are equal */
/* Comes to rest `distance` from here, never faster than `top` (above 0) unless it already is. A distance within which
 * it cannot stop is overrun and come back to. */
struct speed_plan speed_plan_to(const struct speed_limits* limits, double from, double distance, double top);

#endif
