// Model of rtl/servo_ic/channel_input.sv: synchroniser on clk_pwm and three-sample filter at SCLK.
#pragma once

#include <cstdint>

#include "systemc/core/model_block.h"

namespace brick {

class ChannelInput {
 public:
  void reset(Tick t) {
    const unsigned pins = pins_;
    *this = ChannelInput{};
    pins_ = pins;
    now_ = t;
  }

  unsigned pins() const { return pins_; }
  // Seen by the edges after `now`.
  void set_pins(Tick now, unsigned pins) {
    synchronise(now);
    pins_ = pins;
  }

  unsigned level() const { return (s0_ & s1_) | (s0_ & s2_) | (s1_ & s2_); }
  bool ready() const { return samples_ > 4; }

  void sclk(Tick edge) {
    synchronise(edge - 1);
    s2_ = s1_;
    s1_ = s0_;
    s0_ = sync2_;
    if (samples_ <= 4) ++samples_;
  }

 private:
  void synchronise(Tick t) {
    if (t <= now_) return;
    sync2_ = t - now_ > 1 ? pins_ : sync1_;
    sync1_ = pins_;
    now_ = t;
  }

  Tick now_ = 0;
  unsigned pins_ = 0, sync1_ = 0, sync2_ = 0, s0_ = 0, s1_ = 0, s2_ = 0, samples_ = 0;
};

}  // namespace brick
