// What the host reaches over its bus, and how it spends its time: registers and memory behind a window, its pages and a
// PCI bridge (host-bus:3.1, host-bus:3.6, host-bus:3.7), the host port with its time-outs, the interrupt controllers,
// and the heartbeat of whoever watches the run.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <fmt/format.h>

#include "testbench/host/dpram_port.h"
#include "testbench/host/host_bus.h"
#include "testbench/host/interrupt_port.h"
#include "testbench/unit/host_library/fake_machine.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

class HostAccessTest : public ::testing::Test {
 protected:
  static constexpr Tick kAccessMs = ns_to_ticks(1'000'000);

  // The cycles since the last call, by command and address; writes with their data.
  Lines take_cycles() {
    Lines cycles;
    for (const auto& [seen, before, after] : fake.changes) {
      if (before.isa_ior_n && !after.isa_ior_n) cycles.push_back(fmt::format("in {:X}", after.isa_sa));
      if (before.isa_iow_n && !after.isa_iow_n)
        cycles.push_back(fmt::format("out {:X} {:02X}", after.isa_sa, after.isa_sd & 0xFF));
      if (before.isa_memr_n && !after.isa_memr_n) cycles.push_back(fmt::format("read {:X}", after.isa_sa));
      if (before.isa_memw_n && !after.isa_memw_n)
        cycles.push_back(
            fmt::format("write {:X} {:04X}{}", after.isa_sa, after.isa_sd, after.isa_sbhe_n ? "" : " SBHE"));
    }
    fake.changes.clear();
    return cycles;
  }
  BoardOutputs tripped() {
    BoardOutputs pins = machine.outputs();
    pins.set(pin::kWdo, 1);
    return pins;
  }

  Machine machine{sc_core::sc_gen_unique_name("machine"), MachineConfig{}};
  FakeMachine& fake = FakeMachine::last();
  HostBus bus{machine};
};

// Eight switches are A11 to A4 of the I/O block, ten A23 to A14 of the window.
TEST_F(HostAccessTest, ACardIsWhereItsSwitchesSay) {
  EXPECT_EQ(bus.io_base(), 0x210u);
  EXPECT_EQ(bus.window(), 0xD0000u);
  bus.io_write(7, 0x41);
  bus.dpram_write(0x9050, 0xBEEF);
  EXPECT_EQ(bus.dpram_read(0x9050), 0xBEEF);
  EXPECT_EQ(take_cycles(), (Lines{"out 217 41", "write D9050 BEEF SBHE", "read D9050"}));
  machine.inputs().io_base = 0x30;
  machine.inputs().window = 0x35;
  bus.io_read(regs::host_io::kData7);
  bus.io_write(regs::host_io::kIvr, 5);
  bus.dpram_write(0x50, 1);
  EXPECT_EQ(take_cycles(), (Lines{"in 307", "out 303 05", "write D4050 0001 SBHE"}));
}

// Bits 1, 0 of +12 say which 16 KiB the window shows: set each time.
TEST_F(HostAccessTest, ASmallWindowHasPages) {
  machine.inputs().window_flat = false;
  machine.inputs().window = 0x35;
  for (const auto& [offset, cycle] :
       {std::pair(0x3FFEu, "read D7FFE"), std::pair(0x4000u, "read D4000"), std::pair(0xD052u, "read D5052")}) {
    bus.dpram_read(offset);
    EXPECT_EQ(take_cycles(), (Lines{fmt::format("out 21C {:02X}", offset >> 14), cycle})) << offset;
  }
  bus.dpram_write(0x8010, 0x1234, 1);
  EXPECT_EQ(take_cycles(), (Lines{"out 21C 02", "write D4010 1234"}));
}

TEST_F(HostAccessTest, BytesOfAWordAreWrittenByThemselves) {
  bus.dpram_write(0x100, 0x1111);
  bus.dpram_write(0x100, 0xBEEF, 1);
  EXPECT_EQ(bus.dpram_read(0x100), 0x11EF);
  bus.dpram_write(0x100, 0xBE22, 2);
  EXPECT_EQ(bus.dpram_read(0x100), 0xBEEF);
}

// A slot of eight bits: a cycle for each byte.
TEST_F(HostAccessTest, AnEightBitSlotTakesBytes) {
  machine.inputs().slot8 = true;
  HostBus narrow(machine);
  EXPECT_EQ(bus.width(), 16u);
  EXPECT_EQ(narrow.width(), 8u);
  fake.changes.clear();
  narrow.dpram_write(0x100, 0xBEEF);
  EXPECT_EQ(take_cycles(), (Lines{"write D0100 FFEF", "write D0101 FFBE"}));
  narrow.set_width(16);
  narrow.dpram_write(0x100, 0xBEEF);
  EXPECT_EQ(take_cycles(), (Lines{"write D0100 BEEF SBHE"}));
}

// host-bus:4.1, host-bus:4.5.
TEST_F(HostAccessTest, InterruptControllersAreReadRegisterByRegister) {
  for (std::uint8_t n = 8; n < 12; ++n) fake.io[n] = static_cast<std::uint8_t>(0x50 + n);
  const HostBus::Pic pic = bus.read_pic();
  EXPECT_EQ(pic.ist, 0x58);
  EXPECT_EQ(pic.sig, 0x59);
  EXPECT_EQ(pic.msk, 0x5A);
  EXPECT_EQ(pic.elr, 0x5B);
  EXPECT_EQ(bus.acknowledge_8259(), 0x5A);
  take_cycles();
  bus.write_pic_mask(0x12);
  bus.write_pic_edge_level(0x34);
  bus.clear_pic();
  EXPECT_EQ(take_cycles(), (Lines{"out 21A 12", "out 21B 34", "out 218 00"}));
  bus.mask_8259(0x77);
  const HostBus::Pic8259 other = bus.read_8259();
  EXPECT_EQ(take_cycles(), (Lines{"out 219 77", "out 218 0A", "in 218", "out 218 0B", "in 218", "in 219"}));
  EXPECT_EQ(other.irr, 0x0A) << "what the register holds";
  EXPECT_EQ(other.isr, 0x0B);
  EXPECT_EQ(other.imr, 0x77);
}

// ---------------------------------------------------------------------------------------------------------------- PCI

// host-bus:3.6: the same cycles on the local bus, through the ranges of the start-up; ones where nobody answers.
TEST_F(HostAccessTest, APciBoardIsReachedThroughItsBridge) {
  PciBridge bridge(sc_core::sc_gen_unique_name("bridge"), {0x210, 0xD0000, 0x10000});
  fake.bridge = &bridge;
  {
    HostBus pci(machine);
    fake.io[9] = 0xA5;
    EXPECT_EQ(pci.io_read(9), 0xA5);
    pci.io_write(7, 0x41);
    pci.dpram_write(0x8050, 0xBEEF);
    EXPECT_EQ(pci.dpram_read(0x8050), 0xBEEF);
    pci.dpram_write(0x8052, 0x1234, 1);
    pci.dpram_write(0x8052, 0x5678, 2);
    EXPECT_EQ(pci.dpram_read(0x8052), 0x5634);
    EXPECT_EQ(take_cycles(), (Lines{"in 219", "out 217 41", "write D8050 BEEF SBHE", "read D8050", "write D8052 0034",
                                    "write D8053 5600 SBHE", "read D8052"}));
    EXPECT_EQ(pci.io_read(16), 0xFF);
    EXPECT_EQ(pci.dpram_read(0x10000), 0xFFFF);
    EXPECT_EQ(take_cycles(), Lines{}) << "behind the ranges";
    bridge.reset();
    EXPECT_EQ(pci.io_read(9), 0xA5) << "configured anew at power-on";
    EXPECT_TRUE(bridge.inta_n());
    BoardOutputs interrupts = machine.outputs();
    interrupts.set(pin::kIsaIrq, 1);
    fake.planned = {{machine.now() + 1, interrupts}};
    pci.wait(2);
    EXPECT_FALSE(bridge.inta_n());
  }
  EXPECT_TRUE(bridge.inta_n()) << "the host has left";
  fake.bridge = nullptr;
}

// ----------------------------------------------------------------------------------------------------------- host port

// host-bus:3.1/4 to host-bus:3.1/6.
TEST_F(HostAccessTest, CharactersGoAndComeWhenThePortSaysSo) {
  bus.open_port();
  EXPECT_EQ(take_cycles(), (Lines{"out 215 00", "out 216 00"}));
  EXPECT_TRUE(bus.put_char(0x41, 0));
  EXPECT_EQ(take_cycles(), (Lines{"in 212", "out 217 41"}));
  fake.to_host = {0x42};
  EXPECT_EQ(bus.get_char(0), 0x42);
  EXPECT_EQ(take_cycles(), (Lines{"in 212", "in 217"}));
}

// Not less than the time-out and little more; nothing is sent. All ones are no answer.
TEST_F(HostAccessTest, APortThatIsNotReadyIsWaitedForUntilTheTimeOut) {
  fake.takes = false;
  for (const bool nobody : {false, true}) {
    if (nobody) fake.port_status = 0xFF;
    EXPECT_EQ(bus.port_status(), 0);
    Tick begin = bus.now();
    fake.changes.clear();
    EXPECT_FALSE(bus.put_char(0x41, kAccessMs));
    EXPECT_GE(bus.now() - begin, kAccessMs);
    EXPECT_LE(bus.now() - begin, kAccessMs + kAccessMs / 20);
    for (const std::string& cycle : take_cycles()) ASSERT_EQ(cycle, "in 212");
    begin = bus.now();
    EXPECT_FALSE(bus.get_char(kAccessMs));
    EXPECT_GE(bus.now() - begin, kAccessMs);
    EXPECT_LE(bus.now() - begin, kAccessMs + kAccessMs / 20);
    for (const std::string& cycle : take_cycles()) ASSERT_EQ(cycle, "in 212");
  }
  fake.port_status = 0xFE;
  EXPECT_EQ(bus.port_status(), 0xFE);
}

// A controller whose watchdog has tripped answers no more: nobody waits for it.
TEST_F(HostAccessTest, ATrippedWatchdogEndsEachWait) {
  fake.takes = false;
  EXPECT_FALSE(bus.tripped());
  fake.planned = {{bus.now() + kAccessMs / 2, tripped()}};
  const Tick begin = bus.now();
  EXPECT_FALSE(bus.get_char(100 * kAccessMs));
  EXPECT_TRUE(bus.tripped());
  EXPECT_FALSE(bus.put_char(0x41, 100 * kAccessMs));
  EXPECT_LE(bus.now() - begin, kAccessMs);
}

// host-bus:3.2: RREQ always, TREQ while there is something to be sent; HREQ is waited for, and nothing moves meanwhile.
TEST_F(HostAccessTest, APortByItsRequestLineTurnsRequestsOnAsTheyAreNeeded) {
  InterruptPort port(bus);
  Lines heard;
  port.on_character = [&](std::uint8_t c) { heard.push_back(std::string(1, static_cast<char>(c))); };
  port.open();
  EXPECT_EQ(take_cycles(), (Lines{"out 215 00", "out 216 00", "out 210 01"}));
  EXPECT_TRUE(port.idle());
  EXPECT_FALSE(port.run_until(bus.now() + kAccessMs));
  EXPECT_EQ(take_cycles(), Lines{});
  port.send('A');
  EXPECT_FALSE(port.idle());
  fake.takes = false;
  const Tick limit = bus.now() + kAccessMs;
  EXPECT_FALSE(port.run_until(limit));
  EXPECT_EQ(bus.now(), limit);
  EXPECT_EQ(take_cycles(), Lines{"out 210 03"});
  fake.to_host = {'B'};
  fake.takes = true;
  EXPECT_TRUE(port.run_until(bus.now() + kAccessMs));
  EXPECT_EQ(heard, Lines{"B"}) << "what has come is read first";
  EXPECT_EQ(take_cycles(), (Lines{"in 212", "in 217"}));
  EXPECT_FALSE(port.idle());
  EXPECT_TRUE(port.run_until(bus.now() + kAccessMs));
  EXPECT_EQ(take_cycles(), (Lines{"in 212", "out 217 41"}));
  EXPECT_TRUE(port.idle());
  port.open();
  EXPECT_EQ(take_cycles(), (Lines{"out 215 00", "out 216 00", "out 210 01"})) << "there is nothing more to send";
  fake.later.emplace_back(bus.now() + kAccessMs / 2, "C");
  EXPECT_TRUE(port.run_until(bus.now() + kAccessMs));
  EXPECT_EQ(heard, (Lines{"B", "C"}));
  const Tick now = bus.now();
  EXPECT_FALSE(port.run_until(now));
  EXPECT_EQ(bus.now(), now);
}

TEST_F(HostAccessTest, TheRamIsReachedByWordsOverTheBus) {
  BusDpram ram(bus);
  ram.write(0x9050, 0xBEEF);
  EXPECT_EQ(fake.memory[0x9050], 0xBEEF);
  EXPECT_EQ(ram.read(0x9050), 0xBEEF);
  EXPECT_EQ(ram.now(), bus.now());
  const Tick begin = ram.now();
  ram.pause(begin - 16 * 1000, begin + kAccessMs);  // a sixteenth of the wait so far
  ram.read(0);
  EXPECT_NEAR(static_cast<double>(ram.now() - begin), 1000 + 480 / 8.477, 20);
}

// ---------------------------------------------------------------------------------------------------------------- time

// A cycle begins at a multiple of the grid behind now and the cycle before, its pins move at their times.
TEST_F(HostAccessTest, CyclesBeginOnTheGridBehindThePauseOfTheHost) {
  const auto lows = [this] {
    std::vector<Tick> ticks;
    for (const auto& c : fake.changes)
      if (c.before.isa_iow_n && !c.after.isa_iow_n) ticks.push_back(c.seen);
    fake.changes.clear();
    return ticks;
  };
  const auto at = [](std::int64_t ns) { return fs_to_tick(ns * kFsPerNs); };
  for (int n = 0; n < 3; ++n) bus.io_write(7, 0);
  EXPECT_EQ(lows(), (std::vector<Tick>{at(120 + 120), at(960 + 120), at(1800 + 120)}));
  EXPECT_EQ(bus.free_at(), 2640 * kFsPerNs);
  bus.set_pace([] { return 3u; });
  bus.io_write(7, 0);
  EXPECT_EQ(lows(), std::vector<Tick>{at(2640 + 3 * 120 + 120)});
  bus.set_pace(nullptr);
  bus.set_times(isa::kTight);
  EXPECT_EQ(bus.times().grid, kFsPerNs);
  bus.io_write(7, 0);
  EXPECT_EQ(lows(), std::vector<Tick>{at(2640 + 360 + 840 + 91)});
  bus.advance_to(fs_to_tick(9'000 * kFsPerNs));
  bus.io_write(7, 0);
  const std::int64_t next = static_cast<std::int64_t>(tick_to_fs(fs_to_tick(9'000 * kFsPerNs)) / kFsPerNs) + 1;
  EXPECT_EQ(lows(), std::vector<Tick>{at(next + 91)});
}

// A pin by hand: the edge behind it sees it, and the next cycle comes after it.
TEST_F(HostAccessTest, PinsMoveByHandAtTheirTime) {
  const TimeFs time = 5'003 * kFsPerNs;
  bus.drive_at(time, [](HostInputs& in) { in.isa_aen = true; });
  ASSERT_EQ(fake.changes.size(), 1u);
  EXPECT_EQ(fake.changes[0].seen, fs_to_tick(time));
  EXPECT_TRUE(fake.changes[0].after.isa_aen);
  EXPECT_EQ(bus.free_at(), time);
  bus.io_write(7, 0);
  EXPECT_FALSE(machine.inputs().isa_aen) << "the cycle is not DMA's";
}

// Once in a million ticks, however the time is spent.
TEST_F(HostAccessTest, TheHeartbeatIsHeardWhileTimePasses) {
  constexpr Tick kBeat = 1'000'000;
  int beats = 0;
  bus.set_heartbeat([&] { ++beats; });
  bus.advance_to(10 * kBeat);
  EXPECT_EQ(beats, 10);
  bus.wait(3 * kBeat + 1);
  EXPECT_EQ(beats, 14);
  bus.wait_change(pin::kIsaIrq, bus.now() + 5 * kBeat);
  EXPECT_EQ(beats, 19);
  EXPECT_FALSE(bus.wait_pin(pin::kIsaIrq, 1, 2 * kBeat));
  EXPECT_EQ(beats, 21);
  bus.io_read(2);
  EXPECT_EQ(beats, 22) << "behind a cycle";
  const Tick begin = bus.now();
  bus.advance_to_stop(begin + 5 * kBeat);
  EXPECT_EQ(bus.now(), begin + kBeat) << "one at a time";
  EXPECT_EQ(beats, 23);
  bus.advance_to_stop(begin + kBeat + 7);
  EXPECT_EQ(bus.now(), begin + kBeat + 7);
}

// Whoever ends the run by it leaves no strobe low.
TEST_F(HostAccessTest, TheHeartbeatIsNotHeardWithinACycle) {
  fake.ready_low_from = 30;
  fake.ready_low_to = 1500;
  bool silent = true;
  bus.set_heartbeat([&] {
    const HostInputs& in = machine.inputs();
    silent = silent && in.isa_ior_n && in.isa_iow_n && in.isa_memr_n && in.isa_memw_n;
  });
  bus.io_read(9);
  fake.ready_low_from = bus.now() + 40;
  fake.ready_low_to = bus.now() + 1500;
  bus.dpram_write(0x100, 1);
  EXPECT_TRUE(silent);
}

TEST_F(HostAccessTest, AnErrorOfTheBusSaysWhichCycle) {
  fake.ready_low_from = 20;
  try {
    bus.io_read(9);
    FAIL();
  } catch (const HostBusError& e) {
    EXPECT_EQ(std::string(e.what()),
              "host bus: IOCHRDY stays low in the read cycle at I/O address 0x219; expected: high "
              "within 15.6 us (t10)");
  }
}

TEST_F(HostAccessTest, AnErrorOfTheBusSaysWhichCycleOfMemory) {
  fake.ready_low_from = 20;
  try {
    bus.dpram_write(0x1050, 1);
    FAIL();
  } catch (const HostBusError& e) {
    EXPECT_EQ(std::string(e.what()),
              "host bus: IOCHRDY stays low in the write cycle at memory address 0xD1050; expected: "
              "high within 15.6 us (t10)");
  }
}

}  // namespace
}  // namespace brick
