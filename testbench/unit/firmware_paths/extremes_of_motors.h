// Test fixture: how fast motors were, and how hard they were accelerated, from a start to the end of all motion.
#pragma once

#include "testbench/unit/firmware_program/moving_motors.h"

namespace moving_motors {

class ExtremesOfMotors : public MovingMotors {
 protected:
  // Largest of the first and second differences (counts a ms, a ms^2) of a motor at any interrupt.
  struct Extremes {
    double velocity = 0, acceleration = 0;
  };
  static std::vector<Extremes> extremes(
      unsigned count, double* end, const std::function<void(double)>& look = [](double) {},
      const std::string& start = "&1B1R") {
    std::vector<Extremes> found(count);
    std::vector<std::vector<double>> samples(count);
    constexpr unsigned kSpan = 8;  // interrupts
    *end = run(
        [&](double t) {
          look(t);
          for (unsigned i = 0; i < count; ++i) {
            auto& s = samples[i];
            s.push_back(at(i + 1));
            const std::size_t n = s.size();
            if (n < 2 * kSpan + 1) continue;
            const double span = kSpan * kTickMs, v1 = (s[n - 1] - s[n - 1 - kSpan]) / span;
            const double v0 = (s[n - 1 - kSpan] - s[n - 1 - 2 * kSpan]) / span;
            found[i].velocity = std::max(found[i].velocity, std::abs(s[n - 1] - s[n - 2]) / kTickMs);
            found[i].acceleration = std::max(found[i].acceleration, std::abs(v1 - v0) / span);
          }
        },
        start);
    return found;
  }
};

}  // namespace moving_motors
