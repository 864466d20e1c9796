// Clocks, watchdog and register decoding of the whole board through its pins, the same expectations on both engines.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/board/words.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/servo_ic/clock_words.h"

namespace brick {
namespace {

constexpr std::uint32_t kTwoIcs = 0x3, kFourIcs = 0xF;  // as BoardInputs::fitted
constexpr std::uint32_t kExternalSource = 30;
// A clock pin is released within one SERVO period and taken within one more; of PHASE and SERVO periods at reset
// values.
constexpr Tick kHandOver = 3 * 4 * 13057;

class BoardOn : public ::testing::TestWithParam<bool> {
 protected:
  static BoardRig board_with(std::uint32_t ics) {
    return BoardRig(GetParam() ? make_rtl_board(ics) : make_model_board(ics), ics);
  }
  BoardRig rig = board_with(kTwoIcs);
};
INSTANTIATE_TEST_SUITE_P(Engines, BoardOn, ::testing::Values(true, false),
                         [](const auto& engine) { return std::string(engine.param ? "Rtl" : "Model"); });

TEST_P(BoardOn, ClocksIdleHighWithNoSource) {
  EXPECT_EQ(rig.get(pin::kPhaseSource), kNoSource);
  for (int i = 0; i < 20; ++i) {
    rig.run(5000);
    EXPECT_EQ(rig.get(pin::kPhase), 1u);
    EXPECT_EQ(rig.get(pin::kServo), 1u);
  }
}

TEST_P(BoardOn, EveryServoIcIsAtItsAddress) {
  BoardRig four = board_with(kFourIcs);
  const std::uint32_t bases[] = {0x78000, 0x78100, 0x78200, 0x78300};
  for (std::uint32_t i = 0; i < 4; ++i) four.write(true, bases[i] + kAdcStrobe, 0x111111 * (i + 1));
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(four.read(true, bases[i] + kAdcStrobe), 0x111111 * (i + 1));
  EXPECT_EQ(four.read(true, bases[0] + kClockWord), 0x3038D2u);
  EXPECT_EQ(four.read(false, bases[0] + kClockWord), 0u) << "the Y word belongs to a channel";
}

TEST_P(BoardOn, AbsentIcReadsZeroIgnoresWritesAndDoesNotDrive) {
  for (const std::uint32_t base : {0x78200u, 0x78120u, 0x79200u, 0x7B320u, 0x7A400u}) {
    rig.write(true, base + kAdcStrobe, 0xFFFFFF);
    EXPECT_EQ(rig.read(true, base + kAdcStrobe), 0u) << std::hex << base;
  }
  rig.in.fitted = kTwoIcs & ~1u;  // IC 0 is built but not fitted
  rig.apply();
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  EXPECT_EQ(rig.read(true, kServoIcBase[0] + kClockWord), 0u);
  EXPECT_EQ(rig.get(pin::kPhaseSource), kNoSource);
}

// The same for an IC that is taken out while it works: it keeps its registers, and none of its outputs reaches the
// board.
TEST_P(BoardOn, IcTakenOutWhileItWorksNoLongerDrivesClocksDataAndInterrupts) {
  constexpr std::uint32_t kControl = 5, kEquHigh = 0x1800;  // EQU initial state 1, write enable
  for (const std::uint32_t ic : {0u, 1u}) {
    const std::uint32_t other = 1 - ic;
    rig.in.fitted = kTwoIcs;
    rig.in.line_select = 0x951;  // IR5: EQU1, IR6: EQU5
    rig.apply();
    rig.write(true, kServoIcBase[other] + kClockWord, clock_word(0, 3, 3));
    rig.write(true, kServoIcBase[ic] + kClockWord, clock_word(0, 3, 0));
    for (const std::uint32_t base : {kServoIcBase[0], kServoIcBase[1]}) rig.write(true, base + kControl, kEquHigh);
    rig.run(kHandOver);
    ASSERT_EQ(rig.get(pin::kPhaseSource), ic);
    ASSERT_EQ(rig.get(pin::kPicSig) >> 5 & 3, 3u);
    rig.edge(pin::kServo, 0);  // PHASE and SERVO are low

    rig.in.fitted = kTwoIcs & ~(1u << ic);
    rig.apply();
    rig.run(12);
    EXPECT_EQ(rig.get(pin::kPhaseSource), kNoSource);
    EXPECT_EQ(rig.get(pin::kPicSig) >> 5 & 3, 1u << other) << "EQU of the IC that is left";
    EXPECT_EQ(rig.read(true, kServoIcBase[ic] + kAdcStrobe), 0u);
    EXPECT_EQ(rig.read(true, kServoIcBase[ic] + kControl), 0u);
    rig.write(true, kServoIcBase[ic] + kAdcStrobe, 0x123456);  // nobody listens
    BoardOutputs clocks = select_pins(pin::kPhase, pin::kServo);
    const BoardOutputs before = rig.board().outputs();
    EXPECT_TRUE(before.get(pin::kPhase) == 1 && before.get(pin::kServo) == 1);
    const Tick end = rig.now() + 5 * 13057;
    EXPECT_EQ(rig.board().run_until(end, clocks), end) << "the clocks idle high";

    // It ran on all the time, so with a second source of another frequency a conflict would show.
    rig.write(true, kServoIcBase[other] + kPwmWord, pwm_word(5000));
    rig.write(true, kServoIcBase[other] + kClockWord, clock_word(0, 3, 0));
    rig.run(kHandOver);
    EXPECT_EQ(rig.get(pin::kPhaseSource), other);
    EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
    const Tick rise = rig.edge(pin::kPhase, 1);
    EXPECT_EQ(rig.edge(pin::kPhase, 1) - rise, 10003);

    rig.write(true, kServoIcBase[other] + kClockWord, clock_word(0, 3, 3));
    rig.run(kHandOver);
    rig.in.fitted = kTwoIcs;
    rig.apply();
    rig.run(kHandOver);
    EXPECT_EQ(rig.read(true, kServoIcBase[ic] + kAdcStrobe), 0xFFFFFEu);
    EXPECT_EQ(rig.get(pin::kPhaseSource), ic);
    EXPECT_EQ(rig.get(pin::kPicSig) >> 5 & 3, 3u);
  }
}

TEST_P(BoardOn, TheIcWithDirectionZeroSuppliesTheWholeBoard) {
  BRICK_COVERS("I19-2 CLK-6");
  BoardRig four = board_with(kFourIcs);
  const struct {
    std::uint32_t base, index, max_count;
  } sources[] = {{0x78000, 0, 6527}, {0x78100, 1, 5000}, {0x78300, 3, 3000}, {0x78200, 2, 1473}};
  for (const auto& s : sources) {
    four.write(true, s.base + kPwmWord, pwm_word(s.max_count));
    four.write(true, s.base + kClockWord, clock_word(0, 3, 0));
    four.run(kHandOver);
    EXPECT_EQ(four.get(pin::kPhaseSource), s.index);
    EXPECT_EQ(four.get(pin::kSourceConflict), 0u);
    const Tick period = 2 * Tick{s.max_count} + 3;
    const Tick rise = four.edge(pin::kPhase, 1);
    EXPECT_EQ(four.edge(pin::kPhase, 1) - rise, period);
    const Tick fall = four.edge(pin::kServo, 0);
    EXPECT_EQ(four.edge(pin::kServo, 0) - fall, 4 * period);
    four.write(true, s.base + kClockWord, clock_word(0, 3, 3));
  }
  four.run(kHandOver);
  EXPECT_EQ(four.get(pin::kPhaseSource), kNoSource);
}

// servo-ic:1.3, servo-ic:6.2, servo-ic:7.2/5: MACRO IC 0 is at $078400 with 64 words of either space, none of them a
// servo IC's, and index 18 of the sources. Bit 0 of the kinds is its own.
TEST_P(BoardOn, AMacroIcHasItsPlaceItsKindAndItsClocks) {
  constexpr std::uint32_t kMacro = 0x78400, kClock = kMacro + 0x0C, kPwm = kMacro + 0x0D, kChannel = kMacro + 0x15;
  BoardRig five = board_with(0x4000F);
  const std::pair<bool, std::uint32_t> words[] = {{false, 0x00}, {false, 0x02}, {true, 0x0E},
                                                  {true, 0x0F},  {false, 0x0F}, {true, 0x15}};
  std::uint32_t value = 0x10101;
  for (const auto& [x, offset] : words) five.write(x, kMacro + offset, value++);
  value = 0x10101;
  for (const auto& [x, offset] : words) {
    EXPECT_EQ(five.read(x, kMacro + offset), value++) << offset;
    EXPECT_EQ(five.read(x, kMacro + 0x20 + offset), 0u) << "node registers are not built, " << offset;
  }
  for (const std::uint32_t ic : {0x78000u, 0x78100u, 0x78200u, 0x78300u}) {
    EXPECT_EQ(five.read(true, ic + kAdcStrobe), 0xFFFFFEu);
    EXPECT_EQ(five.read(true, ic + kPwmWord), 0x197F0Fu);
  }
  for (const std::uint32_t other : {0x79400u, 0x7A400u, 0x7B400u}) EXPECT_EQ(five.read(true, other + 0x0E), 0u);
  five.write(true, kPwm, pwm_word(300));
  for (const unsigned kinds : {0xFu, 0xEu}) {
    five.in.macro_gate = kinds;
    five.apply();
    five.run(3);
    EXPECT_EQ(five.read(true, kChannel), kinds == 0xF ? 0u : 0x10106u);
    five.write(true, kClock, clock_word(0, 3, 3));
    EXPECT_EQ(five.read(true, kClock), clock_word(0, 3, kinds == 0xF ? 1 : 3));
  }
  five.write(true, kClock, clock_word(0, 3, 0));
  five.run(60'000);  // past the period of the reset value, and the pins are taken with rising edges
  EXPECT_EQ(five.get(pin::kPhaseSource), 18u);
  EXPECT_EQ(five.get(pin::kSourceConflict), 0u);
  constexpr Tick kPhase = 2 * 300 + 3, kSoon = 10 * kPhase;
  const Tick rise = five.edge(pin::kPhase, 1, kSoon);
  EXPECT_EQ(five.edge(pin::kPhase, 1, kSoon) - rise, kPhase);
  const Tick fall = five.edge(pin::kServo, 0, kSoon);
  EXPECT_EQ(five.edge(pin::kServo, 0, kSoon) - fall, 4 * kPhase);
}

// The divider variables of an IC that is not the source are stored and have no effect.
TEST_P(BoardOn, DividersOfOtherIcsHaveNoEffect) {
  BRICK_COVERS("I19-2 CLK-6");
  rig.write(true, kServoIcBase[1] + kClockWord, clock_word(0, 3, 0));
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(7, 9, 3));
  rig.run(60'000);
  const Tick rise = rig.edge(pin::kPhase, 1);
  EXPECT_EQ(rig.edge(pin::kPhase, 1) - rise, 13057);
  EXPECT_EQ(rig.read(true, kServoIcBase[0] + kClockWord), clock_word(7, 9, 3));
}

// servo-ic:7.2: a conflict is a disagreement of more than 2 clk. IC 1 follows IC 0 five ticks behind, then makes the
// clocks of the same grid itself; the next turnaround finds PHASE high, so it takes the pin with the rise after that:
// the first tick at which the two differ is the fall of IC 0 after that, a tick after the third such it shows.
TEST_P(BoardOn, TwoDriversConflictWhenTheyHaveDisagreedForThreeTicks) {
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  for (int edges = 0; edges < 6; ++edges) rig.edge(pin::kPhase, 1);  // IC 1 is in step
  rig.run(100);
  rig.write(true, kServoIcBase[1] + kClockWord, clock_word(0, 3, 0));
  for (int rises = 0; rises < 2; ++rises) rig.edge(pin::kPhase, 1);
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u) << "both high: two drivers, no fight";
  const Tick first = rig.edge(pin::kPhase, 0) - kNetDelay;
  rig.run(3 - kNetDelay);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
  EXPECT_EQ(rig.edge(pin::kSourceConflict, 1, kHandOver) - first, 4);
  rig.run(100'000);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 1u) << "until there is one driver again";
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 3));
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
}

TEST_P(BoardOn, LowestNumberedOfTwoDriversWinsAndTheConflictShows) {
  rig.write(true, kServoIcBase[1] + kPwmWord, pwm_word(1000));
  rig.write(true, kServoIcBase[1] + kClockWord, clock_word(0, 3, 0));
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kPhaseSource), 0u);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 1u);
  const Tick rise = rig.edge(pin::kPhase, 1);
  EXPECT_EQ(rig.edge(pin::kPhase, 1) - rise, 13057);
  rig.write(true, kServoIcBase[1] + kClockWord, clock_word(0, 3, 3));
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
}

TEST_P(BoardOn, PhaseAndServoMayComeFromDifferentIcs) {
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 2));  // drives PHASE
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kServo), 1u) << "idle beside a PHASE that is driven";
  rig.write(true, kServoIcBase[1] + kClockWord, clock_word(0, 1, 1));  // drives SERVO from that PHASE
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kPhaseSource), 0u);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
  const Tick fall = rig.edge(pin::kServo, 0, kHandOver);
  EXPECT_EQ(rig.edge(pin::kServo, 0, kHandOver) - fall, 2 * 13057);
}

TEST_P(BoardOn, JumperE1TakesTheClocksFromOutside) {
  rig.in.ext_clock = true;
  rig.apply();
  rig.run(10);
  EXPECT_EQ(rig.get(pin::kPhaseSource), kExternalSource);
  rig.in.ext_phase = rig.in.ext_servo = false;
  rig.apply();
  rig.run(2);
  EXPECT_EQ(rig.get(pin::kPhase), 1u) << "in the synchroniser";
  rig.run(kNetDelay);
  EXPECT_EQ(rig.get(pin::kPhase), 0u);
  EXPECT_EQ(rig.get(pin::kServo), 0u);
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  EXPECT_EQ(rig.get(pin::kPhaseSource), kExternalSource);
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u) << "it does not take nets that are low";
  rig.in.ext_phase = rig.in.ext_servo = true;
  rig.apply();
  rig.run(kHandOver);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 1u);
}

// Two edges of clk_ref see the line high, then two of clk_pwm; the reference edge after those is the first that works.
// It takes the straps, the next one the drivers.
TEST_P(BoardOn, ResetIsLetGoInStepWithBothClocksAtWhateverTickTheLineRises) {
  rig.in.ext_clock = true;
  for (const Tick phase : {0, 1, 2}) {
    rig.in.rst_n = false;
    rig.apply();
    rig.run(1);
    EXPECT_EQ(rig.get(pin::kPhaseSource), kNoSource) << "at once";
    while (rig.now() % kTicksPerRef != phase) rig.run(1);
    const Tick seen = rig.now() - phase + kTicksPerRef, works = seen + kTicksPerRef + 2 + 1;
    rig.in.rst_n = true;
    rig.apply();
    EXPECT_EQ(rig.edge(pin::kPhaseSource, kExternalSource, 100), works + kTicksPerRef) << "line high after " << phase;
  }
}

TEST_P(BoardOn, HostSignalLatchReadsBackAndDrivesItsPins) {
  for (const std::uint32_t value : {0x1u, 0x2u, 0x4u, 0x8u, 0xFu, 0x0u}) {
    rig.write(true, kHostSignals, value);
    EXPECT_EQ(rig.get(pin::kIpos) | rig.get(pin::kBreq) << 1 | rig.get(pin::kEror) << 2 | rig.get(pin::kF1er) << 3,
              value);
    EXPECT_EQ(rig.read(true, kHostSignals), value);
  }
}

// A write takes place at the third clk_ref edge that sees /WR low (host-bus:2.6).
TEST_P(BoardOn, WriteTakesPlaceAtTheThirdReferenceEdge) {
  while (rig.now() % 3 != 0) rig.run(1);
  rig.in.pa_addr = kHostSignals;
  rig.in.pa_x = true;
  rig.in.pa_wdata = 2;
  rig.in.pa_wr_n = false;
  rig.apply();
  const Tick start = rig.now();
  EXPECT_EQ(rig.edge(pin::kBreq, 1, 100) - start, 9);
}

// A read takes its sample at the third that sees /RD low.
TEST_P(BoardOn, ReadDataIsThereAtTheThirdReferenceEdge) {
  while (rig.now() % 3 != 0) rig.run(1);
  rig.in.pa_addr = 0x7801C;
  rig.in.pa_x = true;
  rig.in.pa_aa = 2;
  rig.in.pa_rd_n = false;
  rig.apply();
  const Tick start = rig.now();
  EXPECT_EQ(rig.edge(pin::kPaData, 0x197F0F, 100) - start, 9);
}

// 960 periods of 39.3216 MHz / 1024 are 25 ms. Both timers start at reset; the clock of the timers is free-running.
TEST_P(BoardOn, WatchdogTripsAfter25MsWithoutStrobe) {
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  EXPECT_EQ(rig.edge(pin::kWdTripped, 1),
            960 * 1024 * 3 + 12);  // clk_ref edges count from tick 15
  EXPECT_EQ(rig.get(pin::kWdo), 1u);
}

TEST_P(BoardOn, WatchdogIsHeldByStrobesAndServoEdgesAndTripsWithoutEither) {
  constexpr Tick kMs = kPwmClockHz / 1000;
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  for (int i = 0; i < 3; ++i) {
    rig.run(24 * kMs);
    rig.write(true, kWatchdogStrobe, 0);
    EXPECT_EQ(rig.get(pin::kWdTripped), 0u);
  }
  // Servo clock gone, strobes go on.
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 3));
  const Tick stopped = rig.now();
  for (int i = 0; i < 4 && rig.get(pin::kWdTripped) == 0; ++i) {
    rig.board().run_until(rig.now() + 8 * kMs, select_pins(pin::kWdTripped));
    if (rig.get(pin::kWdTripped) == 0) rig.write(true, kWatchdogStrobe, 0);
  }
  EXPECT_EQ(rig.get(pin::kWdTripped), 1u);
  EXPECT_GE(rig.now() - stopped, 24 * kMs);
  EXPECT_LE(rig.now() - stopped, 25 * kMs);
  // Only reset recovers.
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  rig.write(true, kWatchdogStrobe, 0);
  rig.run(kMs);
  EXPECT_EQ(rig.get(pin::kWdTripped), 1u);
  rig.in.rst_n = false;
  rig.apply();
  rig.run(1);
  EXPECT_EQ(rig.get(pin::kWdTripped), 0u);
}

// The timer counts a free-running clock, so it runs 959 to 960 periods of 1024 clk_ref after the strobe.
TEST_P(BoardOn, WatchdogRunsTwentyFiveMillisecondsFromTheLastStrobe) {
  constexpr Tick kPeriod = 1024 * 3;
  rig.write(true, kServoIcBase[0] + kClockWord, clock_word(0, 3, 0));
  for (const Tick pause : {Tick{1'000'000}, 300 * kPeriod + 17}) {
    rig.run(pause);
    rig.write(true, kWatchdogStrobe, 0);
  }
  const Tick strobe = rig.now();
  const Tick trip = rig.edge(pin::kWdTripped, 1);
  EXPECT_GT(trip - strobe, 959 * kPeriod - 30) << "30: the strobe's own bus cycle";
  EXPECT_LE(trip - strobe, 960 * kPeriod);
}

// Either edge of SERVO counts: the last one here is a fall, 10 ms after the rise.
TEST_P(BoardOn, WatchdogCountsFromTheLastServoEdgeOfEitherDirection) {
  constexpr Tick kMs = kPwmClockHz / 1000;
  rig.in.ext_clock = true;
  for (const bool level : {false, true, false}) {
    rig.in.ext_servo = level;
    rig.apply();
    rig.run(10 * kMs);
    rig.write(true, kWatchdogStrobe, 0);
  }
  const Tick last_edge = rig.now() - 10 * kMs;
  const Tick trip = rig.edge(pin::kWdTripped, 1);
  EXPECT_GE(trip - last_edge, 24 * kMs);
  EXPECT_LE(trip - last_edge, 25 * kMs);
}

}  // namespace
}  // namespace brick
