#include <brick/host_signals.h>

#include "systemc/component/chip.h"
#include "systemc/component/host_signals/host_signals_registers.h"

namespace brick::component {

HostSignals::HostSignals(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, host_signals_words::kRegisterBytes}}),
      HostSignalsPins(*this, ""),
      registers("registers") {
  registers.register_b_transport(this, &HostSignals::transport);
  registers.register_transport_dbg(this, &HostSignals::debug);
  set_chip(engine.factory().host_signals());
}

}  // namespace brick::component
