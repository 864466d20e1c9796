// Model of rtl/servo_ic/channel_pfm.sv: the PFM_CLK periods to the next overflow are computed, those before it are
// added at once.
#pragma once

#include <algorithm>
#include <cstdint>

#include "systemc/core/model_block.h"

namespace brick {

class ChannelPfm {
 public:
  struct Inputs {
    bool run;
    std::uint32_t command;  // 24 bits, signed
    unsigned width;         // PFM_CLK periods, 0 as 1
  };

  bool pulse() const { return pulse_; }
  bool down() const { return down_; }
  bool event() const { return event_; }  // a pulse began since the last SCLK
  void take_event() { event_ = false; }

  // PFM_CLK periods to the next pulse.
  std::int64_t periods_to_pulse(const Inputs& in) const {
    const std::int64_t step = size(in);
    if (!in.run || step == 0) return kNever;
    return negative(in) ? acc_ / step + 1 : (kRange - acc_ + step - 1) / step;
  }
  // PFM_CLK periods to the next change of a pin.
  std::int64_t periods_to_change(const Inputs& in) const {
    return std::min<std::int64_t>(periods_to_pulse(in), pulse_ && in.run ? left_ + 1 : kNever);
  }

  // k periods of PFM_CLK, not beyond the next pulse. Returns true when it begins with the last of them.
  bool advance(std::int64_t k, const Inputs& in) {
    if (k == 0 || !in.run) return false;
    const bool begins = k == periods_to_pulse(in);
    acc_ = (acc_ + (negative(in) ? -k : k) * size(in)) & (kRange - 1);
    if (begins) {
      left_ = in.width == 0 ? 0 : in.width - 1;
      pulse_ = event_ = true;
      down_ = negative(in);
    } else if (k > left_) {
      pulse_ = false;
    } else {
      left_ -= k;
    }
    return begins;
  }
  void stop() { pulse_ = false; }  // any edge of clk_ref without `run`

 private:
  static constexpr std::int64_t kRange = 1 << 24;
  static constexpr std::int64_t kLimit = kRange / 4;  // at most a quarter of PFM_CLK
  static bool negative(const Inputs& in) { return in.command >> 23 & 1; }
  static std::int64_t size(const Inputs& in) {
    const std::int64_t command = in.command;
    return std::min<std::int64_t>(negative(in) ? kRange - command : command, kLimit);
  }

  std::int64_t acc_ = 0, left_ = 0;  // left_: of a pulse
  bool pulse_ = false, down_ = false, event_ = false;
};

}  // namespace brick
