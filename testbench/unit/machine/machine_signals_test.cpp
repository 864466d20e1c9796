// The named signals that users and waveforms rely on (docs/signals.md): they exist, with the right width and radix, and
// follow pins, host cycles and the nesting of tasks.
#include "systemc/machine/machine_signals.h"

#include <gtest/gtest.h>

#include "systemc/cpu/cpu.h"
#include "systemc/cpu/port_a.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

class NamedSignals : public ::testing::Test {
 protected:
  std::uint64_t value(const char* name) const {
    const auto id = signals.find(name);
    EXPECT_TRUE(id) << name;
    return id ? signals.value(*id) : ~0ull;
  }
  Signals signals;
  MachineSignals machine{signals};
};

TEST_F(NamedSignals, AreAllThereWithWidthAndRadix) {
  BRICK_COVERS("CARD-6");
  PortA port_a(sc_core::sc_gen_unique_name("port_a"), signals);
  const struct {
    const char* name;
    unsigned width;
    Radix radix;
  } contract[] = {
      {"clock.phase", 1, Radix::kBinary},
      {"clock.servo", 1, Radix::kBinary},
      {"clock.source", 13, Radix::kDecimal},
      {"host.breq", 1, Radix::kBinary},
      {"host.irq", 1, Radix::kBinary},
      {"host.ipos", 1, Radix::kBinary},
      {"host.eror", 1, Radix::kBinary},
      {"host.f1er", 1, Radix::kBinary},
      {"host.hreq", 1, Radix::kBinary},
      {"host.wdo", 1, Radix::kBinary},
      {"host.brld_n", 1, Radix::kBinary},
      {"host.erld_n", 1, Radix::kBinary},
      {"host.f1ld_n", 1, Radix::kBinary},
      {"host.ipld_n", 1, Radix::kBinary},
      {"host.ctrl0", 1, Radix::kBinary},
      {"host.ctrl1", 1, Radix::kBinary},
      {"host.jpan", 16, Radix::kHex},
      {"host.init_n", 1, Radix::kBinary},
      {"host.mi1", 1, Radix::kBinary},
      {"host.mi2", 1, Radix::kBinary},
      {"host.axexp0", 1, Radix::kBinary},
      {"host.axexp1", 1, Radix::kBinary},
      {"host.isa.la", 7, Radix::kHex},
      {"host.isa.sa", 20, Radix::kHex},
      {"host.isa.sbhe_n", 1, Radix::kBinary},
      {"host.isa.sd", 16, Radix::kHex},
      {"host.isa.ior_n", 1, Radix::kBinary},
      {"host.isa.iow_n", 1, Radix::kBinary},
      {"host.isa.memr_n", 1, Radix::kBinary},
      {"host.isa.memw_n", 1, Radix::kBinary},
      {"host.isa.iochrdy", 1, Radix::kBinary},
      {"host.isa.aen", 1, Radix::kBinary},
      {"host.isa.resetdrv", 1, Radix::kBinary},
      {"host.pic.ist", 8, Radix::kHex},
      {"host.pic.sig", 8, Radix::kHex},
      {"host.pic.msk", 8, Radix::kHex},
      {"host.pic.elr", 8, Radix::kHex},
      {"dpram.busy_host", 1, Radix::kBinary},
      {"dpram.busy_cpu", 1, Radix::kBinary},
      {"bus.addr", 19, Radix::kHex},
      {"bus.data", 24, Radix::kHex},
      {"bus.aa", 4, Radix::kBinary},
      {"bus.rd_n", 1, Radix::kBinary},
      {"bus.wr_n", 1, Radix::kBinary},
      {"bus.ta_n", 1, Radix::kBinary},
      {"cpu.pc", 32, Radix::kHex},
      {"cpu.task", 2, Radix::kDecimal},
      {"cpu.symbol", 1, Radix::kText},
      {"brick.watchdog.tripped", 1, Radix::kBinary},
  };
  for (const auto& c : contract) {
    const auto id = signals.find(c.name);
    ASSERT_TRUE(id) << c.name;
    EXPECT_EQ(signals.info(*id).width, c.width) << c.name;
    EXPECT_EQ(signals.info(*id).radix, c.radix) << c.name;
  }
}

TEST_F(NamedSignals, EveryPinOfTheBoardHasItsOwn) {
  for (const PinField& f : pin::kAll) {
    BoardOutputs low, high;
    high.set(f, ~0u);
    machine.outputs(0, high, low);
    machine.outputs(1, low, high);
    for (const PinField& other : pin::kAll)
      EXPECT_EQ(value(std::string(other.name).c_str()), &other == &f ? high.get(f) : 0u)
          << f.name << " sets " << other.name;
    machine.outputs(2, high, low);
  }
}

// servo-ic:7.1: I7m07 of servo IC m, I7m57 of IC m*, I6807 and on in steps of 50 for MACRO ICs.
TEST_F(NamedSignals, ClockSourceIsTheNumberOfTheDirectionVariable) {
  const struct {
    unsigned source, variable;
  } cases[] = {{0, 7007},  {1, 7107},  {9, 7907},  {10, 7257}, {11, 7357}, {17, 7957},
               {18, 6807}, {19, 6857}, {20, 6907}, {21, 6957}, {30, 0},    {31, 0}};
  for (const auto& c : cases) {
    BoardOutputs before, after;
    before.set(pin::kPhaseSource, 29);
    after.set(pin::kPhaseSource, c.source);
    machine.outputs(0, before, after);
    EXPECT_EQ(value("clock.source"), c.variable) << c.source;
  }
}

TEST_F(NamedSignals, HostBusShowsTheCommandsAndWhoeverDrivesTheData) {
  BoardInputs in;
  BoardOutputs board;
  board.set(pin::kIsaSd, 0xB0AD);
  board.set(pin::kIsaSdOe, 3);
  in.isa_sa = 0xD1050;
  in.isa_sd = 0x4057;
  const struct {
    const char* name;
    bool BoardInputs::*pin;
    unsigned data;
  } commands[] = {{"host.isa.ior_n", &BoardInputs::isa_ior_n, 0xB0AD},
                  {"host.isa.iow_n", &BoardInputs::isa_iow_n, 0x4057},
                  {"host.isa.memr_n", &BoardInputs::isa_memr_n, 0xB0AD},
                  {"host.isa.memw_n", &BoardInputs::isa_memw_n, 0x4057}};
  for (const auto& c : commands) {
    in.*c.pin = false;
    machine.inputs(0, in, board);
    for (const auto& other : commands)
      EXPECT_EQ(value(other.name), &other == &c ? 0u : 1u) << c.name << " moves " << other.name;
    EXPECT_EQ(value("host.isa.sd"), c.data) << c.name;
    in.*c.pin = true;
  }
  in.isa_aen = in.isa_resetdrv = true;
  in.isa_sbhe_n = false;
  in.set_address(0xFD1050);
  machine.inputs(0, in, board);
  EXPECT_EQ(value("host.isa.aen"), 1u);
  EXPECT_EQ(value("host.isa.resetdrv"), 1u);
  EXPECT_EQ(value("host.isa.sbhe_n"), 0u);
  EXPECT_EQ(value("host.isa.sa"), 0xD1050u);
  EXPECT_EQ(value("host.isa.la"), 0x7Eu) << "A23..A17";
}

// host-bus:3.8/1: a lane that nobody drives reads as ones, whatever the board has in its register.
TEST_F(NamedSignals, DataLanesThatTheBoardDoesNotDriveArePulledUpInARead) {
  BoardInputs in;
  in.isa_memr_n = false;
  machine.inputs(0, in, {});
  for (const auto& [lanes, data] : {std::pair{0u, 0xFFFFu}, {1u, 0xFFADu}, {2u, 0xB0FFu}, {3u, 0xB0ADu}}) {
    BoardOutputs board;
    machine.outputs(0, board, board);
    board.set(pin::kIsaSd, 0xB0AD);
    machine.outputs(1, {}, board);
    BoardOutputs drives = board;
    drives.set(pin::kIsaSdOe, lanes);
    machine.outputs(2, board, drives);
    EXPECT_EQ(value("host.isa.sd"), data) << lanes;
    machine.outputs(3, drives, {});
  }
}

// 0 background, 1 real-time, 2 servo, 3 phase; a handler that is interrupted comes back.
TEST_F(NamedSignals, TaskFollowsTheNestingOfInterrupts) {
  constexpr std::uint32_t kInterrupt = 0x8000'0000;
  machine.trap(0, kInterrupt | kIrqRealTime);
  EXPECT_EQ(value("cpu.task"), 1u);
  machine.trap(1, kInterrupt | kIrqServo);
  EXPECT_EQ(value("cpu.task"), 2u);
  machine.trap(2, kInterrupt | kIrqPhase);
  EXPECT_EQ(value("cpu.task"), 3u);
  machine.trap_return(3);
  EXPECT_EQ(value("cpu.task"), 2u);
  machine.trap_return(4);
  EXPECT_EQ(value("cpu.task"), 1u);
  machine.trap_return(5);
  EXPECT_EQ(value("cpu.task"), 0u);
  machine.trap(6, kInterrupt | kIrqPhase);
  machine.restart(7);
  EXPECT_EQ(value("cpu.task"), 0u) << "after a reset";
}

}  // namespace
}  // namespace brick
