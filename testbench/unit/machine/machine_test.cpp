// The machine: interrupts at their exact time, faults, reset and power, straps, flash, watchdog, named signals.
#include "systemc/machine/machine.h"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>

#include "systemc/core/cpu_clock.h"
#include "systemc/cpu/cycle_costs.h"
#include "systemc/host/pci_bridge.h"
#include "testbench/host/host_bus.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/machine/machine_rig.h"

namespace brick {
namespace {

constexpr Tick kResetTicks = 120;  // machine_impl.h
constexpr Tick kMs = 117'965;

TEST(Machine, PhaseInterruptIsSeenSixteenTicksAfterTheFall) {
  BRICK_COVERS("CARD-3");
  MachineRig rig("probe");
  std::vector<PortACycle> writes;
  rig.machine.on_bus_cycle = [&](const PortACycle& c) {
    if (c.write && c.address == 0x070010) writes.push_back(c);
  };
  std::vector<Tick> falls;
  while (rig.machine.now() < 2 * kMs) {
    rig.machine.run_until(2 * kMs, select_pins(pin::kPhase));
    if (rig.machine.outputs().get(pin::kPhase) == 0) falls.push_back(rig.machine.now());
  }
  ASSERT_GT(falls.size(), 100u);
  // The CPU sleeps: it wakes with the first cycle at or after fall + 16, takes the trap, jumps, and starts the write.
  // Only when another handler is still running does it come later.
  CpuClock clock;
  clock.restart(kResetTicks, 0, 8);
  unsigned exact = 0;
  ASSERT_GE(writes.size() + 1, falls.size());
  for (std::size_t i = 0; i < writes.size(); ++i) {
    const TimeFs expected = clock.time(clock.first_cycle(falls[i] + 16) + cost::kTrap + cost::kJump);
    EXPECT_GE(writes[i].start, expected);
    exact += writes[i].start == expected;
    EXPECT_EQ(writes[i].data, i & 0xFFFFFF);
  }
  EXPECT_GT(exact, writes.size() / 2);
}

TEST(Machine, RefusedAccessesAreFaults) {
  MachineRig rig("fault");
  rig.machine.run_until(kMs / 10);
  EXPECT_EQ(rig.y(0x102), 1u);
  EXPECT_EQ(rig.y(0x100), 5u) << "load access fault";
  EXPECT_EQ(rig.y(0x101), 7u) << "store access fault";
  EXPECT_EQ(rig.y(0x103), 7u) << "byte store";
}

// What programs/fault.S does, at its addresses.
TEST(Machine, TellsExceptionsOfItsCpu) {
  for (const Engine engine : {Engine::kSystemC, Engine::kRtl}) {
    MachineConfig config;
    config.engine = engine;
    MachineRig rig("fault", config);
    rig.machine.run_until(kMs / 10);
    const auto errors = rig.machine.run_errors();
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_THAT(errors[0], ::testing::MatchesRegex("exception of the CPU: load access fault at 0xc0200004, "
                                                   "pc 0x100000[0-9a-f]+ \\(_start\\), at 0\\.00[0-9]+ ms; .*"));
    EXPECT_THAT(errors[1], ::testing::StartsWith("exceptions of the CPU: 2 more, the last: store access fault at "
                                                 "0xc03c0004, pc 0x100000"));
    EXPECT_EQ(errors[1], "exceptions of the CPU: 2 more, the last: " + rig.machine.last_exception());
    EXPECT_EQ(rig.machine.take_run_errors(), errors);
    EXPECT_TRUE(rig.machine.run_errors().empty()) << "taken";
  }
}

TEST(Machine, InterruptsAreNoExceptions) {
  MachineRig rig("probe");
  rig.machine.run_until(2 * kMs);
  EXPECT_GT(rig.machine.instructions(), 1000u);
  EXPECT_TRUE(rig.machine.run_errors().empty());
  EXPECT_EQ(rig.machine.last_exception(), "");
}

TEST(Machine, ResetKeepsRamAndPowerCycleLosesIt) {
  MachineRig rig("probe");
  rig.machine.run_until(kMs);
  EXPECT_EQ(rig.y(0x103), 1u) << "power-on";
  EXPECT_EQ(rig.y(0x104), 0u);
  rig.set_y(0x200, 0xABCDEF);
  rig.machine.set_jumper_e3(true);
  rig.machine.reset();
  rig.machine.run_until(2 * kMs);
  EXPECT_EQ(rig.y(0x103), 0u) << "reset line";
  EXPECT_EQ(rig.y(0x104), 1u) << "jumper";
  EXPECT_EQ(rig.y(0x200), 0xABCDEFu);
  const std::uint32_t random = rig.y(0x201);
  rig.machine.power_cycle();
  rig.machine.run_until(3 * kMs);
  EXPECT_EQ(rig.y(0x103), 1u);
  EXPECT_NE(rig.y(0x200), 0xABCDEFu);
  EXPECT_NE(rig.y(0x201), random) << "RAM comes up at random";
}

// host-bus:3.6/4: the bridge loses its ranges with the power, not with the card's reset.
TEST(Machine, PowerCycleResetsThePciBridge) {
  struct StartUp final : LocalBus {
    std::uint8_t read_io(std::uint32_t) override { return 0xFF; }
    void write_io(std::uint32_t, std::uint8_t) override {}
    std::uint16_t read_memory(std::uint32_t, unsigned) override { return 0xFFFF; }
    void write_memory(std::uint32_t, std::uint16_t, unsigned) override {}
    bool irq() const override { return false; }
    void bridge_reset() override { ++asked; }
    unsigned asked = 0;
  } start_up;
  MachineConfig config;
  config.board.bus = "pci";
  MachineRig rig("probe", config);
  ASSERT_NE(rig.machine.pci(), nullptr);
  rig.machine.pci()->attach(start_up);
  rig.machine.reset();
  rig.machine.run_until(kMs);
  EXPECT_EQ(start_up.asked, 0u);
  rig.machine.power_cycle();
  EXPECT_EQ(start_up.asked, 1u);
}

// Nobody makes local cycles then, and nobody is told of a power-on.
TEST(Machine, HostThatHasLeftIsNotAskedByItsBridge) {
  MachineConfig config;
  config.board.bus = "pci";
  MachineRig rig("probe", config);
  {
    HostBus host(rig.machine);
    host.wait(240);
    EXPECT_NE(host.io_read(2), 0xFF);
  }
  PciCommand command(PciSpace::kIo);
  unsigned char data = 0;
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_READ_COMMAND);
  payload.set_address(0xE002);
  payload.set_data_ptr(&data);
  payload.set_data_length(1);
  payload.set_streaming_width(1);
  payload.set_extension(&command);
  sc_core::sc_time delay;
  rig.machine.pci()->transport(payload, delay);
  payload.clear_extension(&command);
  EXPECT_EQ(payload.get_response_status(), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  rig.machine.power_cycle();
}

TEST(Machine, RamAtPowerOnDependsOnTheSeedOnly) {
  MachineConfig one, two;
  two.seed = 2;
  MachineRig a("probe", one), b("probe", one), c("probe", two);
  EXPECT_EQ(a.y(0x300), b.y(0x300));
  EXPECT_NE(a.y(0x300), c.y(0x300));
  EXPECT_EQ(a.y(0x300) >> 24, 0u) << "words of 24 bits";
}

TEST(Machine, TrippedWatchdogStopsTheCpuUntilReset) {
  BRICK_COVERS("WDT-1");
  MachineRig rig("probe");
  rig.machine.run_until(kMs);
  rig.set_y(0x101, 1);  // no more strobes
  rig.machine.run_until(40 * kMs, select_pins(pin::kWdTripped));
  ASSERT_EQ(rig.machine.outputs().get(pin::kWdTripped), 1u);
  const Tick trip = rig.machine.now();
  EXPECT_NEAR(static_cast<double>(trip), static_cast<double>(26 * kMs), static_cast<double>(kMs))
      << "25 ms after the last strobe";
  rig.machine.run_until(trip + 100);  // a bus cycle may end
  const std::uint64_t instructions = rig.machine.instructions();
  rig.machine.run_until(trip + 10 * kMs);
  EXPECT_EQ(rig.machine.instructions(), instructions);
  rig.set_y(0x101, 0);
  rig.machine.reset();
  rig.machine.run_until(rig.machine.now() + kMs);
  EXPECT_EQ(rig.machine.outputs().get(pin::kWdTripped), 0u);
  EXPECT_GT(rig.machine.instructions(), instructions);
}

TEST(Machine, WithoutFirmwareTheBoardStillAnswersItsPins) {
  Machine machine("bare", MachineConfig{});
  EXPECT_EQ(machine.run_until(kMs), kMs);
  EXPECT_EQ(machine.instructions(), 0u);
}

TEST(Machine, FlashFileIsKeptBetweenRuns) {
  const std::string file = ::testing::TempDir() + "brick_flash_test.bin";
  std::remove(file.c_str());
  MachineConfig config;
  config.flash_file = file;
  {
    MachineRig rig("probe", config);
    EXPECT_EQ(*rig.machine.cpu().memory(0x30000000, 1), 0xFF) << "erased";
    *rig.machine.cpu().memory(0x30000010, 1) = 0x5A;
  }
  {
    MachineRig rig("probe", config);
    EXPECT_EQ(*rig.machine.cpu().memory(0x30000010, 1), 0x5A);
    *rig.machine.cpu().memory(0x30000011, 1) = 0xA5;
    rig.machine.power_cycle();
    EXPECT_EQ(*rig.machine.cpu().memory(0x30000011, 1), 0xA5) << "flash survives a power cycle";
  }
  std::remove(file.c_str());
}

TEST(Machine, SaysWhatIsWrongWithTheFlashFile) {
  const auto message = [](const std::string& file) {
    MachineConfig config;
    config.flash_file = file;
    try {
      MachineRig rig("probe", config);
    } catch (const std::runtime_error& e) { return std::string(e.what()); }
    return std::string();
  };
  const std::string file = ::testing::TempDir() + "brick_flash_short.bin";
  std::ofstream(file) << "too short";
  EXPECT_EQ(message(file), "flash file " + file + ": has 9 bytes; expected 1048576");
  std::remove(file.c_str());
  EXPECT_THAT(message("/nonexistent/flash.bin"), ::testing::HasSubstr("/nonexistent/flash.bin: cannot be written"));
  EXPECT_THAT(message(::testing::TempDir()), ::testing::HasSubstr("is not a file"));
}

TEST(Machine, SignalsNameTheClockSourceAndTheTask) {
  BRICK_COVERS("I19-2");
  MachineRig rig("probe");
  EXPECT_EQ(rig.signal("clock.source"), 0u);
  rig.machine.run_until(kMs);
  EXPECT_EQ(rig.signal("clock.source"), 7007u);
  // Right after a phase interrupt was taken the task is 3; 3 us later the CPU sleeps again.
  rig.machine.run_until(2 * kMs, select_pins(pin::kPhase));
  if (rig.machine.outputs().get(pin::kPhase) != 0) rig.machine.run_until(2 * kMs, select_pins(pin::kPhase));
  const Tick fall = rig.machine.now();
  rig.machine.run_until(fall + 20);
  EXPECT_EQ(rig.signal("cpu.task"), 3u);
  for (const char* name :
       {"bus.addr",        "bus.data",        "bus.aa",           "bus.rd_n",       "bus.wr_n",
        "bus.ta_n",        "host.isa.sa",     "host.isa.sd",      "host.isa.ior_n", "host.isa.iow_n",
        "host.isa.memr_n", "host.isa.memw_n", "host.isa.iochrdy", "host.isa.aen",   "host.pic.ist",
        "host.pic.sig",    "host.pic.msk",    "host.pic.elr",     "host.breq",      "host.irq",
        "host.ipos",       "host.eror",       "host.f1er",        "host.hreq",      "host.wdo",
        "dpram.busy_host", "dpram.busy_cpu",  "cpu.pc",           "cpu.symbol",     "watchdog.tripped",
        "clock.phase",     "clock.servo"})
    EXPECT_TRUE(rig.machine.signals().find(name)) << name;
}

TEST(Machine, KeepsTheLastBusCycles) {
  MachineRig rig("probe");
  rig.machine.run_until(kMs);
  const auto& cycles = rig.machine.last_bus_cycles();
  ASSERT_GE(cycles.size(), 16u);
  for (std::size_t i = 1; i < cycles.size(); ++i) EXPECT_LT(cycles[i - 1].tick, cycles[i].tick);
}

}  // namespace
}  // namespace brick
