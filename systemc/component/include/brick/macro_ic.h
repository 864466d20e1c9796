// MACRO IC (DSPGATE2 or MACROGATE), clock part: registers, PHASE and SERVO. docs/macro_ic.md, servo-ic:6.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>

namespace brick::component {

class MacroIc final : public Component {
 public:
  MacroIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // 64 words X and 64 Y of 24 bits, in the low bits of 4 bytes: X of offset n at 8 n + 4, Y at 8 n (servo-ic:6.2).
  tlm_utils::simple_target_socket_optional<MacroIc> registers;

  In<> rst_n;             // reset, asynchronous, idle 1; outputs follow with the next edge
  In<> gate;              // 0 DSPGATE2, 1 MACROGATE, which has no servo clock of its own (servo-ic:6.1)
  In<> phase_i, servo_i;  // clock net, idle 1 (servo-ic:5.1)
  Out<> phase_o, phase_oe, servo_o, servo_oe;  // what it drives onto them, high while it does not; that it does

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
