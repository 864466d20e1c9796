// Model of rtl/board/watchdog.sv: trips when 25 ms pass without a firmware strobe or without an edge of SERVO, or when
// 5 V is not good. Closed form: a timer that was reloaded at clk_ref edge number n runs out at the 960th multiple of
// 1024 after n.
#pragma once

#include <algorithm>

#include <systemc>

#include "systemc/core/model_block.h"

namespace brick {

class Watchdog final : public sc_core::sc_module, public ModelBlock {
 public:
  explicit Watchdog(const sc_core::sc_module_name& name) : sc_module(name) {}

  bool strobe = false;                 // input: seen by the next clk_ref edge only, the board takes it away after that
  bool servo = true, pwr_good = true;  // inputs

  bool trip() const { return trip_; }
  bool relay() const { return relay_; }  // energised

  Tick next_event() const override {
    if (relay_ == trip_ || (!trip_ && !(pwr_good && good1_ && good2_))) return tick_of(edge_ + 1);
    return trip_ ? kNever : tick_of(std::min(strobe_end_, servo_end_));
  }

  void advance(Tick t) override {
    const std::int64_t last = edge_at(t);
    // The first of these edges samples the inputs, the second sees the sampled SERVO, the third the 5 V that have come
    // through two flip-flops; the later ones see nothing new.
    for (int n = 0; n < 3 && edge_ < last; ++n) {
      ++edge_;
      const bool reload_strobe = strobe && n == 0, reload_servo = servo1_ != servo2_;
      servo2_ = servo1_;
      servo1_ = servo;
      trip_ = trip_ || !good2_ || (strobe_end_ == edge_ && !reload_strobe) || (servo_end_ == edge_ && !reload_servo);
      good2_ = good1_;
      good1_ = pwr_good;
      if (reload_strobe) strobe_end_ = end_after(edge_);
      if (reload_servo) servo_end_ = end_after(edge_);
    }
    trip_ = trip_ || std::min(strobe_end_, servo_end_) <= last;
    edge_ = last;
    if (edge_ > 0) relay_ = !trip_;
  }

  void reset(Tick t) override {
    first_ = t / kTicksPerRef;
    edge_ = 0;
    strobe_end_ = servo_end_ = end_after(0);
    servo1_ = servo2_ = good1_ = good2_ = true;
    trip_ = relay_ = false;
  }

 private:
  static constexpr std::int64_t kPrescale = 1024, kTimeout = 960;  // 25 ms
  static std::int64_t end_after(std::int64_t edge) { return (edge / kPrescale + kTimeout) * kPrescale; }
  std::int64_t edge_at(Tick t) const { return t / kTicksPerRef - first_; }  // clk_ref edges executed since reset
  Tick tick_of(std::int64_t edge) const { return (edge + first_) * kTicksPerRef; }

  std::int64_t first_{}, edge_{}, strobe_end_{}, servo_end_{};
  bool servo1_{}, servo2_{};  // SERVO, two stages on clk_ref
  bool good1_{}, good2_{};    // 5 V, the same
  bool trip_{}, relay_{};
};

}  // namespace brick
