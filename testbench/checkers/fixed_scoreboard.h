// BREQ and Fixed Buffer Full while fixed buffers are entered (firmware:4.6, host-bus:5.7/11): told which words are
// open, what I18 is and what the rotary buffers would show, it expects the edges of each command, one after the other,
// and their final state. Knows nothing of the firmware.
#pragma once

#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class FixedScoreboard {
 public:
  static constexpr Tick kShortestPulse = ns_to_ticks(1'000), kLongestPulse = ns_to_ticks(50'000);  // T_PULSE

  void i18(unsigned words) { i18_ = words; }
  void rotary(bool level) { rotary_ = level; }  // what is shown while no fixed buffer is open

  void shown(bool level) { level_ = level; }  // by something that is not judged here

  // Causes; each ends with settled().
  void opened(unsigned open_words) { state(true, open_words); }  // OPEN, CLEAR
  void closed() { state(false, 0); }
  void line(unsigned words);  // stored
  void nothing() { expect({}); }

  // What is seen. `full`: bit 11 of the second word of ???.
  void edge(Tick now, bool level);
  void settled(Tick now, bool pin, bool signal, bool full);

  bool expect_full() const { return !open_ || open_words_ <= i18_; }
  bool expect_level() const { return open_ ? open_words_ > i18_ : rotary_; }

  const std::vector<std::string>& violations() const { return violations_; }
  struct Counts {
    unsigned lines = 0, pulses = 0, stays_low = 0, rises = 0, quiet = 0;  // quiet: causes that move nothing
  };
  const Counts& counts() const { return counts_; }

 private:
  void state(bool open, unsigned open_words);
  void expect(std::vector<bool> edges);
  void violate(Tick now, const std::string& text);

  bool open_ = false, rotary_ = false, level_ = false;
  unsigned i18_ = 10, open_words_ = 0;
  std::vector<bool> expected_;  // levels to come
  std::size_t seen_ = 0;        // of them
  Tick fell_at_ = 0;
  Counts counts_;
  std::vector<std::string> violations_;
};

}  // namespace brick
