#include "testbench/checkers/breq_scoreboard.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr Tick kTaskJitter = ns_to_ticks(60'000);  // the real-time task may start this much later than its interrupt
double microseconds(Tick t) { return static_cast<double>(t) * 78'125.0 / 9216.0 / 1000.0; }
}  // namespace

void BreqScoreboard::violate(Tick now, const std::string& text) {
  violations_.push_back(fmt::format("{:.3f} us, &{}: {}", microseconds(now), selected_ + 1, text));
}

// ----------------------------------------------------------------------------------------------------- range of lines

unsigned BreqScoreboard::lowest(const System& s, Tick now) const {
  if (!s.running) return s.low;
  const Tick apart = line_time_ - kTaskJitter;
  const Tick taken = (now - s.since) / apart + (s.exact_start ? 0 : 1);
  return taken >= s.low ? 0 : s.low - static_cast<unsigned>(taken);
}

// A system that was not shown may have left Full unseen.
void BreqScoreboard::age(System& s, Tick now) {
  const bool shown = &s == &now_selected();
  if (!shown && s.running && s.full == true && lowest(s, now) < i16_) s.full.reset();
}

void BreqScoreboard::limits(unsigned i16, unsigned i17) {
  i16_ = i16;
  i17_ = i17;
  for (auto& s : systems_) s = System{};
}

void BreqScoreboard::empty(unsigned cs) {
  const bool running = systems_[cs].running;
  systems_[cs] = System{};
  systems_[cs].running = running;
}

void BreqScoreboard::select(unsigned cs, Tick now) {
  decide_pulse(now);
  age(systems_[cs], now);
  selected_ = cs;
  reselect_ = true;
  pulse_ = may_fall_ = must_fall_ = line_under_way_ = false;
}

void BreqScoreboard::run(unsigned cs, Tick now) {
  systems_[cs].since = now;
  systems_[cs].exact_start = false;
  systems_[cs].running = true;
}

void BreqScoreboard::halt(unsigned cs, Tick now) {
  System& s = systems_[cs];
  s.low = lowest(s, now);
  s.since = now;
  s.running = false;
}

// --------------------------------------------------------------------------------------------------------------- lines

void BreqScoreboard::line_sent(Tick now) {
  decide_pulse(now);
  System& s = now_selected();
  line_under_way_ = may_fall_ = true;
  must_fall_ = level_;
  ++s.high;
}

void BreqScoreboard::stored(Tick now) {
  System& s = now_selected();
  if (!line_under_way_) return;
  line_under_way_ = false;
  ++counts_.lines;
  s.low = lowest(s, now) + 1;  // rule 1: the line has entered
  s.since = now;
  s.exact_start = false;
  if (s.full == false && s.low >= i17_) s.full = true;  // rule 3, certain whatever was taken meanwhile
}

void BreqScoreboard::line_stored(Tick now) { stored(now); }

// --------------------------------------------------------------------------------------------------------------- edges

void BreqScoreboard::edge(Tick now, bool level) {
  decide_pulse(now);
  System& s = now_selected();
  level_ = level;
  last_edge_ = now;
  const Tick rose_at = std::exchange(rose_at_, level ? now : -1);
  if (reselect_) return;  // judged by settled()
  if (!level) {
    if (!may_fall_) {
      violate(now, "BREQ falls although no program line came; expected: high");
      return;
    }
    if (rose_at >= 0 && now - rose_at < kShortestHigh)
      violate(now, fmt::format("BREQ was high for {:.3f} us; expected: 1 us or more between two pulses",
                               microseconds(now - rose_at)));
    may_fall_ = must_fall_ = false;
    pulse_ = true;
    fell_at_ = now;
    stored(now);
    return;
  }
  if (pulse_) {
    pulse_ = false;
    shortest_ = std::min(shortest_, now - fell_at_);
    longest_ = std::max(longest_, now - fell_at_);
    ++counts_.pulses;
    if (now - fell_at_ < kShortestPulse)
      violate(now, fmt::format("BREQ was low for {:.3f} us; expected: 1 us or more (T_PULSE)",
                               microseconds(now - fell_at_)));
    if (lowest(s, now) >= i17_)
      violate(now, fmt::format("BREQ rises with {} or more lines ahead; expected: stays low from I17={} on (rule 3)",
                               lowest(s, now), i17_));
    s.full = false;
    s.high = std::min(s.high, i17_ == 0 ? 0 : i17_ - 1);
    s.low = std::min(s.low, s.high);
    return;
  }
  if (s.full == false) {
    violate(now, "BREQ rises although Full is 0 and no line was being stored; expected: no edge");
    return;
  }
  ++counts_.raised_by_execution;  // rule 4
  raised_at_ = now;
  if (!s.running) violate(now, "BREQ rises although no line is being executed; expected: low while Full is 1");
  if (i16_ == 0 || lowest(s, now) > i16_ - 1)
    violate(now, fmt::format("BREQ rises with {} or more lines ahead; expected: fewer than I16={} (rule 4)",
                             lowest(s, now), i16_));
  s.full = false;
  if (i16_ > 0) {  // a line has just been taken: exactly I16-1 are left; one more if a line is on its way in
    s.low = std::min(s.high, i16_ - 1);
    s.high = line_under_way_ ? std::max(s.low, i16_) : s.low;
    s.since = now;
    s.exact_start = true;
  }
}

// ------------------------------------------------------------------------------------------------------------- queries

void BreqScoreboard::lines_ahead(Tick from, Tick now, unsigned pr) {
  decide_pulse(now);
  System& s = now_selected();
  ++counts_.queries;
  const bool moved =
      edge_since(from);  // a line was taken while the question was being answered: counted with it or without
  const unsigned low = lowest(s, now), high = s.high + (moved ? 1 : 0);
  if (pr < low || pr > high)
    violate(now, low == high ? fmt::format("PR answers {}; expected: {}", pr, low)
                             : fmt::format("PR answers {}; expected: {} to {}", pr, low, high));
  if (moved) return;
  s.low = s.high = pr;
  s.since = from;
  s.exact_start = false;
  if (s.full == true && pr < i16_ && i16_ <= i17_)
    violate(now, fmt::format("{} lines ahead and BREQ is still low; expected: high below I16={} (rule 4)", pr, i16_));
}

void BreqScoreboard::full_bit(Tick from, Tick now, bool full) {
  decide_pulse(now);
  System& s = now_selected();
  ++counts_.queries;
  if (edge_since(from)) return;  // it changed while the question was being answered
  if (s.full && *s.full != full)
    violate(now, fmt::format("Rotary Buffer Full is {}; expected: {} ({} to {} lines ahead)", full ? 1 : 0,
                             *s.full ? 1 : 0, lowest(s, now), s.high));
  s.full = full;
}

void BreqScoreboard::signal(Tick from, Tick now, bool level, const char* source) {
  ++counts_.queries;
  if (edge_since(from) || edge_since(now - ns_to_ticks(500))) return;
  if (level != level_)
    violate(now, fmt::format("{} shows BREQ {}; expected: {} as the pin", source, level ? 1 : 0, level_ ? 1 : 0));
}

// Low for longer than T_PULSE allows: the line has made the buffer full, or a rule is broken.
void BreqScoreboard::decide_pulse(Tick now) {
  if (!pulse_ || now - fell_at_ <= kLongestPulse) return;
  System& s = now_selected();
  pulse_ = false;
  ++counts_.stays_low;
  if (s.high < i17_)
    violate(now, fmt::format("BREQ stays low with at most {} lines ahead; expected: high again below I17={} (rule 2)",
                             s.high, i17_));
  s.full = true;
}

void BreqScoreboard::settled(Tick now) {
  decide_pulse(now);
  System& s = now_selected();
  if (must_fall_)
    violate(now, "the line was stored and BREQ did not go low; expected: low at least momentarily (rule 1)");
  may_fall_ = must_fall_ = reselect_ = false;
  if (!s.full) s.full = !level_;
  if (level_ == *s.full)
    violate(now, fmt::format("BREQ is {} and Rotary Buffer Full should be {}; expected: BREQ {}", level_ ? 1 : 0,
                             *s.full ? 1 : 0, *s.full ? 0 : 1));
}

}  // namespace brick
