// The board of separate chips is the one board: random traffic on all pins and random life on the motor side, compared
// at every tick. A million ticks each: BRICK_CHIP_TICKS=1000000 bin/unit_chips (seed: BRICK_RANDOM_SEED).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/cosim/engines.h"
#include "testbench/unit/chips/chip_lockstep.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

using ::testing::ContainsRegex;
using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

constexpr std::uint32_t kTwoIcs = 0x3, kWithMacroIc = 0x40003, kThreeIcs = 0x7;  // as BoardInputs::fitted

Tick ticks() {
  const char* asked = std::getenv("BRICK_CHIP_TICKS");
  return asked == nullptr ? 100'000 : std::strtoll(asked, nullptr, 10);
}

std::unique_ptr<ChipLockstep> chips_beside_board(std::uint32_t fitted, ChipFault fault = ChipFault::kNone,
                                                 std::uint64_t seed = 0) {
  return std::make_unique<ChipLockstep>(make_rtl_board(fitted, {seed, false, seed}), fitted, seed, fault);
}

// What a board of chips must not be given: straps that move while the power is on, a second source of the clocks.
void keep_straps(BoardInputs& in, std::uint32_t fitted, bool outside, unsigned source) {
  in.fitted = fitted;
  in.ext_clock = outside;
  for (unsigned ic = 0; ic < regs::kGateIcs.size(); ++ic) {
    const auto& gate = regs::kGateIcs[ic];
    const auto offset = gate.macro ? regs::macro_ic::kClockControl.address : regs::servo_ic::kClockControl.address;
    if ((outside || ic != source) && in.pa_addr == gate.base + offset && in.pa_x)
      in.pa_wdata = regs::servo_ic::clock_control::kServoExternal.set(
          regs::servo_ic::clock_control::kPhaseExternal.set(in.pa_wdata, 1), 1);
  }
}

// Single cycles, for a Board and for Chips alike.
constexpr std::uint32_t kClock0 = 0x078004, kClock1 = 0x078104, kPwm1 = 0x07811C, kControl1 = 0x078105;

void run(Board& board, Tick ticks) { board.run_until(board.now() + ticks); }
void run(Chips& chips, Tick ticks) {
  for (Tick t = 0; t < ticks; ++t) chips.tick();
}
template <class B>
void apply(B& board, const BoardInputs& in, Tick ticks) {
  board.set_inputs(in);
  run(board, ticks);
}
template <class B>
void switch_on(B& board, BoardInputs& in) {
  in.rst_n = false;
  apply(board, in, 20);
  in.rst_n = true;
  apply(board, in, 20);
}
template <class B>
void write(B& board, BoardInputs& in, std::uint32_t address, std::uint32_t data) {
  in.pa_addr = address;
  in.pa_x = true;
  in.pa_aa = 2;
  in.pa_wdata = data;
  apply(board, in, 6);
  in.pa_wr_n = false;
  apply(board, in, 12);
  in.pa_wr_n = true;
  apply(board, in, 6);
}
std::uint32_t read(Board& board, BoardInputs& in, std::uint32_t address) {
  in.pa_addr = address;
  in.pa_x = true;
  in.pa_aa = 2;
  apply(board, in, 6);
  in.pa_rd_n = false;
  apply(board, in, 12);
  const BoardOutputs out = board.outputs();
  EXPECT_EQ(out.get(pin::kPaDataOe), 1u);
  in.pa_rd_n = true;
  apply(board, in, 6);
  return out.get(pin::kPaData);
}

struct Moves {
  unsigned phase = 0, trips = 0;
  explicit Moves(Board& board) {
    board.on_change = [this](Tick, const BoardOutputs& before, const BoardOutputs& after) {
      phase += before.get(pin::kPhase) != after.get(pin::kPhase);
      trips += after.get(pin::kWdTripped) & ~before.get(pin::kWdTripped);
    };
  }
};

struct MotorLife {
  const char* name;
  MotorTrafficOptions options;
  std::uint32_t pulled = 0;  // of its ICs
};

// Two accesses in a thousand ticks or more, whatever the seed.
MotorTrafficOptions life(std::uint32_t ics) {
  MotorTrafficOptions options{ics};
  options.bus_pause = 100;
  options.long_pause = 1'000;
  return options;
}
MotorTrafficOptions five_volts_fail() {
  MotorTrafficOptions options = life(kTwoIcs);
  options.reset_one_in = 0;
  options.fail_every = 100;
  return options;
}
MotorTrafficOptions by_macro() {
  MotorTrafficOptions options = life(kWithMacroIc);
  options.macro_drives = true;
  return options;
}

class ChipsUnderMotors : public ::testing::TestWithParam<MotorLife> {};

TEST_P(ChipsUnderMotors, AreTheBoardAtEveryTick) {
  const MotorTrafficOptions& options = GetParam().options;
  auto board = chips_beside_board(options.ics);
  const unsigned source = options.macro_drives ? kMaxServoIcs : 0;
  const std::uint32_t fitted = options.ics & ~GetParam().pulled;
  board->filter = [&](BoardInputs& in) { keep_straps(in, fitted, false, source); };
  const Moves moves(*board);
  MotorTraffic traffic(random_seed(1), options);
  const auto enough = [&] {
    return board->counts().reads_by_ics >= 50 && moves.phase >= 20 && (options.fail_every == 0 || moves.trips != 0);
  };
  for (Tick end = ticks(); board->now() == 0 || (!enough() && end <= 20 * ticks()); end += ticks())
    ASSERT_NO_THROW(traffic.run(*board, end, 65'536));
  EXPECT_TRUE(enough()) << board->counts().reads_by_ics << " reads, PHASE moved " << moves.phase << " times, "
                        << moves.trips << " trips";
  EXPECT_THAT(board->chips().take_contention(), IsEmpty());
  EXPECT_EQ(board->counts().shared, 0u);
}
INSTANTIATE_TEST_SUITE_P(Lives, ChipsUnderMotors,
                         ::testing::Values(MotorLife{"TwoIcs", life(kTwoIcs)}, MotorLife{"ThreeIcs", life(kThreeIcs)},
                                           MotorLife{"OneIsPulled", life(kTwoIcs), 0x2},
                                           MotorLife{"ByMacroIc", by_macro()},
                                           MotorLife{"FiveVoltsFail", five_volts_fail()}),
                         [](const auto& life) { return std::string(life.param.name); });

// All the other pins, with cycles that no bus master makes among them: where two chips drive D, D is not compared.
TEST(Chips, AreTheBoardUnderTrafficOnAllPins) {
  for (const bool outside : {false, true}) {
    auto board = chips_beside_board(kTwoIcs, ChipFault::kNone, 5);
    board->filter = [&](BoardInputs& in) { keep_straps(in, kTwoIcs, outside, 1); };
    const Moves moves(*board);
    BoardTraffic traffic(random_seed(outside ? 3 : 2));
    const auto enough = [&] { return board->counts().reads_by_ics >= 50 && moves.phase >= 20; };
    for (Tick end = ticks(); board->now() == 0 || (!enough() && end <= 20 * ticks()); end += ticks())
      ASSERT_NO_THROW(traffic.run(*board, end)) << "outside " << outside;
    EXPECT_TRUE(enough()) << board->counts().reads_by_ics << " reads, PHASE moved " << moves.phase << " times";
    EXPECT_THAT(board->chips().take_contention(), Each(StartsWith("D:"))) << "outside " << outside;
  }
}

// With power off servo IC 1 is pulled, and its strap at the board's chip; then put back. Its words read 0 meanwhile,
// and somebody drives them.
TEST(Chips, AreTheBoardWhileAnIcIsPulled) {
  auto board = chips_beside_board(kTwoIcs);
  BoardInputs in;
  unsigned by_ics = 0;
  for (const bool pulled : {false, true, false}) {
    in.fitted = pulled ? 1u : kTwoIcs;
    switch_on(*board, in);
    write(*board, in, kControl1, 0x000003);
    EXPECT_EQ(read(*board, in, kControl1), pulled ? 0u : 3u);
    EXPECT_EQ(read(*board, in, kClock1), pulled ? 0u : 0x3038D2u);
    by_ics += pulled ? 0u : 2u;
    EXPECT_EQ(board->counts().reads_by_ics, by_ics);
  }
}

// Servo IC 1 becomes a second source: PHASE and SERVO have two drivers, which each chip's own clocks tell apart.
TEST(Chips, ContentionOfTheClocksIsReported) {
  Chips chips(kTwoIcs, 0);
  BoardInputs in;
  switch_on(chips, in);
  write(chips, in, kClock0, 0x0008D2);
  run(chips, 60'000);
  EXPECT_THAT(chips.take_contention(), IsEmpty());
  write(chips, in, kPwm1, 0x100000);  // another period
  write(chips, in, kClock1, 0x0008D2);
  run(chips, 150'000);
  EXPECT_THAT(chips.take_contention(),
              UnorderedElementsAre(MatchesRegex("PHASE: servo_ic0 [01] servo_ic1 [01] at tick [0-9]+"),
                                   MatchesRegex("SERVO: servo_ic0 [01] servo_ic1 [01] at tick [0-9]+")));
}

TEST(Chips, ArePulledWithPowerOffOnly) {
  Chips chips(kTwoIcs, 0);
  BoardInputs in;
  switch_on(chips, in);
  in.fitted = 1;
  EXPECT_THROW(chips.set_inputs(in), std::logic_error);
}

// What is wrong with a chip or the board around it is found, at the pin that shows it.
struct Fault {
  const char* name;
  ChipFault fault;
  const char* shown;
};
class ChipsWithAFault : public ::testing::TestWithParam<Fault> {};

TEST_P(ChipsWithAFault, AreNotTheBoard) {
  MotorTrafficOptions options = life(kTwoIcs);
  options.fail_every = 300;
  options.reset_one_in = 0;
  auto board = chips_beside_board(kTwoIcs, GetParam().fault);
  const std::uint32_t fitted = GetParam().fault == ChipFault::kStrapLeft ? 1 : kTwoIcs;
  board->filter = [&](BoardInputs& in) {
    keep_straps(in, fitted, false, 0);
    in.line_select = 0x951;  // EQU1, EQU5 are lines of the interrupt controller
  };
  try {
    MotorTraffic(random_seed(1), options).run(*board, 2'000'000);
    FAIL() << "not found";
  } catch (const LockstepDifference& e) { EXPECT_THAT(e.what(), ContainsRegex(GetParam().shown)); }
}
INSTANTIATE_TEST_SUITE_P(
    Planted, ChipsWithAFault,
    ::testing::Values(Fault{"WrongNumber", ChipFault::kWrongNumber,
                            "bus.rdata_oe: board_top \\$1, chips \\$0|servo_ic1"},
                      Fault{"PhaseNeverTurns", ChipFault::kPhaseNeverTurns, "clock.phase: board_top \\$0, chips \\$1"},
                      Fault{"ServoNeverTurns", ChipFault::kServoNeverTurns, "clock.servo: board_top \\$0, chips \\$1"},
                      Fault{"LateClocks", ChipFault::kLateClocks, "clock.(phase|servo): board_top"},
                      Fault{"LateReset", ChipFault::kLateReset, "servo_ic[01]"},
                      Fault{"NoTrip", ChipFault::kNoTrip, "servo_ic1"},
                      Fault{"SwappedEqu", ChipFault::kSwappedEqu, "host.pic.sig: board_top"},
                      Fault{"StrapLeft", ChipFault::kStrapLeft, "bus.rdata_oe: board_top \\$1, chips \\$0"}),
    [](const auto& fault) { return std::string(fault.param.name); });

}  // namespace
}  // namespace brick
