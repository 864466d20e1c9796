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
    reciprocal_ = ~std::uint64_t{0} / divisor() + 1;
  }
  // Number of the cycle since power-on, as if the clock had always been this fast.
  Cycle number(Cycle cycle) const { return edge_ * n_ / kTicksPerMultiplier + cycle - cycle_; }
  unsigned multiplier() const { return static_cast<unsigned>(n_); }

  // The start of a cycle, from which times are counted without a division each.
  struct Origin {
    TimeFs block = 0;       // start of the 144 ticks that it is in
    std::int64_t rest = 0;  // from there, in parts of a tick
  };
  Origin origin(Cycle cycle) const {
    const std::int64_t offset = 4 * kTicksPerMultiplier * (cycle - cycle_);
    const Tick tick = edge_ + offset / parts();
    return {static_cast<TimeFs>(tick / detail::kBlockTicks) * detail::kBlockFs,
            tick % detail::kBlockTicks * parts() + offset % parts()};
  }
  // Time of the instant `quarters` quarter cycles after it, at most 30000 of them, rounded down to a femtosecond.
  // Multiplied by the reciprocal of the divisor: the product is below 2^49 and the divisor below 2^15, so that is
  // exact.
  TimeFs time(const Origin& from, std::int64_t quarters) const {
    const auto product = static_cast<std::uint64_t>((from.rest + kTicksPerMultiplier * quarters) * detail::kBlockFs);
    return from.block + static_cast<TimeFs>(static_cast<unsigned __int128>(product) * reciprocal_ >> 64);
  }
  TimeFs time(Cycle cycle, std::int64_t quarters = 0) const { return time(origin(cycle), quarters); }
  // First clock edge that is not before the start of `cycle`.
  Tick tick(Cycle cycle) const { return edge_ + (kTicksPerMultiplier * (cycle - cycle_) + n_ - 1) / n_; }
  // First cycle that starts at or after clock edge `t`.
  Cycle first_cycle(Tick t) const {
    return cycle_ + ((t - edge_) * n_ + kTicksPerMultiplier - 1) / kTicksPerMultiplier;
  }

 private:
  std::int64_t parts() const { return 4 * n_; }  // of a tick
  std::uint64_t divisor() const { return static_cast<std::uint64_t>(detail::kBlockTicks * parts()); }

  Tick edge_ = 0;
  Cycle cycle_ = 0;
  std::int64_t n_ = 8;
  std::uint64_t reciprocal_ = ~std::uint64_t{0} / (8 * 4 * detail::kBlockTicks) + 1;  // 2^64 / divisor(), rounded up
};

}  // namespace brick
