// Position capture, index conditioning and position compare of a channel.
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

constexpr std::uint32_t kX4 = 3;

TEST_F(ChannelTest, HomeFlagCapturesOnceUntilTheRegisterIsRead) {
  control(1, kX4 | 2 << 4);
  steps(1, 10, true);
  const int at = counter(1);
  pin(1, kHmfl, true);
  EXPECT_TRUE(status(1, 11));
  EXPECT_FALSE(status(1, 10));
  steps(1, 5, true);
  pin(1, kHmfl, false);
  pin(1, kHmfl, true);
  EXPECT_EQ(rig_.peek(false, base(1) + 3), 0u) << "the Y word is OUT B";
  EXPECT_TRUE(status(1, 11));
  EXPECT_EQ(rig_.read(true, base(1) + 3), static_cast<std::uint32_t>(at)) << "the first edge";
  EXPECT_FALSE(status(1, 11));
  rig_.ticks(kHold);
  EXPECT_FALSE(status(1, 11)) << "already high when armed";
  pin(1, kHmfl, false);
  pin(1, kHmfl, true);
  EXPECT_TRUE(status(1, 11));
  EXPECT_EQ(rig_.read(true, base(1) + 3), static_cast<std::uint32_t>(at + 5));
}

TEST_F(ChannelTest, EveryTriggerCodeNeedsItsOwnLevels) {
  for (unsigned select = 0; select < 4; ++select) {
    for (unsigned code = 0; code < 16; ++code) {
      if ((code & 3) == 0) continue;
      for (unsigned levels = 0; levels < 4; ++levels) {  // bit 0 index, bit 1 flag, from their opposites to these
        const unsigned flag = kHmfl + select;
        rig_.in.pins[1] = ((levels & 1) != 0 ? 0 : 1u << kC) | ((levels & 2) != 0 ? 0 : 1u << flag);
        control(2, code << 4 | select << 8);
        rig_.ticks(kHold);
        rig_.read(true, base(2) + 3);
        rig_.in.pins[1] = ((levels & 1) != 0 ? 1u << kC : 0) | ((levels & 2) != 0 ? 1u << flag : 0);
        rig_.ticks(kHold);
        const bool index = ((levels & 1) != 0) != ((code & 4) != 0), level = ((levels & 2) != 0) != ((code & 8) != 0);
        const bool expected = (code & 3) == 1 ? index : (code & 3) == 2 ? level : index && level;
        EXPECT_EQ(status(2, 11), expected) << "code " << code << " flag " << select << " levels " << levels;
      }
    }
  }
}

TEST_F(ChannelTest, SoftwareTriggerIsTheRiseOfItsBit) {
  for (unsigned idle : {0u, 8u}) {
    control(1, idle << 4);
    rig_.ticks(kHold);
    rig_.read(true, base(1) + 3);
    rig_.ticks(kHold);
    EXPECT_FALSE(status(1, 11));
    control(1, (idle | 4) << 4);
    rig_.ticks(kHold);
    EXPECT_TRUE(status(1, 11));
  }
}

TEST_F(ChannelTest, GatedIndexWaitsForItsAbState) {
  for (bool low : {false, true}) {
    control(1, kX4 | 1 << 4 | 1 << 15 | (low ? 1u << 16 : 0));
    place_[0] = low ? 1 : 0;  // 10, 00 of {A, B}; the gate state comes later
    rig_.in.pins[0] = low ? 1 : 0;
    rig_.ticks(kHold);
    rig_.read(true, base(1) + 3);
    pin(1, kC, true);
    EXPECT_FALSE(status(1, 11));
    steps(1, low ? 3 : 2, true);
    EXPECT_TRUE(status(1, 11));
    EXPECT_TRUE(status(1, 10));
    EXPECT_EQ(rig_.peek(true, base(1) + 3), static_cast<std::uint32_t>(counter(1)) & 0xFFFFFF);
    EXPECT_NE(rig_.read(true, base(1) + 3), 0u);
    EXPECT_FALSE(status(1, 10));
    pin(1, kC, false);
  }
}

TEST_F(ChannelTest, HallEdgeCaptureKeepsUvw) {
  for (unsigned bit : {kU, kV, kW}) {
    rig_.in.pins[0] = 0;
    control(1, kX4 | 1 << 15);
    rig_.ticks(kHold);
    rig_.read(true, base(1) + 3);
    rig_.ticks(kHold);
    EXPECT_FALSE(status(1, 11));
    pin(1, bit, true);
    EXPECT_TRUE(status(1, 11));
    EXPECT_EQ(rig_.peek(true, base(1)) & 7, 1u << (bit - kW));
    pin(1, bit, false);
    EXPECT_EQ(rig_.peek(true, base(1)) & 7, 1u << (bit - kW)) << "one shot";
  }
}

TEST_F(ChannelTest, DemultiplexedLineSetsCuvwByAbState) {
  EXPECT_TRUE(status(1, 3));
  control(1, kX4 | 1 << 17);
  // During 00, 10, 11, 01 of {A, B} the line carries V, U, C, W: it is high in one of them, and then in all but one.
  const std::uint32_t carried[] = {1 << 21, 1 << 22, 1 << 14, 1 << 20}, all = 7 << 20 | 1 << 14;
  for (const bool high : {true, false}) {
    for (unsigned place = 0; place < 4; ++place) {
      for (int i = 0; i < 5; ++i) {  // into each state with the line as it is to be there
        rig_.pin(1, kC, (((place_[0] + 1) & 3) == place) == high);
        step(1, true);
      }
      const std::uint32_t word = rig_.peek(true, base(1));
      EXPECT_EQ(word & all, high ? carried[place] : all & ~carried[place])
          << "place " << place << (high ? ", high" : ", low");
    }
  }
  EXPECT_FALSE(status(1, 3));
}

TEST_F(ChannelTest, CaptureAtTheEdgeOfTheReadWins) {
  int wins = 0, late = 0;
  for (Tick delay = 0; delay < 2 * kHold; delay += 3) {
    control(1, kX4 | 2 << 4);
    pin(1, kHmfl, false);
    rig_.read(true, base(1) + 3);
    rig_.ticks(kHold);
    while (rig_.now() % kSclk != 0) rig_.tick();
    rig_.pin(1, kHmfl, true);
    rig_.ticks(delay);
    rig_.read(true, base(1) + 3);
    rig_.ticks(kHold);
    (status(1, 11) ? wins : late)++;
  }
  EXPECT_GT(wins, 0);  // read before or at the trigger: captured
  EXPECT_GT(late, 0);  // read after it: cleared
}

TEST_F(ChannelTest, CompareTogglesWhenLeftAndMovesTheOther) {
  control(1, kX4 | 1 << 10);
  control(1, kX4 | 1 << 11);
  steps(1, 100, true, 40);
  rig_.write(false, base(1) + 7, 1000);
  rig_.write(true, base(1) + 7, (1010 - 2000) & 0xFFFFFF);
  rig_.write(true, base(1) + 6, 2000);
  EXPECT_EQ(counter(1), 100);
  EXPECT_FALSE(equ(1));
  steps(1, 900, true, 40);
  EXPECT_EQ(counter(1), 1000);
  EXPECT_FALSE(equ(1)) << "still equal";
  EXPECT_EQ(rig_.peek(true, base(1) + 7), (1010u - 2000u) & 0xFFFFFF);
  step(1, true);
  EXPECT_TRUE(equ(1)) << "1000 -> 1001";
  EXPECT_TRUE(status(1, 9));
  EXPECT_EQ(rig_.peek(true, base(1) + 7), 1010u);
  steps(1, 9, true);
  EXPECT_TRUE(equ(1));
  step(1, true);
  EXPECT_FALSE(equ(1)) << "1010 -> 1011";
  EXPECT_EQ(rig_.peek(false, base(1) + 7), 3000u);
  steps(1, 3001 - 1011, true, 40);
  EXPECT_EQ(counter(1), 3001);
  EXPECT_TRUE(equ(1)) << "3000 -> 3001";
  EXPECT_EQ(rig_.peek(true, base(1) + 7), 3010u);
}

TEST_F(ChannelTest, CompareStepsBackWhenMovingDown) {
  control(1, kX4 | 1 << 10);
  control(1, kX4);
  steps(1, 5, true);
  rig_.write(false, base(1) + 7, 5);
  rig_.write(true, base(1) + 7, 100);
  rig_.write(true, base(1) + 6, 7);
  step(1, false);
  EXPECT_TRUE(equ(1));
  EXPECT_EQ(rig_.peek(true, base(1) + 7), 93u);
}

TEST_F(ChannelTest, BothComparesEqualCancelAndBothStep) {
  control(1, kX4 | 1 << 10);
  control(1, kX4);
  rig_.write(false, base(1) + 7, 0);
  rig_.write(true, base(1) + 7, 0);
  rig_.write(true, base(1) + 6, 3);
  step(1, true);
  EXPECT_FALSE(equ(1));
  EXPECT_EQ(rig_.peek(false, base(1) + 7), 3u);
  EXPECT_EQ(rig_.peek(true, base(1) + 7), 3u);
}

TEST_F(ChannelTest, DirectWriteOfEquFallsBackByItself) {
  control(1, 1 << 12 | 1 << 11);
  EXPECT_TRUE(equ(1));
  rig_.ref();
  EXPECT_EQ(rig_.peek(true, base(1) + 5), 1u << 12);
  control(1, 0);
  EXPECT_TRUE(equ(1)) << "without bit 11 nothing is copied";
  control(1, 1 << 11);
  EXPECT_FALSE(equ(1));
}

TEST_F(ChannelTest, ChannelOneDrivesTheComparesOfTheOthers) {
  control(1, kX4 | 1 << 10);
  control(1, kX4);
  for (unsigned ch = 2; ch <= 4; ++ch) {
    rig_.write(false, base(ch) + 7, ch);
    rig_.write(true, base(ch) + 7, 500);
    control(ch, kX4 | (ch == 4 ? 0 : 1 << 13));
  }
  steps(1, 5, true);
  EXPECT_TRUE(equ(2));
  EXPECT_TRUE(equ(3));
  EXPECT_FALSE(equ(4)) << "own counter";
}

TEST_F(ChannelTest, FineCompareTogglesBetweenCounts) {
  const std::uint32_t word = kX4 | 1 << 18;
  control(1, word | 1 << 10);
  control(1, word);
  steps(1, 4, true, 1000 * kSclk);
  rig_.write(false, base(1) + 7, 4);
  rig_.write(false, base(1) + 1, 1024);
  rig_.write(true, base(1) + 7, 4);
  rig_.write(false, base(1), 3072);
  EXPECT_EQ(rig_.peek(false, base(1) + 1) & 0xFFF, 1024u);
  EXPECT_EQ(rig_.peek(false, base(1)) & 0xFFF, 3072u);
  // The fourth cell has been passed by now; do the next one with compares of its own.
  rig_.write(false, base(1) + 7, 5);
  rig_.write(true, base(1) + 7, 5);
  const bool before = equ(1);
  step(1, true, 0);
  Tick rise = 0, fall = 0;
  const Tick start = rig_.now();
  while (rig_.now() < start + 1000 * kSclk) {
    rig_.tick();
    if (rise == 0 && equ(1) != before) rise = rig_.now();
    if (rise != 0 && fall == 0 && equ(1) == before) fall = rig_.now();
  }
  EXPECT_NEAR(static_cast<double>(fall - rise), 500.0 * kSclk, 1.0 * kSclk);
  EXPECT_NEAR(static_cast<double>(rise - start), 250.0 * kSclk, 6.0 * kSclk) << "filter delay and rounding";
}

}  // namespace
}  // namespace brick
