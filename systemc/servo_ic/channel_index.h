// Model of rtl/servo_ic/channel_index.sv: gated and de-multiplexed index, encoder loss.
#pragma once

#include "systemc/core/motor_pins.h"

namespace brick {

class ChannelIndex {
 public:
  // Inputs as the status word shows them, from the filtered pins.
  unsigned level(unsigned pins, bool demux) const {
    constexpr unsigned kReplaced = 1u << kEncC | 7u << kW;
    return demux ? (pins & ~kReplaced) | (part(pins) & 7) << kW | (part(pins) >> 3) << kEncC : pins;
  }
  static bool index(unsigned level, bool gated, bool gate_low) {
    const bool c = is(level, kEncC);
    return gated ? c && is(level, kEncA) != gate_low && is(level, kEncB) != gate_low : c;
  }
  bool incomplete() const { return seen_ != 0xF; }

  // One SCLK edge; returns true when it sees an encoder loss.
  bool sclk(unsigned pins) {
    seen_ |= state(pins);
    part_ = part(pins);
    const bool equal = is(pins, kT) == is(pins, kU) || is(pins, kV) == is(pins, kW);
    const bool loss = equal && equal_;
    equal_ = equal;
    return loss;
  }

 private:
  // W in state 01 of {A, B}, V in 00, U in 10, C in 11: bits 0..3 by {B, A}.
  static unsigned state(unsigned pins) {
    constexpr unsigned kState[4] = {2, 4, 1, 8};
    return kState[pins & 3];
  }
  // What the line carries in each state: now in the present one, when it was last there in the others.
  unsigned part(unsigned pins) const { return (part_ & ~state(pins)) | (is(pins, kEncC) ? state(pins) : 0); }
  static bool is(unsigned pins, ChannelPin pin) { return (pins >> pin & 1) != 0; }

  unsigned seen_ = 0, part_ = 0;
  bool equal_ = false;
};

}  // namespace brick
