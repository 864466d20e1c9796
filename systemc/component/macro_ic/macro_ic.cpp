#include <brick/macro_ic.h>

#include "systemc/component/chip.h"

namespace brick::component {

constexpr unsigned kAddresses = 64 * 8;  // bytes of all registers

MacroIc::MacroIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, kAddresses}}), MacroIcPins(*this, ""), registers("registers") {
  registers.register_b_transport(this, &MacroIc::transport);
  registers.register_transport_dbg(this, &MacroIc::debug);
  set_chip(engine.factory().macro_ic());
}

}  // namespace brick::component
