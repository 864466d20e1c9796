// Lines of programs that have moves and something else: what comes first, what breaks blending, which rate counts.
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class LinesOfMoves : public MovingMotors {
 protected:
  static std::int64_t position(double counts) { return std::llround(counts * kUnit); }
};

// motion:5.5/4: axes of a line move before what stands behind them.
TEST_F(LinesOfMoves, HomeComesBehindTheAxesOfItsLine) {
  fit({"1000X"});
  ASSERT_EQ(host("I119=1 I120=20 I121=0 I192=1 I123=10 I125=$78000 I124=$120001"), "");
  store({"TM50 TA20 TS0 X1 HOME1", "X0.25"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(65));
  EXPECT_FALSE(motors[0].status.home_search);
  EXPECT_GT(at(1), 900.0);
  platform::servo_ticks(ticks_of(60));
  EXPECT_TRUE(motors[0].status.home_search);
  EXPECT_GT(at(1), 1000.0);
  *hal_x(0x78003) = 0;
  *hal_x(0x78000) |= 1u << 11;
  platform::servo_ticks(ticks_of(500));
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(motors[0].trajectory, position(250));
}

TEST_F(LinesOfMoves, HomezComesBehindTheAxesOfItsLine) {
  fit({"1000X"});
  store({"TM50 TA20 TS0 X1 HOMEZ1", "X0.25"});
  double before = 0.0, behind = 0.0;
  const double end = run([&](double) {
    double& largest = motors[0].status.home_complete ? behind : before;
    largest = std::max(largest, at(1));
  });
  EXPECT_EQ(motors[0].trajectory, position(250)) << "counted from where X1 ended";
  EXPECT_GT(end, 140.0);
  EXPECT_EQ(before, 1000.0);
  EXPECT_LE(behind, 250.0) << "X goes on from 0";
}

TEST_F(LinesOfMoves, PsetWaitsForTheMoveBeforeIt) {
  fit({"1000X"});
  store({"TM50 TA20 TS0 X1", "PSET X5", "X6"});
  unsigned early = 0;
  run([&](double t) { early += t < 69.0 && motors[0].bias != 0 ? 1 : 0; });
  EXPECT_EQ(early, 0u);
  EXPECT_EQ(motors[0].trajectory, position(2000));
}

// HOMEZ as HMZ: of an open loop the actual position. HOME closes none.
TEST_F(LinesOfMoves, MotorsThatAProgramHomes) {
  fit({"1000X"});
  ASSERT_EQ(host("&2#3->X I200=1 I300=1"), "");
  motors[1].loop = LOOP_OPEN;
  motors[1].actual = position(77);
  store({"HOMEZ2 P1=1"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(9);
  EXPECT_EQ(host("RY$2014"), "0");
  EXPECT_TRUE(motors[1].status.home_complete);
  store({"HOME2"}, 2);
  ASSERT_EQ(host("&1B2R"), "");
  platform::servo_ticks(9);
  EXPECT_EQ(host("RY$2014"), "1") << "its loop is open";
  motors[2].loop = LOOP_CLOSED;
  for (const char* line : {"HOME3", "HOMEZ3"}) {
    store({line}, 3);
    coordinate_systems[1].running = true;
    ASSERT_EQ(host("&1B3R"), "") << line;
    platform::servo_ticks(9);
    EXPECT_EQ(host("RY$2014"), "1") << line << ": another program moves it";
    coordinate_systems[1].running = false;
  }
}

// motion:5.3/1: it has waited, if only for an interrupt.
TEST_F(LinesOfMoves, WaitBreaksBlending) {
  fit({"1000X"});
  store({"TM100 TA40 TS0 X1", "WHILE(P1=0) WAIT", "X2"});
  p_variable_write(1, 0);
  const double end = run([](double t) {
    if (t > 20) p_variable_write(1, 1);
  });
  EXPECT_NEAR(end, 2 * 140, 2 * kTickMs);
}

// firmware:7.9: two jumps back without a move end the calculation of an interrupt, and blending.
TEST_F(LinesOfMoves, TwoJumpsBackBreakBlending) {
  fit({"1000X"});
  store({"TM100 TA40 TS0 X1", "P1=0", "WHILE(P1<3)", "P1=P1+1", "ENDWHILE", "X2"});
  EXPECT_NEAR(run(), 2 * 140, 2 * kTickMs);
  store({"TM100 TA40 TS0 X1", "P1=0", "WHILE(P1<1)", "P1=P1+1", "ENDWHILE", "X0"});
  EXPECT_NEAR(run(), 240, 2 * kTickMs) << "one is not enough";
}

// motion:5.5/3
TEST_F(LinesOfMoves, VirtualAxesGoRapidAtTheFeedrate) {
  store({"F100 TA20 TS0 RAPID X3", "X6"});
  EXPECT_NEAR(run(), 2 * (30 + 20), 2 * kTickMs) << "they do not blend";
  EXPECT_EQ(cs().position[AXIS_X], 6.0);
  store({"RAPID X7^0.5"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(9);
  EXPECT_EQ(host("RY$2014"), "1");
}

// motion:5.2/5
TEST_F(LinesOfMoves, ArcsWithoutSegmentsAreStraight) {
  fit({"1000X", "1000Y"});
  for (const char* mode : {"CIRCLE1", "CIRCLE2"}) {
    store({std::string(mode) + " TM100 TA20 TS0 X1 Y1 I1 J0", "X0 Y0 R1"});
    run([](double) { ASSERT_NEAR(at(1), at(2), 2 / kUnit); });
    EXPECT_EQ(host("RY$2014"), "0") << mode;
  }
  store({"LINEAR TM100 X1 I1"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(9);
  EXPECT_EQ(host("RY$2014"), "1");
}

TEST_F(LinesOfMoves, TheLastOfFAndTmCounts) {
  fit({"1000X"});
  store({"TM500 F100 TA10 TS0 X20", "DWELL1 F1 TM30 X0"});
  EXPECT_NEAR(run(), 200 + 10 + 1 + 30 + 10, 6 * kTickMs);
}

// Whole ms (firmware:3.4), read back where they are kept.
TEST_F(LinesOfMoves, AccelerationTimesAreWholeMilliseconds) {
  fit({"1000X"});
  store({"TM100 TA40.4 TS10.6 X1"});
  follow({changes_of({{1000, 100, 40, 11}}, 40)});
  EXPECT_EQ(host("I5187"), "40");
  EXPECT_EQ(host("I5188"), "11");
  EXPECT_EQ(host("I5189"), "100");
}

}  // namespace
