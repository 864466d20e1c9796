// Clock selection: the PHASE and SERVO nets of up to 22 ICs, or of clocks from outside. docs/clock_select.md,
// servo-ic:7.
#pragma once

#include <array>

#include <brick/component.h>
#include <brick/pins/clock_select.h>

namespace brick::component {

class ClockSelect final : public Component, public ClockSelectPins {
 public:
  static constexpr std::size_t kIcs = 22;  // servo IC 0..9, 2*..9* (10..17), MACRO IC 0..3 (18..21)

  ClockSelect(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
