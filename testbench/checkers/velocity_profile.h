// Motion along one axis as a sum of changes of velocity, each an acceleration that rises, stands and falls in straight
// lines (firmware:7.5, motion:4.1). Jogs and LINEAR moves, blended or not, are lists of such changes; where two overlap
// they add. Counts and milliseconds, double precision.
#pragma once

#include <vector>

namespace brick {

// Of the whole `time` a `rounding` at each end is the rise and the fall of the acceleration, 2 * rounding <= time.
struct VelocityChange {
  double start, time, rounding, by;
};

class VelocityProfile {
 public:
  explicit VelocityProfile(double position, double velocity = 0) : position_(position), velocity_(velocity) {}

  void add(const VelocityChange& change) { changes_.push_back(change); }
  double position(double t) const;  // t = 0 is where it begins
  double velocity(double t) const;
  double end() const;  // of the last change

  // The time in from..to at which it is at `position`; it must go one way in between.
  double time_at(double position, double from, double to) const;

 private:
  double position_, velocity_;
  std::vector<VelocityChange> changes_;
};

}  // namespace brick
