// A process of a test with a socket, and what a program does with a register.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include <gtest/gtest.h>
#include <tlm_utils/simple_initiator_socket.h>

namespace brick::component {

constexpr auto kRead = tlm::TLM_READ_COMMAND;
constexpr auto kWrite = tlm::TLM_WRITE_COMMAND;

// A process of the test with a socket.
class Initiator : public sc_core::sc_module {
 public:
  Initiator(const sc_core::sc_module_name& name, std::function<void(Initiator&)> program)
      : sc_module(name), program_(std::move(program)) {
    SC_HAS_PROCESS(Initiator);
    SC_THREAD(run);
  }
  tlm_utils::simple_initiator_socket<Initiator> socket{"socket"};
  bool ended = false;

  std::uint32_t data = 0;
  using Payload = std::unique_ptr<tlm::tlm_generic_payload>;
  Payload payload(tlm::tlm_command command, std::uint64_t address, unsigned length = 4) {
    auto p = std::make_unique<tlm::tlm_generic_payload>();
    p->set_command(command);
    p->set_address(address);
    p->set_data_ptr(reinterpret_cast<unsigned char*>(&data));
    p->set_data_length(length);
    p->set_streaming_width(length);
    return p;
  }
  tlm::tlm_response_status send(const Payload& p, sc_core::sc_time& delay) {
    socket->b_transport(*p, delay);
    return p->get_response_status();
  }
  tlm::tlm_response_status send(const Payload& p) {
    sc_core::sc_time none;
    return send(p, none);
  }

  // A register of 4 bytes, as a program uses it.
  std::uint32_t read(std::uint64_t address) {
    EXPECT_EQ(send(payload(tlm::TLM_READ_COMMAND, address)), tlm::TLM_OK_RESPONSE);
    return data;
  }
  void write(std::uint64_t address, std::uint32_t value) {
    data = value;
    EXPECT_EQ(send(payload(tlm::TLM_WRITE_COMMAND, address)), tlm::TLM_OK_RESPONSE);
  }
  std::uint32_t debug_read(std::uint64_t address) {
    EXPECT_EQ(socket->transport_dbg(*payload(tlm::TLM_READ_COMMAND, address)), 4u);
    return data;
  }

 private:
  void run() {
    program_(*this);
    ended = true;
  }
  std::function<void(Initiator&)> program_;
};

}  // namespace brick::component
