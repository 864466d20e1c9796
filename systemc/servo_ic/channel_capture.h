// Model of rtl/servo_ic/channel_capture.sv: one-shot position capture.
#pragma once

#include <cstdint>

#include "systemc/core/model_block.h"

namespace brick {

class ChannelCapture {
 public:
  std::uint32_t position() const { return position_; }
  unsigned fraction() const { return fraction_; }
  bool captured() const { return captured_; }
  bool captured_gi() const { return captured_gi_; }
  unsigned hall() const { return hall_; }

  // The SCLK edge t; `level` as status bits 23..12, `control` the control word, position after the edge.
  void sclk(Tick t, bool ready, bool index, unsigned level, std::uint32_t control, std::uint32_t position,
            unsigned fraction) {
    const bool inverted = (control >> 6 & 1) != 0;
    const bool i = index != inverted;
    const bool f = ((level >> (4 + (control >> 8 & 3)) & 1) != 0) != ((control >> 7 & 1) != 0);
    const unsigned source = control >> 4 & 3;
    const bool term = source == 0 ? inverted : source == 1 ? i : source == 2 ? f : i && f;
    const unsigned halls = level >> 8 & 7;
    const bool gated = (control >> 15 & 1) != 0;
    const bool hall_mode = gated && (source & 1) == 0;
    const bool edge = hall_mode ? halls != last_halls_ : term && !last_term_;
    last_term_ = term;
    last_halls_ = halls;
    if (!ready || !armed_ || !edge) return;
    armed_ = false;
    captured_ = true;
    captured_gi_ = gated && (source & 1) != 0;
    position_ = position;
    fraction_ = fraction;
    if (hall_mode) hall_ = halls;
    captured_at_ = t;
  }
  // A read of X:+3 ends at the edge t, which has been executed. A capture at that edge wins.
  void read(Tick t) {
    if (captured_at_ == t) return;
    armed_ = true;
    captured_ = captured_gi_ = false;
  }

 private:
  bool last_term_ = false, armed_ = true, captured_ = false, captured_gi_ = false;
  unsigned last_halls_ = 0, hall_ = 0, fraction_ = 0;
  std::uint32_t position_ = 0;
  Tick captured_at_ = -1;
};

}  // namespace brick
