// What goes into a waveform (`--trace`): names or globs of docs/signals.md. A pattern stands for every signal whose
// whole name it matches, or whose end behind a dot: `host.*`, `breq`, `servo_ic?.ch1.pwm_*`; `all` for every signal.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace brick {

class Signals;

class TraceGroups {
 public:
  TraceGroups() = default;  // every signal but the serial clocks, which run freely with PHASE
  explicit TraceGroups(std::vector<std::string> patterns) : patterns_(std::move(patterns)) {}
  static TraceGroups all() { return TraceGroups({"all"}); }

  bool select(const std::string& name) const;                          // full name, without the top scope
  std::optional<std::string> unmatched(const Signals& signals) const;  // first pattern that no signal has

 private:
  std::vector<std::string> patterns_;  // empty: the default
};

}  // namespace brick
