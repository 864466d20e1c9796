// Clock selection: the PHASE and SERVO nets of up to 22 ICs, or of clocks from outside. docs/clock.md, servo-ic:7.
#pragma once

#include <array>

#include <brick/component.h>

namespace brick::component {

class ClockSelect final : public Component {
 public:
  static constexpr std::size_t kIcs = 22;  // servo IC 0..9, 2*..9* (10..17), MACRO IC 0..3 (18..21)

  ClockSelect(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  In<> rst_n;       // reset, asynchronous, idle 1; outputs follow with the next edge
  In<kIcs> fitted;  // bit i: IC i counts; all of them if not bound
  // What each IC drives, idle 1, and that it does: its pins phase_o, servo_o, phase_oe, servo_oe.
  std::array<In<>, kIcs> phase_i, servo_i, phase_oe_i, servo_oe_i;
  In<> ext_clock;             // jumper E1: the clocks come from outside (servo-ic:7.3)
  In<> ext_phase, ext_servo;  // these, idle 1

  Out<> phase, servo;   // the nets, back to all ICs
  Out<5> phase_source;  // IC that drives PHASE; 30 from outside, 31 none
  Out<> conflict;       // drivers of a net disagree (servo-ic:7.2/5)

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
