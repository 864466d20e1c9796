// The clocks of the channels, clk_ref / 2^n: each number of SCLK and PFM_CLK by what it times, and that a new one waits
// for the end of the running period (servo-ic:3.3, servo-ic:5/2). DAC_CLK and ADC_CLK show themselves:
// channel_output_test.cpp.
#include <array>
#include <functional>

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

// The first period of each begins with the first reference edge behind a reset, and its length is that of the reset
// value: 12 ticks of SCLK and PFM_CLK, 24 of DAC_CLK, 48 of ADC_CLK. A status bit, a pulse, the second bit of $7FFFC0
// and the first of $FFFFFE rise with an edge each.
TEST_F(ChannelDividerTest, EachRunsFromTheFirstReferenceEdgeBehindAReset) {
  for (Tick later = 0; later < 48; later += kTicksPerRef + 1) {
    SCOPED_TRACE(later);
    rig_.write(ic_words::kClockControl, kWithout | 0xFFFu);
    rig_.ticks(2 * period(7) + later);
    rig_.in.pins.fill(0);
    rig_.in.phase = false;
    rig_.reset();
    const Tick first = (rig_.now() / kTicksPerRef + 1) * kTicksPerRef;
    rig_.ref();
    control(1, kPfm);
    rig_.write(1, words::kOutC, 0xFFFFFF);  // underflows at once
    rig_.pin(1, kUser, true);
    rig_.in.phase = true;
    struct Line {
      const char* name;
      Tick period, least;  // no sooner than this
      std::function<bool()> level;
    };
    const Line lines[] = {
        {"PFM_CLK", 12, 12, [&] { return rig_.other(kPulse, 1); }},
        {"SCLK", 12, 24, [&] { return bool{status(1, status_bit::kUser)}; }},
        {"ADC_CLK", 48, 0, [&] { return (rig_.pins().serial & 8) != 0; }},
        {"DAC_CLK", 24, 24, [&] { return (rig_.pins().serial & 2) != 0; }},
    };
    std::array<Tick, 4> rise{};
    for (const Tick end = rig_.now() + 3 * 48; rig_.now() < end;) {
      rig_.tick();
      for (unsigned i = 0; i < 4; ++i)
        if (rise[i] == 0 && lines[i].level()) rise[i] = rig_.now();
    }
    for (unsigned i = 0; i < 4; ++i) {
      ASSERT_NE(rise[i], 0) << lines[i].name;
      EXPECT_EQ((rise[i] - first) % lines[i].period, 0) << lines[i].name;
      EXPECT_GE(rise[i] - first, lines[i].least) << lines[i].name;
    }
    EXPECT_EQ(rise[0] - first, 12) << "the first addition behind the write";
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
