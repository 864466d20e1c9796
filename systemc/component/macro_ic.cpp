#include <brick/macro_ic.h>

#include "systemc/component/chip.h"
#include "systemc/component/macro_ic_words.h"

namespace brick::component {

const std::vector<PinInfo>& MacroIc::pin_table() {
  using namespace macro_ic_words;
  constexpr PinDirection kIn = PinDirection::kIn, kOut = PinDirection::kOut;
  static const std::vector<PinInfo> table{
      {"rst_n", kIn, 0, kRstN, 1, 1, "servo-ic:6.2", "reset, asynchronous, active low"},
      {"gate", kIn, 0, kGate, 1, 0, "servo-ic:6.1", "1 = MACROGATE, 0 = DSPGATE2"},
      {"phase_i", kIn, 0, kPhaseIn, 1, 1, "servo-ic:5.1", "PHASE net"},
      {"servo_i", kIn, 0, kServoIn, 1, 1, "servo-ic:5.1", "SERVO net"},
      {"phase_o", kOut, 0, kPhase, 1, 0, "servo-ic:5.1", "PHASE as the IC drives it, high while it does not"},
      {"phase_oe", kOut, 0, kPhaseOe, 1, 0, "servo-ic:5.1", "the IC drives PHASE"},
      {"servo_o", kOut, 0, kServo, 1, 0, "servo-ic:5.1", "SERVO as the IC drives it, high while it does not"},
      {"servo_oe", kOut, 0, kServoOe, 1, 0, "servo-ic:5.1", "the IC drives SERVO"}};
  return table;
}

MacroIc::MacroIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, macro_ic_words::kAddresses}}),
      registers("registers"),
      rst_n(*this, "rst_n"),
      gate(*this, "gate"),
      phase_i(*this, "phase_i"),
      servo_i(*this, "servo_i"),
      phase_o(*this, "phase_o"),
      phase_oe(*this, "phase_oe"),
      servo_o(*this, "servo_o"),
      servo_oe(*this, "servo_oe") {
  registers.register_b_transport(this, &MacroIc::transport);
  registers.register_transport_dbg(this, &MacroIc::debug);
  set_chip(engine.factory().macro_ic());
}

}  // namespace brick::component
