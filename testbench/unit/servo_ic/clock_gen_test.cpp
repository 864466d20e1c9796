// Rules of the clock chain that sums over whole periods do not show: when a new servo divider is taken, and from which
// tick on a word is in use (servo-ic:5.1/5, servo-ic:5.1/12).
#include <gtest/gtest.h>

#include "testbench/unit/servo_ic/servo_ic_rig.h"

namespace brick {
namespace {

template <class Rig>
class ClockChainOn : public ::testing::Test {
 protected:
  ClockChainOn() {
    rig.power_up();
    rig.write(true, kPwmWord, pwm_word(20));
  }
  Tick servo_falls() { return rig.edge_of(&ServoIcRig::servo, false, kLongest); }

  static constexpr Tick kPhase = 2 * 20 + 3, kLongest = 16 * kPhase;
  Rig rig;
};

using Engines = ::testing::Types<RtlRig, ModelRig>;
TYPED_TEST_SUITE(ClockChainOn, Engines, EngineNames);

// Written in the first of four phase periods: this period of SERVO is still four long.
TYPED_TEST(ClockChainOn, NewServoDividerIsTakenWhenTheRunningPeriodEnds) {
  this->rig.write(true, kClockWord, clock_word(0, 3, 0));
  this->rig.run(20 * 13057);
  for (const auto& [from, to] : {std::pair<unsigned, unsigned>{3, 0}, {0, 2}, {2, 1}, {1, 3}}) {
    const Tick fall = this->servo_falls();
    this->rig.write(true, kClockWord, clock_word(0, to, 0));
    const Tick next = this->servo_falls();
    EXPECT_EQ(next - fall, (from + 1) * this->kPhase) << from << " to " << to;
    EXPECT_EQ(this->servo_falls() - next, (to + 1) * this->kPhase) << from << " to " << to;
  }
}

// The second after the reference edge of its write: an edge that takes a divider then takes the new one, pins that are
// high go.
TYPED_TEST(ClockChainOn, AWordIsInUseFromTheSecondTickAfterItsWrite) {
  this->rig.write(true, kClockWord, clock_word(0, 0, 0));
  this->rig.run(20 * 13057);
  for (const bool servo : {true, false}) {
    const auto divide = [&](unsigned n) {
      this->rig.write(true, kClockWord, clock_word(servo ? 0 : n, servo ? n : 0, 0));
    };
    const auto edge = [&] {
      return servo ? this->servo_falls() : this->rig.edge_of(&ServoIcRig::phase, true, this->kLongest);
    };
    for (const Tick lead : {1, 2, 3}) {
      SCOPED_TRACE(::testing::Message() << (servo ? "SERVO, " : "PHASE, ") << lead << " ticks before its edge");
      divide(1);
      this->rig.run(10 * this->kPhase);
      Tick next = 0;
      do {
        const Tick at = edge();
        ASSERT_NE(at, kNever);
        next = at + 2 * this->kPhase;
      } while ((next - lead) % kTicksPerRef != 0);
      this->rig.run(next - lead - 1 - this->rig.now());
      divide(4);
      EXPECT_EQ(this->rig.now(), next - lead);
      EXPECT_EQ(edge(), next);
      EXPECT_EQ(edge() - next, (lead < 2 ? 2 : 5) * this->kPhase);
    }
    divide(0);
    this->rig.run(10 * this->kPhase);
  }
  this->rig.edge_of(&ServoIcRig::servo, true);
  this->rig.edge_of(&ServoIcRig::phase, true);
  this->rig.write(true, kClockWord, clock_word(0, 4, 3));
  this->rig.tick();
  EXPECT_TRUE(this->rig.phase_oe() && this->rig.servo_oe());
  this->rig.tick();
  EXPECT_FALSE(this->rig.phase_oe() || this->rig.servo_oe());
}

// I7m00 too, at the bottom turnaround: from the bottom -(old + 2) to the new end, new + 1, are old + new + 3 ticks.
// PHASE rises at each turnaround. 4 I7m00 + 6 is no multiple of 3, so that a bottom comes any number of ticks behind a
// reference edge.
TYPED_TEST(ClockChainOn, AMaximumCountIsInUseFromTheSecondTickAfterItsWrite) {
  constexpr unsigned kOne = 20, kOther = 31;
  constexpr Tick kMixed = kOne + kOther + 3;
  const auto way = [](unsigned count) { return Tick{2 * count + 3}; };
  const auto turnaround = [&] { return this->rig.edge_of(&ServoIcRig::phase, true, this->kLongest); };
  this->rig.write(true, kClockWord, clock_word(0, 0, 0));
  this->rig.run(20 * 13057);
  this->rig.write(true, kPwmWord, pwm_word(kOther));
  Tick last = turnaround(), top = turnaround();
  for (; top - last != kMixed && this->rig.now() < 21 * 13057; top = turnaround()) last = top;
  ASSERT_EQ(top - last, kMixed);
  unsigned count = kOther;
  Tick bottom = top + way(count);
  for (const Tick lead : {1, 2, 3, 1, 2, 3}) {
    const unsigned to = count == kOne ? kOther : kOne;
    SCOPED_TRACE(::testing::Message() << lead << " ticks before a bottom, to " << to);
    while (bottom - lead < this->rig.now() + kTicksPerRef || (bottom - lead) % kTicksPerRef != 0)
      bottom += 2 * way(count);
    this->rig.run(bottom - lead - 1 - this->rig.now());
    this->rig.write(true, kPwmWord, pwm_word(to));
    EXPECT_EQ(this->rig.now(), bottom - lead);
    EXPECT_EQ(turnaround(), bottom);
    if (lead < 2) {
      EXPECT_EQ(turnaround(), bottom + way(count)) << "too late for this one";
      bottom += 2 * way(count);
      EXPECT_EQ(turnaround(), bottom);
    }
    EXPECT_EQ(turnaround(), bottom + kMixed);
    bottom += kMixed + way(to);
    EXPECT_EQ(turnaround(), bottom);
    count = to;
  }
}

}  // namespace
}  // namespace brick
