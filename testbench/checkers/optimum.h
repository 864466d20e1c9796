// The fastest way along a path of cubic B-spline segments within velocity and acceleration limits, in doubles, for the
// tests of lookahead: the square w of the rate is linear over each segment, at most 1, and free where the path stands.
// Written from the definition of the limits, with none of the controller's arithmetic.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace optimum {

struct Motor {
  std::vector<double> points;     // control points, the ends three times
  double velocity, acceleration;  // a ms, a ms^2; 0: no limit
};

class Solver {
 public:
  Solver(const std::vector<Motor>& motors, double period) : motors_(motors), period_(period) {
    knots_ = static_cast<int>(motors.front().points.size()) - 2;
    solve();
  }
  double time() const {  // ms
    double sum = 0;
    for (int k = 0; k + 1 < knots_; ++k) sum += 2 * period_ / (std::sqrt(w_[k]) + std::sqrt(w_[k + 1]));
    return sum;
  }
  // Longest stop from the optimum, in segments.
  int longest_stop() const {
    int longest = 0;
    for (int k = 0; k + 1 < knots_; ++k) {
      double w = w_[k];
      int at = k;
      for (; at + 1 < knots_ && w > 0; ++at) w = least(at, w);
      longest = std::max(longest, at - k);
    }
    return longest;
  }

 private:
  static constexpr int kSamples = 5;
  struct Line {  // |c0 w0 + c1 w1| <= 1
    double c0, c1;
  };
  std::vector<Line> lines(int k) const {
    std::vector<Line> found;
    for (const Motor& m : motors_) {
      if (m.acceleration <= 0) continue;
      const double* p = &m.points[static_cast<std::size_t>(k)];
      const double d0 = p[1] - p[0], d1 = p[2] - p[1], d2 = p[3] - p[2], by = m.acceleration * period_ * period_;
      for (int i = 0; i < kSamples; ++i) {
        const double s = i / (kSamples - 1.0), bend = (d1 - d0) * (1 - s) + (d2 - d1) * s;
        const double pace = (d0 + d1) / 2 + (d1 - d0) * s + (d2 - 2 * d1 + d0) * s * s / 2;
        found.push_back({(bend * (1 - s) - pace / 2) / by, (bend * s + pace / 2) / by});
      }
    }
    return found;
  }
  double cap(int k) const {  // of w at a knot, by the velocity there
    double most = 1;
    for (const Motor& m : motors_) {
      const double* p = &m.points[static_cast<std::size_t>(k)];
      const double v = std::abs(p[2] - p[0]) / 2 / period_;
      if (m.velocity > 0 && v > m.velocity) most = std::min(most, std::pow(m.velocity / v, 2));
    }
    return most;
  }
  // Range of the unknown w beside a known one; empty: first > second.
  struct Range {
    double first, second;
  };
  static Range range(const std::vector<Line>& lines, double known, bool second_unknown, double most) {
    Range r = {0, most};
    for (const Line& l : lines) {
      const double a = second_unknown ? l.c1 : l.c0, b = (second_unknown ? l.c0 : l.c1) * known;
      if (a == 0) {
        if (std::abs(b) > 1 + 1e-12) r.second = -1;
        continue;
      }
      const double x = (1 - b) / a, y = (-1 - b) / a;
      r.first = std::max(r.first, std::min(x, y));
      r.second = std::min(r.second, std::max(x, y));
    }
    return r;
  }
  double least(int k, double w) const {
    const Range r = range(lines(k), w, true, caps_[k + 1]);
    return r.first > r.second ? std::min(w, caps_[k + 1]) : r.first;
  }
  void solve() {
    caps_.resize(knots_), w_.resize(knots_);
    for (int k = 0; k < knots_; ++k) caps_[k] = cap(k);
    std::vector<double> reach(knots_);
    reach[knots_ - 1] = caps_[knots_ - 1];
    for (int k = knots_ - 2; k >= 0; --k) {
      const auto bounds = lines(k);
      const auto most = [&](double w1) {
        const Range r = range(bounds, w1, false, caps_[k]);
        return r.first > r.second + 1e-15 ? -1.0 : r.second;
      };
      double low = 0, high = reach[k + 1];  // concave where it exists, from 0 on
      double best = std::max(most(low), most(high));
      for (int i = 0; i < 40; ++i) {
        const double a = low + (high - low) * 0.4, b = low + (high - low) * 0.6;
        const double fa = most(a), fb = most(b);
        best = std::max({best, fa, fb});
        if (fb < 0 || fa > fb)
          high = b;
        else
          low = a;
      }
      reach[k] = std::max(0.0, best);
    }
    w_[0] = reach[0];
    for (int k = 0; k + 1 < knots_; ++k) {
      const Range r = range(lines(k), w_[k], true, reach[k + 1]);
      w_[k + 1] = std::max(1e-12, std::max(r.second, 0.0));
    }
  }
  std::vector<Motor> motors_;
  double period_;
  int knots_ = 0;
  std::vector<double> caps_, w_;
};

}  // namespace optimum
