#include "testbench/checkers/shortest_levels.h"

#include <algorithm>

#include <fmt/format.h>

#include "testbench/checkers/clock_checker.h"

namespace brick {

namespace {

constexpr const char* kNames[] = {"PHASE low", "PHASE high", "SERVO low", "SERVO high"};

// SERVO is low for a phase period; with a divider of 0 it is as PHASE.
std::array<Tick, 4> full_levels(const ClockSetting& s) {
  const bool divided = s.servo_divider > 0;
  return {s.low(), s.high(), divided ? s.phase() : s.low(), divided ? s.servo() - s.phase() : s.high()};
}

}  // namespace

void ShortestLevels::begin(const ClockSetting& from, const ClockSetting& to) {
  const auto a = full_levels(from), b = full_levels(to);
  bounds_.emplace();
  for (unsigned i = 0; i < kLevels; ++i) (*bounds_)[i] = std::min(a[i], b[i]);
}

void ShortestLevels::pins(Tick now, bool phase, bool servo) {
  for (const bool is_servo : {false, true}) {
    const bool level = is_servo ? servo : phase;
    if (level == now_is_[is_servo]) continue;
    if (bounds_ && since_[is_servo]) {
      const unsigned i = index(is_servo, !level);  // what ended
      const Tick length = now - *since_[is_servo], bound = (*bounds_)[i];
      Level& entry = levels_[i];
      if (entry.count++ == 0 || length - bound < entry.length - entry.bound) {
        entry.length = length;
        entry.bound = bound;
      }
    }
    now_is_[is_servo] = level;
    since_[is_servo] = now;
  }
}

bool ShortestLevels::kept(unsigned least) const {
  return std::all_of(levels_.begin(), levels_.end(),
                     [least](const Level& l) { return l.count >= least && l.length >= l.bound; });
}

std::string ShortestLevels::text() const {
  std::string text;
  for (unsigned i = 0; i < kLevels; ++i)
    text += fmt::format("{}{} {} ticks ({} at least, {} seen)", i == 0 ? "" : ", ", kNames[i], levels_[i].length,
                        levels_[i].bound, levels_[i].count);
  return text;
}

}  // namespace brick
