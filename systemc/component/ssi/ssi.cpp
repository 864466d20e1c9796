#include <brick/ssi.h>

#include "systemc/component/chip.h"

namespace brick::component {

constexpr unsigned kAddresses = 64 * 8;  // bytes of all registers

Ssi::Ssi(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, kAddresses}}), SsiPins(*this, ""), registers("registers") {
  registers.register_b_transport(this, &Ssi::transport);
  registers.register_transport_dbg(this, &Ssi::debug);
  set_chip(engine.factory().ssi());
}

}  // namespace brick::component
