#include "testbench/checkers/jog_profile.h"

#include <algorithm>
#include <cmath>

namespace brick {

double JogLimits::time_for(double change) const {
  return std::max({time, 2 * rounding, std::fabs(change) / acceleration + rounding});
}

double JogLimits::peak(double distance) const {
  double slow = 0, fast = speed;
  if (fast * time_for(fast) <= distance) return fast;
  for (int i = 0; i < 60; ++i) {
    const double middle = (slow + fast) / 2;
    (middle * time_for(middle) < distance ? slow : fast) = middle;
  }
  return slow;
}

VelocityProfile jog_profile(double from, double to, const JogLimits& limits) {
  const double distance = std::fabs(to - from), peak = limits.peak(distance);
  if (distance == 0) return VelocityProfile(from);
  VelocityProfile profile(from);
  const double ramp = limits.time_for(peak), signed_peak = to > from ? peak : -peak;
  profile.add({0, ramp, limits.rounding, signed_peak});
  profile.add({distance / peak, ramp, limits.rounding, -signed_peak});
  return profile;
}

VelocityProfile jog_to_speed(double from, double velocity, double speed, const JogLimits& limits) {
  VelocityProfile profile(from, velocity);
  profile.add({0, limits.time_for(speed - velocity), limits.rounding, speed - velocity});
  return profile;
}

VelocityProfile jog_on(double from, double velocity, double to, const JogLimits& limits) {
  const double speed = to > from ? limits.speed : -limits.speed;
  const double change = limits.time_for(speed - velocity), stop = limits.time_for(speed);
  VelocityProfile profile(from, velocity);
  profile.add({0, change, limits.rounding, speed - velocity});
  const double ways = (velocity + speed) / 2 * change + speed / 2 * stop;
  profile.add({change + (to - from - ways) / speed, stop, limits.rounding, -speed});
  return profile;
}

}  // namespace brick
