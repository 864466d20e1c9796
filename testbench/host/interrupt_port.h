// The host port by its request line HREQ: characters go and come when the board asks for them, and while it does not
// the bus stands still.
#pragma once

#include <cstdint>
#include <functional>

#include "testbench/host/host_bus.h"

namespace brick {

class InterruptPort {
 public:
  explicit InterruptPort(HostBus& bus) : bus_(bus) {}

  void open();                // at power-on, and whenever somebody else has written to the port
  void send(std::uint8_t c);  // once it can be: `idle` until then
  bool idle() const { return !sending_; }

  // To the next character that came or went, or to tick `limit`; false when there was none.
  bool run_until(Tick limit);
  std::function<void(std::uint8_t)> on_character;

 private:
  void request(bool transmit);

  HostBus& bus_;
  bool sending_ = false, requests_transmit_ = false;
  std::uint8_t character_ = 0;
};

}  // namespace brick
