// Decoding edge by edge: on which line and at which level each mode counts, what is an error and where, and what a held
// counter leaves alone (servo-ic:5.4). Counts are read after each edge, so that no mode passes by its sum.
#include <vector>

#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelDecodeTest : public ChannelTest {
 protected:
  // Counts made by each quarter cycle, from 00 through 10, 11, 01 of {A, B} and round again, or backwards.
  std::vector<int> quarters(regs::decode::Code mode, bool up, int n = 8) {
    control(1, decode_mode(mode));
    std::vector<int> made;
    for (int last = counter(1); n > 0; --n) {
      step(1, up);
      made.push_back(counter(1) - last);
      last += made.back();
    }
    return made;
  }
  void clear_error() { rig_.write(1, words::kStatus, 0); }
};

TEST_F(ChannelDecodeTest, X2CountsTheEdgesOfA) {
  EXPECT_EQ(quarters(regs::decode::kX2Cw, true), (std::vector<int>{1, 0, 1, 0, 1, 0, 1, 0}));
  EXPECT_EQ(quarters(regs::decode::kX2Cw, false), (std::vector<int>{0, -1, 0, -1, 0, -1, 0, -1}));
  EXPECT_EQ(quarters(regs::decode::kX2Ccw, true), (std::vector<int>{-1, 0, -1, 0, -1, 0, -1, 0}));
  EXPECT_EQ(quarters(regs::decode::kX2Ccw, false), (std::vector<int>{0, 1, 0, 1, 0, 1, 0, 1}));
}

TEST_F(ChannelDecodeTest, X1CountsBothWaysAtTheEdgeOfAWithBLow) {
  EXPECT_EQ(quarters(regs::decode::kX1Cw, true), (std::vector<int>{1, 0, 0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(quarters(regs::decode::kX1Cw, false), (std::vector<int>{0, 0, 0, -1, 0, 0, 0, -1}));
  EXPECT_EQ(quarters(regs::decode::kX1Ccw, true), (std::vector<int>{-1, 0, 0, 0, -1, 0, 0, 0}));
  EXPECT_EQ(quarters(regs::decode::kX1Ccw, false), (std::vector<int>{0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST_F(ChannelDecodeTest, X4CountsEveryEdge) {
  EXPECT_EQ(quarters(regs::decode::kX4Cw, true, 4), (std::vector<int>{1, 1, 1, 1}));
  EXPECT_EQ(quarters(regs::decode::kX4Cw, false, 4), (std::vector<int>{-1, -1, -1, -1}));
  EXPECT_EQ(quarters(regs::decode::kX4Ccw, true, 4), (std::vector<int>{-1, -1, -1, -1}));
  EXPECT_EQ(quarters(regs::decode::kX4Ccw, false, 4), (std::vector<int>{1, 1, 1, 1}));
}

// A is the pulse, its rise counts; B is the direction, in the same sample, high upwards in mode 0 and downwards in 4.
TEST_F(ChannelDecodeTest, PulseAndDirectionCountsTheRiseOfAInTheDirectionOfB) {
  for (const auto mode : {regs::decode::kPulseCw, regs::decode::kPulseCcw}) {
    const int up = mode == regs::decode::kPulseCw ? 1 : -1;
    control(1, decode_mode(mode));
    int expected = counter(1);
    const auto levels = [&](bool a, bool b, int counts) {  // A and B together
      rig_.pin(1, kA, a);
      rig_.pin(1, kB, b);
      expected += counts;
      EXPECT_EQ(counter(1), expected) << "mode " << mode << ", A " << a << ", B " << b;
    };
    levels(true, true, up);    // B rises with A: this pulse goes upwards
    levels(false, true, 0);    // A falls
    levels(false, false, 0);   // B falls
    levels(true, false, -up);  // A rises with B low
    levels(true, true, 0);     // B rises
    levels(false, true, 0);
    levels(true, false, -up);  // B falls with A
    levels(false, false, 0);
  }
}

// Illegal transitions: A and B together, in both directions.
TEST_F(ChannelDecodeTest, OnlyQuadratureAndHallModesRaiseTheError) {
  for (std::uint32_t mode = 0; mode < 16; ++mode) {
    const bool quadrature = mode < 8 && (mode & 3) != 0, hall = mode == 11 || mode == 15;
    control(1, field::kDecode.at(mode));
    rig_.in.pins[0] = hall ? 4 : 0;  // {C, B, A}: 001 of {A, B, C} is a hall code
    rig_.ticks(kHold);
    clear_error();
    for (const unsigned pins : {3u, 0u, 7u}) {
      rig_.in.pins[0] = pins;
      rig_.ticks(kHold);
    }
    EXPECT_EQ(bool{status(1, status_bit::kEncoderError)}, quadrature || hall) << "mode " << mode;
  }
}

TEST_F(ChannelDecodeTest, ErrorOfEachQuadratureModeCountsNothing) {
  for (const auto mode : {regs::decode::kX1Cw, regs::decode::kX2Cw, regs::decode::kX4Cw, regs::decode::kX1Ccw,
                          regs::decode::kX2Ccw, regs::decode::kX4Ccw}) {
    control(1, decode_mode(mode));
    for (const unsigned from : {0u, 1u, 2u, 3u}) {
      rig_.in.pins[0] = from;
      rig_.ticks(kHold);
      clear_error();
      const int start = counter(1);
      rig_.in.pins[0] = from ^ 3;
      rig_.ticks(kHold);
      EXPECT_TRUE(status(1, status_bit::kEncoderError)) << "mode " << mode << " from " << from;
      EXPECT_EQ(counter(1), start) << "mode " << mode << " from " << from;
    }
  }
}

// Standing still, single steps and the turn between both directions.
TEST_F(ChannelDecodeTest, LegalStepsRaiseNoErrorInAnyQuadratureMode) {
  for (const auto mode : {regs::decode::kX1Cw, regs::decode::kX2Cw, regs::decode::kX4Cw, regs::decode::kX1Ccw,
                          regs::decode::kX2Ccw, regs::decode::kX4Ccw}) {
    control(1, decode_mode(mode));
    rig_.ticks(kHold);
    clear_error();
    for (const bool up : {true, false}) {
      for (int quarter = 0; quarter < 5; ++quarter) {
        EXPECT_FALSE(status(1, status_bit::kEncoderError)) << "mode " << mode << " before quarter " << quarter;
        step(1, up);
      }
    }
    EXPECT_FALSE(status(1, status_bit::kEncoderError)) << "mode " << mode;
  }
}

// A code that is none is an error for as long as it stands: cleared, the bit is set again by the next SCLK, and a clear
// at the edge of an SCLK, one of the four edges of its period, clears nothing. A jump over one or two codes is an error
// once.
TEST_F(ChannelDecodeTest, HallCodesThatAreNoneLastAndJumpsDoNot) {
  control(1, decode_mode(regs::decode::kHallCw));
  for (const unsigned none : {0u, 7u}) {
    rig_.in.pins[0] = none;
    rig_.ticks(kHold);
    unsigned cleared = 0;
    for (Tick phase = 0; phase < kSclk; phase += kTicksPerRef) {
      clear_error();
      cleared += !status(1, status_bit::kEncoderError);
      rig_.ticks(kSclk);
      EXPECT_TRUE(status(1, status_bit::kEncoderError)) << none;
    }
    EXPECT_EQ(cleared, 3u) << none;
  }
  rig_.in.pins[0] = 4;  // 001 of {A, B, C}
  rig_.ticks(kHold);
  const int start = counter(1);
  for (const unsigned jump : {2u, 1u, 6u, 5u, 2u}) {  // 010, 100, 011, 101, 010: two or three places each
    clear_error();
    rig_.in.pins[0] = jump;
    rig_.ticks(kHold);
    EXPECT_TRUE(status(1, status_bit::kEncoderError)) << jump;
    clear_error();
    rig_.ticks(kHold);
    EXPECT_FALSE(status(1, status_bit::kEncoderError)) << jump << " stands now";
  }
  EXPECT_EQ(counter(1), start);
}

// The clear takes what was there before: an error of its own edge stays, one of the edge before is gone.
TEST_F(ChannelDecodeTest, AnErrorAtTheEdgeOfItsClearIsNotLost) {
  control(1, kX4);
  const auto both_lines = [&] {  // at the same place in the period of SCLK each time
    rig_.ticks(kHold);
    clear_error();
    while (rig_.now() % kSclk != 0) rig_.tick();
    rig_.in.pins[0] ^= 1u << kA | 1u << kB;
  };
  both_lines();
  const Tick start = rig_.now();
  wait_until([&] { return status(1, status_bit::kEncoderError); });
  const Tick error = rig_.now() - start;
  ASSERT_EQ(error % kTicksPerRef, 0);
  for (const Tick clear : {error - kTicksPerRef, error, error + kTicksPerRef}) {
    both_lines();
    rig_.ticks(clear - kTicksPerRef);
    clear_error();  // with the next edge
    rig_.ticks(kHold);
    EXPECT_EQ(bool{status(1, status_bit::kEncoderError)}, clear <= error) << clear - error;
  }
}

// The sign is that of the command, whatever the DIR pin shows; at most one count an SCLK, however fast the pulses are.
TEST_F(ChannelDecodeTest, OwnPulsesCountWithTheSignOfTheCommandOncePerSclk) {
  for (const std::uint32_t inverted : {0u, kInvertDir | kInvertC}) {
    const std::uint32_t word = decode_mode(regs::decode::kInternalPulse) | kPfm | inverted;
    control(1, word | kCounterReset);
    control(1, word);
    rig_.write(1, words::kOutC, 0x100000);  // every 16 PFM_CLK
    rig_.ticks(10 * 16 * 12);
    rig_.write(1, words::kOutC, 0);
    EXPECT_EQ(counter(1), 10) << inverted;
    rig_.write(1, words::kOutC, 0xF00000);
    rig_.ticks(30 * 16 * 12);
    rig_.write(1, words::kOutC, 0);
    EXPECT_EQ(counter(1), 10 - 30) << inverted;
  }
  // PFM_CLK at 39.3216 MHz, a pulse in each fourth: two in an SCLK of 24 ticks are one count.
  control(1, decode_mode(regs::decode::kInternalPulse) | kPfm | kCounterReset);
  rig_.write(ic_words::kClockControl, ic_words::clock_control::kSclkDivider.set(
                                          ic_words::clock_control::kPfmDivider.set(kServoEachPhase, 0), 3));
  rig_.ticks(kHold);
  control(1, decode_mode(regs::decode::kInternalPulse) | kPfm);
  rig_.write(1, words::kOutC, 0x400000);
  rig_.ticks(100 * 24);
  rig_.write(1, words::kOutC, 0);
  EXPECT_NEAR(counter(1), 100, 1);
}

// By no word of the channel but bit 10 of X:+5; X:+4 is the IC's.
TEST_F(ChannelDecodeTest, CounterCannotBeSet) {
  control(1, kX4);
  steps(1, 3, true);
  for (const bool x : {false, true})
    for (unsigned offset = 0; offset < 8; ++offset) {
      if (x && offset == words::kControl.address)
        control(1, kX4);
      else if (!x || offset != 4)
        rig_.write(x, base(1) + offset, 0x123456);
      EXPECT_EQ(counter(1), 3) << (x ? "X:+" : "Y:+") << offset;
    }
}

// Neither position nor timers nor compares see what the encoder does while the counter is held.
TEST_F(ChannelDecodeTest, HeldCounterLeavesTimersAndComparesAlone) {
  control(1, kX4);
  steps(1, 5, true, 20 * kSclk);
  control(1, kX4 | kCounterReset);
  rig_.write(1, words::kCompareA, 0);
  rig_.write(1, words::kCompareB, 0x400000);
  steps(1, 6, true, 50 * kSclk);
  EXPECT_FALSE(equ(1));
  EXPECT_EQ(rig_.peek(1, words::kTimer1), 20u) << "of the last counts before";
  rig_.ticks(2 * kPhase);
  EXPECT_GE(rig_.peek(1, words::kTimer2), 300u) << "runs on";
  EXPECT_EQ(counter(1), 0);
}

}  // namespace
}  // namespace brick
