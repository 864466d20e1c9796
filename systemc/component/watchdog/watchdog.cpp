#include <brick/watchdog.h>

#include "systemc/component/chip.h"

namespace brick::component {

Watchdog::Watchdog(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, 4}}), WatchdogPins(*this, ""), registers("registers") {
  registers.register_b_transport(this, &Watchdog::transport);
  registers.register_transport_dbg(this, &Watchdog::debug);
  set_chip(engine.factory().watchdog());
}

}  // namespace brick::component
