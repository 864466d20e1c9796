// Base of the channel tests: the rig after reset with default dividers (SCLK 12 ticks), own clocks and a short phase
// period.
#pragma once

#include <array>

#include "testbench/unit/servo_channel/channels_rig.h"

namespace brick {

class ChannelTest : public ::testing::Test {
 protected:
  static constexpr Tick kSclk = 12;
  static constexpr Tick kHold = 6 * kSclk;  // long enough for the filter
  static constexpr unsigned kMaxCount = 100;
  static constexpr Tick kPhase = 2 * kMaxCount + 3;
  static constexpr std::uint32_t kServoEachPhase = ic_words::clock_control::kServoDivider.set(kOwnClocks, 0);

  void SetUp() override {
    rig_.reset();
    rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 15));
    rig_.write(ic_words::kClockControl, kServoEachPhase);
    rig_.ticks(2 * 13057);
  }
  void TearDown() override { EXPECT_EQ(rig_.difference, "") << "RTL and model"; }

  void control(unsigned channel, std::uint32_t word) { rig_.write(channel, words::kControl, word); }
  void pin(unsigned channel, unsigned bit, bool level, Tick hold = kHold) {
    rig_.pin(channel, bit, level);
    rig_.ticks(hold);
  }
  // A quarter cycle of A and B.
  void step(unsigned channel, bool up, Tick hold = kHold) {
    constexpr std::array<unsigned, 4> kAb{0, 1, 3, 2};  // {B, A}: A leads
    unsigned& place = place_[channel - 1];
    place = (place + (up ? 1 : 3)) & 3;
    rig_.in.pins[channel - 1] = (rig_.in.pins[channel - 1] & ~3u) | kAb[place];
    rig_.ticks(hold);
  }
  void steps(unsigned channel, int n, bool up, Tick hold = kHold) {
    while (n-- > 0) step(channel, up, hold);
  }
  // Until the condition holds, one tick at a time; a failure where it takes longer than any period of these tests.
  template <class Condition>
  void wait_until(Condition condition) {
    constexpr Tick kLongest = 100'000;
    const Tick end = rig_.now() + kLongest;
    while (!condition()) {
      if (rig_.now() >= end) FAIL() << "it does not come about within " << kLongest << " ticks";
      rig_.tick();
    }
  }
  // Signed counter, through the phase latch.
  int counter(unsigned channel) {
    rig_.ticks(kHold + 2 * kPhase);
    const std::uint32_t word = rig_.peek(channel, words::kPhasePosition);
    return static_cast<int>(word << 8) >> 8;
  }
  // What they saw is in the message of the expectation that fails.
  ::testing::AssertionResult status(unsigned channel, const regs::Field& bit) {
    return saw(channel, bit.name, bit.is_set(rig_.peek(channel, words::kStatus)));
  }
  ::testing::AssertionResult equ(unsigned channel) { return saw(channel, "EQU", rig_.other(kEqu, channel)); }

  static ::testing::AssertionResult saw(unsigned channel, const char* what, bool level) {
    return ::testing::AssertionResult(level) << "channel " << channel << ": " << what << " is " << level;
  }

  ChannelsRig rig_;
  std::array<unsigned, 4> place_{};
};

}  // namespace brick
