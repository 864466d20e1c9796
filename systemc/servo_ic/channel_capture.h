// Model of rtl/servo_ic/channel_capture.sv: one-shot position capture.
#pragma once

#include <cstdint>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/model_block.h"
#include "systemc/core/motor_pins.h"

namespace brick {

class ChannelCapture {
 public:
  std::uint32_t position() const { return position_; }
  unsigned fraction() const { return fraction_; }
  bool captured() const { return captured_; }
  bool captured_gi() const { return captured_gi_; }
  unsigned hall() const { return hall_; }

  // The SCLK edge t; `level` by ChannelPin, `control` the control word, position after the edge.
  void sclk(Tick t, bool ready, bool index, unsigned level, std::uint32_t control, std::uint32_t position,
            unsigned fraction) {
    namespace field = regs::servo_channel::control;
    const bool inverted = field::kIndexInvert.is_set(control);
    const bool i = index != inverted;
    const bool f = (level >> flag_pin(field::kFlagSelect.get(control)) & 1) != field::kFlagInvert.get(control);
    bool term = inverted, uses_index = false;
    switch (field::kCaptureSource.get(control)) {
      case regs::capture_source::kIndex:
        term = i;
        uses_index = true;
        break;
      case regs::capture_source::kFlag:
        term = f;
        break;
      case regs::capture_source::kIndexAndFlag:
        term = i && f;
        uses_index = true;
        break;
      case regs::capture_source::kSoftware:
        break;
    }
    const unsigned halls = level >> kW & 7;
    const bool gated = field::kGatedIndex.is_set(control);
    const bool hall_mode = gated && !uses_index;
    const bool edge = hall_mode ? halls != last_halls_ : term && !last_term_;
    last_term_ = term;
    last_halls_ = halls;
    if (!ready || !armed_ || !edge) return;
    armed_ = false;
    captured_ = true;
    captured_gi_ = gated && uses_index;
    position_ = position;
    fraction_ = fraction;
    if (hall_mode) hall_ = halls;
    captured_at_ = t;
  }
  // A read of X:+3 took its sample at the edge t, which has been executed. A capture at that edge wins.
  void read(Tick t) {
    if (captured_at_ == t) return;
    armed_ = true;
    captured_ = captured_gi_ = false;
  }

 private:
  static unsigned flag_pin(std::uint32_t code) {
    switch (code) {
      case regs::flag_select::kHmfl:
        return kHmfl;
      case regs::flag_select::kPlim:
        return kPlim;
      case regs::flag_select::kMlim:
        return kMlim;
      default:
        return kUser;
    }
  }

  bool last_term_ = false, armed_ = true, captured_ = false, captured_gi_ = false;
  unsigned last_halls_ = 0, hall_ = 0, fraction_ = 0;
  std::uint32_t position_ = 0;
  Tick captured_at_ = -1;
};

}  // namespace brick
