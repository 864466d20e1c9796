// Paths of unsegmented moves in programs as the sheet has them. LINEAR (firmware:7.5): each move has its mean velocity,
// and where one meets the next, or rest, the velocity changes over Ta around the corner. PVT and SPLINE1
// (firmware:7.8): a cubic a move. Counts and milliseconds, one axis.
#pragma once

#include <vector>

#include "testbench/checkers/velocity_profile.h"

namespace brick {

struct LinearMove {
  double distance, time;  // of F or TM, Ta at least
};
// From rest to rest. `corners`: Ta at each, one more than moves, `rounding` of them all TS.
VelocityProfile linear_profile(double from, const std::vector<LinearMove>& moves, const std::vector<double>& corners,
                               double rounding);

struct CubicMove {
  double time, from, to, velocity_from, velocity_to;
};
// Cubics one after the other, each given by its ends.
class CubicPath {
 public:
  explicit CubicPath(std::vector<CubicMove> moves) : moves_(std::move(moves)) {}
  double position(double t) const;
  double end() const;
  double time_at(double position, double from, double to) const;

 private:
  std::vector<CubicMove> moves_;
};

struct PvtMove {
  double to, velocity, time;
};
CubicPath pvt_path(double from, const std::vector<PvtMove>& moves);
// Way points of equal times; one piece more is added before the first and one after the last.
CubicPath spline_path(double from, const std::vector<double>& points, double time);

}  // namespace brick
