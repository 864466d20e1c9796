// Model of rtl/servo_ic/channel_index.sv: gated and de-multiplexed index, encoder loss.
#pragma once

namespace brick {

class ChannelIndex {
 public:
  // Inputs as status bits 23..12 show them, from the filtered pins.
  unsigned level(unsigned pins, bool demux) const {
    return demux ? (pins & 0x8FB) | (part_ & 7) << 8 | (part_ >> 3) << 2 : pins;
  }
  static bool index(unsigned level, bool gated, bool gate_low) {
    const bool c = (level & 4) != 0;
    return gated ? c && (level & 3) == (gate_low ? 0u : 3u) : c;
  }
  bool incomplete() const { return seen_ != 0xF; }

  // One SCLK edge; returns true when it sees an encoder loss.
  bool sclk(unsigned pins) {
    // W in state 01 of {A, B}, V in 00, U in 10, C in 11: bits 0..3 by {B, A}.
    constexpr unsigned kState[4] = {2, 4, 1, 8};
    const unsigned state = kState[pins & 3];
    seen_ |= state;
    part_ = (part_ & ~state) | ((pins & 4) != 0 ? state : 0);
    const bool equal = ((pins >> 11 ^ pins >> 10) & 1) == 0 || ((pins >> 9 ^ pins >> 8) & 1) == 0;
    const bool loss = equal && equal_;
    equal_ = equal;
    return loss;
  }

 private:
  unsigned seen_ = 0, part_ = 0;
  bool equal_ = false;
};

}  // namespace brick
