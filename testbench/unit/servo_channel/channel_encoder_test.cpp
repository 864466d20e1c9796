// Input side of a channel: filter, decode modes, timers, hardware 1/T, flags.
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

TEST_F(ChannelTest, QuadratureModesCountOneTwoAndFourPerCycle) {
  const std::pair<regs::decode::Code, int> modes[] = {
      {regs::decode::kX1Cw, 1}, {regs::decode::kX2Cw, 2}, {regs::decode::kX4Cw, 4}};
  for (const auto& [mode, factor] : modes) {
    control(2, decode_mode(mode));
    const int start = counter(2);
    steps(2, 40, true);
    EXPECT_EQ(counter(2) - start, 10 * factor) << "mode " << mode;
    steps(2, 60, false);
    EXPECT_EQ(counter(2) - start, -5 * factor) << "mode " << mode;
    steps(2, 20, true);
  }
}

TEST_F(ChannelTest, CounterClockwiseModesCountTheOtherWay) {
  const std::pair<regs::decode::Code, int> modes[] = {
      {regs::decode::kX1Ccw, -5}, {regs::decode::kX2Ccw, -10}, {regs::decode::kX4Ccw, -20}};
  for (const auto& [mode, counts] : modes) {
    control(1, decode_mode(mode));
    const int start = counter(1);
    steps(1, 20, true);
    EXPECT_EQ(counter(1) - start, counts) << "mode " << mode;
  }
}

TEST_F(ChannelTest, OnceACycleCountsOneEdgeSoThatJitterOverItNetsZero) {
  control(1, decode_mode(regs::decode::kX1Cw));
  const int start = counter(1);
  for (int i = 0; i < 7; ++i) {
    step(1, true);
    EXPECT_EQ(counter(1) - start, 1);
    step(1, false);
    EXPECT_EQ(counter(1) - start, 0);
  }
}

TEST_F(ChannelTest, PulseAndDirectionCountsRisingEdgesOfA) {
  control(1, decode_mode(regs::decode::kPulseCw));
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
  control(1, decode_mode(regs::decode::kPulseCcw));
  pin(1, kA, false);
  pin(1, kA, true);
  EXPECT_EQ(counter(1) - start, 5) << "counter-clockwise";
  EXPECT_FALSE(status(1, status_bit::kEncoderError));
}

TEST_F(ChannelTest, HallModesCountSixPerCycleAndRefuseImpossibleCodes) {
  const unsigned abc[] = {4, 6, 2, 3, 1, 5};  // {C, B, A}, as {A, B, C}: 001 011 010 110 100 101
  for (const regs::decode::Code mode : {regs::decode::kHallCw, regs::decode::kHallCcw}) {
    rig_.in.pins[2] = abc[0];
    rig_.ticks(kHold);
    control(3, decode_mode(mode));
    rig_.write(3, words::kStatus, 0);
    const int start = counter(3);
    for (int i = 1; i <= 12; ++i) {
      rig_.in.pins[2] = abc[i % 6];
      rig_.ticks(kHold);
    }
    EXPECT_EQ(counter(3) - start, mode == regs::decode::kHallCw ? 12 : -12);
    EXPECT_FALSE(status(3, status_bit::kEncoderError));
    rig_.in.pins[2] = 7;
    rig_.ticks(kHold);
    EXPECT_TRUE(status(3, status_bit::kEncoderError));
    EXPECT_EQ(counter(3) - start, mode == regs::decode::kHallCw ? 12 : -12);
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
  control(1, decode_mode(regs::decode::kX4Ccw));
  const int start = counter(1);
  EXPECT_FALSE(status(1, status_bit::kEncoderError));
  rig_.in.pins[0] ^= 3;
  rig_.ticks(kHold);
  EXPECT_EQ(counter(1), start);
  EXPECT_TRUE(status(1, status_bit::kEncoderError));
  place_[0] = 2;
  steps(1, 8, true);
  EXPECT_TRUE(status(1, status_bit::kEncoderError)) << "latched";
  rig_.write(1, words::kStatus, 0xFFFFFF);
  EXPECT_FALSE(status(1, status_bit::kEncoderError));
  rig_.in.pins[0] ^= 3;
  rig_.ticks(kHold);
  EXPECT_TRUE(status(1, status_bit::kEncoderError));
  control(1, decode_mode(regs::decode::kX4Ccw) | kCounterReset);
  rig_.ref();
  EXPECT_FALSE(status(1, status_bit::kEncoderError)) << "cleared by the counter reset";
  EXPECT_EQ(counter(1), 0);
}

TEST_F(ChannelTest, FilterStopsOneSampleAndPassesTwo) {
  control(1, kX4);
  const int start = counter(1);
  for (Tick phase = 0; phase < kSclk; ++phase) {
    pin(1, kA, true, kSclk);  // one sample, wherever it falls
    pin(1, kA, false, kHold + phase + 1);
    EXPECT_EQ(counter(1), start);
    EXPECT_FALSE(status(1, status_bit::kCha));
    pin(1, kA, true, 2 * kSclk);
    rig_.pin(1, kA, false);
    rig_.ticks(3);
    bool seen = false;
    for (Tick t = 0; t < kHold; ++t) {
      rig_.tick();
      seen = seen || status(1, status_bit::kCha);
    }
    EXPECT_TRUE(seen);
  }
}

TEST_F(ChannelTest, EveryInputShowsInItsStatusBit) {
  control(4, kX4);
  for (unsigned bit = 0; bit < 12; ++bit) {
    rig_.in.pins[3] = 1u << bit;
    rig_.ticks(kHold);
    EXPECT_EQ(rig_.peek(4, words::kStatus) >> status_bit::kCha.lsb, 1u << bit) << "pin " << kChannelPinNames[bit];
  }
}

TEST_F(ChannelTest, TimersMeasureTheLastTwoCounts) {
  control(1, kX4);
  steps(1, 5, true, 100 * kSclk);
  EXPECT_EQ(rig_.peek(1, words::kTimer1), 100u) << "T1";
  const std::uint32_t t2 = rig_.peek(1, words::kTimer2);
  EXPECT_GT(t2, 60u);  // latched by SERVO less than 40 SCLK ago
  EXPECT_LT(t2, 100u);
  EXPECT_EQ(words::servo_position::kDown.get(rig_.peek(1, words::kServoPosition)), 0u) << "up";
  steps(1, 1, false, 100 * kSclk);
  EXPECT_EQ(rig_.peek(1, words::kTimer1), words::timer1::kReversed.mask() | 100u) << "direction reversed";
  EXPECT_EQ(words::servo_position::kDown.get(rig_.peek(1, words::kServoPosition)), 1u) << "down";
  EXPECT_EQ(words::servo_position::kPosition.get(rig_.peek(1, words::kServoPosition)),
            static_cast<std::uint32_t>(counter(1)) & 0x7FFFFF);
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
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 4));
  rig_.write(1, words::kOutC, 0x4000);  // one pulse in 1024 PFM_CLK
  std::uint32_t t1[2];
  const Tick echo[2] = {300, 450};  // SCLK from the pulse to the echo
  control(1, decode_mode(regs::decode::kMldt) | kPfm);
  for (int i = 0; i < 2; ++i) {
    wait_until([&] { return !rig_.other(kPulse, 1); });
    wait_until([&] { return rig_.other(kPulse, 1); });
    rig_.ticks(echo[i] * kSclk);
    pin(1, kA, true);
    pin(1, kA, false, 3 * kPhase);
    t1[i] = rig_.peek(1, words::kTimer1);
  }
  EXPECT_EQ(t1[1] - t1[0], 150u);
  EXPECT_GE(t1[0], 300u);
  EXPECT_LE(t1[0], 305u) << "synchroniser and filter";
}

TEST_F(ChannelTest, InternalPulsesCountWithTheSignOfTheCommand) {
  control(1, decode_mode(regs::decode::kInternalPulse) | kPfm);
  const int start = counter(1);
  rig_.write(1, words::kOutC, 0x010000);  // every 256 PFM_CLK of 12 ticks
  rig_.ticks(10 * 256 * 12 + 600);
  rig_.write(1, words::kOutC, 0);
  EXPECT_EQ(counter(1) - start, 10);
  rig_.write(1, words::kOutC, 0xFF0000);
  rig_.ticks(20 * 256 * 12 + 600);
  rig_.write(1, words::kOutC, 0);
  EXPECT_NEAR(counter(1) - start, -10, 1);
}

TEST_F(ChannelTest, Hardware1TFractionIsT2OverT1) {
  for (bool up : {true, false}) {
    for (Tick rest : {130, 333, 777, 990, 2500}) {
      control(1, kX4 | kFine);
      steps(1, 3, up, 1000 * kSclk);
      step(1, up, rest * kSclk);
      const std::uint32_t fraction = fine2::kServo.get(rig_.peek(1, words::kTimer2));
      rig_.in.phase = rig_.in.servo = true;
      control(1, kX4);  // now the words show the timers latched with it
      const std::uint32_t t2 = rig_.peek(1, words::kTimer2), t1 = words::timer1::kT1.get(rig_.peek(1, words::kTimer1));
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
  rig_.write(1, words::kStatus, 0);
  rig_.ticks(kHold);
  EXPECT_FALSE(status(1, status_bit::kEncoderLoss));
  rig_.pin(1, kU, true);
  rig_.ticks(kHold);
  EXPECT_TRUE(status(1, status_bit::kEncoderLoss));
  rig_.write(1, words::kStatus, status_bit::kEncoderLoss.mask());
  EXPECT_TRUE(status(1, status_bit::kEncoderLoss)) << "writing 1 leaves it";
  while (rig_.now() % kSclk != 0) rig_.tick();  // SCLK began with the edge at tick 6: the write is apart from it
  rig_.write(1, words::kStatus, 0);
  EXPECT_FALSE(status(1, status_bit::kEncoderLoss));
  rig_.ticks(3 * kSclk);
  EXPECT_TRUE(status(1, status_bit::kEncoderLoss)) << "the cause lasts";
  rig_.pin(1, kU, false);
  rig_.ticks(kHold);
  rig_.write(1, words::kStatus, 0);
  rig_.pin(1, kW, true);
  rig_.ticks(kHold);
  EXPECT_TRUE(status(1, status_bit::kEncoderLoss)) << "V = W";
}

TEST_F(ChannelTest, ResetDoesNotCountTheLevelsItFinds) {
  rig_.in.pins.fill(0xFFF);
  rig_.reset();
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 15));
  rig_.write(ic_words::kClockControl, kServoEachPhase);
  rig_.ticks(2 * 13057);
  EXPECT_EQ(counter(1), 0);
  EXPECT_EQ(rig_.peek(1, words::kStatus),
            0xFFF000u | status_bit::kEncoderLoss.mask() | status_bit::kDemuxInvalid.mask())
      << "T = U is an encoder loss, de-multiplexing incomplete";
}

}  // namespace
}  // namespace brick
