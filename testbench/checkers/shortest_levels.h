// The shortest high and low levels of PHASE and SERVO while the clock source moves. Every level is at least as long as
// one of the old or of the new source: a pin is let go and taken while its net is high, with an own rise
// (servo-ic:5.1/4, servo-ic:5.1/8, servo-ic:5.1/9).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "systemc/core/ticks.h"

namespace brick {

struct ClockSetting;

class ShortestLevels {
 public:
  struct Level {
    unsigned count = 0;          // levels that ended while the source moved
    Tick length = 0, bound = 0;  // of the one with the least margin
  };

  void begin(const ClockSetting& from, const ClockSetting& to);  // the source is about to move
  void end() { bounds_.reset(); }
  void pins(Tick now, bool phase, bool servo);  // after each edge of one of the two

  const Level& level(bool servo, bool high) const { return levels_[index(servo, high)]; }
  bool kept(unsigned least) const;  // each of the four was seen `least` times or more, and none was too short
  std::string text() const;         // "PHASE high 6528 ticks (6528 at least), ..."

 private:
  static constexpr unsigned kLevels = 4;
  static unsigned index(bool servo, bool high) { return (servo ? 2u : 0u) + (high ? 1u : 0u); }

  std::optional<std::array<Tick, kLevels>> bounds_;
  std::array<Level, kLevels> levels_{};
  std::array<bool, 2> now_is_{true, true};
  std::array<std::optional<Tick>, 2> since_;  // the last edge; unknown at first
};

}  // namespace brick
