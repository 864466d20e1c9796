// Interrupt controller of the host bus: eight lines, one interrupt. docs/interrupt_controller.md, host-bus:4.
#pragma once

#include <array>

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/interrupt_controller.h>

namespace brick::component {

class InterruptController final : public Component, public InterruptControllerPins {
 public:
  InterruptController(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // Four bytes (host-bus:4.1): 0 status, a write clears; 1 signal; 2 mask, 1 = enabled; 3 edge (0) or level (1).
  tlm_utils::simple_target_socket_optional<InterruptController> registers;

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
