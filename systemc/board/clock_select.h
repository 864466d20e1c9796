// Model of rtl/board/clock_select.sv: the board's PHASE and SERVO nets from the ICs that drive them or from jumper E1.
#pragma once

#include <algorithm>
#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/model_block.h"
#include "systemc/core/sync2.h"

namespace brick {

class ClockSelect final : public sc_core::sc_module, public ModelBlock {
 public:
  explicit ClockSelect(const sc_core::sc_module_name& name) : sc_module(name) {}

  struct Drivers {  // bits as in BoardInputs::fitted, absent ICs already taken out
    std::uint32_t phase = 0;
    std::uint32_t servo = 0;
    bool ext = false;
    bool operator!=(const Drivers& o) const { return phase != o.phase || servo != o.servo || ext != o.ext; }
  };
  Drivers in;
  bool ext_phase = true, ext_servo = true;             // inputs
  std::uint32_t phase_level = ~0u, servo_level = ~0u;  // levels of the IC outputs

  bool phase() const { return phase_q_; }
  bool servo() const { return servo_q_; }
  std::uint32_t phase_source() const {
    if (q_.ext) return regs::clock_source::kOutside;
    return q_.phase == 0 ? regs::clock_source::kNone : static_cast<std::uint32_t>(__builtin_ctz(q_.phase));
  }
  // Drivers of one net have disagreed for more than kTolerated ticks; stays until there is one driver again.
  bool conflict() const { return conflict_ && several(); }

  Tick next_event() const override {
    if (q_.ext && (ext_phase_.moves(ext_phase) || ext_servo_.moves(ext_servo))) return now_ + 1;
    if (phase_level != phase_level_q_ || servo_level != servo_level_q_) return now_ + 1;
    if (phase_net() != phase_q_ || servo_net() != servo_q_) return now_ + 1;
    const Tick conflict_rises = !conflict_ && disagree() ? now_ + kTolerated + 1 - disagree_ : kNever;
    return std::min(conflict_rises, in != q_ ? next_ref_edge(now_) : kNever);
  }
  void advance(Tick t) override {
    if (t <= now_) return;
    // Nothing that disagree() and the nets look at has changed since now_, so all edges up to t see the same.
    if (disagree() && disagree_ + (t - now_) > kTolerated) conflict_ = true;
    disagree_ = disagree() ? std::min(kTolerated, disagree_ + (t - now_)) : 0;
    conflict_ = conflict_ && several();
    phase_q_ = phase_net();
    servo_q_ = servo_net();
    phase_level_q_ = phase_level;
    servo_level_q_ = servo_level;
    ext_phase_.advance(ext_phase, t - now_);
    ext_servo_.advance(ext_servo, t - now_);
    if (next_ref_edge(now_) <= t) q_ = in;
    now_ = t;
  }
  void reset(Tick t) override {
    q_ = Drivers{};
    disagree_ = 0;
    ext_phase_ = ext_servo_ = Sync2{true, true};
    phase_level_q_ = servo_level_q_ = ~0u;
    phase_q_ = servo_q_ = true;
    now_ = t;
  }

 private:
  static constexpr Tick kTolerated = 2;  // ticks for which two drivers may disagree

  bool several() const {
    if (q_.ext) return q_.phase != 0 || q_.servo != 0;
    return (q_.phase & (q_.phase - 1)) != 0 || (q_.servo & (q_.servo - 1)) != 0;
  }
  bool disagree() const {
    return several() &&
           (fight(q_.phase, phase_level_q_, ext_phase_.level()) || fight(q_.servo, servo_level_q_, ext_servo_.level()));
  }
  bool fight(std::uint32_t drivers, std::uint32_t level, bool ext_level) const {
    const bool low = (drivers & ~level) != 0, high = (drivers & level) != 0;
    return q_.ext ? (ext_level ? low : high) : low && high;
  }
  bool phase_net() const { return net(q_.phase, phase_level_q_, ext_phase_.level()); }
  bool servo_net() const { return net(q_.servo, servo_level_q_, ext_servo_.level()); }
  bool net(std::uint32_t drivers, std::uint32_t level, bool ext_level) const {
    if (q_.ext) return ext_level;
    return drivers == 0 || (level & drivers & (0u - drivers)) != 0;  // lowest-numbered driver wins, idle is high
  }

  Drivers q_;
  Sync2 ext_phase_, ext_servo_;
  std::uint32_t phase_level_q_{}, servo_level_q_{};  // of the ICs, a tick later
  bool phase_q_{}, servo_q_{};                       // the nets
  bool conflict_{};
  Tick disagree_{};  // ticks for which they have, kTolerated at most
  Tick now_{};
};

}  // namespace brick
