// Dual-ported RAM with BUSY: 32768 words of 16 bits between the host and the CPU. docs/dpram.md, host-bus:6.9.
#pragma once

#include <cstdint>

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/dpram.h>

namespace brick::component {

struct DpramOptions {
  std::uint64_t seed = 0;  // of what the RAM holds at power-on; 0 and 1: zero
};

// Both sockets have the byte offsets of the host's window (host-bus:6.1): the Y word of PMAC address $060000 + k at 4
// k, its X word at 4 k + 2, the low byte of a word first. Two accesses of one word, at least one a write: the later one
// waits for the end of the other (BUSY). Beyond the fitted size words read 0 and take no write. A reset keeps the
// content. Debug transport reads the content, as many bytes as are asked for and there.
class Dpram final : public Component, public DpramPins {
 public:
  Dpram(const sc_core::sc_module_name& name, TimeBase& time, const DpramOptions& options = {},
        const Engine& engine = model_engine());

  // Bytes, at any address and in any number: each word that they touch is a cycle with its byte lanes, on clk_ref, two
  // edges for a read and three for a write, and BUSY on top. Byte enables leave bytes, and words, out.
  tlm_utils::simple_target_socket_optional<Dpram> host;
  // One word of 16 bits an access, on clk_pwm: six edges for a read and five for a write, and BUSY (/TA) on top.
  tlm_utils::simple_target_socket_optional<Dpram> cpu;

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
