// The ASCII port in the dual-ported RAM beside the host port, on the bus (host-bus:6.6).
#include <random>

#include "rtl/regs/dpram_map.h"
#include "testbench/host/dpram_port.h"
#include "testbench/unit/random_seed.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr unsigned kCompareLine = 5;  // EQU1 in IST and SIG, host-bus:4.2

class DpramAsciiOn : public Controller {
 protected:
  void open(const MachineConfig& config = {}) {
    start(config);
    ASSERT_EQ(ask("I58=1"), "");
    wait(ms_to_ticks(3));  // a pass of the background
    ram_ = std::make_unique<BusDpram>(bus());
    port_ = std::make_unique<DpramPort>(*ram_);
  }
  DpramPort& port() { return *port_; }
  std::string ask_ram(const std::string& line) {
    const Reply reply = port().command(line);
    EXPECT_TRUE(reply.complete) << "no complete answer to " << line;
    std::string joined;
    for (const auto& part : reply.lines) joined += (joined.empty() ? "" : "|") + part;
    return joined;
  }

 private:
  std::unique_ptr<BusDpram> ram_;
  std::unique_ptr<DpramPort> port_;
};

// Both ports have a line under way at random distances; each gets its own answer from its own addresses.
TEST_P(DpramAsciiOn, BothPortsAtOnce) {
  ASSERT_NO_FATAL_FAILURE(open());
  std::mt19937 random(random_seed(3));
  ASSERT_EQ(ask("&1#1"), "");
  ASSERT_EQ(ask_ram("&5#9"), "");
  const int rounds = GetParam() == Engine::kSystemC ? 60 : 12;
  for (int i = 1; i <= rounds; ++i) {
    const std::string n = std::to_string(i);
    wait(static_cast<Tick>(random() % 100'000));
    ASSERT_TRUE(link().send("P1=" + n + " P1&#"));
    wait(static_cast<Tick>(random() % 10'000));
    const std::string text = "P2=" + n + " P2&#" + std::string(random() % 230, ' ');
    ASSERT_TRUE(port().send(text));
    wait(static_cast<Tick>(random() % 10'000));
    EXPECT_THAT(link().finish().lines, ::testing::ElementsAre(n, "1", "1"));
    EXPECT_THAT(port().finish().lines, ::testing::ElementsAre(n, "5", "9")) << text;
  }
  EXPECT_EQ(ask_ram("UUU"), "ERR003");
  EXPECT_EQ(ask("P1 P2"), std::to_string(rounds) + "|" + std::to_string(rounds));
}

// A host that has left an answer of 1,000 lines where it is.
TEST_P(DpramAsciiOn, AnAnswerThatNobodyReadsDelaysNoOtherCommand) {
  ASSERT_NO_FATAL_FAILURE(open());
  const auto time = [this] {
    const Tick from = machine().now();
    for (int i = 0; i < 5; ++i) EXPECT_EQ(ask("P3=3 P3"), "3");
    return (machine().now() - from) / 5;
  };
  wait(ms_to_ticks(5));  // the port is idle
  const Tick before = time();
  ASSERT_TRUE(port().send("P1000..1999"));
  wait(ms_to_ticks(50));
  const Tick meanwhile = time();
  EXPECT_LT(meanwhile, before + ns_to_ticks(50'000)) << before << " ticks before";
  const Reply reply = port().finish();
  EXPECT_TRUE(reply.complete);
  EXPECT_EQ(reply.lines.size(), 1000u);
}

TEST_P(DpramAsciiOn, I56InterruptsByEqu1OncePerLine) {
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_EQ(ask("I56=1"), "");
  bus().write_pic_edge_level(0);
  bus().clear_pic();
  bus().write_pic_mask(1u << kCompareLine);
  ASSERT_TRUE(port().send("P1=1 P1 P1"));
  std::string codes;
  for (int line = 0; line < 3; ++line) {
    ASSERT_TRUE(bus().wait_pin(pin::kIsaIrq, 1, ms_to_ticks(10))) << line;
    EXPECT_EQ(bus().read_pic_status(), 1u << kCompareLine);
    bus().clear_pic();
    wait(ms_to_ticks(2));
    EXPECT_EQ(bus().read_pic_signals() >> kCompareLine & 1, 1) << "high until the line is released";
    EXPECT_EQ(bus().irq(), false) << "and no second edge";
    const auto response = port().take(0);
    ASSERT_TRUE(response);
    codes += std::to_string(response->code) + " ";
  }
  EXPECT_EQ(codes, "13 13 6 ");
  wait(ms_to_ticks(3));
  EXPECT_EQ(bus().read_pic_signals() >> kCompareLine & 1, 0);
}

// What the RAM holds at power-on is random by the seed, and nothing of it is a command.
TEST_P(DpramAsciiOn, WhatTheRamHeldBeforeIsNoCommand) {
  MachineConfig config;
  config.seed = 12;
  ASSERT_NO_FATAL_FAILURE(open(config));
  EXPECT_FALSE(port().look());
  EXPECT_EQ(ask_ram("P1..5"), "0|0|0|0|0");
}

BRICK_ON_ENGINES(DpramAsciiOn, Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
