// Model of rtl/servo_ic/clock_gen.sv: triangle counter, phase and servo dividers, re-alignment to an external phase
// clock. Closed form between events: the ramp of the triangle is linear in ticks, the synchroniser is a delay. Only
// edges that do more (turnaround, half way, edge of an external clock) are executed one by one, with the same rules as
// the RTL.
#pragma once

#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/model_block.h"

namespace brick {

// What the clock chain starts with, the reset values of the registers.
constexpr unsigned kMaxCountReset = regs::servo_ic::pwm_control::kMaxCount.get(regs::servo_ic::kPwmControl.reset);
constexpr unsigned kPhaseDivReset =
    regs::servo_ic::clock_control::kPhaseDivider.get(regs::servo_ic::kClockControl.reset);
constexpr unsigned kServoDivReset =
    regs::servo_ic::clock_control::kServoDivider.get(regs::servo_ic::kClockControl.reset);

class ClockGen : public sc_core::sc_module, public ModelBlock {
 public:
  explicit ClockGen(const sc_core::sc_module_name& name) : sc_module(name) {}

  struct Settings {
    unsigned max_count = kMaxCountReset;  // I7m00
    unsigned phase_div = kPhaseDivReset;  // I7m01
    unsigned servo_div = kServoDivReset;  // I7m02
    bool phase_ext = true;                // I7m07 bit 0
    bool servo_ext = true;                // I7m07 bit 1
    bool operator==(const Settings& o) const {
      return max_count == o.max_count && phase_div == o.phase_div && servo_div == o.servo_div &&
             phase_ext == o.phase_ext && servo_ext == o.servo_ext;
    }
  };
  struct Inputs : Settings {  // settings are taken over by an edge and act from the next one on
    bool phase = true;        // pins
    bool servo = true;
    bool operator==(const Inputs& o) const { return Settings::operator==(o) && phase == o.phase && servo == o.servo; }
  };
  Inputs in;

  bool phase() const { return s_.phase || phase_ext(); }  // high while the pin is an input
  bool servo() const { return s_.servo || servo_ext(); }
  bool phase_oe() const { return s_.phase_oe; }  // the pin is driven
  bool servo_oe() const { return s_.servo_oe; }
  // Drives a pin, or will.
  bool active() const {
    return s_.phase_oe || s_.servo_oe || !in.phase_ext || !in.servo_ext || !s_.set.phase_ext || !s_.set.servo_ext;
  }
  bool phase_clock() const { return s_.phase; }  // own or external
  bool servo_clock() const { return s_.servo; }
  int cnt() const { return s_.up ? s_.ramp : ~s_.ramp; }
  bool up() const { return s_.up; }  // changes with each turnaround
  Tick next_special_edge() const;    // first edge that is not just one more step of the triangle

  // Inputs and registers of another one, at its time.
  void take(const ClockGen& o) {
    in = o.in;
    s_ = o.s_;
    now_ = o.now_;
  }
  // Remembers inputs and registers; whether they are the same now, the time apart.
  void mark() {
    marked_in_ = in;
    marked_ = s_;
  }
  bool repeats() const { return in == marked_in_ && s_ == marked_; }
  void jump(Tick by) { now_ += by; }

  Tick next_event() const override;  // next change of an output that is driven, or of its direction
  void advance(Tick t) override;
  void reset(Tick t) override;

 private:
  // The pin is followed: a pin still driven is not.
  bool phase_ext() const { return s_.set.phase_ext && !s_.phase_oe; }
  bool servo_ext() const { return s_.set.servo_ext && !s_.servo_oe; }
  bool servo_release() const { return s_.servo_oe && s_.set.servo_ext && s_.servo; }
  bool phase_release() const {
    return s_.phase_oe && s_.set.phase_ext && s_.phase && (s_.servo || !(s_.servo_oe && s_.set.servo_ext));
  }
  bool settings_move() const { return !(s_.set == in); }

  struct State {
    Settings set;  // those that act
    int ramp = 0;  // up ? cnt : ~cnt, counts up from -top to top
    int top = static_cast<int>(kMaxCountReset) + 1;
    bool up = true;
    unsigned phase_cnt = 0, fall_cnt = 0, servo_cnt = kServoDivReset, miss = 0;
    bool odd = false;
    bool phase = true, servo = true;
    bool phase_oe = false, servo_oe = false;
    bool phase1 = true, phase2 = true, servo1 = true, servo2 = true;  // synchroniser
    bool operator==(const State& o) const {
      return set == o.set && ramp == o.ramp && top == o.top && up == o.up && phase_cnt == o.phase_cnt &&
             fall_cnt == o.fall_cnt && servo_cnt == o.servo_cnt && miss == o.miss && odd == o.odd && phase == o.phase &&
             servo == o.servo && phase_oe == o.phase_oe && servo_oe == o.servo_oe && phase1 == o.phase1 &&
             phase2 == o.phase2 && servo1 == o.servo1 && servo2 == o.servo2;
    }
  };

  Tick next_turn() const { return now_ + 1 + (s_.top - s_.ramp); }
  Tick turn_after(unsigned turns) const;
  void skip(Tick edges);
  void step();
  bool align(bool& retard);

  State s_, marked_;
  Inputs marked_in_;
  Tick now_ = 0;
};

}  // namespace brick
