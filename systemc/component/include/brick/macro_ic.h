// MACRO IC (DSPGATE2 or MACROGATE), clock part: registers, PHASE and SERVO. docs/macro_ic.md, servo-ic:6.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/macro_ic.h>

namespace brick::component {

class MacroIc final : public Component, public MacroIcPins {
 public:
  MacroIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // 64 words X and 64 Y of 24 bits, in the low bits of 4 bytes: X of offset n at 8 n + 4, Y at 8 n (servo-ic:6.2).
  tlm_utils::simple_target_socket_optional<MacroIc> registers;

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
