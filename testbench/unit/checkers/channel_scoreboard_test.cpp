// The scoreboard of the encoder and capture benches against hand-made sequences: the check vectors of servo-ic:14/7
// to 12, and the tick of a count from the filter's rule.
#include "testbench/checkers/channel_scoreboard.h"

#include <gtest/gtest.h>

#include "rtl/regs/brick_regs.hpp"

namespace brick {
namespace {

constexpr std::uint16_t kA = 1u << kEncA, kB = 1u << kEncB, kC = 1u << kEncC, kHome = 1u << kHmfl;
constexpr Tick kSclk = 12;
using namespace regs::servo_channel;
constexpr std::uint32_t kError = status::kEncoderError.mask(), kCaptured = status::kCaptured.mask(),
                        kGatedIndex = status::kCapturedGatedIndex.mask();

class ChannelScoreboardRules : public ::testing::Test {
 protected:
  ChannelScoreboardRules() {
    board_.synchronise(0, kSclk, 0);  // SCLK at ticks 0, 12, 24, ...
    board_.decoder.mode = 9;          // holds
    put(0);
  }
  // The levels stay for ten SCLK periods, or for `ticks`.
  void put(unsigned pins, Tick ticks = 10 * kSclk) {
    board_.drive(now_, static_cast<std::uint16_t>(pins));
    now_ += ticks;
    board_.advance(now_);
  }
  void cycle_up() {
    for (const unsigned pins : {+kA, kA | kB, +kB, 0}) put(pins);
  }
  std::int32_t position_of(unsigned mode) {
    board_.decoder.mode = mode;
    const std::int32_t before = board_.decoder.counter();
    cycle_up();
    return board_.decoder.counter() - before;
  }

  ChannelScoreboard board_;
  Tick now_ = 0;
};

TEST_F(ChannelScoreboardRules, CountsACycleByItsMode) {
  const int expected[16] = {-1, 1, 2, 4, 1, -1, -2, -4, 0, 0, 0, 0, 0, 0, 0, 0};  // pulse on A with B low counts down
  for (unsigned mode = 0; mode < 11; ++mode) EXPECT_EQ(position_of(mode), expected[mode]) << "I7mn0=" << mode;
}

TEST_F(ChannelScoreboardRules, CountsHallStatesInTheirOrder) {
  put(kC);
  board_.decoder.mode = 11;
  board_.decoder.clear_error();
  for (const unsigned pins : {kB | kC, +kB, kA | kB, +kA, kA | kC, +kC}) put(pins);
  EXPECT_EQ(board_.decoder.counter(), 6);
  EXPECT_FALSE(board_.decoder.error());
  board_.decoder.mode = 15;
  put(kA | kC);  // one back
  EXPECT_EQ(board_.decoder.counter(), 7);
  put(kA | kB | kC);
  EXPECT_TRUE(board_.decoder.error());
  EXPECT_EQ(board_.decoder.counter(), 7);
}

TEST_F(ChannelScoreboardRules, BothLinesAtOnceAreAnErrorAndNoCount) {
  board_.decoder.mode = 3;
  put(kA | kB);
  EXPECT_EQ(board_.decoder.counter(), 0);
  EXPECT_EQ(board_.status(kError), kError);
  put(kB);
  EXPECT_EQ(board_.decoder.counter(), 1);
  EXPECT_EQ(board_.status(kError), kError);
  board_.decoder.clear_error();
  EXPECT_EQ(board_.status(kError), 0u);
}

TEST_F(ChannelScoreboardRules, PassesTwoSamplesAndNotOne) {
  board_.decoder.mode = 3;
  board_.counts.clear();
  put(kA, kSclk);
  put(0);
  EXPECT_TRUE(board_.counts.empty());
  put(kA, 2 * kSclk);
  put(0);
  EXPECT_EQ(board_.counts.size(), 2u);  // up and down again
}

// The wrong rule of the negative controls differs where one sample decides, and nowhere else.
TEST_F(ChannelScoreboardRules, WrongFilterIsAsLateAndPassesOneSample) {
  board_.filter.lets_one_pass = true;
  board_.decoder.mode = 3;
  board_.counts.clear();
  put(kA, 129);  // driven at 120: sampled at 132 and 144, counted at 156, as with the right rule
  put(kA | kB, kSclk);
  put(kA);
  ASSERT_EQ(board_.counts.size(), 3u);
  EXPECT_EQ(board_.counts[0].tick, 156);
}

TEST_F(ChannelScoreboardRules, CountsTwoPeriodsAfterTheFirstSample) {
  board_.decoder.mode = 3;
  board_.counts.clear();
  // Driven at 120: seen from 123 on, sampled at 132 and 144, counted at 156. Driven at 249 = 252 - 3: sampled at 252,
  // counted at 276.
  EXPECT_EQ(now_, 120);
  put(kA, 129);
  put(kA | kB);
  ASSERT_EQ(board_.counts.size(), 2u);
  EXPECT_EQ(board_.counts[0].tick, 156);
  EXPECT_EQ(board_.counts[1].tick, 276);
  EXPECT_EQ(board_.decoder.t1(), 10u);
  EXPECT_EQ(ChannelScoreboard::earliest(120, kSclk), 147);
  EXPECT_EQ(ChannelScoreboard::latest(120, kSclk), 158);
}

TEST_F(ChannelScoreboardRules, CapturesOnceOnTheEdgeOfAFlag) {
  board_.decoder.mode = 3;
  board_.capture.code = 2;
  put(kA);
  put(kA | kHome);
  EXPECT_EQ(board_.status(kCaptured), kCaptured);
  EXPECT_EQ(board_.capture.position(), 1u);
  put(kA | kB);
  put(kA | kB | kHome);
  EXPECT_EQ(board_.capture.position(), 1u) << "not armed";
  EXPECT_EQ(board_.capture.read(), 1u);
  put(kB | kHome);
  EXPECT_EQ(board_.status(kCaptured), 0u) << "true already when armed";
  put(kB);
  put(kB | kHome);
  EXPECT_EQ(board_.capture.read(), 3u);
}

TEST_F(ChannelScoreboardRules, GatesTheIndex) {
  board_.decoder.mode = 3;
  board_.capture.gated = true;
  board_.capture.gate = 1;  // A and B low
  put(kA);
  put(kA | kB | kC);
  EXPECT_FALSE(board_.capture.captured());
  put(kB | kC);
  put(kC);
  EXPECT_EQ(board_.status(kCaptured | kGatedIndex), kCaptured | kGatedIndex);
  EXPECT_EQ(board_.capture.read(), 4u);  // the count that enters 00 included
}

TEST(CompareRule, ToggleWhenAPositionIsLeft) {
  Compare c;
  c.a = 1000;
  c.b = static_cast<std::uint32_t>(1010 - 2000) & 0xFFFFFF;
  c.increment = 2000;
  std::vector<std::uint32_t> at;
  for (std::uint32_t p = 100; p < 3010; ++p)
    if (c.count(p, 1)) at.push_back(p);
  EXPECT_EQ(at, (std::vector<std::uint32_t>{1000, 1010, 3000}));
  EXPECT_EQ(c.a, 3000u);
  EXPECT_EQ(c.b, 3010u);
  at.clear();
  for (std::uint32_t p = 3009; p > 1000; --p)
    if (c.count(p, -1)) at.push_back(p);
  EXPECT_EQ(at, (std::vector<std::uint32_t>{3000, 1010}));
}

// servo-ic:5.4, mode 8: each pulse of the own PFM output counts with the next SCLK edge, whatever the lines do.
TEST_F(ChannelScoreboardRules, CountsItsOwnPulses) {
  board_.decoder.mode = 8;
  const std::int32_t before = board_.decoder.counter();
  for (const int direction : {1, 1, -1}) {
    board_.pulse(now_, direction);
    put(kA);
  }
  EXPECT_EQ(board_.decoder.counter(), before + 1);
  EXPECT_TRUE(board_.decoder.down());
  board_.decoder.mode = 9;
  board_.pulse(now_, 1);
  put(0);
  EXPECT_EQ(board_.decoder.counter(), before + 1) << "no other mode has them";
}

// servo-ic:5.4: control bit 10 holds the counter at 0, without an error.
TEST_F(ChannelScoreboardRules, AHeldCounterIsZero) {
  board_.decoder.mode = 7;
  cycle_up();
  ASSERT_NE(board_.decoder.counter(), 0);
  board_.decoder.hold = true;
  put(kA | kB);  // both at once
  EXPECT_EQ(board_.decoder.counter(), 0);
  EXPECT_FALSE(board_.decoder.error());
}

// servo-ic:5.9: codes 0 and 4 (by software), 3 (index and flag).
TEST(CaptureRule, BySoftwareAndByBoth) {
  Capture software(0);
  software.code = 0;
  EXPECT_FALSE(software.step(0, 1));
  software.code = 4;
  EXPECT_TRUE(software.step(0, 2));
  EXPECT_EQ(software.read(), 2u);
  EXPECT_FALSE(software.step(0, 3)) << "it stands: the condition has to become true anew";
  Capture both(0);
  both.code = 3;
  std::uint32_t position = 0;
  for (const auto& [level, captures] :
       {std::pair<unsigned, bool>{kC, false}, {0, false}, {kHome, false}, {kHome | kC, true}})
    EXPECT_EQ(both.step(static_cast<std::uint16_t>(level), ++position), captures) << level;
  EXPECT_EQ(both.position(), 4u);
}

// servo-ic:5.8/3: the index line has four signals, one by each state of A and B: C, U, V and W of the status word.
TEST(CaptureRule, TheIndexLineIsTakenApart) {
  constexpr unsigned kLines = 1u << kU | 1u << kV | 1u << kW;
  const std::pair<unsigned, unsigned> states[] = {{kA | kB, kC}, {+kA, 1u << kU}, {0, 1u << kV}, {+kB, 1u << kW}};
  for (const auto& [high_in, shows] : states) {
    Capture capture(0);
    capture.gate = 2;
    for (const auto& [state, unused] : states) {
      EXPECT_TRUE(capture.incomplete());
      capture.step(static_cast<std::uint16_t>(state | (state == high_in ? +kC : 0)), 0);
    }
    EXPECT_FALSE(capture.incomplete());
    const auto level = static_cast<std::uint16_t>(kLines | kHome | kB | (high_in == kB ? +kC : 0));
    EXPECT_EQ(capture.shown(level), kHome | kB | shows) << "the pins U, V and W are none of it";
    capture.gate = 0;
    EXPECT_EQ(capture.shown(level), level);
  }
}

}  // namespace
}  // namespace brick
