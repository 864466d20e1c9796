// The shape of a Port A cycle in quarters of a CPU clock, from the formulas of the DSP563xx (host-bus:2.2) without
// their guard bands: what the pins do at the latest or earliest is the guard band away. docs/port_a.md draws it.
#pragma once

#include <cstdint>

#include "systemc/core/ticks.h"

namespace brick {

struct PortAShape {
  unsigned clocks;       // length of the cycle, row 100
  unsigned strobe_low;   // quarters from address valid to /RD or /WR low, rows 115 and 101
  unsigned strobe_high;  // to /RD or /WR high, rows 116 and 107
  unsigned data_driven;  // of a write: data on the bus, rows 108 and 110
  unsigned idle_clocks;  // after the cycle before the next may begin, rows 113 and 114
  unsigned held_clocks;  // of the idle clocks: address and AA stay, row 117
};

constexpr PortAShape port_a_shape(unsigned wait_states, bool write) {
  PortAShape s{};
  s.clocks = wait_states + (wait_states <= 3 ? 1 : wait_states <= 7 ? 2 : 3);
  s.strobe_high = 4 * wait_states + 3;
  if (!write)
    s.strobe_low = 2;
  else
    s.strobe_low = wait_states <= 1 ? 1 : wait_states <= 3 ? 3 : 5;
  s.data_driven = wait_states == 0 ? 2 : 4;
  s.idle_clocks = wait_states <= 3 ? 1 : 0;
  s.held_clocks = !write && (wait_states == 2 || wait_states == 3) ? 1 : 0;
  return s;
}

constexpr TimeFs kReadDataSetup = 5 * kFsPerNs;  // rows 104 and 105: data must stand this long before /RD rises
constexpr TimeFs kTaSetup = 2 * kFsPerNs;        // row 118: before the clock edge a quarter before the strobe rises

// Extra cycles of an access to DMI memory in an area with these wait states: one clock is in the instruction's own
// cost.
constexpr std::int64_t memory_wait(unsigned wait_states) { return port_a_shape(wait_states, false).clocks - 1; }

}  // namespace brick
