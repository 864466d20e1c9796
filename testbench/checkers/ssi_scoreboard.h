// Judges the serial encoder inputs from outside: of each frame its clock edges, and the word that the controller must
// have of it. What an encoder put on the line is known; how it is taken is said here by servo-ic:11.3, servo-ic:11.4
// and servo-ic:11.9, not by the design.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

// How a channel is set.
struct SsiSetting {
  std::int64_t period = 768;  // ticks, or cycles of 100 MHz
  bool cycles = false;        // of 100 MHz
  unsigned bits = 24;         // of the position
  bool gray = false;
  unsigned parity = 0;  // 1 odd, 2 even
  unsigned delay = 0;   // serial periods from the trigger to the first fall

  unsigned clocks() const { return bits + (parity != 0 ? 2 : 1); }
  Tick after(std::int64_t count) const;  // ticks from the trigger to the end of so many
};

// What a frame must leave in the registers.
struct SsiResult {
  std::uint32_t position = 0;
  bool parity_error = false;
  bool operator==(const SsiResult& o) const { return position == o.position && parity_error == o.parity_error; }
};

// `word`: `length` bits that the encoder sends, the highest first; with no encoder the line is high.
SsiResult ssi_result(const SsiSetting& setting, std::uint64_t word, unsigned length, bool missing);

// The first difference of a frame's clock edges to what they must be, trigger included; "" when there is none.
std::string ssi_clock_difference(const SsiSetting& setting, Tick trigger, const std::vector<Tick>& edges);

}  // namespace brick
