// Timers to the SCLK: T1 and T2 at a latch of SERVO, the sign of a turn, and the times of an MLDT (servo-ic:5.2,
// servo-ic:5.5, servo-ic:5.6). A count shows itself at its own edge, by EQU.
#include <set>

#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelTimerTest : public ChannelTest {
 protected:
  // Lets the condition become true, one tick at a time; the tick of the edge that did it.
  template <class Condition>
  Tick edge_of(Condition condition, Tick limit = 100'000) {
    const Tick end = rig_.now() + limit;
    while (!condition() && rig_.now() < end) rig_.tick();
    EXPECT_LT(rig_.now(), end);
    return rig_.now();
  }
  Tick servo_falls() {
    edge_of([&] { return rig_.pins().servo; });
    return edge_of([&] { return !rig_.pins().servo; });
  }
  // The next count turns EQU.
  void watch_count() {
    const std::uint32_t here = static_cast<std::uint32_t>(counter(1)) & 0xFFFFFF;
    rig_.write(1, words::kCompareA, here);
    rig_.write(1, words::kCompareB, here + 0x400000);
  }
  std::uint32_t timer1() { return rig_.peek(1, words::kTimer1); }
  std::uint32_t timer2() { return rig_.peek(1, words::kTimer2); }
};

// The latch acts at the first edge of clk_ref after that of SERVO and takes what stands before it: T2 has counted the
// SCLK edges since the count, that of the latch not among them. A phase of 203 ticks meets each place in the 12 of
// SCLK.
TEST_F(ChannelTimerTest, T2IsLatchedAtTheReferenceEdgeAfterTheFallOfServo) {
  control(1, kX4);
  watch_count();
  const bool before = bool{equ(1)};
  step(1, true, 0);
  const Tick count = edge_of([&] { return bool{equ(1)} != before; });
  servo_falls();
  rig_.ticks(kTicksPerRef);
  for (int i = 0; i < 24; ++i) {
    const std::uint32_t old = timer2();
    const Tick fall = servo_falls();
    const Tick latch = (fall / kTicksPerRef + 1) * kTicksPerRef;
    EXPECT_EQ(timer2(), old) << "not before";
    rig_.ticks(latch - fall);
    EXPECT_EQ(timer2(), static_cast<std::uint32_t>((latch - 1 - count) / kSclk)) << "SERVO fell at " << fall - count;
  }
}

// A clock from outside passes two flip-flops, so its fall is one inside at the third edge; the words are latched at the
// edge of clk_ref after that.
TEST_F(ChannelTimerTest, ClocksFromOutsideLatchAtTheReferenceEdgeAfterTheThirdTick) {
  control(1, kX4);
  rig_.write(ic_words::kClockControl, ic_words::kClockControl.reset);
  rig_.ticks(6 * kPhase);
  for (Tick phase = 0; phase < 2 * kTicksPerRef; ++phase) {
    step(1, true, kHold + phase);
    const std::uint32_t old_phase = rig_.peek(1, words::kPhasePosition),
                        old_servo = rig_.peek(1, words::kServoPosition);
    rig_.in.phase = rig_.in.servo = false;
    const Tick latch = ((rig_.now() + 3) / kTicksPerRef + 1) * kTicksPerRef;
    EXPECT_EQ(edge_of([&] { return rig_.peek(1, words::kPhasePosition) != old_phase; }), latch);
    EXPECT_NE(rig_.peek(1, words::kServoPosition), old_servo);
    rig_.in.phase = rig_.in.servo = true;
    step(1, true, kHold + phase);
    rig_.in.phase = false;
    rig_.ticks(30);
    rig_.in.phase = true;
    const std::uint32_t old = rig_.peek(1, words::kServoPosition);
    rig_.in.servo = false;
    const Tick second = ((rig_.now() + 3) / kTicksPerRef + 1) * kTicksPerRef;
    EXPECT_EQ(edge_of([&] { return rig_.peek(1, words::kServoPosition) != old; }), second);
    rig_.in.servo = true;
  }
}

// Bit 23 tells that this count went the other way than the one before it.
TEST_F(ChannelTimerTest, T1IsTheTimeBetweenTheLastTwoCountsWithTheTurnInBit23) {
  control(1, kX4);
  constexpr std::uint32_t kRest = 30;  // SCLK, more than a servo period
  steps(1, 2, true, kRest * kSclk);
  struct Row {
    bool up;
    std::uint32_t periods;
    bool turned;
  };
  for (const Row& row : {Row{true, 41, false}, Row{false, 57, true}, Row{false, 100, false}, Row{true, 33, true},
                         Row{true, 64, false}}) {
    rig_.ticks((row.periods - kRest) * kSclk);
    step(1, row.up, kRest * kSclk);
    EXPECT_EQ(timer1(), row.periods | (row.turned ? 0x800000u : 0u));
  }
}

// Both timers stand still at their end, and T1 takes that.
TEST(ChannelTimerEnd, BothTimersStopAtTheirEnd) {
  ChannelCounter counter;
  ChannelDecode::Result count;
  count.count = true;
  constexpr std::uint32_t kEnd = 0x7FFFFF;
  for (const std::uint32_t periods : {kEnd - 2, kEnd - 1, kEnd, kEnd + 6}) {
    counter.skip(periods);
    counter.latch_servo();
    EXPECT_EQ(counter.servo_t2(), std::min(periods, kEnd));
    counter.sclk(count, false);
    counter.latch_servo();
    EXPECT_EQ(counter.servo_t1(), std::min(periods + 1, kEnd));
    EXPECT_EQ(counter.servo_t2(), 0u);
  }
}

// --- Hardware 1/T

// Y:+0 and Y:+1 take no fraction while 1/T is off.
TEST_F(ChannelTimerTest, FractionsAreWrittenWithHardware1TOnly) {
  control(1, kX4);
  rig_.write(1, words::kTimer1, 0xABC);
  rig_.write(1, words::kTimer2, 0xDEF);
  control(1, kX4 | kFine);
  EXPECT_EQ(timer1() & 0xFFF, 0u);
  EXPECT_EQ(timer2() & 0xFFF, 0u);
  rig_.write(1, words::kTimer1, 0xABC);
  rig_.write(1, words::kTimer2, 0xDEF);
  EXPECT_EQ(timer1() & 0xFFF, 0xABCu) << "of compare B";
  EXPECT_EQ(timer2() & 0xFFF, 0xDEFu) << "of compare A";
}

// 26 edges of clk_ref after a count the fraction is floor(4096 T2 / T1), at every latch. T1 is 40 SCLK; a step begins
// at an edge of SCLK, of which the third after it counts.
TEST_F(ChannelTimerTest, FractionIsTheQuotientFrom26ReferenceEdgesOn) {
  constexpr Tick kT1 = 40;
  control(1, kX4 | kFine);
  rig_.in.pins[1] ^= 1u << kUser;
  edge_of([&] { return bool{status(2, status_bit::kUser)}; });
  int seen = 0;
  for (int i = 0; i < 20; ++i) {
    const Tick count = rig_.now() + 3 * kSclk, end = rig_.now() + kT1 * kSclk;
    step(1, true, 0);
    while (rig_.now() < end) {
      const bool servo = rig_.pins().servo;
      rig_.tick();
      const Tick latch = (rig_.now() / kTicksPerRef + 1) * kTicksPerRef;
      if (i < 2 || !servo || rig_.pins().servo || latch - count < 26 * kTicksPerRef || latch >= end) continue;
      rig_.ticks(latch - rig_.now());
      const auto t2 = static_cast<std::uint32_t>((latch - kTicksPerRef - 1 - count) / kSclk);
      EXPECT_EQ(fine2::kServo.get(timer2()), 4096 * t2 / kT1) << "T2 " << t2;
      ++seen;
    }
  }
  EXPECT_GT(seen, 20);
}

// SCLK as fast as clk_ref: e is 0 for the 13 edges of the division, whose periods are made up two at a time until the
// last of the 26, and what is latched is e as of the edge before, so of T2 - 1 (servo-ic:5.7/3). Nearly T1 is left over
// of 4096 for either T1: both of two periods carry.
TEST_F(ChannelTimerTest, FractionIsTheQuotientWithTheFastestSclkToo) {
  constexpr Tick kCounts = 3 * kTicksPerRef;  // behind a change of the pins at an edge
  rig_.write(ic_words::kClockControl, ic_words::clock_control::kSclkDivider.set(kServoEachPhase, 0));
  control(1, kX4 | kFine);
  for (const Tick t1 : {Tick{41}, Tick{79}}) {  // 4096 = 99 * 41 + 37 = 51 * 79 + 67
    std::set<Tick> seen;
    rig_.ref();
    for (int i = 0; i < 150; ++i) {
      const Tick count = rig_.now() + kCounts, end = rig_.now() + t1 * kTicksPerRef;
      step(1, true, 0);
      while (rig_.now() < end) {
        const bool servo = rig_.pins().servo;
        rig_.tick();
        const Tick latch = (rig_.now() / kTicksPerRef + 1) * kTicksPerRef;
        if (i < 2 || !servo || rig_.pins().servo || latch <= count || latch >= end) continue;
        rig_.ticks(latch - rig_.now());
        const Tick t2 = (latch - count) / kTicksPerRef - 1;
        const Tick added = std::max(Tick{0}, std::min(2 * (t2 - 13), t2 - 1));
        EXPECT_EQ(fine2::kServo.get(timer2()), static_cast<std::uint32_t>(4096 * added / t1))
            << "T1 " << t1 << ", T2 " << t2;
        seen.insert(t2);
      }
    }
    // Edges 1 to T1 - 4 of 150 periods whose phases to SERVO differ: half of them at least.
    EXPECT_GE(static_cast<Tick>(seen.size()), (t1 - 4) / 2);
  }
}

// Each rest is longer than T1, the time between the counts before it, so the fraction is full; but none is known after
// a turn, until the next count.
TEST_F(ChannelTimerTest, FractionIsNoneAfterATurn) {
  const auto rest = [&](bool up, Tick periods) {
    step(1, up, periods * kSclk);
    return fine2::kServo.get(timer2());
  };
  control(1, kX4 | kFine);
  steps(1, 3, true, 40 * kSclk);
  EXPECT_EQ(rest(true, 100), 4095u);
  EXPECT_EQ(rest(false, 100), 4095u) << "downwards 4095 - e: the end at which it came in";
  EXPECT_EQ(rest(false, 200), 0u);
  EXPECT_EQ(rest(true, 300), 0u) << "upwards e";
  EXPECT_EQ(rest(true, 500), 4095u);
}

// 1/T comes on an edge of clk_ref before a count, at its edge, and one behind it. Where it was off at the edge of the
// count there is no fraction until the next one (servo-ic:5.7/1).
TEST_F(ChannelTimerTest, ACountBeforeHardware1TCameOnHasNoFraction) {
  for (const Tick behind : {-kTicksPerRef, Tick{0}, kTicksPerRef}) {
    control(1, kX4);
    steps(1, 3, true, 40 * kSclk);
    const bool before{status(2, status_bit::kUser)};
    rig_.in.pins[1] ^= 1u << kUser;
    edge_of([&] { return bool{status(2, status_bit::kUser)} != before; });  // an SCLK; the third after it counts
    step(1, true, 3 * kSclk + behind - kTicksPerRef);
    control(1, kX4 | kFine);
    rig_.ticks(100 * kSclk);
    EXPECT_EQ(fine2::kServo.get(timer2()), behind < 0 ? 4095u : 0u) << behind << " ticks behind the count";
  }
}

// Both clocks are inputs behind a reset: SERVO does not fall, so what shows is what the reset left.
TEST_F(ChannelTimerTest, AResetEmptiesTheServoFraction) {
  control(1, kX4 | kFine);
  steps(1, 4, true, 100 * kSclk);
  ASSERT_NE(fine2::kServo.get(timer2()), 0u);
  rig_.reset();
  control(1, kX4 | kFine);
  EXPECT_EQ(timer2(), 0u);
}

// Nothing has been counted behind a reset. The first SCLK comes with the first edge of clk_ref, then one each 12 ticks;
// SERVO from outside is latched 6 ticks behind the reset, and 129 later, when SCLK comes for the twelfth time.
TEST_F(ChannelTimerTest, BothBeginWithTheReset) {
  steps(1, 4, true, 100 * kSclk);
  rig_.reset();
  rig_.in.servo = false;
  rig_.ticks(3 + 2 * kTicksPerRef);
  EXPECT_EQ(timer1(), 0u);
  EXPECT_EQ(timer2(), 1u);
  rig_.in.servo = true;
  rig_.ticks(10 * kSclk);
  rig_.in.servo = false;
  rig_.ticks(3 + 2 * kTicksPerRef);
  EXPECT_EQ(timer1(), 0u) << "there has been no count";
  EXPECT_EQ(timer2(), 11u);
}

TEST_F(ChannelTimerTest, CaptureWithACountTakesTheEndOfTheCellAtWhichItCameIn) {
  control(1, kX4 | kFine | kFlag);
  for (const bool up : {true, false, true, true, false, false}) {
    pin(1, kHmfl, false, 60 * kSclk);
    rig_.read(1, words::kFlagPosition);
    rig_.pin(1, kHmfl, true);
    step(1, up, kHold);
    EXPECT_TRUE(status(1, status_bit::kCaptured));
    EXPECT_EQ(fine1::kCaptured.get(timer1()), up ? 0u : 4095u);
    EXPECT_EQ(rig_.peek(1, words::kFlagPosition), static_cast<std::uint32_t>(counter(1)) & 0xFFFFFF);
  }
}

// --- MLDT

class ChannelMldtTest : public ChannelTimerTest {
 protected:
  void SetUp() override {
    ChannelTest::SetUp();
    rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 4));
    rig_.write(1, words::kOutC, 0x4000);  // a pulse every 1024 PFM_CLK
    control(1, decode_mode(regs::decode::kMldt) | kPfm);
  }
  // The rise of a pulse: an edge of PFM_CLK, which is one of SCLK too; the next SCLK finds it.
  Tick pulse() {
    edge_of([&] { return !rig_.other(kPulse, 1); });
    return edge_of([&] { return rig_.other(kPulse, 1); });
  }
  // The echo rises so many ticks after the pulse. Returns T1.
  std::uint32_t echo(Tick after) {
    pulse();
    rig_.ticks(after);
    pin(1, kA, true, kHold);
    pin(1, kA, false, 3 * kPhase);
    return timer1();
  }
};

// The pulse rises at SCLK edge 0 and is found by edge 1. A level that stands at the pin 3 ticks before edge n is
// sampled by it, shown by n + 1 and found by n + 2: k = n + 1, T1 = n. One tick later it is the next edge's.
TEST_F(ChannelMldtTest, T1IsOneLessThanTheSclkPeriodsFromPulseToEcho) {
  for (const std::uint32_t n : {20u, 21u, 300u, 450u, 900u}) {
    EXPECT_EQ(echo(n * kSclk - 3), n);
    EXPECT_EQ(echo(n * kSclk - 2), n + 1);
  }
}

TEST_F(ChannelMldtTest, TurnIsNotShownNothingCountsAndT2RunsOnWithoutAnEcho) {
  control(1, kX4);
  step(1, true, 20 * kSclk);
  step(1, false, 20 * kSclk);
  ASSERT_EQ(timer1() >> 23, 1u);
  const int position = counter(1);
  control(1, decode_mode(regs::decode::kMldt) | kPfm);
  EXPECT_EQ(echo(50 * kSclk - 3), 50u) << "bit 23 is 0";
  EXPECT_EQ(counter(1), position);
  pulse();
  const Tick last = pulse();
  rig_.write(1, words::kOutC, 0);  // no more pulses
  rig_.ticks(3 * kPhase);
  EXPECT_EQ(timer1(), 50u) << "pulses without an echo";
  const Tick latch = (servo_falls() / kTicksPerRef + 1) * kTicksPerRef;
  rig_.ticks(latch - rig_.now());
  EXPECT_EQ(timer2(), static_cast<std::uint32_t>((latch - 1 - (last + kSclk)) / kSclk))
      << "0 at the edge that found it";
}

// Nor is one left of the counts before, echo or none: e is 0, at the end of the cell at which they came in.
TEST_F(ChannelMldtTest, HasNoFraction) {
  for (const bool up : {true, false}) {
    control(1, kX4 | kFine);
    steps(1, 4, up, 100 * kSclk);
    const std::uint32_t none = up ? 0 : 4095;
    ASSERT_NE(fine2::kServo.get(timer2()), none) << "it has one by now";
    control(1, decode_mode(regs::decode::kMldt) | kPfm | kFine);
    rig_.ticks(3 * kPhase);
    EXPECT_EQ(fine2::kServo.get(timer2()), none) << (up ? "up" : "down") << ", no echo yet";
    for (int i = 0; i < 3; ++i) {
      echo(50 * kSclk);
      EXPECT_EQ(fine2::kServo.get(timer2()), none) << (up ? "up" : "down");
    }
  }
}

// A counter that is held at 0 has none either, then and until the next count behind.
TEST_F(ChannelMldtTest, NorHasAHeldCounter) {
  for (const bool up : {true, false}) {
    control(1, kX4 | kFine);
    steps(1, 4, up, 100 * kSclk);
    const std::uint32_t none = up ? 0 : 4095;
    ASSERT_NE(fine2::kServo.get(timer2()), none) << "it has one by now";
    for (const std::uint32_t word : {kX4 | kFine | kCounterReset, kX4 | kFine}) {
      control(1, word);
      rig_.ticks(100 * kSclk + 3 * kPhase);
      EXPECT_EQ(fine2::kServo.get(timer2()), none) << (up ? "up" : "down") << (word == (kX4 | kFine) ? ", let go" : "");
    }
    steps(1, 2, up, 100 * kSclk);
    EXPECT_NE(fine2::kServo.get(timer2()), none) << "counts have one again";
  }
}

// Into MLDT and out of it again seven reference edges later, at any edge of the division and of the catching up behind
// a count and before it: from a change that meets an estimate on there is none until the next count.
TEST_F(ChannelMldtTest, ComesAndGoesAtAnyEdgeOfTheDivision) {
  for (Tick at = 0; at <= 40; ++at) {
    SCOPED_TRACE(at);
    control(1, kX4 | kFine);
    steps(1, 3, true, 40 * kSclk);
    step(1, true, kHold - 5 * kSclk + at * kTicksPerRef);
    control(1, decode_mode(regs::decode::kMldt) | kFine);
    rig_.ticks(7 * kTicksPerRef);
    control(1, kX4 | kFine);
    rig_.ticks(3 * kPhase);
    if (at * kTicksPerRef >= 2 * kSclk) { EXPECT_EQ(fine2::kServo.get(timer2()), 0u) << "the count was there"; }
    step(1, true, 40 * kSclk);
    step(1, true, 40 * kSclk + 3 * kPhase);
    EXPECT_EQ(fine2::kServo.get(timer2()), 4095u) << "the next count has had its time";
    ASSERT_EQ(rig_.difference, "");
  }
}

// A second echo of one pulse: T2 has run on from the same pulse.
TEST_F(ChannelMldtTest, EveryEchoOfAPulseIsTimedFromIt) {
  pulse();
  rig_.ticks(100 * kSclk - 3);
  pin(1, kA, true, 40 * kSclk);
  pin(1, kA, false, 60 * kSclk);
  pin(1, kA, true, 3 * kPhase);
  EXPECT_EQ(timer1(), 200u);
}

}  // namespace
}  // namespace brick
