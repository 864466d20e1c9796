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

  void SetUp() override {
    rig_.reset();
    rig_.write(true, 0x1C, kMaxCount << 8 | 15);
    rig_.write(true, 0x04, kOwnClocks & 0x0FFFFF);  // servo as fast as phase
    rig_.ticks(2 * 13057);
  }
  void TearDown() override { EXPECT_EQ(rig_.difference, "") << "RTL and model"; }

  void control(unsigned channel, std::uint32_t word) { rig_.write(true, base(channel) + 5, word); }
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
  // Signed counter, through the phase latch.
  int counter(unsigned channel) {
    rig_.ticks(kHold + 2 * kPhase);
    const std::uint32_t word = rig_.peek(true, base(channel) + 1);
    return static_cast<int>(word << 8) >> 8;
  }
  bool status(unsigned channel, unsigned bit) { return (rig_.peek(true, base(channel)) >> bit & 1) != 0; }
  bool equ(unsigned channel) { return rig_.other(kEqu, channel); }

  ChannelsRig rig_;
  std::array<unsigned, 4> place_{};
};

}  // namespace brick
