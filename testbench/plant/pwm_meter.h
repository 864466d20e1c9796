// Measures the six PWM pins of a channel: how long each phase's upper and lower switch were on. A phase is at +1/2 of
// the bus while the upper one is on, at -1/2 while the lower one is, and counts as 0 in the dead time.
#pragma once

#include <array>
#include <cstdint>

#include "systemc/core/motor_digest.h"
#include "systemc/core/ticks.h"

namespace brick::plant {

class PwmMeter {
 public:
  static constexpr unsigned kPhases = PwmTimes::kPhases;

  // The pins from which it starts, also once more; without it all low at tick 0.
  void begin(Tick tick, unsigned pins) {
    at_ = from_ = tick;
    sum_ = {};
    both_on_ = false;
    changed(tick, pins);
  }
  // Every change of the pins, bits A top, A bottom, B top, ... from bit 0.
  void changed(Tick tick, unsigned pins) {
    settle(tick);
    pins_ = pins;
    for (unsigned i = 0; i < kPhases; ++i) both_on_ = both_on_ || (pins >> (2 * i) & 3) == 3;
  }

  // The same from sums that somebody else keeps, in place of changed(): those from which it starts, and those up to
  // now, after which take() and take_short() say what has been since the last ones.
  void begin(Tick tick, const PwmTimes& times) {
    begin(tick, 0u);
    times_ = times;
  }
  void add(Tick now, const PwmTimes& times) {
    for (unsigned i = 0; i < kPhases; ++i) sum_[i] += times.balance[i] - times_.balance[i];
    both_on_ = both_on_ || times.shorts != times_.shorts;
    times_ = times;
    at_ = now;
  }

  // Average of each phase since the last call, -1 .. 1.
  std::array<double, kPhases> take(Tick now) {
    settle(now);
    std::array<double, kPhases> average{};
    if (now > from_)
      for (unsigned i = 0; i < kPhases; ++i)
        average[i] = static_cast<double>(sum_[i]) / static_cast<double>(now - from_);
    sum_ = {};
    from_ = now;
    return average;
  }

  // Upper and lower switch of a phase were on at the same time, since the last call: the bus was shorted.
  bool take_short() {
    const bool both = both_on_;
    both_on_ = false;
    return both;
  }

 private:
  void settle(Tick t) {
    if (t <= at_) return;
    for (unsigned i = 0; i < kPhases; ++i)
      sum_[i] += (t - at_) * (static_cast<int>(pins_ >> (2 * i) & 1) - static_cast<int>(pins_ >> (2 * i + 1) & 1));
    at_ = t;
  }

  std::array<Tick, kPhases> sum_{};
  PwmTimes times_;
  Tick at_ = 0, from_ = 0;
  unsigned pins_ = 0;
  bool both_on_ = false;
};

}  // namespace brick::plant
