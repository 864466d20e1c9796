#include <brick/interrupt_controller.h>

#include "systemc/component/chip.h"

namespace brick::component {

InterruptController::InterruptController(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{1, 4}}), InterruptControllerPins(*this, ""), registers("registers") {
  registers.register_b_transport(this, &InterruptController::transport);
  registers.register_transport_dbg(this, &InterruptController::debug);
  set_chip(engine.factory().interrupt_controller());
}

}  // namespace brick::component
