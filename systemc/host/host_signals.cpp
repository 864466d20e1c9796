#include "systemc/host/host_signals.h"

#include "systemc/core/register_access.h"

namespace brick {

HostSignals::HostSignals(const sc_core::sc_module_name& name) : sc_module(name), socket("socket") {
  socket.register_b_transport(this, &HostSignals::b_transport);
}

void HostSignals::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  if (!check_payload(payload, 4, 4)) return;
  const Tick edge = catch_up(*this, now(), delay);
  if (payload.is_read()) {
    set_payload_value(payload, std::uint32_t{latch_});
  } else {
    in = {true, false, static_cast<std::uint8_t>(payload_value<std::uint32_t>(payload) & 0xF)};
    advance(edge);
    in = {};
  }
  delay = delay_until(edge);
}

}  // namespace brick
