// Where the clocks come from, on whole boards with the real image: any IC as the source, the search at
// re-initialisation, I19 through SAVE and reset, two sources, none. Periods are arithmetic on servo-ic:3.1,
// servo-ic:3.2 and servo-ic:6.1.
#include "systemc/cpu/port_a.h"
#include "systemc/machine/board_file.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr unsigned kMacroIc0 = 18, kMacroIc1 = 19;
constexpr Tick kFactoryPhase = 2 * 6527 + 3;
constexpr unsigned long kConfigurationError = 1ul << 7, kNoPhaseClock = 1ul << 3;

class ClockSources : public Controller {
 protected:
  void start_with(std::uint32_t fitted, std::uint32_t macro_gate = 0) {
    MachineConfig config;
    config.board.fitted = fitted;
    config.board.macro_gate = macro_gate;
    start(config);
  }
  void start_board(const std::string& name) {
    MachineConfig config;
    config.board = read_board_file("boards/" + name + ".toml");
    start(config);
  }
  void reset_command(const std::string& command) {
    link().command(command);
    ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(100))) << "no reply after " << command;
  }
  unsigned long problems() {
    return std::stoul(ask("???").substr(0, 6), nullptr, 16) & (kConfigurationError | kNoPhaseClock | 1ul << 10);
  }
  std::uint64_t source() { return machine().signals().value(*machine().signals().find("clock.source")); }
  bool conflict() { return machine().outputs().get(pin::kSourceConflict) != 0; }

  // Hand-over of the clock pins (docs/clock_select.md), bounds in phase periods of the IC: one to be an input drives on
  // until both clocks are high; a new source takes PHASE with a rise, the end of its second period at the latest.
  void await_release(Tick phase) { wait(phase + (phase + 1) / 2); }
  void await_take(Tick phase) { wait(2 * phase); }

  void expect_periods(int max_count, int phase_divider, int servo_divider) {
    SCOPED_TRACE("MaxPhase " + std::to_string(max_count) + ", dividers " + std::to_string(phase_divider) + " " +
                 std::to_string(servo_divider));
    const Tick phase = static_cast<Tick>(2 * max_count + 3) * (phase_divider + 1);
    expect_period(pin::kPhase, phase);
    expect_period(pin::kServo, phase * (servo_divider + 1));
  }

 private:
  void expect_period(const PinField& pin, Tick period) {
    const auto edges = falling_edges(pin, 3, 4 * period);
    ASSERT_EQ(edges.size(), 3u) << pin.name;
    EXPECT_EQ(edges[1] - edges[0], period) << pin.name;
    EXPECT_EQ(edges[2] - edges[1], period) << pin.name;
  }
};

constexpr std::uint32_t kServoIcs01 = 0x3, kWithMacroIc0 = 0x3 | 1u << kMacroIc0;

// CLK-1, CLK-2: a MACRO IC as the source, moved there by one line as on a running system.
TEST_P(ClockSources, OneLineMovesTheSourceToMacroIc0AndItsVariablesSetTheClocks) {
  BRICK_COVERS("CLK-1 CLK-2 CLK-3 I19-2");
  start_with(kWithMacroIc0);
  EXPECT_EQ(ask("I7007 I6807"), "0|3");
  ask("I6802=7");
  expect_periods(6527, 0, 3);  // not the source: no effect
  std::vector<std::uint32_t> written;
  machine().on_bus_cycle = [&](const PortACycle& c) {
    if (c.write && c.x && c.address >= 0x78000 && c.address < 0x7C000) written.push_back(c.address);
  };
  ask("I6807=0 I7007=3");
  machine().on_bus_cycle = nullptr;
  EXPECT_EQ(written, (std::vector<std::uint32_t>{0x78004, 0x7840C})) << "the input first: never two drivers";
  await_take(kFactoryPhase);
  EXPECT_EQ(source(), 6807u);
  wait(ms_to_ticks(2));
  expect_periods(6527, 0, 7);
  ask("I6800=1473 I6801=3 I6802=1");
  wait(ms_to_ticks(4));
  expect_periods(1473, 3, 1);
  ask("I7000=100 I7001=9 I7002=9");
  wait(ms_to_ticks(2));
  expect_periods(1473, 3, 1);
  ask("I6807=3 I7007=0");
  await_take((2 * 100 + 3) * 10);
  EXPECT_EQ(source(), 7007u);
  EXPECT_FALSE(conflict());
}

// CLK-5: 6.67 kHz phase, 3.33 kHz servo: I6802 = 6.67 / 3.33 - 1 = 1. I6800 = 8846 gives 117964.8 / 17695 = 6.6665 kHz.
TEST_P(ClockSources, TheDocumentsExample) {
  BRICK_COVERS("CLK-5 CLK-4");
  start_board("turbo-pmac2-ultralite");
  EXPECT_EQ(ask("I19"), "6807");
  EXPECT_EQ(ask("I10"), "3713991");
  ask("I6800=8846 I6802=1");
  wait(ms_to_ticks(2));
  expect_periods(8846, 0, 1);
  // I10 = 8388608 / servo kHz, as an expression and as the formula with 640/9.
  EXPECT_EQ(ask("I10=640*(2*I6800+3)*(I6801+1)*(I6802+1)/9 I10"), "2516622");  // 640 * 17695 * 2 / 9 = 2516622.2
}

BRICK_ON_ENGINES(ClockSources, at_night(Engine::kRtl), Engine::kSystemC, Engine::kLockstep);

class ClockSourceRanges : public ClockSources {};

// CLK-3: every divider from 0 to 15 on a MACRO IC, with a short triangle so that the slowest is quick to see.
TEST_P(ClockSourceRanges, ServoIsAnIntegerFractionOfPhaseForEveryDivider) {
  BRICK_COVERS("CLK-3 CLK-1");
  start_board("turbo-pmac2-ultralite");
  ask("I6800=2948");
  for (int divider = 0; divider <= 15; ++divider) {
    ask("I6802=" + std::to_string(divider));
    wait(ms_to_ticks(2));
    expect_periods(2948, 0, divider);
  }
  EXPECT_EQ(ask("I6802=16 I6802"), "0") << "0 to 15, modulo 16";
  ask("I6802=1");
  for (const int divider : {0, 1, 5, 15}) {
    ask("I6801=" + std::to_string(divider));
    wait(ms_to_ticks(2));
    expect_periods(2948, divider, 1);
  }
}

BRICK_ON_ENGINES(ClockSourceRanges, Engine::kSystemC, Engine::kLockstep);

class ClockSourceBoards : public ClockSources {};

// Every legal I19 on a board with all ICs: stored at once, active after SAVE and reset.
TEST_P(ClockSourceBoards, EveryLegalI19SuppliesTheBoardAfterSaveAndReset) {
  BRICK_COVERS("I19-1 I19-2");
  start_board("all-ics");
  EXPECT_EQ(ask("I4900 I4902"), "$FF3FF|$F");
  EXPECT_EQ(ask("I20..23"), "$78400|$79400|$7A400|$7B400");
  std::vector<unsigned> numbers = {6807, 6857, 6907, 6957};
  for (unsigned m = 0; m < 10; ++m) numbers.push_back(7007 + 100 * m);
  for (unsigned m = 2; m < 10; ++m) numbers.push_back(7057 + 100 * m);
  ASSERT_EQ(numbers.size(), 22u);
  if (GetParam() != Engine::kSystemC)
    numbers = night() ? std::vector<unsigned>{6857, 7957} : std::vector<unsigned>{7957};
  std::string before = "7007";
  for (const unsigned number : numbers) {
    SCOPED_TRACE("I19=" + std::to_string(number));
    const std::string text = std::to_string(number), max_count = "I" + std::to_string(number - 7);
    EXPECT_EQ(ask("I19=" + text + " I19"), text);
    EXPECT_EQ(std::to_string(source()), before) << "I19 alone changes nothing";
    ask(max_count + "=5000");
    EXPECT_EQ(ask("SAVE"), "");
    reset_command("$$$");
    EXPECT_EQ(source(), number);
    EXPECT_FALSE(conflict());
    EXPECT_EQ(ask("I" + text), "0");
    if (before != text) { EXPECT_EQ(ask("I" + before), "3"); }
    EXPECT_EQ(problems(), 0u);
    const auto edges = falling_edges(pin::kPhase, 2, 60'000);
    ASSERT_EQ(edges.size(), 2u);
    EXPECT_EQ(edges[1] - edges[0], 10003) << "2 * 5000 + 3";
    before = text;
  }
}

BRICK_ON_ENGINES(ClockSourceBoards, Engine::kSystemC, Engine::kLockstep);

class ClockSourceFaults : public ClockSources {};

// servo-ic:7.1/3 on the hardware: the order, and a MACROGATE passed over.
TEST_P(ClockSourceFaults, ReInitialisationTakesTheFirstIcThatCanMakeBothClocks) {
  BRICK_COVERS("I19-3");
  const struct {
    std::uint32_t fitted, gate;
    unsigned source;
  } cases[] = {
      {1u << kMacroIc0 | 1u << 1, 0, 6807},      // MACRO IC 0 before servo IC 1
      {1u << kMacroIc0 | 1u << 1, 1, 7107},      // unless it is a MACROGATE
      {1u << 10 | 1u << kMacroIc1, 0, 7257},     // servo IC 2* before MACRO IC 1
      {1u << 17 | 1u << 9 | 1u << 12, 0, 7907},  // servo IC 9 before 4*, 9*
      {1u << kMacroIc1 | 1u << 20, 2, 6907},     // MACRO IC 2, 1 being a MACROGATE
  };
  for (const auto& k : cases) {
    if (GetParam() != Engine::kSystemC && !night() && k.source != 7107 && k.source != 7907) continue;
    start_with(k.fitted, k.gate);
    EXPECT_EQ(ask("I19"), std::to_string(k.source)) << std::hex << k.fitted;
    EXPECT_EQ(source(), k.source) << std::hex << k.fitted;
    ask("I19=6957 I3=2");
    reset_command("$$$***");
    EXPECT_EQ(ask("I19"), std::to_string(k.source)) << std::hex << k.fitted;
    EXPECT_EQ(problems(), 0u);
  }
}

TEST_P(ClockSourceFaults, AMacroGateTakesItsClocksFromOutsideWithDirectionOne) {
  BRICK_COVERS("I19-2");
  start_with(kServoIcs01 | 1u << kMacroIc0 | 1u << kMacroIc1, 2);
  EXPECT_EQ(ask("I19 I7007 I7107 I6807 I6857"), "7007|0|3|3|1");
  EXPECT_EQ(ask("I4902 I4903"), "$3|$1");
  EXPECT_EQ(ask("I6857=3 I6857"), "1") << "one bit";
  EXPECT_EQ(ask("I6810 I6860 I6860=3 I6860"), "7|0|0") << "it has no supplementary channels";
  EXPECT_FALSE(conflict());
}

TEST_P(ClockSourceFaults, VariablesOfAnAbsentMacroIcReadZero) {
  start();
  EXPECT_EQ(ask("I20..23"), "$0|$0|$0|$0");
  EXPECT_EQ(ask("I6800=5 I6807=0 I6800 I6807"), "0|0");
  EXPECT_EQ(source(), 7007u);
}

TEST_P(ClockSourceFaults, TwoSourcesShowAConflictAndTheLowestNumberedWins) {
  start_with(kWithMacroIc0);
  ask("I6800=3000 I6807=0");
  wait(ms_to_ticks(1));  // 19 rises of 6003 ticks, 13057 on the net: one of each three comes while the net is high
  EXPECT_TRUE(conflict());
  EXPECT_EQ(source(), 7007u);
  expect_periods(6527, 0, 3);
  const auto errors = machine().take_run_errors();
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_THAT(errors[0], ::testing::HasSubstr("servo IC 0 (I7007) and MACRO IC 0 (I6807) drive"));
  ask("I6807=3");
  await_release(2 * 3000 + 3);
  EXPECT_FALSE(conflict());
}

// All ICs external and nothing arriving: PHASE and SERVO stand high, the status bit shows while the watchdog lets the
// CPU live, 25 ms from the last servo edge.
TEST_P(ClockSourceFaults, NoSourceIsReportedAndTripsTheWatchdog) {
  BRICK_COVERS("I19-2");
  start_with(kWithMacroIc0);
  ask("I7007=3");
  await_release(kFactoryPhase);
  EXPECT_EQ(source(), 0u);
  const Tick stopped = machine().now();
  wait(ms_to_ticks(2));
  EXPECT_EQ(problems(), kNoPhaseClock);
  EXPECT_EQ(machine().outputs().get(pin::kPhase), 1u);
  EXPECT_EQ(machine().outputs().get(pin::kServo), 1u);
  machine().run_until(stopped + ms_to_ticks(30), select_pins(pin::kWdTripped));
  EXPECT_EQ(machine().outputs().get(pin::kWdTripped), 1u);
  EXPECT_LE(machine().now() - stopped, ms_to_ticks(26));
}

// I19 that names an IC which is not there is kept as text; after a reset nothing drives the clocks. Jumper E3 recovers.
TEST_P(ClockSourceFaults, I19OfAnAbsentIcMeansNoSourceAfterReset) {
  BRICK_COVERS("I19-1 I19-2 WDT-2");
  start_with(kServoIcs01);
  EXPECT_EQ(ask("I19=6807 I19"), "6807");
  EXPECT_EQ(ask("SAVE"), "");
  reset_command("$$$");
  EXPECT_EQ(ask("I19 I7007 I7107"), "6807|3|3");
  EXPECT_EQ(source(), 0u);
  EXPECT_EQ(problems(), kNoPhaseClock);
  machine().run_until(machine().now() + ms_to_ticks(30), select_pins(pin::kWdTripped));
  EXPECT_EQ(machine().outputs().get(pin::kWdTripped), 1u);
  machine().set_jumper_e3(true);
  machine().reset();
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(ask("I19"), "7007");
  EXPECT_EQ(problems(), 0u);
}

// The flash store says which ICs there were: a board that has lost or gained one says so.
TEST_P(ClockSourceFaults, ADifferentSetOfIcsIsAConfigurationError) {
  start_with(kWithMacroIc0);
  EXPECT_EQ(ask("SAVE"), "");
  machine().inputs().fitted = kServoIcs01;
  machine().apply();
  machine().reset();
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(problems(), kConfigurationError);
  EXPECT_EQ(ask("I20"), "$78400") << "found at the last re-initialisation";
  reset_command("$$$***");
  EXPECT_EQ(problems(), 0u);
  EXPECT_EQ(ask("I20"), "$0");
}

TEST_P(ClockSourceFaults, AMacroIcOfTheOtherKindIsAConfigurationError) {
  BRICK_COVERS("I19-2");
  start_with(1u << kMacroIc0);
  EXPECT_EQ(ask("SAVE"), "");
  machine().inputs().macro_gate = 1;
  machine().apply();
  machine().reset();
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(ask("I19 I6807"), "6807|1") << "it cannot make a servo clock";
  EXPECT_EQ(source(), 0u);
  EXPECT_EQ(problems(), kConfigurationError | kNoPhaseClock);
}

// The source is an accessory IC that is pulled out: I19 names it still.
TEST_P(ClockSourceFaults, AMissingSourceIcMeansConfigurationErrorAndNoPhaseClock) {
  BRICK_COVERS("I19-2");
  start_board("umac-turbo");
  EXPECT_EQ(ask("SAVE"), "");
  machine().inputs().fitted = 0xC;
  machine().apply();
  machine().reset();
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(ask("I19"), "6807");
  EXPECT_EQ(source(), 0u);
  EXPECT_EQ(problems(), kConfigurationError | kNoPhaseClock);
}

BRICK_ON_ENGINES(ClockSourceFaults, Engine::kRtl, Engine::kSystemC);

}  // namespace
}  // namespace brick
