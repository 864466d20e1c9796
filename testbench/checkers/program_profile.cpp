#include "testbench/checkers/program_profile.h"

#include <utility>

namespace brick {

VelocityProfile linear_profile(double from, const std::vector<LinearMove>& moves, const std::vector<double>& corners,
                               double rounding) {
  VelocityProfile profile(from);
  double corner = corners.at(0) / 2, velocity = 0;
  for (std::size_t i = 0; i <= moves.size(); ++i) {
    const double next = i < moves.size() ? moves[i].distance / moves[i].time : 0;
    profile.add({corner - corners.at(i) / 2, corners.at(i), rounding, next - velocity});
    if (i < moves.size()) corner += moves[i].time;
    velocity = next;
  }
  return profile;
}

double CubicPath::position(double t) const {
  for (const CubicMove& m : moves_) {
    if (t >= m.time) {
      t -= m.time;
      continue;
    }
    const double u = (t < 0 ? 0 : t) / m.time, d = m.to - m.from, v0 = m.velocity_from * m.time,
                 v1 = m.velocity_to * m.time;
    return m.from + u * (v0 + u * (3 * d - 2 * v0 - v1 + u * (v0 + v1 - 2 * d)));
  }
  return moves_.back().to;
}

double CubicPath::end() const {
  double sum = 0;
  for (const CubicMove& m : moves_) sum += m.time;
  return sum;
}

double CubicPath::time_at(double position, double from, double to) const {
  const bool up = this->position(to) > this->position(from);
  for (int i = 0; i < 60; ++i) {
    const double middle = (from + to) / 2;
    ((this->position(middle) < position) == up ? from : to) = middle;
  }
  return (from + to) / 2;
}

CubicPath pvt_path(double from, const std::vector<PvtMove>& moves) {
  std::vector<CubicMove> list;
  double velocity = 0;
  for (const PvtMove& m : moves) {
    list.push_back({m.time, from, m.to, velocity, m.velocity});
    from = m.to;
    velocity = m.velocity;
  }
  return CubicPath(list);
}

CubicPath spline_path(double from, const std::vector<double>& points, double time) {
  // The first and the last point stand for their neighbours outside, too.
  std::vector<double> x{from, from, from};
  x.insert(x.end(), points.begin(), points.end());
  x.insert(x.end(), 2, points.back());
  std::vector<CubicMove> list;
  for (std::size_t n = 1; n + 2 < x.size(); ++n) {
    const auto way = [&x](std::size_t i) { return (x[i - 1] + 4 * x[i] + x[i + 1]) / 6; };
    const auto velocity = [&x, time](std::size_t i) { return (x[i + 1] - x[i - 1]) / (2 * time); };
    list.push_back({time, way(n), way(n + 1), velocity(n), velocity(n + 1)});
  }
  return CubicPath(list);
}

}  // namespace brick
