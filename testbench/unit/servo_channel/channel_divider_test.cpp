// The clocks of the channels, clk_ref / 2^n: each number of SCLK and PFM_CLK by what it times, and that a new one waits
// for the end of the running period (servo-ic:3.3, servo-ic:5/2). DAC_CLK and ADC_CLK show themselves:
// channel_output_test.cpp.
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

constexpr Tick period(unsigned n) { return kTicksPerRef << n; }

class ChannelDividerTest : public ChannelTest {
 protected:
  static constexpr std::uint32_t kWithout = kServoEachPhase & ~0xFFFu;  // all four divide by 1
  void divide(const regs::Field& clock, unsigned n) { rig_.write(ic_words::kClockControl, clock.set(kWithout, n)); }
  // T2 as the next fall of SERVO latches it, and when that was.
  std::uint32_t latch(Tick& at) {
    wait_until([&] { return rig_.pins().servo; });
    wait_until([&] { return !rig_.pins().servo; });
    at = rig_.now();
    rig_.ref(3);
    return rig_.peek(1, words::kTimer2);
  }
  Tick pulse_rises() {
    const Tick end = rig_.now() + 200 * period(7);
    while (rig_.other(kPulse, 1) && rig_.now() < end) rig_.tick();
    while (!rig_.other(kPulse, 1) && rig_.now() < end) rig_.tick();
    EXPECT_LT(rig_.now(), end);
    return rig_.now();
  }
};

// T2 counts SCLK: over 100 periods of it, one more or less by where the two latches stand in a period.
TEST_F(ChannelDividerTest, EachNumberOfSclkTimesT2) {
  for (unsigned n = 0; n < 8; ++n) {
    divide(ic_words::clock_control::kSclkDivider, n);
    rig_.ticks(2 * period(7));
    Tick from = 0, to = 0;
    const std::uint32_t before = latch(from);
    rig_.ticks(100 * period(n));
    const std::uint32_t passed = latch(to) - before;
    EXPECT_GE(passed * period(n), to - from - period(n)) << "n " << n;
    EXPECT_LE(passed * period(n), to - from + period(n)) << "n " << n;
  }
}

// The other three numbers are not SCLK's.
TEST_F(ChannelDividerTest, SclkTakesItsOwnNumberOnly) {
  rig_.write(ic_words::kClockControl, kWithout | 0xFF8u);
  rig_.ticks(2 * period(7));
  Tick from = 0, to = 0;
  const std::uint32_t before = latch(from);
  const std::uint32_t passed = latch(to) - before;
  EXPECT_GE(passed * period(0), to - from - period(0));
  EXPECT_LE(passed * period(0), to - from + period(0));
}

// A quarter of PFM_CLK at the most, one period wide: both are whole periods.
TEST_F(ChannelDividerTest, EachNumberOfPfmClkTimesPulses) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 1));
  control(1, kPfm);
  rig_.write(1, words::kOutC, 0x400000);
  for (unsigned n = 0; n < 8; ++n) {
    divide(ic_words::clock_control::kPfmDivider, n);
    rig_.ticks(2 * period(7));
    pulse_rises();
    const Tick rise = pulse_rises();
    wait_until([&] { return !rig_.other(kPulse, 1); });
    EXPECT_EQ(rig_.now() - rise, period(n)) << "n " << n;
    EXPECT_EQ(pulse_rises() - rise, 4 * period(n)) << "n " << n;
  }
}

// Pulses come with every fourth PFM_CLK. The number is written one reference edge after a pulse began, so in the middle
// of the first of the four periods if that is longer: that one is not cut, the other three have the new length. At
// n = 0 the write's own edge ends the first period, and the second still takes the old number: a divider loads with
// the edge at which a period begins, which the written word is behind.
TEST_F(ChannelDividerTest, ANewNumberWaitsForTheEndOfTheRunningPeriod) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 1));
  control(1, kPfm);
  rig_.write(1, words::kOutC, 0x400000);
  for (unsigned before = 0; before < 8; ++before)
    for (unsigned after = 0; after < 8; ++after) {
      divide(ic_words::clock_control::kPfmDivider, before);
      rig_.ticks(2 * period(7));
      pulse_rises();
      const Tick rise = pulse_rises();
      divide(ic_words::clock_control::kPfmDivider, after);
      ASSERT_EQ(rig_.now() - rise, kTicksPerRef);
      const int old = before == 0 ? 2 : 1;
      EXPECT_EQ(pulse_rises() - rise, old * period(before) + (4 - old) * period(after)) << before << " to " << after;
    }
}

}  // namespace
}  // namespace brick
