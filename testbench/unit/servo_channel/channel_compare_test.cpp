// Writes of the compares against what the hardware does to them: a write never turns EQU, and it beats a move at the
// same edge (servo-ic:5.10). What the compares do by themselves is in channel_capture_test.cpp.
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelCompareTest : public ChannelTest {
 protected:
  static constexpr std::uint32_t kFar = 0x400000;

  void SetUp() override {
    ChannelTest::SetUp();
    control(1, kX4 | kCounterReset);
    control(1, kX4);
  }
  void place(std::uint32_t a, std::uint32_t b, std::uint32_t increment) {
    rig_.write(1, words::kCompareA, a);
    rig_.write(1, words::kCompareB, b);
    rig_.write(1, words::kCompareIncrement, increment);
  }
};

TEST_F(ChannelCompareTest, WritingNeverTurnsEqu) {
  steps(1, 4, true);
  for (const bool level : {false, true}) {
    control(1, kX4 | kEquWrite | (level ? kEquState : 0));
    for (const std::uint32_t value : {3u, 4u, 5u, kFar}) {
      for (const auto& [a, b] : {std::pair{value, kFar}, {kFar, value}, {value, value}}) {
        place(a, b, a == b ? 0 : 4);
        rig_.ticks(4 * kSclk);
        EXPECT_EQ(bool{equ(1)}, level) << a << ' ' << b;
      }
    }
  }
}

TEST_F(ChannelCompareTest, IncrementOf0LeavesTheComparesWhereTheyAre) {
  place(2, kFar, 0);
  steps(1, 4, true);
  EXPECT_TRUE(equ(1));
  EXPECT_EQ(rig_.peek(1, words::kCompareA), 2u);
  EXPECT_EQ(rig_.peek(1, words::kCompareB), kFar);
}

// The other compare goes the way of the channel's own count, whichever way channel 1 counts at that edge.
TEST_F(ChannelCompareTest, EachChannelGoesTheWayOfItsOwnCount) {
  for (const unsigned ch : {2u, 3u, 4u})
    for (const bool up : {true, false}) {
      control(ch, kX4 | kCounterReset);
      control(ch, kX4);
      rig_.write(ch, words::kCompareA, 0);
      rig_.write(ch, words::kCompareB, 100);
      rig_.write(ch, words::kCompareIncrement, 7);
      const bool before{equ(ch)};
      step(1, !up, 0);
      step(ch, up);
      EXPECT_NE(bool{equ(ch)}, before) << ch;
      EXPECT_EQ(rig_.peek(ch, words::kCompareB), up ? 107u : 93u) << ch;
    }
}

// Leaving 0 moves the other compare by 7. Written one edge before, the new value moves; written at the edge or after
// it, it stands.
TEST_F(ChannelCompareTest, AWriteBeatsAMoveAtTheSameEdge) {
  for (const bool of_a : {true, false}) {
    const regs::Register& other = of_a ? words::kCompareA : words::kCompareB;
    const auto prepare = [&] {
      control(1, kX4 | kCounterReset);
      control(1, kX4);
      place(of_a ? kFar : 0, of_a ? 0 : kFar, 7);
      while (rig_.now() % kSclk != 0) rig_.tick();
    };
    prepare();
    const Tick start = rig_.now();
    const bool before = bool{equ(1)};
    step(1, true, 0);
    wait_until([&] { return bool{equ(1)} != before; });
    const Tick count = rig_.now() - start;
    for (const Tick edge : {count - kTicksPerRef, count, count + kTicksPerRef}) {
      prepare();
      step(1, true, edge - kTicksPerRef);
      rig_.write(1, other, 777);
      rig_.ticks(kHold);
      EXPECT_EQ(rig_.peek(1, other), edge < count ? 784u : 777u) << edge - count;
    }
  }
}

}  // namespace
}  // namespace brick
