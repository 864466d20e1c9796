// Input side of a channel: filter, decode modes, timers, hardware 1/T, flags.
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

TEST_F(ChannelTest, QuadratureModesCountOneTwoAndFourPerCycle) {
  const int factor[] = {1, 2, 4};
  for (unsigned mode = 1; mode <= 3; ++mode) {
    control(2, mode);
    const int start = counter(2);
    steps(2, 40, true);
    EXPECT_EQ(counter(2) - start, 10 * factor[mode - 1]) << "mode " << mode;
    steps(2, 60, false);
    EXPECT_EQ(counter(2) - start, -5 * factor[mode - 1]) << "mode " << mode;
    steps(2, 20, true);
  }
}

TEST_F(ChannelTest, CounterClockwiseModesCountTheOtherWay) {
  const int counts[] = {-5, -10, -20};
  for (unsigned mode = 5; mode <= 7; ++mode) {
    control(1, mode);
    const int start = counter(1);
    steps(1, 20, true);
    EXPECT_EQ(counter(1) - start, counts[mode - 5]) << "mode " << mode;
  }
}

TEST_F(ChannelTest, OnceACycleCountsOneEdgeSoThatJitterOverItNetsZero) {
  control(1, 1);
  const int start = counter(1);
  for (int i = 0; i < 7; ++i) {
    step(1, true);
    EXPECT_EQ(counter(1) - start, 1);
    step(1, false);
    EXPECT_EQ(counter(1) - start, 0);
  }
}

TEST_F(ChannelTest, PulseAndDirectionCountsRisingEdgesOfA) {
  control(1, 0);
  rig_.pin(1, kB, true);
  rig_.ticks(kHold);
  const int start = counter(1);
  for (int i = 0; i < 5; ++i) {
    pin(1, kA, true);
    pin(1, kA, false);
  }
  EXPECT_EQ(counter(1) - start, 5);
  pin(1, kB, false);
  pin(1, kA, true);
  EXPECT_EQ(counter(1) - start, 4);
  control(1, 4);
  pin(1, kA, false);
  pin(1, kA, true);
  EXPECT_EQ(counter(1) - start, 5) << "counter-clockwise";
  EXPECT_FALSE(status(1, 8));
}

TEST_F(ChannelTest, HallModesCountSixPerCycleAndRefuseImpossibleCodes) {
  const unsigned abc[] = {4, 6, 2, 3, 1, 5};  // {C, B, A}, as {A, B, C}: 001 011 010 110 100 101
  for (unsigned mode : {11u, 15u}) {
    rig_.in.pins[2] = abc[0];
    rig_.ticks(kHold);
    control(3, mode);
    rig_.write(true, base(3), 0);
    const int start = counter(3);
    for (int i = 1; i <= 12; ++i) {
      rig_.in.pins[2] = abc[i % 6];
      rig_.ticks(kHold);
    }
    EXPECT_EQ(counter(3) - start, mode == 11 ? 12 : -12);
    EXPECT_FALSE(status(3, 8));
    rig_.in.pins[2] = 7;
    rig_.ticks(kHold);
    EXPECT_TRUE(status(3, 8));
    EXPECT_EQ(counter(3) - start, mode == 11 ? 12 : -12);
  }
}

TEST_F(ChannelTest, UnusedModesHoldTheCounter) {
  for (unsigned mode : {9u, 10u, 13u, 14u}) {
    control(1, mode);
    const int start = counter(1);
    steps(1, 9, true);
    EXPECT_EQ(counter(1), start) << "mode " << mode;
  }
}

TEST_F(ChannelTest, BothLinesInOneSclkCountNothingAndSetTheErrorUntilCleared) {
  control(1, 7);
  const int start = counter(1);
  EXPECT_FALSE(status(1, 8));
  rig_.in.pins[0] ^= 3;
  rig_.ticks(kHold);
  EXPECT_EQ(counter(1), start);
  EXPECT_TRUE(status(1, 8));
  place_[0] = 2;
  steps(1, 8, true);
  EXPECT_TRUE(status(1, 8)) << "latched";
  rig_.write(true, base(1), 0xFFFFFF);
  EXPECT_FALSE(status(1, 8));
  rig_.in.pins[0] ^= 3;
  rig_.ticks(kHold);
  EXPECT_TRUE(status(1, 8));
  control(1, 7 | 1 << 10);
  rig_.ref();
  EXPECT_FALSE(status(1, 8)) << "cleared by the counter reset";
  EXPECT_EQ(counter(1), 0);
}

TEST_F(ChannelTest, FilterStopsOneSampleAndPassesTwo) {
  control(1, 3);
  const int start = counter(1);
  for (Tick phase = 0; phase < kSclk; ++phase) {
    pin(1, kA, true, kSclk);  // one sample, wherever it falls
    pin(1, kA, false, kHold + phase + 1);
    EXPECT_EQ(counter(1), start);
    EXPECT_FALSE(status(1, 12));
    pin(1, kA, true, 2 * kSclk);
    rig_.pin(1, kA, false);
    rig_.ticks(3);
    bool seen = false;
    for (Tick t = 0; t < kHold; ++t) {
      rig_.tick();
      seen |= status(1, 12);
    }
    EXPECT_TRUE(seen);
  }
}

TEST_F(ChannelTest, EveryInputShowsInItsStatusBit) {
  control(4, 0x3);
  for (unsigned bit = 0; bit < 12; ++bit) {
    rig_.in.pins[3] = 1u << bit;
    rig_.ticks(kHold);
    EXPECT_EQ(rig_.peek(true, base(4)) >> 12, 1u << bit);
  }
}

TEST_F(ChannelTest, TimersMeasureTheLastTwoCounts) {
  control(1, 3);
  steps(1, 5, true, 100 * kSclk);
  EXPECT_EQ(rig_.peek(false, base(1)), 100u) << "T1";
  const std::uint32_t t2 = rig_.peek(false, base(1) + 1);
  EXPECT_GT(t2, 60u);  // latched by SERVO less than 40 SCLK ago
  EXPECT_LT(t2, 100u);
  EXPECT_EQ(rig_.peek(true, base(1) + 2) & 1, 0u) << "up";
  steps(1, 1, false, 100 * kSclk);
  EXPECT_EQ(rig_.peek(false, base(1)), 0x800000u | 100u) << "direction reversed";
  EXPECT_EQ(rig_.peek(true, base(1) + 2) & 1, 1u) << "down";
  EXPECT_EQ(rig_.peek(true, base(1) + 2) >> 1, static_cast<std::uint32_t>(counter(1)) & 0x7FFFFF);
}

TEST(ChannelTimers, SaturateInTheModel) {
  ChannelCounter counter;
  counter.skip(0x7FFFFE);
  counter.latch_servo();
  EXPECT_EQ(counter.servo_t2(), 0x7FFFFEu);
  counter.skip(100);
  counter.latch_servo();
  EXPECT_EQ(counter.servo_t2(), 0x7FFFFFu);
}

TEST_F(ChannelTest, MldtTimesTheEchoOfTheOwnPulse) {
  rig_.write(true, 0x1C, kMaxCount << 8 | 4);
  rig_.write(false, base(1) + 4, 0x4000);  // one pulse in 1024 PFM_CLK
  std::uint32_t t1[2];
  const Tick echo[2] = {300, 450};  // SCLK from the pulse to the echo
  control(1, 12 | 1 << 23);
  for (int i = 0; i < 2; ++i) {
    while (rig_.other(kPulse, 1)) rig_.tick();
    while (!rig_.other(kPulse, 1)) rig_.tick();
    rig_.ticks(echo[i] * kSclk);
    pin(1, kA, true);
    pin(1, kA, false, 3 * kPhase);
    t1[i] = rig_.peek(false, base(1));
  }
  EXPECT_EQ(t1[1] - t1[0], 150u);
  EXPECT_GE(t1[0], 300u);
  EXPECT_LE(t1[0], 305u) << "synchroniser and filter";
}

TEST_F(ChannelTest, InternalPulsesCountWithTheSignOfTheCommand) {
  control(1, 8 | 1 << 23);
  const int start = counter(1);
  rig_.write(false, base(1) + 4, 0x010000);  // every 256 PFM_CLK of 12 ticks
  rig_.ticks(10 * 256 * 12 + 600);
  rig_.write(false, base(1) + 4, 0);
  EXPECT_EQ(counter(1) - start, 10);
  rig_.write(false, base(1) + 4, 0xFF0000);
  rig_.ticks(20 * 256 * 12 + 600);
  rig_.write(false, base(1) + 4, 0);
  EXPECT_NEAR(counter(1) - start, -10, 1);
}

TEST_F(ChannelTest, Hardware1TFractionIsT2OverT1) {
  const std::uint32_t mode = 3, fine = 1 << 18;
  for (bool up : {true, false}) {
    for (Tick rest : {130, 333, 777, 990, 2500}) {
      control(1, mode | fine);
      steps(1, 3, up, 1000 * kSclk);
      step(1, up, rest * kSclk);
      const std::uint32_t fraction = rig_.peek(false, base(1) + 1) >> 12;
      rig_.in.phase = rig_.in.servo = true;
      control(1, mode);  // now the words show the timers latched with it
      const std::uint32_t t2 = rig_.peek(false, base(1) + 1), t1 = rig_.peek(false, base(1)) & 0x7FFFFF;
      EXPECT_EQ(t1, 1000u);
      const std::uint32_t e = std::min(4095u, 4096 * t2 / t1), before = std::min(4095u, 4096 * (t2 - 1) / t1);
      const std::uint32_t expected = up ? e : 4095 - e, earlier = up ? before : 4095 - before;
      EXPECT_TRUE(fraction == expected || fraction == earlier)
          << fraction << ", expected " << expected << ", T2 " << t2;
      rig_.ticks(1000 * kSclk);
    }
  }
}

TEST_F(ChannelTest, EncoderLossNeedsEqualPairsForTwoSamples) {
  for (unsigned bit : {kT, kV}) rig_.pin(1, bit, true);
  rig_.ticks(kHold);
  rig_.write(true, base(1), 0);
  rig_.ticks(kHold);
  EXPECT_FALSE(status(1, 7));
  rig_.pin(1, kU, true);
  rig_.ticks(kHold);
  EXPECT_TRUE(status(1, 7));
  rig_.write(true, base(1), 0x80);
  EXPECT_TRUE(status(1, 7)) << "writing 1 leaves it";
  rig_.write(true, base(1), 0);
  EXPECT_FALSE(status(1, 7));
  rig_.ticks(3 * kSclk);
  EXPECT_TRUE(status(1, 7)) << "the cause lasts";
  rig_.pin(1, kU, false);
  rig_.ticks(kHold);
  rig_.write(true, base(1), 0);
  rig_.pin(1, kW, true);
  rig_.ticks(kHold);
  EXPECT_TRUE(status(1, 7)) << "V = W";
}

TEST_F(ChannelTest, ResetDoesNotCountTheLevelsItFinds) {
  rig_.in.pins.fill(0xFFF);
  rig_.reset();
  rig_.write(true, 0x1C, kMaxCount << 8 | 15);
  rig_.write(true, 0x04, kOwnClocks & 0x0FFFFF);
  rig_.ticks(2 * 13057);
  EXPECT_EQ(counter(1), 0);
  EXPECT_EQ(rig_.peek(true, base(1)), 0xFFF000u | 0x80u | 0x08u)
      << "T = U is an encoder loss, de-multiplexing incomplete";
}

}  // namespace
}  // namespace brick
