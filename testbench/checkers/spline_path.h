// Where a program of LINEAR and CIRCLE moves goes when it is made of segments (motion:7.1, motion:7.2): each move goes
// along its own way, its progress rises with a change of velocity about either corner; of the sum a control point is
// taken every Isx13 ms, the first and the last three times; the path is their uniform cubic B-spline. Motors in counts,
// from where they stand at first; milliseconds of program time; double precision.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace brick {

using MotorPoint = std::vector<double>;

struct SplineMove {
  double time;                                  // ms, of F or TM
  std::function<MotorPoint(double share)> way;  // from the start of the move, 0 to 1 of it
};

SplineMove line_move(double time, const MotorPoint& by);

// The first three motors are X, Y, Z; Z may be missing. About `centre`, seen from the start, by `turn` radians of a
// right-hand screw along the unit vector `normal`. The radius changes evenly with the angle to what the end has; what
// the end is out of the plane, and all other motors, go evenly.
struct Arc {
  std::array<double, 3> centre, normal;
  double turn;
};
SplineMove arc_move(double time, const MotorPoint& by, const Arc& arc);

class SplinePath {
 public:
  // `ta`, `ts`: of every corner. Every move takes `ta` at least.
  SplinePath(const std::vector<SplineMove>& moves, double ta, double ts, double period);

  double period() const { return period_; }
  double end() const { return period_ * static_cast<double>(points_.size() - 3); }
  std::size_t motors() const { return points_.front().size(); }
  const std::vector<MotorPoint>& points() const { return points_; }
  MotorPoint at(double t) const;
  // The same with the points of a motor no further up than `most` (motion:7.5/6).
  SplinePath held(std::size_t motor, double most) const;
  std::size_t first_beyond(std::size_t motor, double most) const;  // of its points

  // How far a point is from the path, and where on it that is, between two times.
  struct Nearest {
    double time, distance;
  };
  Nearest nearest(const MotorPoint& point, double from, double to) const;

 private:
  double distance2(const MotorPoint& point, double t) const;

  double period_;
  std::vector<MotorPoint> points_;
};

}  // namespace brick
