// Control points of a path and their B-spline, in doubles (motion:7.1).
#pragma once

#include <cmath>
#include <functional>
#include <vector>

namespace spline_path {

// Control points every `period` ms of a path of `time` ms, the first and the last three times.
inline std::vector<double> points_of(const std::function<double(double)>& path, double time, double period) {
  const int intervals = static_cast<int>(std::ceil(time / period - 1e-9));
  std::vector<double> points(3, path(0));
  for (int i = 1; i < intervals; ++i) points.push_back(path(i * period));
  points.insert(points.end(), 3, path(time));
  return points;
}

class Spline {
 public:
  Spline(const std::function<double(double)>& path, double time, double period)
      : Spline(points_of(path, time, period), period) {}
  Spline(std::vector<double> points, double period) : period_(period), points_(std::move(points)) {}
  double length() const { return period_ * static_cast<double>(points_.size() - 3); }
  double at(double t) const {
    if (t >= length()) return points_.back();
    const auto i = static_cast<std::size_t>(t / period_);
    const double u = t / period_ - static_cast<double>(i), v = 1 - u;
    const double* p = &points_[i];
    return (v * v * v * p[0] + (3 * u * u * u - 6 * u * u + 4) * p[1] + (3 * v * v * v - 6 * v * v + 4) * p[2] +
            u * u * u * p[3]) /
           6;
  }
  const std::vector<double>& points() const { return points_; }

 private:
  double period_;
  std::vector<double> points_;
};

}  // namespace spline_path
