// What the model of the channels says of itself where no pin shows it: when nothing is to come, and how long the
// switches of the PWM have been on over long stretches that are executed at once.
#include <random>

#include "testbench/unit/random_seed.h"
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

// systemc/core/model_block.h: a position that has come to rest asks for no edge, with 1/T as soon as its fraction is
// full: behind T1 SCLK periods and the 13 clk_ref of the division.
TEST_F(ChannelTest, EquOfAPositionAtRestIsNoEvent) {
  constexpr Tick kDivision = 13 * kTicksPerRef;
  for (const bool fine : {false, true}) {
    control(1, fine ? kX4 | kFine : kX4);
    rig_.write(1, words::kCompareA, 3);
    rig_.ticks(20 * kSclk);
    EXPECT_EQ(rig_.next_equ_event(1), kNever) << fine;
    for (int round = 0; round < 3; ++round) {
      steps(1, 4, round != 1);
      EXPECT_LT(rig_.next_equ_event(1), kNever) << "a count has just come in";
      rig_.ticks(kHold + kDivision + 10 * kSclk);
      EXPECT_EQ(rig_.next_equ_event(1), kNever) << fine << ", behind round " << round;
    }
  }
}

// The pulse train asks for the edges of its pulses alone: by sixteenths of the range a pulse comes with each 16th
// PFM_CLK and is three long (servo-ic:5.12), off it asks for none.
TEST(ChannelPfmEvents, AreTheEdgesOfThePulses) {
  for (const std::uint32_t command : {0x100000u, 0xF00000u}) {  // up, down
    const ChannelPfm::Inputs in{true, command, 3}, off{false, command, 3};
    ChannelPfm pfm;
    EXPECT_EQ(pfm.periods_to_change(off), kNever);
    pfm.advance(pfm.periods_to_pulse(in), in);  // the first one downwards comes at once
    for (int pulse = 0; pulse < 3; ++pulse) {
      EXPECT_TRUE(pfm.pulse());
      EXPECT_EQ(pfm.periods_to_change(in), 3);
      pfm.advance(2, in);
      EXPECT_EQ(pfm.periods_to_change(in), 1);
      pfm.advance(1, in);
      EXPECT_FALSE(pfm.pulse());
      EXPECT_EQ(pfm.periods_to_change(in), 13);
      EXPECT_EQ(pfm.periods_to_change(off), kNever);
      EXPECT_TRUE(pfm.advance(13, in));
    }
    pfm.stop();
    EXPECT_EQ(pfm.periods_to_change(off), kNever);
  }
}

// systemc/core/motor_digest.h: what TOP is on for, less what BOT is, here to the tick from the pins. Commands of one
// period each, so that a switch may be on for any number of ticks, one too.
TEST(ChannelPwmTimes, AreThoseOfThePinsHoweverLongTheStretch) {
  constexpr int kMaxCount = 100, kRange = kMaxCount + 4;
  constexpr Tick kTriangle = 2 * (2 * kMaxCount + 3);
  std::mt19937 random(random_seed(1));
  ServoIc slow{sc_core::sc_gen_unique_name("ic")}, fast{sc_core::sc_gen_unique_name("ic")};
  Tick now = 0, on = 0, asked = 0;
  unsigned ones = 0;
  Tick length = 0;
  const auto run_to = [&](Tick end) {
    while (now < end) {
      const std::uint32_t pins = slow.motor_outputs().w[0] & 3;  // from this edge to the next
      on += (pins & 1) != 0 ? 1 : (pins & 2) != 0 ? -1 : 0;
      ones += pins == 0 && length == 1 ? 1 : 0;
      length = pins == 0 ? 0 : length + 1;
      slow.advance(++now);
    }
  };
  const auto write = [&](const regs::Register& word, std::uint32_t value) {
    run_to(next_ref_edge(now));
    fast.advance(now);
    for (ServoIc* ic : {&slow, &fast}) ic->write(word.space == 'X', word.address, value);
  };
  for (ServoIc* ic : {&slow, &fast}) ic->reset(0);
  write(ic_words::kPwmControl, pwm_control(kMaxCount, 1));
  write(ic_words::kClockControl, kOwnClocks);
  for (int run = 0; run < 3000; ++run) {
    const int command = static_cast<int>(random() % (2 * kRange + 1)) - kRange;
    write(words::kOutA, static_cast<std::uint32_t>(command) << 8 & 0xFFFFFF);
    run_to(now + kTriangle);
    if (run % 7 != 0) continue;
    fast.advance(now);
    ASSERT_EQ(fast.channels().pwm_times(0).balance[0], on) << "between ticks " << asked << " and " << now;
    asked = now;
  }
  EXPECT_GT(ones, 5u) << "on for a tick";
}

// With inverted outputs both switches of a phase are on in its dead time: as often as the pins show them so, and not at
// all without (systemc/core/motor_digest.h).
TEST(ChannelPwmTimes, ShortsAreDeadTimesOfInvertedOutputs) {
  constexpr Tick kTriangle = 2 * (2 * 100 + 3);
  ServoIc ic{sc_core::sc_gen_unique_name("ic")};
  Tick now = 0;
  const auto write = [&](const regs::Register& word, std::uint32_t value) {
    ic.advance(now = next_ref_edge(now));
    ic.write(word.space == 'X', word.address, value);
  };
  ic.reset(0);
  write(ic_words::kPwmControl, pwm_control(100, 1));  // a dead time of 16 ticks
  write(ic_words::kClockControl, kOwnClocks);
  write(words::kOutA, 20 << 8);
  write(words::kOutB, 0x1000000 - (30 << 8));
  write(words::kOutC, 50 << 8);
  ic.advance(now += 2 * 13057);
  for (const std::uint32_t word : {kInvertAb | kInvertC, 0u, kInvertC, kInvertAb}) {
    write(words::kControl, word);
    ic.advance(now += kTriangle);
    const std::uint64_t before = ic.channels().pwm_times(0).shorts;
    std::uint64_t shown = 0;
    std::uint32_t last = ic.motor_outputs().w[0];
    for (const Tick end = now + 5 * kTriangle; now < end;) {
      ic.advance(++now);
      const std::uint32_t pins = ic.motor_outputs().w[0];
      for (unsigned phase = 0; phase < 3; ++phase)
        shown += (pins >> 2 * phase & 3) == 3 && (last >> 2 * phase & 3) != 3 ? 1 : 0;
      last = pins;
    }
    EXPECT_EQ(ic.channels().pwm_times(0).shorts - before, shown);
    EXPECT_EQ(shown, 5 * 2 * ((word & kInvertAb ? 2u : 0u) + (word & kInvertC ? 1u : 0u))) << "two in each triangle";
  }
}

}  // namespace
}  // namespace brick
