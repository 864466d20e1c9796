#include "testbench/checkers/rise_checker.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {
double us(TimeFs time) { return static_cast<double>(time) / (1000.0 * kFsPerNs); }
}  // namespace

std::string RiseChecker::difference() const {
  if (calculated_.size() != lines_) return fmt::format("{} lines calculated, expected {}", calculated_.size(), lines_);
  const TimeFs due_at = calculated_[due()];
  const auto end = std::find_if(background_.begin(), background_.end(), [&](TimeFs t) { return t > due_at; });
  if (end == background_.end()) return "the real-time interrupt did not end, expected an end";
  const std::string expected = fmt::format(", expected one within {:.3f} us after line {} of {}, I16={}",
                                           us(*end - due_at), due() + 1, lines_, i16_);
  if (rises_.size() != 1) return fmt::format("BREQ rose {} times", rises_.size()) + expected;
  if (rises_[0] <= due_at) return fmt::format("BREQ rose {:.3f} us before it", us(due_at - rises_[0])) + expected;
  if (rises_[0] >= *end) return fmt::format("BREQ rose {:.3f} us after it", us(rises_[0] - due_at)) + expected;
  return "";
}

}  // namespace brick
