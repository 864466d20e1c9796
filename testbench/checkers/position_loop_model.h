// The servo loop of motion:1.1 in double precision: what the output has to be, closure by closure, for the commanded
// and the actual position that the loop saw. Counts; output in bits of 16.
#pragma once

#include <array>

namespace brick {

struct LoopGains {
  double position_scale = 96, velocity_scale = 96;        // Ixx08, Ixx09
  double p = 2000, d = 1280, vff = 1280, i = 0, aff = 0;  // Ixx30, 31, 32, 33, 35
  bool integrate_at_rest = true;                          // Ixx34
  double limit_i = 4194304, limit_e = 4194304;            // Ixx63, Ixx67, 1/16 count
  double deadband_gain = 0, deadband = 16;                // Ixx64; Ixx65, 1/16 count
  double friction = 0, bias = 0, limit = 20480;           // Ixx68, Ixx29, Ixx69
  std::array<double, 4> notch{};                          // N1 N2 D1 D2, Ixx36 to 39
};

class PositionLoopModel {
 public:
  // `commanded`, `actual`: where they stood when the loop was closed.
  PositionLoopModel(const LoopGains& gains, double commanded, double actual)
      : g_(gains), commanded_(commanded), actual_(actual) {}

  // The output of one closure.
  double output(double commanded, double actual);
  void follow(double measured);  // the output that was really made: decides about a clip that is too close to call
  double integrator() const { return integrator_; }

 private:
  LoopGains g_;
  double commanded_, actual_, velocity_ = 0, integrator_ = 0;
  bool clipped_ = false;
  std::array<double, 2> in_{}, out_{};  // of the notch, newest first
};

}  // namespace brick
