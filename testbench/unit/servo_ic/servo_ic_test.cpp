// Registers and clock outputs of a servo IC as the source of the clocks, the same expectations on both engines.
// Expected periods are arithmetic on servo-ic:3.1, servo-ic:3.2 and servo-ic:5.1.
#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/servo_ic/servo_ic_rig.h"

namespace brick {
namespace {

template <class Rig>
class ServoIcOn : public ::testing::Test {
 protected:
  ServoIcOn() { rig.power_up(); }

  void drive(unsigned max_count, unsigned phase_div, unsigned servo_div) {
    rig.write(true, kPwmWord, pwm_word(max_count));
    rig.write(true, kClockWord, clock_word(phase_div, servo_div, 0));
  }

  Rig rig;
};

using Engines = ::testing::Types<RtlRig, ModelRig>;
TYPED_TEST_SUITE(ServoIcOn, Engines, EngineNames);

TYPED_TEST(ServoIcOn, GlobalRegistersHaveTheirResetValuesWithBothClocksAsInputs) {
  EXPECT_EQ(this->rig.read(true, kClockWord), 0x3038D2u);
  EXPECT_EQ(this->rig.read(true, kDacStrobe), 0x7FFFC0u);
  EXPECT_EQ(this->rig.read(true, kAdcStrobe), 0xFFFFFEu);
  EXPECT_EQ(this->rig.read(true, kPwmWord), 0x197F0Fu);
  EXPECT_FALSE(this->rig.phase_oe());
  EXPECT_FALSE(this->rig.servo_oe());
}

// Check vector 17: the factory settings as clock and PWM word.
TYPED_TEST(ServoIcOn, FactorySettingsReadBackAsDocumented) {
  this->drive(6527, 0, 3);
  EXPECT_EQ(this->rig.read(true, kClockWord), 0x3008D2u);
  EXPECT_EQ(this->rig.read(true, kPwmWord), 0x197F0Fu);
  this->rig.run(2 * 4 * 13057);  // the pins are taken with rising edges
  EXPECT_TRUE(this->rig.phase_oe());
  EXPECT_TRUE(this->rig.servo_oe());
}

TYPED_TEST(ServoIcOn, EveryBitOfTheGlobalRegistersReadsBackButThoseThatDoNotExist) {
  for (const std::uint32_t value : {0xFFFFFFu, 0x000000u, 0xA5C35Au, 0x5A3CA5u}) {
    for (const unsigned offset : {kDacStrobe, kAdcStrobe}) {
      this->rig.write(true, offset, value);
      EXPECT_EQ(this->rig.read(true, offset), value);
    }
    this->rig.write(true, kClockWord, value);
    EXPECT_EQ(this->rig.read(true, kClockWord), value & 0xFF3FFFu) << "bits 15 and 14 are 0";
    this->rig.write(true, kPwmWord, value);
    EXPECT_EQ(this->rig.read(true, kPwmWord), value & 0x7FFFFFu) << "bit 23 is 0";
  }
}

TYPED_TEST(ServoIcOn, OtherWordsAreUntouchedByAWriteToOneOfThem) {
  this->rig.write(true, kAdcStrobe, 0xF84DFE);
  EXPECT_EQ(this->rig.read(true, kAdcStrobe), 0xF84DFEu);
  EXPECT_EQ(this->rig.read(true, kClockWord), 0x3038D2u);
  EXPECT_EQ(this->rig.read(true, kDacStrobe), 0x7FFFC0u);
  EXPECT_EQ(this->rig.read(true, kPwmWord), 0x197F0Fu);
}

TYPED_TEST(ServoIcOn, EveryChannelHasItsOwnWords) {
  for (unsigned channel = 0; channel < 4; ++channel) this->rig.write(false, 8 * channel + 7, 0x111111 * (channel + 1));
  for (unsigned channel = 0; channel < 4; ++channel) {
    EXPECT_EQ(this->rig.read(false, 8 * channel + 7), 0x111111 * (channel + 1)) << "compare A";
    EXPECT_EQ(this->rig.read(true, 8 * channel + 7), 0u) << "compare B";
  }
  EXPECT_EQ(this->rig.read(true, kClockWord), 0x3038D2u);
}

// The bus of the RTL, whose select and strobe the model's calls do not have: a word of the IC, or of each channel.
TEST(ServoIcBus, AWriteTakesSelectAndStrobeAndAWordShowsOnlySelected) {
  RtlRig rig;
  rig.power_up();
  std::vector<std::pair<bool, unsigned>> words{
      {true, kClockWord}, {true, kDacStrobe}, {true, kAdcStrobe}, {true, kPwmWord}};
  for (const unsigned base : {0x00u, 0x08u, 0x10u, 0x18u})  // OUT A, B, C, control, compares and their increment
    for (const auto& [x, offset] :
         {std::pair{false, 2u}, {false, 3u}, {false, 4u}, {true, 5u}, {false, 7u}, {true, 7u}, {true, 6u}})
      words.emplace_back(x, base + offset);
  for (const auto& [x, offset] : words) {
    SCOPED_TRACE(::testing::Message() << (x ? "X:+" : "Y:+") << offset);
    rig.write(x, offset, 0x010203);
    ServoIcInputs& in = rig.ic().in;
    for (const bool selected : {false, true}) {  // each without the other
      rig.begin_write(x, offset, 0x080104);
      in.sel = selected;
      in.we = !selected;
      rig.run(2 * kTicksPerRef);
      EXPECT_EQ(rig.ic().rdata(), selected ? 0x010203u : 0u);
    }
    rig.end_write();
    EXPECT_EQ(rig.read(x, offset), 0x010203u);
    EXPECT_EQ(rig.read(!x, offset), 0u) << "the other word of the address";
    rig.write(x, offset, 0);
  }
}

// Check vectors 1 and 4, and other settings: {I7m00, I7m01, I7m02}.
TYPED_TEST(ServoIcOn, PhaseAndServoPeriodsAreExactToTheTick) {
  BRICK_COVERS("CLK-3 CLK-6");
  const std::tuple<unsigned, unsigned, unsigned> settings[] = {
      {6527, 0, 3},                                                 // factory: 9.0346 kHz, 2.2587 kHz
      {1473, 3, 1},                                                 // 10.0004 kHz, 5.0002 kHz
      {2948, 0, 0},                                                 // servo as fast as phase
      {32767, 0, 0},                                                // the longest triangle
      {100, 2, 2},   {7, 4, 15}, {6, 15, 1}, {1, 0, 7}, {0, 1, 3},  // the shortest
  };
  for (const auto& [max_count, phase_div, servo_div] : settings) {
    SCOPED_TRACE(::testing::Message() << "I7m00=" << max_count << " I7m01=" << phase_div << " I7m02=" << servo_div);
    this->drive(max_count, phase_div, servo_div);
    this->rig.run(3 * (2 * 6527 + 3) * 16 + 4 * max_count);  // past everything that still ran with the setting before
    const Tick phase = Tick{2 * max_count + 3} * (phase_div + 1);
    const Tick rise = this->rig.edge_of(&ServoIcRig::phase, true);
    const Tick fall = this->rig.edge_of(&ServoIcRig::phase, false);
    const Tick rise2 = this->rig.edge_of(&ServoIcRig::phase, true);
    EXPECT_EQ(rise2 - rise, phase);
    EXPECT_EQ(fall - rise, phase / 2);

    const Tick servo_fall = this->rig.edge_of(&ServoIcRig::servo, false);
    EXPECT_FALSE(this->rig.phase());
    const Tick servo_rise = this->rig.edge_of(&ServoIcRig::servo, true);
    const Tick servo_fall2 = this->rig.edge_of(&ServoIcRig::servo, false);
    EXPECT_EQ(servo_fall2 - servo_fall, phase * (servo_div + 1));
    EXPECT_EQ(servo_rise - servo_fall, servo_div > 0 ? phase : phase - phase / 2);
    EXPECT_EQ((servo_fall - fall) % phase, 0) << "SERVO falls with a fall of PHASE";
  }
}

// CLK-5: 6.67 kHz phase, 3.33 kHz servo with I7m02 = 1. I7m00 = floor(117964.8 / 13.333 - 1) = 8846, one MaxPhase a
// phase.
TYPED_TEST(ServoIcOn, ServoIsHalfOfPhaseWithADividerOfOne) {
  BRICK_COVERS("CLK-6");
  this->drive(8846, 0, 1);
  this->rig.run(200'000);
  const Tick rise = this->rig.edge_of(&ServoIcRig::phase, true);
  const Tick phase = this->rig.edge_of(&ServoIcRig::phase, true) - rise;
  EXPECT_NEAR(static_cast<double>(kPwmClockHz) / static_cast<double>(phase), 6670, 4);
  const Tick fall = this->rig.edge_of(&ServoIcRig::servo, false);
  EXPECT_EQ(this->rig.edge_of(&ServoIcRig::servo, false) - fall, 2 * phase);
}

// A new I7m00 counts from the next bottom turnaround on, so no period is longer or shorter than both settings explain:
// half triangles of 2*20+3 = 43 ticks, then one from the old bottom (-22) to the new top (11), 33 ticks, then 2*10+3
// = 23.
TYPED_TEST(ServoIcOn, NewMaximumCountIsTakenAtTheBottomTurnaround) {
  this->drive(20, 0, 0);
  this->rig.run(2 * 13057 + 1000);
  this->rig.edge_of(&ServoIcRig::phase, true);
  this->rig.write(true, kPwmWord, pwm_word(10));
  Tick last = this->rig.edge_of(&ServoIcRig::phase, true), longest = 0, between = 0;
  for (int i = 0; i < 6; ++i) {
    const Tick next = this->rig.edge_of(&ServoIcRig::phase, true);
    const Tick period = next - last;
    last = next;
    if (period != 43 && period != 23) between += period;
    longest = std::max(longest, period);
    if (i == 5) { EXPECT_EQ(period, 23); }
  }
  EXPECT_EQ(between, 33);
  EXPECT_LE(longest, 43);
}

// Written on the way down it is taken at the very next turnaround, written on the way up only at the one after.
TYPED_TEST(ServoIcOn, NewMaximumCountIsNotTakenAtTheTopTurnaround) {
  int old_halves = 0;
  for (const int later : {0, 1}) {  // in two successive halves, one of them is the way up
    this->rig.power_up();
    this->drive(20, 0, 0);
    this->rig.run(2 * 13057 + 1000);
    for (int i = 0; i <= later; ++i) this->rig.edge_of(&ServoIcRig::phase, true);
    this->rig.write(true, kPwmWord, pwm_word(10));
    Tick last = this->rig.edge_of(&ServoIcRig::phase, true);
    for (Tick period = 0; period != 33; ++old_halves) {
      const Tick next = this->rig.edge_of(&ServoIcRig::phase, true);
      period = next - last;
      last = next;
      ASSERT_TRUE(period == 43 || period == 33) << period;
    }
    --old_halves;  // the last one was the one from the old bottom to the new top
  }
  EXPECT_EQ(old_halves, 1);
}

// A new divider waits for the end of the running period.
TYPED_TEST(ServoIcOn, NewPhaseDividerIsTakenAtTheTerminalCount) {
  this->drive(20, 3, 0);
  this->rig.run(2 * 13057 + 1000);
  const Tick rise = this->rig.edge_of(&ServoIcRig::phase, true);
  this->rig.write(true, kClockWord, clock_word(0, 0, 0));
  EXPECT_EQ(this->rig.edge_of(&ServoIcRig::phase, true) - rise, 4 * 43);
  const Tick next = this->rig.now();
  EXPECT_EQ(this->rig.edge_of(&ServoIcRig::phase, true) - next, 43);
}

TYPED_TEST(ServoIcOn, ResetStopsDrivingAndRestoresTheRegisters) {
  this->drive(20, 0, 0);
  this->rig.run(30'000);
  this->rig.reset(true);
  this->rig.tick();
  EXPECT_FALSE(this->rig.phase_oe());
  EXPECT_FALSE(this->rig.servo_oe());
  this->rig.reset(false);
  this->rig.tick();
  EXPECT_EQ(this->rig.read(true, kClockWord), 0x3038D2u);
  EXPECT_EQ(this->rig.read(true, kPwmWord), 0x197F0Fu);
}

// Whatever tick of the triangle and of the dividers it comes at: the clocks come up as behind the first one.
TYPED_TEST(ServoIcOn, ResetLeavesNothingOfTheClocksOfBefore) {
  constexpr Tick kWay = 2 * 20 + 3, kServo = kWay * 4 * 2;
  const auto edges = [this] {
    this->rig.reset(false);
    const Tick begin = this->rig.now();
    this->drive(20, 3, 1);
    std::vector<Tick> found;
    for (const bool rising : {true, false, true, false})
      found.push_back(this->rig.edge_of(&ServoIcRig::phase, rising, 200'000) - begin);
    for (const bool rising : {false, true})
      found.push_back(this->rig.edge_of(&ServoIcRig::servo, rising, 200'000) - begin);
    return found;
  };
  const auto reset = [this] {  // ends with an edge of clk_ref, all begin alike there
    this->rig.reset(true);
    do this->rig.tick();
    while (this->rig.now() % kTicksPerRef != 0);
  };
  reset();
  const std::vector<Tick> first = edges();
  for (Tick at = 0; at < kServo; at += 5) {  // 5 and 43 have no divisor in common: every tick of a way is hit
    this->rig.run(at);
    reset();
    EXPECT_EQ(edges(), first) << at << " ticks behind a rise of SERVO";
  }
}

// A pin with a pull-up, whatever the direction: taken with a full high time and left after a full low time, whichever
// tick the direction bits are written at.
TYPED_TEST(ServoIcOn, DirectionChangesWithoutAShortPulse) {
  BRICK_COVERS("CLK-6");
  constexpr Tick kPeriod = 2 * 20 + 3, kHigh = kPeriod / 2, kLow = kPeriod - kHigh;
  for (const unsigned servo_div : {0u, 2u}) {
    for (Tick at = 0; at < 3 * kPeriod; at += 5) {
      SCOPED_TRACE(::testing::Message() << "I7m02=" << servo_div << ", written " << at
                                        << " ticks into a period of SERVO");
      this->rig.power_up();
      this->drive(20, 0, servo_div);
      this->rig.run(2 * 13057 + 1000);
      this->rig.edge_of(&ServoIcRig::servo, false);
      this->rig.run(at);
      this->rig.write(true, kClockWord, clock_word(0, servo_div, 3));
      std::vector<Tick> phase_edges{this->rig.now()}, servo_edges;  // each fall and rise of the net from here on
      bool phase = this->rig.phase() || !this->rig.phase_oe(), servo = this->rig.servo() || !this->rig.servo_oe();
      const auto watch = [&](Tick ticks) {
        for (Tick t = 0; t < ticks; ++t) {
          this->rig.tick();
          const bool p = this->rig.phase() || !this->rig.phase_oe(), s = this->rig.servo() || !this->rig.servo_oe();
          if (p != phase) phase_edges.push_back(this->rig.now());
          if (s != servo) servo_edges.push_back(this->rig.now());
          phase = p, servo = s;
        }
      };
      watch(6 * kPeriod);
      EXPECT_FALSE(this->rig.phase_oe());
      EXPECT_FALSE(this->rig.servo_oe());
      EXPECT_TRUE(phase && servo) << "idle";
      for (std::size_t i = phase_edges.size() - 1; i >= 2; i -= 2) EXPECT_EQ(phase_edges[i] - phase_edges[i - 1], kLow);
      phase_edges.clear(), servo_edges.clear();

      this->rig.write(true, kClockWord, clock_word(0, servo_div, 0));
      while (!this->rig.phase_oe()) watch(1);
      ASSERT_TRUE(phase_edges.empty());
      const Tick taken = this->rig.now();
      watch(8 * kPeriod);
      ASSERT_GE(phase_edges.size(), 4u);
      EXPECT_EQ(phase_edges[0] - taken, kHigh);
      EXPECT_EQ(phase_edges[1] - phase_edges[0], kLow);
      ASSERT_GE(servo_edges.size(), 2u);
      EXPECT_EQ(servo_edges[1] - servo_edges[0], servo_div == 0 ? kLow : kPeriod);
    }
  }
}

// A pin whose net is low belongs to somebody else.
TYPED_TEST(ServoIcOn, PinIsNotTakenWhileItsNetIsLow) {
  this->drive(20, 0, 0);
  this->rig.pins(false, false);
  this->rig.run(2 * 13057 + 1000);
  EXPECT_FALSE(this->rig.phase_oe());
  EXPECT_FALSE(this->rig.servo_oe());
  this->rig.pins(true, true);
  this->rig.run(3 * 43);
  EXPECT_TRUE(this->rig.phase_oe());
  EXPECT_TRUE(this->rig.servo_oe());
}

}  // namespace
}  // namespace brick
