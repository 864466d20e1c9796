// Model of rtl/servo_ic/channel_subcount.sv: hardware 1/T. With a SCLK periods added, e is floor(4096 a / T1) exactly;
// only how many periods have been added so far is followed edge by edge, until e is full.
#pragma once

#include <algorithm>
#include <cstdint>

#include "systemc/core/model_block.h"

namespace brick {

class ChannelSubcount {
 public:
  void reset(Tick t) {
    *this = ChannelSubcount{};
    now_ = t / kTicksPerRef * kTicksPerRef;
  }

  bool active() const { return valid_ && e() < kFull; }
  unsigned e() const {
    return valid_ ? static_cast<unsigned>(std::min<std::int64_t>(kFull, t1_ != 0 ? added_ * (kFull + 1) / t1_ : 0)) : 0;
  }

  // Edges of clk_ref up to t at which SCLK does not act.
  void advance(Tick t, bool enable) {
    if (t <= now_) return;
    if (!enable) valid_ = false;
    for (; now_ < t && active() && (steps_ != 0 || lag_ != 0); now_ += kTicksPerRef) step(false);
    now_ = std::max(now_, t);
  }
  // The SCLK edge t; a count leaves T1 as given.
  void sclk(Tick t, bool enable, bool count, bool reversed, std::uint32_t t1) {
    if (count || !enable) {
      valid_ = count && enable && !reversed;
      steps_ = kSteps;
      lag_ = added_ = 0;
      t1_ = t1;
    } else if (active()) {
      step(true);
    }
    now_ = t;
  }

 private:
  static constexpr std::int64_t kFull = 4095;  // the largest e, in 1/4096 count
  static constexpr unsigned kSteps = 13;       // clk_ref cycles of the division

  void step(bool ce) {
    std::int64_t add = 0;
    if (steps_ != 0)
      --steps_;
    else
      add = std::min<std::int64_t>(lag_, 2);
    added_ += add;
    lag_ += (ce ? 1 : 0) - add;
  }

  Tick now_ = 0;
  bool valid_ = false;
  unsigned steps_ = 0;
  std::int64_t lag_ = 0, added_ = 0, t1_ = 0;
};

}  // namespace brick
