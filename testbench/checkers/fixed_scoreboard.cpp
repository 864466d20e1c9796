#include "testbench/checkers/fixed_scoreboard.h"

#include <utility>

#include <fmt/format.h>

namespace brick {

void FixedScoreboard::violate(Tick now, const std::string& text) {
  violations_.push_back(fmt::format("{:.3f} us, {} words open, I18={}: {}",
                                    static_cast<double>(now) * 78'125.0 / 9216.0 / 1000.0, open_words_, i18_, text));
}

void FixedScoreboard::expect(std::vector<bool> edges) {
  expected_ = std::move(edges);
  seen_ = 0;
  if (expected_.empty()) ++counts_.quiet;
}

void FixedScoreboard::state(bool open, unsigned open_words) {
  open_ = open;
  open_words_ = open_words;
  if (expect_level() == level_)
    expect({});
  else
    expect({expect_level()});
}

void FixedScoreboard::line(unsigned words) {
  open_words_ -= words;
  ++counts_.lines;
  if (!level_)
    expect({});
  else if (expect_level())
    expect({false, true});
  else
    expect({false});
}

void FixedScoreboard::edge(Tick now, bool level) {
  if (seen_ >= expected_.size() || expected_[seen_] != level) {
    violate(now, fmt::format("BREQ {}; expected: {}", level ? "rises" : "falls",
                             seen_ < expected_.size() ? "the other edge" : "no edge"));
  } else {
    ++seen_;
    if (level) ++counts_.rises;
    const bool pulse = level && seen_ == 2;
    if (pulse) ++counts_.pulses;
    if (pulse && (now - fell_at_ < kShortestPulse || now - fell_at_ > kLongestPulse))
      violate(now, fmt::format("BREQ was low for {} ticks; expected: {} to {} (T_PULSE)", now - fell_at_,
                               kShortestPulse, kLongestPulse));
  }
  if (!level) fell_at_ = now;
  level_ = level;
}

void FixedScoreboard::settled(Tick now, bool pin, bool signal, bool full) {
  const auto shown = [](bool level) { return level ? "high" : "low"; };
  if (seen_ < expected_.size())
    violate(now, fmt::format("BREQ is {}; expected: {} edges of it, {} at the end", shown(level_), expected_.size(),
                             shown(expect_level())));
  if (pin != level_ || signal != pin)
    violate(now, fmt::format("SIG shows BREQ {}; expected: {} as the pin", shown(signal), shown(pin)));
  if (full != expect_full()) violate(now, fmt::format("Fixed Buffer Full is {}; expected: {}", full, expect_full()));
  if (open_ && seen_ == 1 && expected_.size() == 1 && !level_) ++counts_.stays_low;
  expected_.clear();
  seen_ = 0;
}

}  // namespace brick
