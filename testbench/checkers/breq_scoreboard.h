// Scoreboard of the buffer-request rules (host-bus:5.2, host-bus:5.3, host-bus:5.7; firmware:4.5). It is told what the
// host does and sees (lines, selections, PR, ??, edges of BREQ) and knows nothing of the firmware. For each coordinate
// system it keeps L, the lines ahead of the executing one, as a range: exact while the program stands still, growing
// downwards while it runs, exact again after PR or after the edge that says "L has just fallen below I16".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class BreqScoreboard {
 public:
  static constexpr unsigned kSystems = 16;
  static constexpr Tick kLongestPulse = ns_to_ticks(50'000);  // T_PULSE
  static constexpr Tick kShortestPulse = ns_to_ticks(1'000);
  static constexpr Tick kShortestHigh = ns_to_ticks(1'000);  // host-bus:5.7/7
  static constexpr Tick kSettled = ns_to_ticks(60'000);  // after this the pin shows the final state of the last command

  // `line_time`: the shortest time between two lines being taken for execution (one real-time interrupt).
  explicit BreqScoreboard(Tick line_time) : line_time_(line_time) {}

  // What the host does
  // --------------------------------------------------------------------------------------------------
  void limits(unsigned i16, unsigned i17);  // from now on; every buffer is empty
  void select(unsigned cs, Tick now);       // &n sent (cs 0..15); also for OPEN ROT, CLEAR: the pin is shown anew
  void empty(unsigned cs);                  // CLEAR, or DEFINE ROT: L = 0, Full = 0
  void run(unsigned cs, Tick now);          // lines may be taken from now on
  void halt(unsigned cs, Tick now);         // no line is taken any more (settles the range on the next PR)
  void line_sent(Tick now);                 // CR of a program line written, for the selected coordinate system
  void line_stored(Tick now);               // acknowledged

  // What it sees
  // --------------------------------------------------------------------------------------------------------
  void edge(Tick now, bool level);                                   // BREQ
  void lines_ahead(Tick from, Tick now, unsigned pr);                // PR asked at `from`, answered by `now`
  void full_bit(Tick from, Tick now, bool full);                     // bit 16 of the second word of ??
  void signal(Tick from, Tick now, bool level, const char* source);  // BREQ as read elsewhere: SIG bit 1
  void settled(Tick now);  // nothing was sent for kSettled: pin and state must agree

  // Results
  // -------------------------------------------------------------------------------------------------------------
  const std::vector<std::string>& violations() const { return violations_; }
  struct Counts {
    unsigned lines = 0, pulses = 0, stays_low = 0, raised_by_execution = 0, queries = 0;
    Counts operator-(const Counts& o) const {
      return {lines - o.lines, pulses - o.pulses, stays_low - o.stays_low, raised_by_execution - o.raised_by_execution,
              queries - o.queries};
    }
    bool reaches(const Counts& least) const {
      return lines >= least.lines && pulses >= least.pulses && stays_low >= least.stays_low &&
             raised_by_execution >= least.raised_by_execution && queries >= least.queries;
    }
  };
  const Counts& counts() const { return counts_; }
  bool expect_full() const { return systems_[selected_].full.value_or(false); }
  bool level() const { return level_; }
  Tick fell_at() const { return fell_at_; }      // the last fall for a line
  Tick raised_at() const { return raised_at_; }  // the last rise by execution
  Tick shortest_pulse() const { return shortest_; }
  Tick longest_pulse() const { return longest_; }

 private:
  struct System {
    unsigned low = 0, high = 0;  // range of L at `since`
    Tick since = 0;
    bool exact_start = false;  // a line was taken exactly at `since`
    bool running = false;
    std::optional<bool> full = false;
  };
  System& now_selected() { return systems_[selected_]; }
  unsigned lowest(const System& s, Tick now) const;
  void age(System& s, Tick now);
  void stored(Tick now);
  void decide_pulse(Tick now);
  void violate(Tick now, const std::string& text);
  bool edge_since(Tick from) const { return last_edge_ > from; }

  Tick line_time_;
  unsigned i16_ = 5, i17_ = 10;
  std::array<System, kSystems> systems_{};
  unsigned selected_ = 0;
  bool level_ = false;
  Tick last_edge_ = -1;
  bool reselect_ = false;        // &n, OPEN or CLEAR under way: any edge is allowed until settled()
  bool line_under_way_ = false;  // sent, not yet known to be stored
  bool may_fall_ = false;        // a line was sent and its fall has not come
  bool must_fall_ = false;       // ... and the pin was high, so it must come
  bool pulse_ = false;           // fell for a line, not yet decided
  Tick fell_at_ = 0, raised_at_ = 0, rose_at_ = -1, shortest_ = kNever, longest_ = 0;
  Counts counts_;
  std::vector<std::string> violations_;
};

}  // namespace brick
