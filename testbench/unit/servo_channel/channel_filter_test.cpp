// The way of an input into a channel, to the tick: two flip-flops, the majority of three samples, the memories behind
// it, and what a reset holds back (servo-ic:5.3). Where SCLK falls is not assumed: every tick of its period is tried.
#include <set>

#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelFilterTest : public ChannelTest {
 protected:
  // Ticks until the condition holds, one at a time; kHold at most.
  template <class Condition>
  Tick until(Condition condition) {
    const Tick start = rig_.now();
    while (!condition() && rig_.now() - start < kHold) rig_.tick();
    return rig_.now() - start;
  }
  // To an edge of SCLK, with the user flag of another channel.
  void to_sclk() {
    rig_.in.pins[1] ^= 1u << kUser;
    const bool before = bool{status(2, status_bit::kUser)};
    until([&] { return bool{status(2, status_bit::kUser)} != before; });
  }
  // One level for each of as many SCLK periods, from edge to edge; then what the status word shows after each sample.
  std::string shown(const std::string& levels) {
    std::string seen;
    to_sclk();
    for (const char level : levels) {
      rig_.pin(1, kHmfl, level == '1');
      rig_.ticks(kSclk);
      seen += status(1, status_bit::kHmfl) ? '1' : '0';
    }
    return seen;
  }
};

// A sample is what stood at the pin two edges before, so a change is sampled 3 to 14 ticks later; the sample after that
// shows it.
TEST_F(ChannelFilterTest, LevelIsInTheStatusWordWithTheSecondSampleBehindTwoFlipFlops) {
  for (unsigned input = 0; input < kChannelPins; ++input) {
    std::set<Tick> delays;
    to_sclk();
    for (Tick phase = 0; phase < kSclk; ++phase) {
      const auto level = [&] { return (rig_.peek(1, words::kStatus) >> (12 + input) & 1) != 0; };
      rig_.pin(1, input, false);
      rig_.ticks(kHold + phase);  // from an edge of SCLK
      rig_.pin(1, input, true);
      delays.insert(until(level));
    }
    EXPECT_EQ(*delays.begin(), 3 + kSclk) << kChannelPinNames[input];
    EXPECT_EQ(*delays.rbegin(), 3 + kSclk + kSclk - 1) << kChannelPinNames[input];
    EXPECT_EQ(delays.size(), kSclk) << kChannelPinNames[input];
  }
}

TEST_F(ChannelFilterTest, CountAndCaptureComeOneSclkAfterTheStatusWord) {
  control(1, decode_mode(regs::decode::kPulseCw) | kFlag);
  rig_.write(1, words::kCompareB, 0x400000);
  for (Tick phase = 0; phase < kSclk; ++phase) {
    const bool before = bool{equ(1)};
    rig_.write(1, words::kCompareA, static_cast<std::uint32_t>(counter(1)) & 0xFFFFFF);  // the next count leaves it
    rig_.read(1, words::kFlagPosition);
    rig_.pin(1, kA, true);
    rig_.pin(1, kHmfl, true);
    until([&] { return bool{status(1, status_bit::kHmfl)}; });
    EXPECT_FALSE(status(1, status_bit::kCaptured));
    EXPECT_EQ(until([&] { return bool{status(1, status_bit::kCaptured)}; }), kSclk);
    EXPECT_NE(bool{equ(1)}, before) << "the count shows at the same edge";
    pin(1, kA, false);
    pin(1, kHmfl, false, kHold + phase);
  }
}

TEST_F(ChannelFilterTest, MajorityOfTheLastThreeSamplesComesOut) {
  // What follows the first two samples is the majority of three, worked out by hand; three equal samples, or two in a
  // row, would make other words of the alternating ones.
  EXPECT_EQ(shown("0000100000").substr(2), "00000000") << "one differing sample never passes";
  EXPECT_EQ(shown("0000110000").substr(3), "0011000") << "two in a row always do";
  EXPECT_EQ(shown("0000101000").substr(3), "0001000") << "101 is high";
  EXPECT_EQ(shown("1111111111").substr(2), "11111111");
  EXPECT_EQ(shown("1111011111").substr(2), "11111111");
  EXPECT_EQ(shown("1111010111").substr(3), "1110111") << "010 is low";
  EXPECT_EQ(shown("1010101010").substr(3), "0101010");
}

// Reset leaves decode mode 0: a rise of A is a count, and with compare B out of the way EQU shows it. The status word
// tells which sample brought the level; the SCLK after it counts, if it is the sixth or a later one.
TEST_F(ChannelFilterTest, NothingCountsBeforeTheSixthSclkAfterReset) {
  std::set<Tick> counting, silent;
  for (Tick delay = 0; delay < kHold; ++delay) {
    rig_.in.pins.fill(0);
    rig_.reset();
    const Tick released = rig_.now();
    rig_.write(1, words::kCompareB, 0x400000);
    rig_.ticks(delay);
    rig_.pin(1, kA, true);
    until([&] { return bool{status(1, status_bit::kCha)}; });
    const Tick sample = (rig_.now() - released + kSclk - 1) / kSclk;
    rig_.ticks(2 * kSclk);
    (bool{equ(1)} ? counting : silent).insert(sample + 1);
  }
  ASSERT_FALSE(silent.empty() || counting.empty()) << "of all SCLK some count, some do not";
  EXPECT_EQ(*silent.rbegin(), 5) << "the last SCLK that does not count";
  EXPECT_EQ(*counting.begin(), 6) << "the first one that does";
}

// Whatever was sampled before a reset is forgotten: a level that stands needs its two samples once more.
TEST_F(ChannelFilterTest, AResetEmptiesTheFilter) {
  constexpr unsigned kAll = (1u << kChannelPins) - 1;
  const auto levels = [&] { return rig_.peek(1, words::kStatus) >> 12 & kAll; };
  for (unsigned run = 0; run < 2 * kTicksPerRef; ++run) {  // the first sample is taken 1, 2 or 3 ticks behind the reset
    SCOPED_TRACE(run);
    const bool before = run % 2 != 0;
    rig_.in.pins.fill(before ? kAll : 0);
    rig_.ticks(kHold);
    while (rig_.now() % kTicksPerRef != run / 2) rig_.tick();
    ASSERT_EQ(levels(), before ? kAll : 0);
    rig_.in.pins.fill(kAll);
    rig_.reset();
    for (Tick tick = 1; tick <= kSclk; ++tick) {
      EXPECT_EQ(levels(), 0u) << tick << " ticks after the reset, one sample at most";
      rig_.tick();
    }
    EXPECT_EQ(levels(), 0u);
    rig_.ticks(2 * kSclk);
    EXPECT_EQ(levels(), kAll) << "two samples behind the two flip-flops";
  }
}

TEST_F(ChannelFilterTest, LevelsFoundByAResetAreNoLossOfTheEncoder) {
  rig_.in.pins.fill(1u << kT | 1u << kV);  // the empty filter shows the pairs equal
  rig_.reset();
  rig_.ticks(4 * kHold);
  EXPECT_FALSE(status(1, status_bit::kEncoderLoss));
}

TEST_F(ChannelFilterTest, LevelsFoundByAResetCaptureNothing) {
  rig_.in.pins.fill(1u << kHmfl);
  rig_.reset();
  control(1, kFlag);  // before the first level has come through
  rig_.ticks(4 * kHold);
  EXPECT_TRUE(status(1, status_bit::kHmfl));
  EXPECT_FALSE(status(1, status_bit::kCaptured));
}

}  // namespace
}  // namespace brick
