// A communications processor on a machine of pins, with a scripted controller behind its host port.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "testbench/host/communications_processor.h"
#include "testbench/unit/host_library/fake_machine.h"

namespace brick {

constexpr Tick kMs = ns_to_ticks(1'000'000);

class CommunicationsProcessorTest : public ::testing::Test {
 protected:
  using Packet = EthernetPacket;
  using Bytes = std::string;
  using Lines = std::vector<Bytes>;
  using Replies = std::vector<std::pair<unsigned, Bytes>>;

  CommunicationsProcessorTest() {
    fake().control = [](char c) {
      return c == 0x18 ? Bytes("\x18") : c == 0x02 || c == 0x07 ? Bytes("000000000800\r\x06") : "";
    };
    fake().controller = [this](const Bytes& line) { return controller(line); };
    make({});
  }

  void make(const CommunicationsProcessor::Options& options) {
    processor_ = std::make_unique<CommunicationsProcessor>(bus_, options);
    processor_->on_reply = [this](CommunicationsProcessor::Client client, const Bytes& reply) {
      replies_.emplace_back(static_cast<unsigned>(client), reply);
    };
    ASSERT_TRUE(processor_->start(100 * kMs));
    lines_.clear();
  }

  Bytes controller(const Bytes& line) {
    lines_.push_back(line);
    if (line == "I63=0") fake().control = nullptr;
    if (line == "silent") return "";
    if (line == "bad")
      return "\x07"
             "ERR003\r";
    if (line == "long") return Bytes(3000, 'x') + "\r\x06";
    if (line.empty() || line[0] == '=') return "\x06";
    return line + "\r\x06";
  }

  static FakeMachine& fake() { return FakeMachine::last(); }

  static Packet packet(unsigned request, const Bytes& data = "", unsigned value = 0, unsigned index = 0,
                       unsigned type = 0x40, unsigned length = 0) {
    return {static_cast<std::uint8_t>(type),
            static_cast<std::uint8_t>(request),
            static_cast<std::uint16_t>(value),
            static_cast<std::uint16_t>(index),
            static_cast<std::uint16_t>(data.empty() ? length : data.size()),
            data};
  }

  void request(unsigned client, const Packet& one) { processor_->request(client, one); }
  void run(Tick time = kMs) { processor_->run_until(bus_.now() + time); }

  Replies take() { return std::exchange(replies_, {}); }

  // Of client 1, within `longest`.
  Bytes ask(const Packet& one, Tick longest = 20'000 * kMs) {
    request(1, one);
    for (const Tick end = bus_.now() + longest; replies_.empty() && bus_.now() < end;) run(step_);
    const Replies found = take();
    EXPECT_EQ(found.size(), 1u);
    return found.empty() ? "nothing" : found[0].second;
  }
  Bytes response(const Bytes& line) { return ask(packet(Packet::kGetResponse, line)); }
  Bytes fetch() { return ask(packet(Packet::kGetBuffer, "", 0, 0, 0xC0)); }
  Bytes ready() { return ask(packet(Packet::kReadReady, "", 0, 0, 0xC0, 2)); }

  static int memory_writes() {  // cycles of the bus since `changes` was cleared
    int writes = 0;
    for (const auto& change : fake().changes) writes += !change.after.isa_memw_n && change.before.isa_memw_n ? 1 : 0;
    return writes;
  }

  inline static const Bytes kNul{std::string(1, '\0')};

  Machine machine_{sc_core::sc_gen_unique_name("machine"), MachineConfig{}};
  HostBus bus_{machine_};
  std::unique_ptr<CommunicationsProcessor> processor_;
  Replies replies_;
  Tick step_ = kMs;  // of ask()
  std::vector<Bytes> lines_;
};

}  // namespace brick
