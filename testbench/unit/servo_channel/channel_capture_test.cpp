// Position capture, index conditioning and position compare of a channel.
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

TEST_F(ChannelTest, HomeFlagCapturesOnceUntilTheRegisterIsRead) {
  control(1, kX4 | kFlag);
  steps(1, 10, true);
  const int at = counter(1);
  pin(1, kHmfl, true);
  EXPECT_TRUE(status(1, status_bit::kCaptured));
  EXPECT_FALSE(status(1, status_bit::kCapturedGatedIndex));
  steps(1, 5, true);
  pin(1, kHmfl, false);
  pin(1, kHmfl, true);
  EXPECT_EQ(rig_.peek(1, words::kOutB), 0u) << "the Y word is OUT B";
  EXPECT_TRUE(status(1, status_bit::kCaptured));
  EXPECT_EQ(rig_.read(1, words::kFlagPosition), static_cast<std::uint32_t>(at)) << "the first edge";
  EXPECT_FALSE(status(1, status_bit::kCaptured));
  rig_.ticks(kHold);
  EXPECT_FALSE(status(1, status_bit::kCaptured)) << "already high when armed";
  pin(1, kHmfl, false);
  pin(1, kHmfl, true);
  EXPECT_TRUE(status(1, status_bit::kCaptured));
  EXPECT_EQ(rig_.read(1, words::kFlagPosition), static_cast<std::uint32_t>(at + 5));
}

TEST_F(ChannelTest, EveryTriggerCodeNeedsItsOwnLevels) {
  for (unsigned select = 0; select < 4; ++select) {
    for (unsigned code = 0; code < 16; ++code) {
      if ((code & 3) == 0) continue;
      const unsigned idle = code >> 2;                   // the levels at which neither is true
      for (unsigned levels = 0; levels < 4; ++levels) {  // bit 0 index, bit 1 flag
        for (const unsigned before : {levels ^ 3u, idle}) {
          const unsigned flag = kHmfl + select;
          const auto pins = [&](unsigned of) {
            return ((of & 1) != 0 ? 1u << kC : 0) | ((of & 2) != 0 ? 1u << flag : 0);
          };
          rig_.in.pins[1] = pins(before);
          control(2, code << field::kCaptureSource.lsb | field::kFlagSelect.at(select));
          rig_.ticks(kHold);
          rig_.read(2, words::kFlagPosition);
          rig_.in.pins[1] = pins(levels);
          rig_.ticks(kHold);
          const bool index = ((levels ^ idle) & 1) != 0, level = ((levels ^ idle) & 2) != 0;
          const bool expected = (code & 3) == 1 ? index : (code & 3) == 2 ? level : index && level;
          EXPECT_EQ(bool{status(2, status_bit::kCaptured)}, expected)
              << "code " << code << " flag " << select << " levels " << before << " to " << levels;
        }
      }
    }
  }
}

TEST_F(ChannelTest, SoftwareTriggerIsTheRiseOfItsBit) {
  for (std::uint32_t idle : {0u, field::kFlagInvert.mask()}) {
    control(1, idle);
    rig_.ticks(kHold);
    rig_.read(1, words::kFlagPosition);
    rig_.ticks(kHold);
    EXPECT_FALSE(status(1, status_bit::kCaptured));
    control(1, idle | kIndexInvert);
    rig_.ticks(kHold);
    EXPECT_TRUE(status(1, status_bit::kCaptured));
    rig_.read(1, words::kFlagPosition);
    rig_.ticks(kHold);
    EXPECT_FALSE(status(1, status_bit::kCaptured)) << "it stands";
  }
}

TEST_F(ChannelTest, GatedIndexWaitsForItsAbState) {
  for (bool low : {false, true}) {
    control(1, kX4 | kIndex | kGated | field::kGateState.at(low));
    place_[0] = low ? 1 : 0;  // 10, 00 of {A, B}; the gate state comes later
    rig_.in.pins[0] = low ? 1 : 0;
    rig_.ticks(kHold);
    rig_.read(1, words::kFlagPosition);
    pin(1, kC, true);
    EXPECT_FALSE(status(1, status_bit::kCaptured));
    steps(1, low ? 3 : 2, true);
    EXPECT_TRUE(status(1, status_bit::kCaptured));
    EXPECT_TRUE(status(1, status_bit::kCapturedGatedIndex));
    EXPECT_EQ(rig_.peek(1, words::kFlagPosition), static_cast<std::uint32_t>(counter(1)) & 0xFFFFFF);
    EXPECT_NE(rig_.read(1, words::kFlagPosition), 0u);
    EXPECT_FALSE(status(1, status_bit::kCapturedGatedIndex));
    pin(1, kC, false);
  }
}

TEST_F(ChannelTest, HallEdgeCaptureKeepsUvw) {
  for (unsigned bit : {kU, kV, kW}) {
    rig_.in.pins[0] = 0;
    control(1, kX4 | kGated);
    rig_.ticks(kHold);
    rig_.read(1, words::kFlagPosition);
    rig_.ticks(kHold);
    EXPECT_FALSE(status(1, status_bit::kCaptured));
    pin(1, bit, true);
    EXPECT_TRUE(status(1, status_bit::kCaptured));
    EXPECT_EQ(status_bit::kHallCapture.get(rig_.peek(1, words::kStatus)), 1u << (bit - kW));
    pin(1, bit, false);
    EXPECT_EQ(status_bit::kHallCapture.get(rig_.peek(1, words::kStatus)), 1u << (bit - kW)) << "one shot";
  }
}

// Counts 100 SCLK apart and a flag half way to the next: 0.5 or so of a count.
TEST_F(ChannelTest, AResetEmptiesTheCapturedPositionAndItsFraction) {
  control(1, kX4 | kFlag | kFine);
  steps(1, 5, true, 100 * kSclk);
  step(1, true, 50 * kSclk);
  pin(1, kHmfl, true);
  ASSERT_EQ(rig_.peek(1, words::kFlagPosition), 6u);
  ASSERT_NEAR(fine1::kCaptured.get(rig_.peek(1, words::kTimer1)), 2048, 300);
  rig_.reset();
  control(1, kX4 | kFlag | kFine);
  EXPECT_EQ(rig_.peek(1, words::kFlagPosition), 0u);
  EXPECT_EQ(rig_.peek(1, words::kTimer1), 0u) << "the fractions of the capture and of compare B";
}

TEST_F(ChannelTest, DemultiplexedLineSetsCuvwByAbState) {
  EXPECT_TRUE(status(1, status_bit::kDemuxInvalid));
  control(1, kX4 | kDemux);
  // During 00, 10, 11, 01 of {A, B} the line carries V, U, C, W: it is high in one of them, and then in all but one.
  const std::uint32_t carried[] = {status_bit::kFlagV.mask(), status_bit::kFlagU.mask(), status_bit::kChc.mask(),
                                   status_bit::kFlagW.mask()},
                      all = carried[0] | carried[1] | carried[2] | carried[3];
  for (const bool high : {true, false}) {
    for (unsigned place = 0; place < 4; ++place) {
      for (int i = 0; i < 5; ++i) {  // into each state with the line as it is to be there
        rig_.pin(1, kC, (((place_[0] + 1) & 3) == place) == high);
        step(1, true);
      }
      const std::uint32_t word = rig_.peek(1, words::kStatus);
      EXPECT_EQ(word & all, high ? carried[place] : all & ~carried[place])
          << "place " << place << (high ? ", high" : ", low");
    }
  }
  EXPECT_FALSE(status(1, status_bit::kDemuxInvalid));
}

TEST_F(ChannelTest, CaptureAtTheEdgeOfTheReadWins) {
  int wins = 0, late = 0;
  for (Tick delay = 0; delay < 2 * kHold; delay += 3) {
    control(1, kX4 | kFlag);
    pin(1, kHmfl, false);
    rig_.read(1, words::kFlagPosition);
    rig_.ticks(kHold);
    while (rig_.now() % kSclk != 0) rig_.tick();
    rig_.pin(1, kHmfl, true);
    rig_.ticks(delay);
    rig_.read(1, words::kFlagPosition);
    rig_.ticks(kHold);
    (status(1, status_bit::kCaptured) ? wins : late)++;
  }
  EXPECT_GT(wins, 0);  // read before or at the trigger: captured
  EXPECT_GT(late, 0);  // read after it: cleared
}

TEST_F(ChannelTest, CompareTogglesWhenLeftAndMovesTheOther) {
  control(1, kX4 | kCounterReset);
  control(1, kX4 | kEquWrite);
  steps(1, 100, true, 40);
  rig_.write(1, words::kCompareA, 1000);
  rig_.write(1, words::kCompareB, (1010 - 2000) & 0xFFFFFF);
  rig_.write(1, words::kCompareIncrement, 2000);
  EXPECT_EQ(counter(1), 100);
  EXPECT_FALSE(equ(1));
  steps(1, 900, true, 40);
  EXPECT_EQ(counter(1), 1000);
  EXPECT_FALSE(equ(1)) << "still equal";
  EXPECT_EQ(rig_.peek(1, words::kCompareB), (1010u - 2000u) & 0xFFFFFF);
  step(1, true);
  EXPECT_TRUE(equ(1)) << "1000 -> 1001";
  EXPECT_TRUE(status(1, status_bit::kEqu));
  EXPECT_EQ(rig_.peek(1, words::kCompareB), 1010u);
  EXPECT_EQ(rig_.peek(1, words::kCompareA), 1000u) << "the one that is left stays";
  steps(1, 9, true);
  EXPECT_TRUE(equ(1));
  step(1, true);
  EXPECT_FALSE(equ(1)) << "1010 -> 1011";
  EXPECT_EQ(rig_.peek(1, words::kCompareA), 3000u);
  steps(1, 3001 - 1011, true, 40);
  EXPECT_EQ(counter(1), 3001);
  EXPECT_TRUE(equ(1)) << "3000 -> 3001";
  EXPECT_EQ(rig_.peek(1, words::kCompareB), 3010u);
}

TEST_F(ChannelTest, CompareStepsBackWhenMovingDown) {
  control(1, kX4 | kCounterReset);
  control(1, kX4);
  steps(1, 5, true);
  rig_.write(1, words::kCompareA, 5);
  rig_.write(1, words::kCompareB, 100);
  rig_.write(1, words::kCompareIncrement, 7);
  step(1, false);
  EXPECT_TRUE(equ(1));
  EXPECT_EQ(rig_.peek(1, words::kCompareB), 93u);
  rig_.write(1, words::kCompareA, 100);
  rig_.write(1, words::kCompareB, 4);
  step(1, false);
  EXPECT_FALSE(equ(1));
  EXPECT_EQ(rig_.peek(1, words::kCompareA), 93u);
}

TEST_F(ChannelTest, BothComparesEqualCancelAndBothStep) {
  control(1, kX4 | kCounterReset);
  control(1, kX4);
  rig_.write(1, words::kCompareA, 0);
  rig_.write(1, words::kCompareB, 0);
  rig_.write(1, words::kCompareIncrement, 3);
  step(1, true);
  EXPECT_FALSE(equ(1));
  EXPECT_EQ(rig_.peek(1, words::kCompareA), 3u);
  EXPECT_EQ(rig_.peek(1, words::kCompareB), 3u);
}

TEST_F(ChannelTest, DirectWriteOfEquFallsBackByItself) {
  control(1, kEquState | kEquWrite);
  EXPECT_TRUE(equ(1));
  rig_.ref();
  EXPECT_EQ(rig_.peek(1, words::kControl), kEquState);
  control(1, 0);
  EXPECT_TRUE(equ(1)) << "without bit 11 nothing is copied";
  control(1, kEquWrite);
  EXPECT_FALSE(equ(1));
}

TEST_F(ChannelTest, ChannelOneDrivesTheComparesOfTheOthers) {
  control(1, kX4 | kCounterReset);
  control(1, kX4);
  for (unsigned ch = 2; ch <= 4; ++ch) {
    rig_.write(ch, words::kCompareA, ch);
    rig_.write(ch, words::kCompareB, 500);
    control(ch, kX4 | (ch == 4 ? 0 : kFromChannel1));
  }
  steps(1, 5, true);
  EXPECT_TRUE(equ(2));
  EXPECT_TRUE(equ(3));
  EXPECT_FALSE(equ(4)) << "own counter";
  steps(4, 5, true);
  EXPECT_TRUE(equ(4)) << "which has left 4 now";
}

}  // namespace
}  // namespace brick
