// `/` at any time of a move that the next one would blend with, and R behind it (firmware:4.10/6): where the axis is at
// every servo interrupt, where it comes to rest, and that no acceleration is above what TA and the feedrates ask for.
#include <algorithm>
#include <cmath>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/position.h"
}

namespace {

using platform::host;

constexpr double kTickMs = platform::kDefaultI10 / 8388608.0;
constexpr double kTm = 300.0, kDistance = 100.0, kVelocity = kDistance / kTm;

unsigned tick_at(double ms) { return static_cast<unsigned>(std::lround(ms / kTickMs)); }

class EndBlock : public FirmwareTest {
 protected:
  static coordinate_system& cs() { return coordinate_systems[0]; }
  static double x() {
    double position[AXIS_COUNT];
    cs_present_position(&cs(), position);
    return position[AXIS_X];
  }
  // X100 with `first` ms of acceleration, X200 with `second`; the first has just begun.
  static void begin(int first, int second) {
    platform::power_up();
    ASSERT_EQ(host("OPEN PROG 1 CLEAR TM300 TS0 TA" + std::to_string(first) + " X100"), "");
    ASSERT_EQ(host("TA" + std::to_string(second) + " X200"), "");
    ASSERT_EQ(host("WHILE(P1=0) WAIT"), "");  // it does not end, R would begin it anew
    ASSERT_EQ(host("CLOSE B1R"), "");
    for (int i = 0; i < 100 && !cs().active; ++i) platform::servo_ticks(1);
    ASSERT_TRUE(cs().active);
  }
  static bool rests() { return !cs().active && (!cs().next_valid || cs().end_block); }
};

// From rest the velocity is reached at TA = 100 ms, the stop begins at 300 ms and ends at 400 ms: 10 ms before that the
// way left is v/TA * 10 ms * 10 ms / 2.
TEST_F(EndBlock, AbortBehindItFindsTheAxisWhereItStops) {
  begin(100, 100);
  platform::servo_ticks(tick_at(100.0));
  ASSERT_EQ(host("/"), "");
  const unsigned then = tick_at(390.0);
  platform::servo_ticks(then - tick_at(100.0));
  ASSERT_EQ(host("A"), "");
  platform::real_time();
  const double left = 400.0 - then * kTickMs;
  EXPECT_NEAR(cs().position[AXIS_X], kDistance - kVelocity / 100.0 * left * left / 2.0, 1e-6);
  EXPECT_NEAR(cs().position[AXIS_X], 99.8, 0.1);
}

TEST_F(EndBlock, RunBehindTheBeginOfTheStopStartsTheNextMoveFromRest) {
  begin(100, 100);
  platform::servo_ticks(tick_at(100.0));
  ASSERT_EQ(host("/"), "");
  platform::servo_ticks(tick_at(380.0) - tick_at(100.0));
  ASSERT_EQ(host("R"), "");
  unsigned ticks = tick_at(380.0);
  for (; !rests(); ++ticks) {
    ASSERT_LT(ticks, 5000u);
    platform::servo_ticks(1);
  }
  const auto one = static_cast<unsigned>(std::ceil((kTm + 100.0) / kTickMs));
  EXPECT_EQ(ticks, 2 * one);
  EXPECT_EQ(cs().position[AXIS_X], 200.0);
}

// motion:5.6/5: the move that waits is the step.
TEST_F(EndBlock, AStepBehindItMakesTheMoveThatWaits) {
  platform::power_up();
  for (const char* line : {"OPEN PROG 1 CLEAR TM300 TA100 TS0", "X100", "X200", "X300", "CLOSE", "B1R"})
    ASSERT_EQ(host(line), "");
  platform::servo_ticks(tick_at(150.0));
  ASSERT_EQ(host("/"), "");
  for (const double end : {100.0, 200.0, 300.0}) {
    platform::servo_ticks(tick_at(500.0));
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(x(), end);
    if (end == 100.0) { EXPECT_EQ(host("PC"), "P1:5") << "behind what waits: TM, TA, TS, X, X"; }
    ASSERT_EQ(host("S"), "");
    if (end == 100.0) { EXPECT_EQ(host("PC"), "P1:5"); }
  }
}

// What waits is dropped by B: the step is the first move.
TEST_F(EndBlock, AStepFromTheTopIsItsFirstMove) {
  begin(100, 100);
  platform::servo_ticks(tick_at(150.0));
  ASSERT_EQ(host("/"), "");
  platform::servo_ticks(tick_at(500.0));
  ASSERT_EQ(x(), 100.0);
  ASSERT_EQ(host("B1S"), "");
  platform::servo_ticks(tick_at(1000.0));
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(host("PC"), "P1:4");
  EXPECT_EQ(cs().started, 2u) << "X100, twice";
}

TEST_F(EndBlock, RunBeforeTheBeginOfTheStopBlendsAsIfNothingHadBeen) {
  begin(100, 100);
  platform::servo_ticks(tick_at(100.0));
  ASSERT_EQ(host("/"), "");
  platform::servo_ticks(tick_at(250.0) - tick_at(100.0));
  ASSERT_EQ(host("R"), "");
  unsigned ticks = tick_at(250.0);
  for (; !rests(); ++ticks) {
    ASSERT_LT(ticks, 5000u);
    platform::servo_ticks(1);
  }
  EXPECT_EQ(ticks, static_cast<unsigned>(std::ceil((2 * kTm + 100.0) / kTickMs)));
}

// A move that does not blend is taken out whole.
TEST_F(EndBlock, BeforeAMoveThatDoesNotBlendNothingOfItIsLeft) {
  ASSERT_EQ(host("I5192=1"), "");
  ASSERT_EQ(host("OPEN PROG 1 CLEAR TM300 TS0 TA100 X100"), "");
  ASSERT_EQ(host("X200"), "");
  ASSERT_EQ(host("CLOSE B1R"), "");
  for (int i = 0; i < 100 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(tick_at(100.0));
  ASSERT_EQ(host("/"), "");
  unsigned ticks = tick_at(100.0);
  for (; cs().active && ticks < 5000; ++ticks) platform::servo_ticks(1);
  EXPECT_NEAR(ticks, (kTm + 100.0) / kTickMs, 1.0) << "its own stop, no change of velocity behind it";
  EXPECT_EQ(x(), 100.0);
}

struct Stop {
  double largest_acceleration, rest;
};

constexpr double kNever = 1e6;

// `/` after `slash` ms, R after `run` ms. Followed until it rests.
Stop follow(double slash, double run, const std::function<double()>& x, const std::function<bool()>& rests) {
  Stop found{0.0, 0.0};
  double last = x(), velocity = 0.0;
  const unsigned given = tick_at(run < kNever ? run : slash);  // the last command
  for (unsigned tick = 0; tick < 5000 && (tick < given + 3 || !rests()); ++tick) {
    if (tick == tick_at(slash)) { EXPECT_EQ(host("/"), ""); }
    if (tick == tick_at(run)) { EXPECT_EQ(host("R"), ""); }
    platform::servo_ticks(1);
    const double before = last;
    last = x();
    const double now = (last - before) / kTickMs;
    found.largest_acceleration = std::max(found.largest_acceleration, std::abs(now - velocity) / kTickMs);
    velocity = now;
  }
  found.rest = last;
  return found;
}

// Both moves have the same velocity, so none of these times asks for more than going from it to rest, or from rest to
// it, within the shorter TA.
TEST_F(EndBlock, AtAnyTimeStopsAtACornerWithoutAJumpOfVelocity) {
  unsigned at_first = 0, at_second = 0;
  for (const int first : {100, 200})
    for (const int second : {20, 100, 240})
      for (double slash = 5.0; slash < 410.0; slash += 18.0)
        for (const double later : {7.0, 95.0, kNever}) {
          SCOPED_TRACE("TA" + std::to_string(first) + " TA" + std::to_string(second) + " / at " +
                       std::to_string(slash) + " R " + std::to_string(later) + " later");
          begin(first, second);
          const double blend = first / 2.0 + kTm - second / 2.0;  // where the next move would begin
          const Stop found = follow(slash, slash + later, x, rests);
          const double allowed = kVelocity / std::min(first, second);
          ASSERT_LE(found.largest_acceleration, allowed * 1.001 + 1e-9);
          if (later != kNever) {
            ASSERT_EQ(found.rest, 200.0);
            continue;
          }
          const bool too_late = slash > blend + kTickMs;
          if (std::abs(slash - blend) > kTickMs) { ASSERT_EQ(found.rest, too_late ? 200.0 : 100.0); }
          ++(too_late ? at_second : at_first);
        }
  EXPECT_GT(at_first, 50u);
  EXPECT_GT(at_second, 10u);
}

}  // namespace
