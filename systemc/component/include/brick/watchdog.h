// Hardware watchdog: trips without a strobe, without SERVO, or without 5 V. docs/watchdog.md, servo-ic:10.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/watchdog.h>

namespace brick::component {

class Watchdog final : public Component, public WatchdogPins {
 public:
  Watchdog(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // One word of 4 bytes (X:$070011): each write is a strobe, whatever is written; reads 0.
  tlm_utils::simple_target_socket_optional<Watchdog> registers;

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
