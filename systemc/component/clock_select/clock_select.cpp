#include <brick/clock_select.h>

#include "systemc/component/chip.h"

namespace brick::component {

ClockSelect::ClockSelect(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table()), ClockSelectPins(*this, "") {
  set_chip(engine.factory().clock_select());
}

}  // namespace brick::component
