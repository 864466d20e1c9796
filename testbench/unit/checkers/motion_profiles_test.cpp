// The paths that the benches of motion expect, against numbers that the sheet prints (firmware:7.5, motion:4.1) and
// arithmetic.
#include <cmath>

#include <gtest/gtest.h>

#include "testbench/checkers/jog_profile.h"
#include "testbench/checkers/position_loop_model.h"
#include "testbench/checkers/program_profile.h"

namespace brick {
namespace {

// 50 counts/ms at 0.25 counts/ms^2: 200 ms; the reversal from 50 to -50: 400 ms.
TEST(JogProfile, TakesTheTimesThatTheSheetPrints) {
  const JogLimits limits{0.25, 100, 0, 50};
  EXPECT_EQ(limits.time_for(50), 200);
  EXPECT_EQ(limits.time_for(-100), 400);
  EXPECT_EQ((JogLimits{1, 0, 20, 32}.time_for(32)), 52);
}

TEST(JogProfile, GoesTheWholeWayAndNoFasterThanItMay) {
  const JogLimits limits{4, 0, 5, 32};
  for (const double way : {1600.0, -90.0, 3.0, 0.01}) {
    const VelocityProfile p = jog_profile(7, 7 + way, limits);
    EXPECT_NEAR(p.position(p.end()), 7 + way, 1e-9) << way;
    EXPECT_NEAR(p.velocity(p.end()), 0, 1e-9) << way;
    double fastest = 0, hardest = 0;
    for (double t = 0; t < p.end(); t += 0.01) {
      fastest = std::max(fastest, std::fabs(p.velocity(t)));
      hardest = std::max(hardest, std::fabs(p.velocity(t + 1e-3) - p.velocity(t)) / 1e-3);
      EXPECT_NEAR((p.position(t + 1e-5) - p.position(t - 1e-5)) / 2e-5, p.velocity(t), 1e-4) << way << " at " << t;
    }
    EXPECT_LE(fastest, 32 + 1e-9) << way;
    EXPECT_LE(hardest, 4 + 1e-6) << way;
  }
}

// A triangle: v (v/4 + 5) = 600 has v = 40; with 24 counts/ms allowed the speed is 24.
TEST(JogProfile, AShortMoveHasTheSpeedWhoseRampsMakeItsWay) {
  EXPECT_NEAR((JogLimits{4, 0, 5, 100}.peak(600)), 40, 1e-9);
  EXPECT_NEAR((JogLimits{4, 0, 5, 24}.peak(600)), 24, 0);
}

// X20 then Y20 at 100 counts/ms: the corner is done 400 ms after it begins; a move from rest to rest takes Tm + Ta.
TEST(LinearProfile, BlendsAroundTheCorner) {
  const VelocityProfile x = linear_profile(0, {{200'000, 2000}, {0, 2000}}, {400, 400, 400}, 0);
  EXPECT_EQ(x.end(), 2000 + 2000 + 400);
  EXPECT_NEAR(x.velocity(1999), 100, 1e-9);
  EXPECT_NEAR(x.velocity(2200), 50, 1e-9);
  EXPECT_NEAR(x.velocity(2401), 0, 1e-9);
  EXPECT_NEAR(x.position(x.end()), 200'000, 1e-6);
}

TEST(CubicPath, PvtPassesItsPointsAtItsVelocities) {
  const CubicPath p = pvt_path(10, {{110, 5, 20}, {310, 0, 40}});
  EXPECT_NEAR(p.position(20), 110, 1e-9);
  EXPECT_NEAR((p.position(20.001) - p.position(19.999)) / 0.002, 5, 1e-3);
  EXPECT_NEAR(p.position(60), 310, 1e-9);
  EXPECT_EQ(p.end(), 60);
}

// Way points (X(n-1) + 4 X(n) + X(n+1)) / 6; one time more at either end.
TEST(CubicPath, SplineRunsThroughTheWayPoints) {
  const CubicPath p = spline_path(0, {60, 120, 60}, 10);
  EXPECT_EQ(p.end(), 50);
  EXPECT_NEAR(p.position(10), 10, 1e-9);
  EXPECT_NEAR(p.position(20), 60, 1e-9);
  EXPECT_NEAR(p.position(30), 100, 1e-9);
  EXPECT_NEAR(p.position(50), 60, 1e-9);
}

// 2^-19 x Ixx30 x Ixx08 a count; the integrator adds Ixx33 / 2^23 of the error a closure; beyond Ixx69 it stands.
TEST(PositionLoopModel, TermByTerm) {
  LoopGains g;
  g.p = 65536, g.d = g.vff = 0;
  PositionLoopModel p(g, 10, 0);
  EXPECT_DOUBLE_EQ(p.output(10, 0), 120);
  g.i = 8388608;
  PositionLoopModel i(g, 10, 0);
  EXPECT_DOUBLE_EQ(i.output(10, 0), 240);
  EXPECT_DOUBLE_EQ(i.output(10, 0), 360);
  EXPECT_DOUBLE_EQ(i.output(11, 0), 372);  // it moves: Ixx34
  g.limit = 200;
  PositionLoopModel clipped(g, 10, 0);
  EXPECT_DOUBLE_EQ(clipped.output(10, 0), 200);
  EXPECT_DOUBLE_EQ(clipped.integrator(), 10);
  EXPECT_DOUBLE_EQ(clipped.output(10, 0), 200);
  EXPECT_DOUBLE_EQ(clipped.integrator(), 10);
}

TEST(PositionLoopModel, DeadbandAndFriction) {
  LoopGains g;
  g.p = 65536, g.d = g.vff = 0, g.deadband_gain = -16, g.deadband = 32, g.friction = 5;
  PositionLoopModel inside(g, 1.5, 0);
  EXPECT_DOUBLE_EQ(inside.output(1.5, 0), 0);
  EXPECT_DOUBLE_EQ(inside.output(-3, 0), -12 - 5);  // 1 count beyond the band, going down
}

// From 20 to -20 at 4 counts/ms^2 with 5 ms of rounding: 40/4 + 5 = 15 ms, which end where they began.
TEST(JogProfile, ChangesItsSpeedFromWhereItIs) {
  const VelocityProfile p = jog_to_speed(10, 20, -20, {4, 0, 5, 32});
  EXPECT_NEAR(p.end(), 15, 1e-9);
  EXPECT_NEAR(p.velocity(0), 20, 1e-9);
  EXPECT_NEAR(p.velocity(7.5), 0, 1e-9);
  EXPECT_NEAR(p.velocity(15), -20, 1e-9);
  EXPECT_NEAR(p.position(15), 10, 1e-9);
  EXPECT_NEAR(p.position(25), 10 - 200, 1e-9);
}

TEST(JogProfile, GoesOnToAnotherTarget) {
  for (const double to : {1000.0, -1000.0}) {
    const VelocityProfile p = jog_on(3, 10, to, {4, 0, 5, 32});
    EXPECT_NEAR(p.velocity(0), 10, 1e-9);
    EXPECT_NEAR(p.velocity(p.end() / 2), to > 0 ? 32 : -32, 1e-9);
    EXPECT_NEAR(p.velocity(p.end()), 0, 1e-9);
    EXPECT_NEAR(p.position(p.end()), to, 1e-9);
  }
}

TEST(JogProfile, TellsWhenItIsWhere) {
  for (const double to : {800.0, -800.0}) {
    const VelocityProfile p = jog_profile(0, to, {4, 0, 5, 32});
    EXPECT_NEAR(p.time_at(to / 2, 0, p.end()), p.end() / 2, 1e-9) << "it is symmetrical";
    EXPECT_NEAR(p.position(p.time_at(to / 10, 0, p.end())), to / 10, 1e-9);
  }
}

TEST(CubicPath, TellsWhenItIsWhere) {
  const CubicPath p = pvt_path(10, {{110, 5, 20}, {-90, 0, 40}});
  EXPECT_NEAR(p.time_at(110, 0, 20), 20, 1e-9);
  EXPECT_NEAR(p.position(p.time_at(50, 0, 20)), 50, 1e-9);
  EXPECT_NEAR(p.position(p.time_at(0, 30, 60)), 0, 1e-9) << "on the way down";
}

// 100 bits more or less than a clip at 120: what was measured says whether the integrator stood.
TEST(PositionLoopModel, AClipThatIsTooCloseToCallIsTheMeasuredOne) {
  LoopGains g;
  g.p = 65536, g.d = g.vff = 0, g.i = 8388608, g.integrate_at_rest = false, g.limit = 240.5, g.bias = -7;
  for (const double sign : {1.0, -1.0})
    for (const auto& [measured, integrates] : {std::pair{240.0, true}, {241.0, false}, {100.0, true}}) {
      PositionLoopModel p(g, 10 * sign, 0);
      EXPECT_DOUBLE_EQ(p.output(10 * sign, 0), 240 * sign - 7) << "just not clipped";
      p.follow(measured * sign - 7);
      p.output(10 * sign, 0);
      EXPECT_DOUBLE_EQ(p.integrator(), (integrates ? 20 : 10) * sign) << measured;
    }
}

}  // namespace
}  // namespace brick
