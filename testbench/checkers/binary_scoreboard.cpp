#include "testbench/checkers/binary_scoreboard.h"

#include <algorithm>

#include <fmt/format.h>

#include "rtl/regs/dpram_map.h"

namespace brick {

namespace {
constexpr Tick kOnePass = ns_to_ticks(40'000);  // two lines copied sooner one after the other are of one pass
}

void BinaryScoreboard::violate(Tick now, const std::string& text) {
  violations_.push_back(fmt::format("{}, tick {}", text, now));
}

void BinaryScoreboard::defined(unsigned cs, unsigned ring_words) {
  systems_[cs] = {};
  systems_[cs].ring_words = ring_words;
}

void BinaryScoreboard::line(unsigned cs, std::string text, unsigned commands, unsigned end) {
  systems_[cs].waiting.push_back({std::move(text), commands, end, -1});
}

void BinaryScoreboard::advanced(unsigned cs, Tick now) {
  for (Line& line : systems_[cs].waiting)
    if (line.written < 0) line.written = now;
}

void BinaryScoreboard::recovered(unsigned cs) {
  systems_[cs].waiting.clear();
  systems_[cs].has_error = false;
  systems_[cs].code = 0;
}

// Rules 1 and 5 of host-bus:7.3: line by line, in order, none before its index. host-bus:7.4/7: by the task of I45.
void BinaryScoreboard::pmac_index(unsigned cs, unsigned index, bool in_real_time, Tick now) {
  System& s = systems_[cs];
  if (in_real_time != foreground_)
    violate(now, fmt::format("&{} copied by the {}", cs + 1, in_real_time ? "real-time task" : "background"));
  if (s.waiting.empty() || s.waiting.front().written < 0) {
    violate(now, fmt::format("&{} PMAC index {}, expected none: no line waits", cs + 1, index));
    return;
  }
  const Line& line = s.waiting.front();
  if (index != line.end) violate(now, fmt::format("&{} PMAC index {}, expected {}", cs + 1, index, line.end));
  s.used += line.commands;
  if (s.used > s.ring_words) violate(now, fmt::format("&{} {} words in a ring of {}", cs + 1, s.used, s.ring_words));
  const bool was_ready = s.copied < i17_;
  ++s.copied;
  s.listing += (s.listing.empty() ? "" : "|") + line.text;
  ++counts_.lines;
  counts_.several += s.copied_at >= 0 && now - s.copied_at < kOnePass ? 1 : 0;
  s.copied_at = now;
  if (cs == selected_) {
    // Rule 3 of host-bus:7.1: a fall for each line, as with text, while there is something to fall.
    if (falls_ != (was_ready ? 1u : 0u))
      violate(now, fmt::format("&{} line {}: BREQ fell {} times", cs + 1, s.copied, falls_));
    if (was_ready) delays_.push_back(fell_at_ - line.written);
    counts_.stays_low += was_ready && s.copied >= i17_ ? 1 : 0;
    falls_ = 0;
  }
  s.waiting.pop_front();
}

void BinaryScoreboard::status(unsigned cs, unsigned word, Tick now) {
  System& s = systems_[cs];
  if ((word & DPRAM_ROTARY_ERROR) != 0) {
    s.has_error = true;
    ++counts_.errors;
    if (s.code == 0 || (word & DPRAM_ROTARY_ERROR_CODE) != s.code)
      violate(now, fmt::format("&{} error {}, expected {}", cs + 1, word & DPRAM_ROTARY_ERROR_CODE, s.code));
  } else if ((word & DPRAM_ROTARY_BUSY) != 0) {
    ++counts_.busy;
    const bool full = !s.waiting.empty() && s.used + s.waiting.front().commands > s.ring_words;
    if (!full) violate(now, fmt::format("&{} busy with {} of {} words used", cs + 1, s.used, s.ring_words));
  } else if (word != 0) {
    violate(now, fmt::format("&{} status {:04X}", cs + 1, word));
  }
}

void BinaryScoreboard::closed() {
  for (System& s : systems_) s.waiting.clear();
  unjudged();
}

void BinaryScoreboard::shown(unsigned cs, bool level) {
  selected_ = cs;
  judged_ = true;
  level_ = level;
  falls_ = 0;
  fell_at_ = rose_at_ = -1;
  const bool expected = systems_[cs].copied < i17_;
  if (level != expected) violate(0, fmt::format("&{} shown: BREQ {}, expected {}", cs + 1, level, expected));
}

void BinaryScoreboard::settled(Tick now) {
  const System& s = systems_[selected_];
  const bool expected = s.copied < i17_;
  if (judged_ && level_ != expected)
    violate(now, fmt::format("&{} settled with {} lines: BREQ {:d}, expected {:d}", selected_ + 1, s.copied, level_,
                             expected));
}

void BinaryScoreboard::edge(Tick now, bool level) {
  if (level == level_ || !judged_) return;
  level_ = level;
  if (!level) {
    if (rose_at_ >= 0 && now - rose_at_ < kShortestHigh)
      violate(now, fmt::format("BREQ high for {} ticks only", now - rose_at_));
    fell_at_ = now;
    ++falls_;
    return;
  }
  rose_at_ = now;
  ++counts_.pulses;
  if (now - fell_at_ < kShortestPulse || now - fell_at_ > kLongestPulse)
    violate(now, fmt::format("BREQ low for {} ticks", now - fell_at_));
  // The line that takes L to I17 leaves it low; its index moves behind the pulse.
  if (systems_[selected_].copied + 1 >= i17_)
    violate(now, fmt::format("BREQ high with {} lines and I17 = {}", systems_[selected_].copied + 1, i17_));
}

bool BinaryScoreboard::all_copied() const {
  return std::all_of(systems_.begin(), systems_.end(),
                     [](const System& s) { return s.waiting.empty() || s.has_error; });
}

}  // namespace brick
