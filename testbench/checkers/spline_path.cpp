#include "testbench/checkers/spline_path.h"

#include <algorithm>
#include <cmath>

#include "testbench/checkers/velocity_profile.h"

namespace brick {

namespace {

using Vector = std::array<double, 3>;
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector plus(const Vector& a, const Vector& b, double times) {
  return {a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]};
}

void add(MotorPoint& sum, const MotorPoint& by) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += by[i];
}

// Control points of moves, taken in the order of time: moves that are over count with all they go.
class Trajectory {
 public:
  Trajectory(const std::vector<SplineMove>& moves, double ta, double ts) : moves_(moves), ta_(ta), ts_(ts) {
    for (const SplineMove& m : moves) begins_.push_back(end_), end_ += m.time;
    end_ += ta;
    over_ = MotorPoint(moves.front().way(1).size(), 0);
  }
  double end() const { return end_; }
  MotorPoint at(double t) {
    while (first_ < moves_.size() && t >= begins_[first_] + moves_[first_].time + ta_)
      add(over_, moves_[first_++].way(1));
    MotorPoint sum = over_;
    for (std::size_t k = first_; k < moves_.size() && t > begins_[k]; ++k) add(sum, moves_[k].way(progress(k, t)));
    return sum;
  }

 private:
  double progress(std::size_t k, double t) const {
    VelocityProfile p(0);
    p.add({begins_[k], ta_, ts_, 1 / moves_[k].time});
    p.add({begins_[k] + moves_[k].time, ta_, ts_, -1 / moves_[k].time});
    return p.position(t);
  }
  const std::vector<SplineMove>& moves_;
  double ta_, ts_, end_ = 0;
  std::vector<double> begins_;  // of the change of velocity before each move
  std::size_t first_ = 0;       // that is not over
  MotorPoint over_;
};

std::array<double, 4> weights(double u) {
  const double v = 1 - u;
  return {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * v * v * v - 6 * v * v + 4) / 6, u * u * u / 6};
}

}  // namespace

SplineMove line_move(double time, const MotorPoint& by) {
  return {time, [by](double share) {
            MotorPoint p = by;
            for (double& x : p) x *= share;
            return p;
          }};
}

SplineMove arc_move(double time, const MotorPoint& by, const Arc& arc) {
  const std::size_t axes = std::min<std::size_t>(by.size(), 3);
  Vector end{};
  for (std::size_t i = 0; i < axes; ++i) end[i] = by[i];
  const double out = dot(end, arc.normal);
  const Vector centre = plus(arc.centre, arc.normal, -dot(arc.centre, arc.normal));
  const Vector from = plus({}, centre, -1), to = plus(plus(end, arc.normal, -out), centre, -1);
  const double grows = std::sqrt(dot(to, to) / dot(from, from)) - 1;
  return {time, [=, normal = arc.normal, turn = arc.turn](double share) {
            MotorPoint p = by;
            for (double& x : p) x *= share;
            const double radius = 1 + grows * share;
            Vector at = plus(centre, normal, out * share);
            at = plus(at, from, radius * std::cos(turn * share));
            at = plus(at, cross(normal, from), radius * std::sin(turn * share));
            for (std::size_t i = 0; i < axes; ++i) p[i] = at[i];
            return p;
          }};
}

SplinePath::SplinePath(const std::vector<SplineMove>& moves, double ta, double ts, double period) : period_(period) {
  Trajectory trajectory(moves, ta, ts);
  const auto intervals = static_cast<std::size_t>(std::ceil(trajectory.end() / period - 1e-9));
  points_.assign(3, trajectory.at(0));
  for (std::size_t i = 1; i < intervals; ++i) points_.push_back(trajectory.at(static_cast<double>(i) * period));
  points_.insert(points_.end(), 3, trajectory.at(trajectory.end()));
}

MotorPoint SplinePath::at(double t) const {
  if (t <= 0) return points_.front();
  if (t >= end()) return points_.back();
  const auto k = static_cast<std::size_t>(t / period_);
  const auto w = weights(t / period_ - static_cast<double>(k));
  MotorPoint p(motors(), 0);
  for (std::size_t j = 0; j < w.size(); ++j)
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += w[j] * points_[k + j][i];
  return p;
}

SplinePath SplinePath::held(std::size_t motor, double most) const {
  SplinePath path = *this;
  for (MotorPoint& p : path.points_) p[motor] = std::min(p[motor], most);
  return path;
}

std::size_t SplinePath::first_beyond(std::size_t motor, double most) const {
  std::size_t k = 0;
  while (k < points_.size() && points_[k][motor] <= most) ++k;
  return k;
}

double SplinePath::distance2(const MotorPoint& point, double t) const {
  const double inside = std::min(std::max(t, 0.0), end());
  const auto k = std::min(static_cast<std::size_t>(inside / period_), points_.size() - 4);
  const auto w = weights(inside / period_ - static_cast<double>(k));
  double sum = 0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    double off = -point[i];
    for (std::size_t j = 0; j < w.size(); ++j) off += w[j] * points_[k + j][i];
    sum += off * off;
  }
  return sum;
}

// The distance has one least between two times that are near to one another.
SplinePath::Nearest SplinePath::nearest(const MotorPoint& point, double from, double to) const {
  constexpr int kParts = 22;
  constexpr double kGolden = 0.6180339887498949;
  double low = from, high = to, a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = distance2(point, a), at_b = distance2(point, b);
  for (int i = 0; i < kParts; ++i) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      a = high - kGolden * (high - low), at_a = distance2(point, a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kGolden * (high - low), at_b = distance2(point, b);
    }
  }
  return at_a < at_b ? Nearest{a, std::sqrt(at_a)} : Nearest{b, std::sqrt(at_b)};
}

}  // namespace brick
