// A servo IC that takes PHASE, SERVO or both from its pins: divider on an external phase clock, and how the local
// triangle follows the external edge (servo-ic:5.1/6). A pin change passes two flip-flops, so it acts at the third
// edge.
#include <gtest/gtest.h>

#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/servo_ic/servo_ic_rig.h"

namespace brick {
namespace {

constexpr Tick kHalf = 2 * 100 + 3;  // I7m00 = 100
constexpr Tick kSync = 3;

template <class Rig>
class ExternalPhaseOn : public ::testing::Test {
 protected:
  ExternalPhaseOn() {
    rig.power_up();
    rig.write(true, kPwmWord, pwm_word(100));
    rig.write(true, kClockWord, clock_word(0, 3, 3));
    rig.run(3 * 13057);  // until the triangle has the new length
  }

  // Runs to `tick`, then changes the pin: the next edge is the first to see it.
  void phase_pin(Tick tick, bool level) {
    rig.run(tick - rig.now());
    rig.pins(level, true);
  }
  void phase_pulse(Tick tick) {  // one rising edge at `tick`
    phase_pin(tick - 60, false);
    phase_pin(tick, true);
  }

  // The tick of a turnaround, seen by letting the IC drive PHASE with a divider of one, and taken back to input after
  // that.
  Tick turnaround() {
    rig.write(true, kClockWord, clock_word(0, 3, 0));
    bool last = rig.phase();
    const Tick end = rig.now() + 4 * kHalf;
    Tick found = kNever;
    while (rig.now() < end && found == kNever) {
      rig.tick();
      if (rig.phase() && !last) found = rig.now();
      last = rig.phase();
    }
    rig.write(true, kClockWord, clock_word(0, 3, 3));
    EXPECT_NE(found, kNever);
    return found;
  }
  // First turnaround after the present tick, far enough away to move pins before it.
  Tick coming_turnaround() {
    const Tick seen = turnaround();
    return seen + ((rig.now() + 400 - seen) / kHalf + 1) * kHalf;
  }
  // Distance of the present turnarounds from a grid of kHalf through `origin`.
  Tick offset_from(Tick origin) { return (turnaround() - origin) % kHalf; }

  Rig rig;
};

using Engines = ::testing::Types<RtlRig, ModelRig>;
TYPED_TEST_SUITE(ExternalPhaseOn, Engines, EngineNames);

// A turnaround is the edge that raises PHASE; an external rise at tick t acts at edge t + 3.
TYPED_TEST(ExternalPhaseOn, EdgeWithinEightTicksMovesTheTurnaroundAtOnce) {
  for (const Tick error : {0, 1, 8, -1, -8}) {
    SCOPED_TRACE(error);
    const Tick turn = this->coming_turnaround();
    this->phase_pulse(turn - kSync + error);
    this->rig.run(20);
    EXPECT_EQ(this->offset_from(turn), (error + kHalf) % kHalf);
  }
}

TYPED_TEST(ExternalPhaseOn, EdgeOutsideTheWindowMovesItOnlyAtTheFourthInARow) {
  for (const Tick error : {Tick{9}, Tick{-9}, Tick{80}, Tick{-80}}) {
    SCOPED_TRACE(error);
    Tick turn = this->coming_turnaround();
    for (int i = 0; i < 3; ++i, turn += kHalf) this->phase_pulse(turn - kSync + error);
    this->rig.run(20);
    // Looking costs no external edge: the count of misses stays at three.
    EXPECT_EQ(this->offset_from(turn), 0);
    turn = this->coming_turnaround();
    this->phase_pulse(turn - kSync + error);
    this->rig.run(20);
    EXPECT_EQ(this->offset_from(turn), (error + kHalf) % kHalf);
  }
}

TYPED_TEST(ExternalPhaseOn, AnEdgeInTheWindowStartsTheCountOfMissesAnew) {
  for (const int before : {3, 2, 1}) {
    SCOPED_TRACE(before);
    Tick turn = this->coming_turnaround();
    this->phase_pulse(turn - kSync);
    turn += kHalf;
    for (int i = 0; i < before; ++i, turn += kHalf) this->phase_pulse(turn - kSync + 50);
    this->phase_pulse(turn - kSync);
    turn += kHalf;
    for (int i = 0; i < 3; ++i, turn += kHalf) this->phase_pulse(turn - kSync + 50);
    this->rig.run(20);
    EXPECT_EQ(this->offset_from(turn), 0);
  }
}

// I7m07 = 1: phase from outside, servo made here.
TYPED_TEST(ExternalPhaseOn, OwnServoDividesTheExternalPhase) {
  BRICK_COVERS("CLK-6");
  this->rig.write(true, kClockWord, clock_word(0, 2, 1));
  EXPECT_FALSE(this->rig.phase_oe());
  std::vector<Tick> falls, rises;
  bool last = this->rig.servo();
  const Tick start = this->rig.now() + 10;
  for (int period = 0; period < 12; ++period) {
    for (Tick t = 0; t < 500; ++t) {
      if (t == 0) this->rig.pins(false, true);
      if (t == 200) this->rig.pins(true, true);
      this->rig.tick();
      if (last != this->rig.servo()) (last ? falls : rises).push_back(this->rig.now());
      last = this->rig.servo();
    }
  }
  EXPECT_FALSE(this->rig.phase_oe());
  EXPECT_TRUE(this->rig.servo_oe());
  ASSERT_GE(falls.size(), 3u);
  EXPECT_EQ(falls[1] - falls[0], 3 * 500);
  EXPECT_EQ(falls[2] - falls[1], 3 * 500);
  EXPECT_EQ(rises[0] - falls[0], 500) << "low for one phase period";
  EXPECT_EQ((falls[0] - (start - 10)) % 500, kSync) << "at the third edge after the pin";
}

TYPED_TEST(ExternalPhaseOn, NothingIsDrivenWithBothDirectionsExternal) {
  for (int i = 0; i < 2000; ++i) {
    this->rig.pins(i / 100 % 2 != 0, i / 300 % 2 != 0);
    this->rig.tick();
    ASSERT_FALSE(this->rig.phase_oe());
    ASSERT_FALSE(this->rig.servo_oe());
  }
}

// Re-alignment in the long run: a source 400 ppm slower than the local triangle keeps it within a tick.
TYPED_TEST(ExternalPhaseOn, FollowsASourceThatIsSlower) {
  Tick edge = this->coming_turnaround() - kSync;
  for (int i = 0; i < 50; ++i, edge += kHalf + 1) this->phase_pulse(edge);
  this->rig.run(20);
  EXPECT_EQ(this->offset_from(edge - (kHalf + 1) + kSync), 0);
}

}  // namespace
}  // namespace brick
