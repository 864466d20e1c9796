// The CPU clock: 117.9648 MHz x n / 12 with n = I52 + 1, a rational number of ticks a cycle. Converts cycle numbers to
// femtoseconds and to ticks exactly. A new frequency starts with an edge of clk_pwm, so nothing is ever rounded twice.
#pragma once

#include "systemc/core/ticks.h"

namespace brick {

class CpuClock {
 public:
  using Cycle = std::int64_t;
  static constexpr std::int64_t kTicksPerMultiplier = 12;

  // Cycle `cycle` begins with clock edge `edge`; from there on the clock runs with multiplier `n`.
  void restart(Tick edge, Cycle cycle, unsigned n) {
    edge_ = edge;
    cycle_ = cycle;
    n_ = n;
  }
  // Number of the cycle since power-on, as if the clock had always been this fast.
  Cycle number(Cycle cycle) const { return edge_ * n_ / kTicksPerMultiplier + cycle - cycle_; }
  unsigned multiplier() const { return static_cast<unsigned>(n_); }

  // Time of the instant `quarters` quarter cycles after the start of `cycle`, rounded down to a femtosecond.
  TimeFs time(Cycle cycle, std::int64_t quarters = 0) const {
    const std::int64_t parts = 4 * n_;  // of a tick
    const std::int64_t offset = kTicksPerMultiplier * (4 * (cycle - cycle_) + quarters);
    const Tick tick = edge_ + offset / parts;
    const std::int64_t rest = tick % detail::kBlockTicks * parts + offset % parts;
    return tick / detail::kBlockTicks * detail::kBlockFs + rest * detail::kBlockFs / (detail::kBlockTicks * parts);
  }
  // First clock edge that is not before the start of `cycle`.
  Tick tick(Cycle cycle) const { return edge_ + (kTicksPerMultiplier * (cycle - cycle_) + n_ - 1) / n_; }
  // First cycle that starts at or after clock edge `t`.
  Cycle first_cycle(Tick t) const {
    return cycle_ + ((t - edge_) * n_ + kTicksPerMultiplier - 1) / kTicksPerMultiplier;
  }

 private:
  Tick edge_ = 0;
  Cycle cycle_ = 0;
  std::int64_t n_ = 8;
};

}  // namespace brick
