// PWM and PFM pulses to the tick where the plain rates and widths leave the rule open: a dead time that begins anew,
// pulses that join, the edge of DIR, an accumulator that stands, what rests at which level (servo-ic:5.11,
// servo-ic:5.12, servo-ic:10/10).
#include <vector>

#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelPulseTest : public ChannelTest {
 protected:
  static constexpr Tick kPfmClk = 12;
  // The tick of the edge that makes the condition true.
  template <class Condition>
  Tick edge_of(Condition condition, Tick limit = 100'000) {
    const Tick end = rig_.now() + limit;
    while (!condition() && rig_.now() < end) rig_.tick();
    EXPECT_LT(rig_.now(), end);
    return rig_.now();
  }
  bool pulse() { return rig_.other(kPulse, 1); }
  Tick pulse_rises() {
    edge_of([&] { return !pulse(); });
    return edge_of([&] { return pulse(); });
  }
  void out_c(int command) { rig_.write(1, words::kOutC, static_cast<std::uint32_t>(command) & 0xFFFFFF); }
  unsigned switches() { return rig_.pins().pwm & 0x3F; }  // of channel 1
};

// The comparison is low for 4 I7000 + 6 - (2 command + 2 I7000 + 3) = 203 ticks, less than the 240 of the dead time:
// BOT stays off, and TOP waits 240 ticks from its end, not from its beginning.
TEST_F(ChannelPulseTest, ChangeWithinTheDeadTimeBeginsItAnew) {
  rig_.write(ic_words::kPwmControl, pwm_control(6527, 15));
  rig_.write(1, words::kOutA, (6527 - 100) << 8);
  rig_.ticks(3 * 26114);
  edge_of([&] { return rig_.pwm(1, kTopA); });
  const Tick off = edge_of([&] { return !rig_.pwm(1, kTopA); });
  EXPECT_EQ(edge_of([&] { return rig_.pwm(1, kTopA) || rig_.pwm(1, kBottomA); }) - off, 203 + 240);
  EXPECT_FALSE(rig_.pwm(1, kBottomA));
}

// Inverted, off is high: both switches of A and B, or of C, are on together in the dead time and after a trip. A pair
// that is no PWM output is low, inverted or not. The rest of servo-ic:10/10 is in channel_trip_test.cpp.
TEST_F(ChannelPulseTest, OffIsTheLevelThatTheInversionMakesOfIt) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 255));  // longer than the period: always off
  rig_.ticks(4 * kPhase);
  struct Row {
    std::uint32_t word;
    unsigned switches;
  };
  for (const Row& row : {Row{0, 0}, Row{kInvertAb, 0x0F}, Row{kInvertC, 0x30}, Row{kInvertAb | kInvertC, 0x3F},
                         Row{kInvertAb | kInvertC | kDac, 0x30}, Row{kInvertAb | kInvertC | kPfm, 0x0F},
                         Row{kInvertAb | kInvertC | kDac | kPfm, 0}}) {
    for (const bool trip : {false, true}) {
      rig_.in.trip = trip;
      if (!trip) control(1, row.word);
      rig_.ref(2);
      EXPECT_EQ(switches(), row.switches) << "trip " << trip << ", control " << std::hex << row.word;
      if ((row.word & kDac) == 0) { EXPECT_FALSE(rig_.other(kDacA, 1) || rig_.other(kDacB, 1)); }
    }
  }
}

// The reset value of the dead time, 15, holds all switches off for 240 ticks; then one of each pair turns on. Where the
// triangle was at the reset, which commands it had and which dead time, is nothing to that, nor whether a clock came.
TEST_F(ChannelPulseTest, SwitchesAreOffForTheFirstDeadTimeAfterReset) {
  for (const Tick place : {0, 50, 100, 150, 200, 250, 300, 350, 400}) {  // of the 406 ticks of a period
    SCOPED_TRACE(place);
    rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, place % 100 == 0 ? 0 : 255));
    for (unsigned channel = 1; channel <= 4; ++channel) {
      rig_.write(channel, words::kOutA, 0x003200);
      rig_.write(channel, words::kOutB, 0xFFCE00);
    }
    rig_.ticks(26114 + 4 * kPhase);
    edge_of([&] { return !rig_.pins().phase; });
    rig_.ticks(place);
    rig_.reset(place / 100 % 2 == 0 ? 4 : 0);
    for (Tick t = 0; t < 240; ++t) {
      ASSERT_EQ(rig_.pins().pwm, 0u) << t;
      rig_.tick();
    }
    for (unsigned channel = 1; channel <= 4; ++channel)
      for (const unsigned pair : {kTopA, kTopB, kTopC})
        EXPECT_NE(rig_.pwm(channel, pair), rig_.pwm(channel, pair + 1)) << channel;
    rig_.write(ic_words::kClockControl, kServoEachPhase);
  }
}

// From 0 upwards the triangle comes to -1, below a command of 0, after 2 I7000 + 3 ticks and stands there for one more;
// a switch moves two ticks after the end of that (servo-ic:5.11/10).
TEST_F(ChannelPulseTest, TriangleStartsAtZeroGoingUpAfterReset) {
  rig_.reset();
  const Tick released = rig_.now();
  edge_of([&] { return rig_.pwm(1, kBottomA); });
  EXPECT_EQ(edge_of([&] { return !rig_.pwm(1, kBottomA); }) - released, 2 * 6527 + 3 + 1 + 2);
}

// A command written in one half of the triangle is in use in the next, whichever end lies between them.
TEST_F(ChannelPulseTest, CommandIsTakenAtBothEndsOfTheTriangle) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 0));
  rig_.ticks(4 * kPhase);
  for (int half = 0; half < 6; ++half) {
    edge_of([&] { return !rig_.pins().phase; });
    rig_.write(1, words::kOutA, half % 2 == 0 ? 0x7FFF00 : 0x800000);
    edge_of([&] { return rig_.pins().phase; });  // a turnaround
    rig_.ticks(3);
    EXPECT_EQ(rig_.pwm(1, kTopA), half % 2 == 0) << half;
  }
}

// PHASE from outside comes 5 ticks after a turnaround, which begins again there; it is not a second one, so the
// triangle goes on in its direction and a command of 0 changes the level once in each half.
TEST_F(ChannelPulseTest, TurnaroundThatIsMovedBackIsNotASecondOne) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 0));
  rig_.write(ic_words::kClockControl, ic_words::kClockControl.reset);  // both clocks are inputs
  rig_.ticks(6 * kPhase);
  rig_.in.phase = false;
  edge_of([&] { return !rig_.pwm(1, kTopA); });
  edge_of([&] { return rig_.pwm(1, kTopA); });  // the triangle is at -1, I7000 + 1 before the turnaround
  rig_.ticks(kMaxCount + 1 + 5 - 3);
  rig_.in.phase = true;  // acts at the third edge
  int changes = 0;
  bool last = true;
  for (Tick t = 0; t < 10 * kPhase; ++t) {
    rig_.tick();
    changes += rig_.pwm(1, kTopA) != last;
    last = rig_.pwm(1, kTopA);
  }
  EXPECT_EQ(changes, 10);
}

// servo-ic:5.15/2: whatever FAULT, the limits and the other flags show, and however they change, the pins are those of
// a channel that sees none. The same time behind a reset, two channels with PWM, two with DACs and pulses.
TEST_F(ChannelPulseTest, FlagsActOnNoOutput) {
  const auto run = [&](unsigned flags) {
    while (rig_.now() % kTicksPerRef != 0) rig_.tick();
    rig_.in.pins.fill(0);
    rig_.reset();
    rig_.write(ic_words::kClockControl, kServoEachPhase);
    for (unsigned channel = 1; channel <= 4; ++channel) {
      control(channel, kX4 | kEnable | kEquState | kEquWrite | (channel % 2 == 0 ? kDac | kPfm : 0));
      rig_.write(channel, words::kOutA, 0x200000);
      rig_.write(channel, words::kOutB, 0xE00000);
      rig_.write(channel, words::kOutC, 0x100000);
    }
    std::vector<ChannelPins> seen;
    for (Tick t = 0; t < 3 * 13057; ++t) {
      if (t % 5000 == 100) rig_.in.pins.fill(flags);
      if (t % 5000 == 4900) rig_.in.pins.fill(0);
      rig_.tick();
      seen.push_back(rig_.pins());
    }
    return seen;
  };
  const std::vector<ChannelPins> quiet = run(0);
  std::uint32_t low = 0, high = 0, switched = 0;
  for (const ChannelPins& pins : quiet) {
    low |= ~pins.others;
    high |= pins.others;
    switched |= pins.pwm;
  }
  EXPECT_EQ(high & 0xFFAA0A, 0xFFAA0Au) << "EQU, AENA, DAC B, DAC A, PULSE";
  EXPECT_EQ(low & 0xFF0000, 0u) << "EQU and AENA all the time";
  EXPECT_EQ(switched & 0xFC0FC0u, 0u) << "no PWM";
  EXPECT_NE(switched, 0u);
  for (unsigned input = kFault; input < kChannelPins; ++input)
    EXPECT_TRUE(run(1u << input) == quiet) << kChannelPinNames[input];
}

TEST_F(ChannelPulseTest, AmplifierEnableDoesNotGateThePwm) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 0));
  rig_.write(1, words::kOutA, 0x7FFF00);
  rig_.ticks(4 * kPhase);
  for (const std::uint32_t enable : {0u, kEnable}) {
    control(1, enable);
    rig_.ref();
    EXPECT_TRUE(rig_.pwm(1, kTopA)) << enable;
    EXPECT_EQ(rig_.other(kAena, 1), enable != 0);
  }
}

TEST_F(ChannelPulseTest, WidthOfZeroIsOneAndPulsesThatMeetJoin) {
  control(1, kPfm);
  for (const std::uint32_t width : {0u, 1u, 2u, 255u}) {
    rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, width));
    out_c(width > 15 ? 0x8000 : 0x100000);  // every 512 PFM_CLK, every 16
    pulse_rises();
    const Tick rise = pulse_rises();
    EXPECT_EQ(edge_of([&] { return !pulse(); }) - rise, (width == 0 ? 1 : width) * kPfmClk);
    out_c(0);
  }
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 15));
  rig_.ticks(20 * kPfmClk);
  out_c(0x200000);  // every 8 PFM_CLK
  const Tick first = edge_of([&] { return pulse(); });
  while (rig_.now() < first + 10 * 8 * kPfmClk) {
    rig_.tick();
    ASSERT_TRUE(pulse());
  }
  out_c(0);
  EXPECT_EQ(edge_of([&] { return !pulse(); }) - first, (10 * 8 + 15) * kPfmClk) << "15 from the last overflow on";
}

TEST_F(ChannelPulseTest, DirectionChangesWithTheLeadingEdgeOfThePulse) {
  control(1, kPfm);
  out_c(0x100000);
  pulse_rises();
  for (const int command : {-0x100000, 0x100000, -0x080000}) {
    edge_of([&] { return !pulse(); });
    const bool before = rig_.other(kDir, 1);
    out_c(command);
    wait_until([&] {
      if (!pulse()) { EXPECT_EQ(rig_.other(kDir, 1), before); }
      return pulse();
    });
    EXPECT_EQ(rig_.other(kDir, 1), command < 0);
  }
}

// 256 PFM_CLK to the first overflow, 100 of them before the output is turned off and 156 after it is on again. The
// triangle takes 13057 ticks to its next end: a command that waited for it would be seen.
TEST_F(ChannelPulseTest, CommandActsAtOnceAndTheAccumulatorStandsWhileTheOutputIsOff) {
  rig_.write(ic_words::kPwmControl, pwm_control(6527, 1));
  rig_.ticks(2 * kPhase);
  out_c(0x010000);
  control(1, kPfm);
  rig_.ticks(100 * kPfmClk - kTicksPerRef);
  EXPECT_FALSE(pulse());
  for (const std::uint32_t off : {kInvertC, kInvertDir}) {
    control(1, off);
    EXPECT_FALSE(pulse()) << "rests low, inverted or not";
    EXPECT_FALSE(rig_.other(kDir, 1));
    rig_.ticks(300 * kPfmClk);
  }
  control(1, kPfm);
  const Tick on = rig_.now();
  const Tick wait = edge_of([&] { return pulse(); }) - on;
  EXPECT_GT(wait, 155 * kPfmClk);
  EXPECT_LE(wait, 156 * kPfmClk);
}

TEST_F(ChannelPulseTest, RateIsThatOfAll24BitsOfTheCommandUpToAQuarterOfItsClock) {
  control(1, kPfm);
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 1));
  const auto pulses = [&](int command, Tick periods) {
    out_c(command);
    int n = 0;
    bool last = pulse();
    for (const Tick end = rig_.now() + periods * kPfmClk; rig_.now() < end;) {
      rig_.tick();
      n += pulse() && !last;
      last = pulse();
    }
    out_c(0);
    return n;
  };
  out_c(-1);  // from 0 it underflows at once; the accumulator is then 1 below its end
  const Tick down = edge_of([&] { return pulse(); }, kPfmClk + 1);
  EXPECT_TRUE(rig_.other(kDir, 1));
  out_c(1);
  EXPECT_EQ(edge_of([&] { return !rig_.other(kDir, 1); }) - down, kPfmClk) << "and overflows with the next";
  rig_.ticks(0x10 * kPfmClk);
  out_c(0);
  rig_.ticks(0x10 * kPfmClk);
  for (const int sign : {1, -1}) {
    EXPECT_NEAR(pulses(sign * 0x200000, 800), 100, 1);
    EXPECT_NEAR(pulses(sign * 0x3FFFFF, 800), 200, 1);
    EXPECT_NEAR(pulses(sign * 0x400000, 800), 200, 1);
    EXPECT_NEAR(pulses(sign * 0x7FFFFF, 800), 200, 1);
  }
}

// 3FFFFF and three steps of 400000 make FFFFFF, so the fourth overflows; with steps of 400001 the third would, with one
// the other way the first. Downwards -1 underflows first and leaves FFFFFF, of which the same steps leave 0.
TEST_F(ChannelPulseTest, ALargerCommandIsAQuarterOnItsWayToTheLastStep) {
  int rises = 0;
  const auto run = [&](int command, Tick periods) {  // so many additions of it
    const Tick end = rig_.now() + periods * kPfmClk;
    bool last = pulse();
    out_c(command);
    for (;; rig_.tick()) {
      rises += pulse() && !last;
      last = pulse();
      if (rig_.now() == end) break;
    }
  };
  for (const int sign : {1, -1})
    for (const int command : {0x400000, 0x400001, 0x500000, 0x7FFFFF}) {
      SCOPED_TRACE(::testing::Message() << sign << " times " << command);
      rig_.reset();
      rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 1));
      control(1, kPfm);
      run(0, 4);
      if (sign < 0) run(-1, 1);
      run(0, 4);
      ASSERT_EQ(rises, sign < 0);
      run(sign * 0x3FFFFF, 1);
      run(sign * command, 3);
      run(0, 4);
      EXPECT_EQ(rises, sign < 0);
      run(sign * command, 1);
      run(0, 4);
      EXPECT_EQ(rises, sign < 0 ? 2 : 1);
      EXPECT_EQ(rig_.other(kDir, 1), sign < 0);
      rises = 0;
    }
}

// Bits 7..0 of a PWM command do nothing, and commands are signed.
TEST_F(ChannelPulseTest, LowByteOfAPwmCommandDoesNothing) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 0));
  rig_.ticks(4 * kPhase);
  for (const int command : {-50, -1, 0, 1, 50}) {
    for (const std::uint32_t low : {0x00u, 0x7Fu, 0x80u, 0xFFu}) {
      rig_.write(1, words::kOutA, (static_cast<std::uint32_t>(command) << 8 & 0xFFFF00) | low);
      rig_.ticks(4 * kPhase);
      Tick high = 0;
      for (Tick t = 0; t < 2 * kPhase; ++t) {
        rig_.tick();
        high += rig_.pwm(1, kTopA);
      }
      EXPECT_EQ(high, 2 * command + kPhase) << command << " " << low;
    }
  }
}

}  // namespace
}  // namespace brick
