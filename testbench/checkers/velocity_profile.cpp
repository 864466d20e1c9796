#include "testbench/checkers/velocity_profile.h"

#include <algorithm>
#include <utility>

namespace brick {

namespace {

// Of a change by 1, `t` after its start: velocity and the way that it has made. The acceleration's four corners each
// bend it by 1 / (rounding * (time - rounding)).
struct Share {
  double velocity, way;
};
Share share(const VelocityChange& c, double t) {
  if (t <= 0) return {0, 0};
  if (t >= c.time) return {1, t - c.time / 2};
  const double full = 1 / (c.time - c.rounding);  // acceleration between the roundings
  if (c.rounding <= 0) return {full * t, full * t * t / 2};
  Share s{0, 0};
  for (const auto& [corner, bend] :
       {std::pair{0.0, 1.0}, {c.rounding, -1.0}, {c.time - c.rounding, -1.0}, {c.time, 1.0}}) {
    const double after = t - corner;
    if (after <= 0) continue;
    s.velocity += bend * full / c.rounding * after * after / 2;
    s.way += bend * full / c.rounding * after * after * after / 6;
  }
  return s;
}

}  // namespace

double VelocityProfile::position(double t) const {
  double sum = position_ + velocity_ * t;
  for (const VelocityChange& c : changes_) sum += c.by * share(c, t - c.start).way;
  return sum;
}

double VelocityProfile::velocity(double t) const {
  double sum = velocity_;
  for (const VelocityChange& c : changes_) sum += c.by * share(c, t - c.start).velocity;
  return sum;
}

double VelocityProfile::end() const {
  double last = 0;
  for (const VelocityChange& c : changes_) last = std::max(last, c.start + c.time);
  return last;
}

double VelocityProfile::time_at(double position, double from, double to) const {
  const bool up = this->position(to) > this->position(from);
  for (int i = 0; i < 60; ++i) {
    const double middle = (from + to) / 2;
    ((this->position(middle) < position) == up ? from : to) = middle;
  }
  return (from + to) / 2;
}

}  // namespace brick
