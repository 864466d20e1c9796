// The TLM-2.0 face of the host-side blocks: a talk from host to CPU and back through sockets, exact delays, error
// responses.
#include <gtest/gtest.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/register_access.h"
#include "systemc/host/dpram.h"
#include "systemc/host/host_port.h"
#include "systemc/host/host_signals.h"
#include "systemc/host/interrupt_controller.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

// Calls the target as a bound initiator would; without elaboration, so that many tests fit into one process.
template <class Value, class Socket>
tlm::tlm_response_status transport(Socket& socket, tlm::tlm_command command, std::uint64_t address, Value& value,
                                   sc_core::sc_time& delay) {
  tlm::tlm_generic_payload payload;
  payload.set_command(command);
  payload.set_address(address);
  payload.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
  payload.set_data_length(sizeof value);
  payload.set_streaming_width(sizeof value);
  auto* target = dynamic_cast<tlm::tlm_fw_transport_if<>*>(socket.get_base_export().get_interface());
  target->b_transport(payload, delay);
  return payload.get_response_status();
}

template <class Value, class Socket>
Value read(Socket& socket, std::uint64_t address) {
  Value value{};
  sc_core::sc_time delay;
  EXPECT_EQ(transport(socket, tlm::TLM_READ_COMMAND, address, value, delay), tlm::TLM_OK_RESPONSE);
  return value;
}

template <class Value, class Socket>
void write(Socket& socket, std::uint64_t address, Value value) {
  sc_core::sc_time delay;
  EXPECT_EQ(transport(socket, tlm::TLM_WRITE_COMMAND, address, value, delay), tlm::TLM_OK_RESPONSE);
}

constexpr std::uint64_t cpu_byte(const regs::Register& reg) { return 8ull * (reg.address - regs::hi08::kBase) + 4; }

TEST(TlmSockets, CharacterTravelsThroughTheHostPort) {
  BRICK_COVERS("CARD-1");
  HostPort port("host_port");
  port.reset(0);
  write<std::uint8_t>(port.host_socket, 7, '?');
  EXPECT_EQ(read<std::uint32_t>(port.cpu_socket, cpu_byte(regs::hi08::kHsr)) & 1, 0u) << "still in TX at the next edge";
  EXPECT_EQ(read<std::uint32_t>(port.cpu_socket, cpu_byte(regs::hi08::kHsr)) & 1, 1u);
  EXPECT_EQ(read<std::uint32_t>(port.cpu_socket, cpu_byte(regs::hi08::kHorx)), unsigned{'?'});
  write<std::uint32_t>(port.cpu_socket, cpu_byte(regs::hi08::kHotx), 0x06);
  read<std::uint8_t>(port.host_socket, 2);
  EXPECT_EQ(read<std::uint8_t>(port.host_socket, 2) & 1, 1) << "RXDF";
  EXPECT_EQ(read<std::uint8_t>(port.host_socket, 7), 0x06);
  EXPECT_EQ(read<std::uint8_t>(port.host_socket, 2) & 1, 0);
}

TEST(TlmSockets, AccessEndsAtTheNextReferenceEdge) {
  InterruptController pic("pic");
  pic.reset(0);
  std::uint8_t value = 0x02;
  sc_core::sc_time delay(100, sc_core::SC_NS);  // tick 11 has passed; the next clk_ref edge is tick 12, 101.725 ns
  ASSERT_EQ(transport(pic.socket, tlm::TLM_WRITE_COMMAND, 2, value, delay), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(pic.msk(), 0x02);
  EXPECT_EQ(pic.now(), 12);
  EXPECT_EQ(delay, sc_core::sc_time(12 * 78125.0 / 9216, sc_core::SC_NS));
}

TEST(TlmSockets, HostSignalsAndMemoryHoldWhatIsWritten) {
  HostSignals signals("signals");
  signals.reset(0);
  write<std::uint32_t>(signals.socket, 0, 0xFFFFF2);
  EXPECT_TRUE(signals.breq());
  EXPECT_FALSE(signals.ipos());
  EXPECT_EQ(read<std::uint32_t>(signals.socket, 0), 2u);
  Dpram dpram("dpram");
  dpram.in.small = true;
  dpram.reset(0);
  write<std::uint16_t>(dpram.socket, 16382, 0xBEEF);
  EXPECT_EQ(read<std::uint16_t>(dpram.socket, 16382), 0xBEEF);
}

TEST(TlmSockets, BadPayloadsGetErrorResponses) {
  HostPort port("host_port");
  InterruptController pic("pic");
  Dpram dpram("dpram");
  dpram.in.small = true;
  sc_core::sc_time delay;
  std::uint8_t byte = 0;
  std::uint16_t half = 0;
  std::uint32_t word = 0;
  EXPECT_EQ(transport(port.host_socket, tlm::TLM_READ_COMMAND, 8, byte, delay), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(transport(port.host_socket, tlm::TLM_READ_COMMAND, 0, half, delay), tlm::TLM_BURST_ERROR_RESPONSE);
  EXPECT_EQ(transport(port.cpu_socket, tlm::TLM_WRITE_COMMAND, 48, word, delay), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(transport(pic.socket, tlm::TLM_IGNORE_COMMAND, 0, byte, delay), tlm::TLM_COMMAND_ERROR_RESPONSE);
  EXPECT_EQ(transport(dpram.socket, tlm::TLM_READ_COMMAND, 1, half, delay), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(transport(dpram.socket, tlm::TLM_READ_COMMAND, 16384, half, delay), tlm::TLM_ADDRESS_ERROR_RESPONSE);
}

}  // namespace
}  // namespace brick
