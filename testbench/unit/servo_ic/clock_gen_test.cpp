// A rule of the clock chain that sums over whole periods do not show: when a new servo divider is taken
// (servo-ic:5.1/5).
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
  Tick servo_falls() { return rig.edge_of(&ServoIcRig::servo, false); }

  static constexpr Tick kPhase = 2 * 20 + 3;
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

}  // namespace
}  // namespace brick
