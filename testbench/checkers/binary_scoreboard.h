// The binary rotary transfer as host and buses see it (host-bus:7.2 to host-bus:7.5): told what the host puts into the
// buffers of the dual-ported RAM, it judges each word that the controller writes into a header and each edge of BREQ.
// Programs stand still: what a ring holds is what has been copied. Knows nothing of the firmware.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class BinaryScoreboard {
 public:
  static constexpr unsigned kSystems = 16;
  static constexpr Tick kShortestPulse = ns_to_ticks(1'000), kLongestPulse = ns_to_ticks(50'000);  // T_PULSE
  static constexpr Tick kShortestHigh = ns_to_ticks(1'000);                                        // host-bus:5.7/7

  // What the host does; cs counts from 0.
  void defined(unsigned cs, unsigned ring_words);  // a ring and a buffer, both empty
  void limits(unsigned i17) { i17_ = i17; }
  void line(unsigned cs, std::string text, unsigned commands, unsigned end);  // stands in the RAM up to this index
  void advanced(unsigned cs, Tick now);                                       // the host's index is behind all of them
  void foreground(bool on) { foreground_ = on; }                              // I45
  void expect_error(unsigned cs, unsigned code) { systems_[cs].code = code; }
  void recovered(unsigned cs);          // indices are 0, what was not copied is forgotten
  void closed();                        // what was not copied is forgotten
  void unjudged() { judged_ = false; }  // a command moves BREQ; until ...
  void shown(unsigned cs, bool level);  // ... it shows this system
  void settled(Tick now);               // nothing came for T_PULSE: the pin shows Full of what has been copied

  // What is seen.
  void pmac_index(unsigned cs, unsigned index, bool in_real_time, Tick now);
  void status(unsigned cs, unsigned word, Tick now);
  void edge(Tick now, bool level);

  bool all_copied() const;
  bool has_error(unsigned cs) const { return systems_[cs].has_error; }
  unsigned copied(unsigned cs) const { return systems_[cs].copied; }       // lines in the ring: PR
  std::string listing(unsigned cs) const { return systems_[cs].listing; }  // of them, joined by `|`
  const std::vector<Tick>& delays() const { return delays_; }              // from the host's index to the fall of BREQ
  void forget_delays() { delays_.clear(); }

  const std::vector<std::string>& violations() const { return violations_; }
  struct Counts {
    unsigned lines = 0, pulses = 0, stays_low = 0, busy = 0, errors = 0, several = 0;  // several: lines of one pass
  };
  const Counts& counts() const { return counts_; }

 private:
  struct Line {
    std::string text;
    unsigned commands, end;
    Tick written;  // the host's index
  };
  struct System {
    unsigned ring_words = 0, used = 0, copied = 0, code = 0;
    bool has_error = false;
    std::deque<Line> waiting;
    std::string listing;
    Tick copied_at = -1;
  };
  void violate(Tick now, const std::string& text);

  std::array<System, kSystems> systems_{};
  unsigned selected_ = 0, i17_ = 10;
  bool foreground_ = false, judged_ = false, level_ = false;
  unsigned falls_ = 0;  // of BREQ, for lines of the selected system whose index has not moved yet
  Tick fell_at_ = -1, rose_at_ = -1;
  std::vector<Tick> delays_;
  Counts counts_;
  std::vector<std::string> violations_;
};

}  // namespace brick
