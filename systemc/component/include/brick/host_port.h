// Host port (HI08): eight bytes for the host, six words for the CPU, a word of buffering on either side of each way.
// docs/host_port.md, host-bus:3.2.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/host_port.h>

namespace brick::component {

class HostPort final : public Component, public HostPortPins {
 public:
  HostPort(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // The host's bytes 0..7 (host-bus:3.1). A read takes its byte with one edge of clk_ref and ends with the next, which
  // frees RX if it is that of byte 7 and found a word there.
  tlm_utils::simple_target_socket_optional<HostPort> host;
  // The CPU's words X:$FFFFC2..X:$FFFFC7 (host-bus:3.2): word n at byte 4 n, 24 bits in the low bits of 4 bytes.
  tlm_utils::simple_target_socket_optional<HostPort> cpu;

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
