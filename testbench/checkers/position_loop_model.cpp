#include "testbench/checkers/position_loop_model.h"

#include <algorithm>
#include <cmath>

namespace brick {

namespace {
double within(double value, double limit) { return std::clamp(value, -limit, limit); }
constexpr double kSumMost = 0x1p39 / 32;  // motion:1.1/10
}  // namespace

double PositionLoopModel::output(double commanded, double actual) {
  const double cv = commanded - commanded_, ca = cv - velocity_, av = actual - actual_;
  const double e = within(commanded - actual, g_.limit_e / 16);
  const double shaped = e + g_.deadband_gain / 16 * within(e, g_.deadband / 16);
  if (!clipped_ && !(g_.integrate_at_rest && cv != 0)) integrator_ += g_.i * shaped / 8388608;
  integrator_ = within(integrator_, std::fabs(g_.limit_i) / 16);
  const double v = (g_.vff * cv + g_.aff * ca) / 128 * g_.position_scale - g_.d * av / 128 * g_.velocity_scale;
  const double u = g_.p / 524288 * within(g_.position_scale * (shaped + integrator_) + v, kSumMost);
  const double y = u + g_.notch[0] * in_[0] + g_.notch[1] * in_[1] - g_.notch[2] * out_[0] - g_.notch[3] * out_[1];
  in_ = {u, in_[0]};
  out_ = {y, out_[0]};
  const double pushed = y + (cv > 0 ? g_.friction : cv < 0 ? -g_.friction : 0);
  const double clipped = within(pushed, g_.limit);
  clipped_ = clipped != pushed;
  commanded_ = commanded;
  actual_ = actual;
  velocity_ = cv;
  return clipped + g_.bias;
}

void PositionLoopModel::follow(double measured) {
  if (std::fabs(std::fabs(measured - g_.bias) - g_.limit) <= 1) clipped_ = std::fabs(measured - g_.bias) >= g_.limit;
}

}  // namespace brick
