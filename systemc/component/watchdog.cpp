#include <brick/watchdog.h>

#include "systemc/component/chip.h"
#include "systemc/component/watchdog_words.h"

namespace brick::component {

const std::vector<PinInfo>& Watchdog::pin_table() {
  using namespace watchdog_words;
  static const std::vector<PinInfo> table{
      {"rst_n", PinDirection::kIn, 0, kRstN, 1, 1, "servo-ic:10", "reset, asynchronous, active low"},
      {"servo", PinDirection::kIn, 0, kServo, 1, 1, "servo-ic:10", "SERVO net"},
      {"pwr_good", PinDirection::kIn, 0, kPwrGood, 1, 1, "servo-ic:10", "the 5 V supply is good"},
      {"trip", PinDirection::kOut, 0, kTrip, 1, 0, "servo-ic:10", "tripped, until a reset"},
      {"relay", PinDirection::kOut, 0, kRelay, 1, 0, "servo-ic:10", "1 = energised: from reset to trip"}};
  return table;
}

Watchdog::Watchdog(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, 4}}),
      registers("registers"),
      rst_n(*this, "rst_n"),
      servo(*this, "servo"),
      pwr_good(*this, "pwr_good"),
      trip(*this, "trip"),
      relay(*this, "relay") {
  registers.register_b_transport(this, &Watchdog::transport);
  registers.register_transport_dbg(this, &Watchdog::debug);
  set_chip(engine.factory().watchdog());
}

}  // namespace brick::component
