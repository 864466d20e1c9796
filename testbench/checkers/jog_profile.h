// The path of a jog as the sheet has it (motion:4.1, motion:4.2): Ta(v) = max(Ixx20, 2 Ixx21, v / Ixx19 + Ixx21), of
// which Ixx21 at each end is rounded; a move too short for its speed has the speed v with v Ta(v) = distance.
#pragma once

#include "testbench/checkers/velocity_profile.h"

namespace brick {

struct JogLimits {
  double acceleration = 1;  // Ixx19, counts/ms^2
  double time = 0;          // Ixx20, ms
  double rounding = 20;     // Ixx21, ms
  double speed = 32;        // Ixx22, counts/ms

  double time_for(double change) const;  // Ta of a change of velocity
  double peak(double distance) const;    // speed that a move from rest to rest reaches
};

VelocityProfile jog_profile(double from, double to, const JogLimits& limits);  // from rest to rest
// Without end; `velocity` is where it begins, `speed` (signed) where it goes. speed = 0: J/.
VelocityProfile jog_to_speed(double from, double velocity, double speed, const JogLimits& limits);
// On the way to another target, at `velocity` already, far enough from the target to reach its speed.
VelocityProfile jog_on(double from, double velocity, double to, const JogLimits& limits);

}  // namespace brick
