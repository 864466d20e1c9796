// A process that plays a list of accesses at a socket, each some time after the end of the one before, and records when
// they end and what they read.
#pragma once

#include <vector>

#include <gtest/gtest.h>
#include <tlm_utils/simple_initiator_socket.h>

#include "testbench/unit/component/traffic.h"

namespace brick::component {

class Player : public sc_core::sc_module {
 public:
  using Socket = tlm_utils::simple_initiator_socket_optional<Player>;

  Player(const sc_core::sc_module_name& name, const std::vector<Access>& accesses, unsigned width,
         const sc_core::sc_time& quantum, std::vector<Answer>& answers, std::size_t& annotated)
      : sc_module(name),
        accesses_(accesses),
        width_(width),
        quantum_(quantum),
        answers_(answers),
        annotated_(annotated) {
    SC_HAS_PROCESS(Player);
    SC_THREAD(play);
  }
  Socket socket{"socket"};

 private:
  void play() {
    sc_core::sc_time local;
    for (const Access& access : accesses_) {
      local += sc_core::sc_time::from_value(access.idle);
      if (local > quantum_) {
        wait(local);
        local = sc_core::SC_ZERO_TIME;
      }
      unsigned char data[4], enables[4];
      for (unsigned i = 0; i < 4; ++i) {
        data[i] = static_cast<unsigned char>(access.value >> 8 * i);
        enables[i] = (access.enables >> i & 1) != 0 ? TLM_BYTE_ENABLED : TLM_BYTE_DISABLED;
      }
      const unsigned length = access.length == 0 ? width_ : access.length;
      tlm::tlm_generic_payload payload;
      payload.set_command(access.write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
      payload.set_address(access.address);
      payload.set_data_ptr(data);
      payload.set_data_length(length);
      payload.set_streaming_width(length);
      if (access.enables != 0xFF) {
        payload.set_byte_enable_ptr(enables);
        payload.set_byte_enable_length(length);
      }
      if (local != sc_core::SC_ZERO_TIME) ++annotated_;
      socket->b_transport(payload, local);
      if (!payload.is_response_ok()) SC_REPORT_ERROR("/test/response", payload.get_response_string().c_str());
      std::uint32_t value = 0;
      for (unsigned i = 0; i < length; ++i) value |= static_cast<std::uint32_t>(data[i]) << 8 * i;
      answers_.emplace_back((sc_core::sc_time_stamp() + local).value(), value);
    }
  }

  const std::vector<Access>& accesses_;
  unsigned width_;
  sc_core::sc_time quantum_;
  std::vector<Answer>& answers_;
  std::size_t& annotated_;
};

}  // namespace brick::component
