// Between axes and motors (motion:5.1, motion:5.5): turns of rotary axes, triggers of motors with several axes, the way
// back from motors to axes, PSET.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/jog.h"
#include "firmware/motion/system_motors.h"
}

namespace {

using namespace moving_motors;

class AxesOfMotors : public MovingMotors {
 protected:
  static std::int64_t position(double counts) { return std::llround(counts * kUnit); }
  static double start(unsigned axis) { return cs().moves[cs().executing].start[axis]; }
  static void begin() {
    ASSERT_EQ(host("&1B1R"), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    ASSERT_TRUE(cs().active);
  }
};

TEST_F(AxesOfMotors, TurnsAreThoseOfABAndC) {
  fit({"100B", "100C", "100X", "100U"});
  ASSERT_EQ(host("I127,4,100=36000"), "");
  store({"TM100 TA20 TS0 B270 C270 X270 U270"});
  run();
  const double ends[] = {-9000, -9000, 27000, 27000};
  for (unsigned i = 0; i < 4; ++i) EXPECT_EQ(motors[i].trajectory, position(ends[i])) << i;
}

// motion:5.1/5: of two the lower one, by 0 as well.
TEST_F(AxesOfMotors, TheLowestMotorOfAnAxisTellsTheTurn) {
  for (const auto& [motor, end] : {std::pair{"I127", -9000.0}, {"I227", 27000.0}}) {
    platform::power_up();
    fit({"100A", "100A"});
    ASSERT_EQ(host(std::string(motor) + "=36000"), "");
    store({"TM100 TA20 TS0 A270"});
    run();
    for (unsigned i = 0; i < 2; ++i) EXPECT_EQ(motors[i].trajectory, position(end)) << motor << " " << i;
  }
}

// Three axes of one motor, forwards, and back behind a jog.
TEST_F(AxesOfMotors, ThreeAxesMakeAMotor) {
  fit({"1000X+500Y-200Z+10", "1000Y-500X", "-250Z", "100U-200V+300W"});
  store({"LINEAR TM100 TA20 TS0 X1 Y2 Z3 U1 V2 W3"});
  run();
  const double ends[] = {1000 + 1000 - 600 + 10, 2000 - 500, -750, 100 - 400 + 900};
  for (unsigned i = 0; i < 4; ++i) EXPECT_EQ(motors[i].trajectory, position(ends[i])) << i;
  motors[0].trajectory = position(ends[0] + 1250);
  begin();
  EXPECT_NEAR(start(AXIS_X), 2, 1e-9) << "1000 dX + 500 dY = 1250, 1000 dY - 500 dX = 0, dZ = 0";
  EXPECT_NEAR(start(AXIS_Y), 2.5, 1e-9);
  EXPECT_NEAR(start(AXIS_Z), 3, 1e-9);
  EXPECT_NEAR(start(AXIS_U), 1, 1e-9) << "one motor does not tell three axes";
  EXPECT_NEAR(start(AXIS_V), 2, 1e-9);
}

// motion:5.1/2: to the nearest 1/3072 count.
TEST_F(AxesOfMotors, PositionsAreRounded) {
  fit({"0.3X", "0.2X", "-0.3X", "-0.2X"});
  store({"LINEAR TM100 TA20 TS0 X1"});
  run();
  const int ends[] = {922, 614, -922, -614};  // 921.6 and 614.4
  for (unsigned i = 0; i < 4; ++i) EXPECT_EQ(motors[i].trajectory, ends[i]) << i;
}

TEST_F(AxesOfMotors, DistancesBehindATriggerAddUp) {
  fit({"1000X+500Y"});
  ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=20 I192=1 I125=$78000 I124=$120001"), "");
  store({"RAPID X3^0.5 Y2^-0.25"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(100));
  *hal_x(0x78003) = 200;
  *hal_x(0x78000) |= 1u << 11;
  platform::servo_ticks(ticks_of(400));
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(motors[0].trajectory, position(200 + 500 - 125));
}

// The second motor says nothing that the first has not said: its row is what rounding has left.
TEST_F(AxesOfMotors, AMotorThatSaysNothingNewIsNotAsked) {
  fit({"0.1X+0.3Y", "0.7X+2.1Y"});
  store({"TM100 TA20 TS0 INC X1"});
  motors[0].trajectory = position(5);
  motors[1].trajectory = position(35.25);
  begin();
  EXPECT_LT(std::abs(start(AXIS_X)) + std::abs(start(AXIS_Y)), 100.0);
  EXPECT_NEAR(0.1 * start(AXIS_X) + 0.3 * start(AXIS_Y), 5.0, 1e-9);
}

TEST_F(AxesOfMotors, TheWayBackCountsTheBias) {
  fit({"1000X", "1000Y"});
  store({"TM50 TA20 TS0 X1 PSET X5 P1=1"});
  run();
  ASSERT_EQ(motors[0].trajectory, position(1000)) << "X moves before PSET on the same line";
  ASSERT_EQ(motors[0].bias, position(4000));
  motors[0].trajectory = position(3000);
  motors[1].trajectory = position(500);
  store({"PSET X10 INC", "X1 Y1"}, 1);
  run();
  EXPECT_EQ(motors[0].trajectory, position(4000));
  EXPECT_EQ(motors[1].trajectory, position(1500)) << "PSET leaves Y where the motor told it";
  EXPECT_EQ(cs().position[AXIS_X], 11.0);
  EXPECT_NEAR(cs().position[AXIS_Y], 1.5, 1e-12);
}

// A motor that stands while others move is where the program has it, too (motion:5.6/4).
TEST_F(AxesOfMotors, AMotorThatStandsNeedsNoWayBack) {
  fit({"1000X", "1000Y"});
  motors[1].trajectory = position(500);
  store({"INC TM100 TA20 TS0 X1", "X1", "X1"});
  begin();
  platform::servo_ticks(ticks_of(30));
  ASSERT_EQ(host("Q"), "");
  platform::servo_ticks(ticks_of(300));
  ASSERT_FALSE(run_is_running(0));
  EXPECT_EQ(host("R"), "");
  platform::servo_ticks(ticks_of(200));
  motors[1].trajectory += 1;
  EXPECT_EQ(motors[0].trajectory, position(3000));
}

// In segments as without them: it comes along within two of them.
TEST_F(AxesOfMotors, AMotorBesideItsAxisDoesNotJumpInSegments) {
  fit({"1000X", "1000X"});
  ASSERT_EQ(host("I5113=10"), "");
  motors[1].trajectory = position(250);
  store({"LINEAR TM100 TA20 TS0 X1", "X2"});
  double last = at(2), fastest = 0.0;
  run([&](double) {
    fastest = std::max(fastest, std::abs(at(2) - last) / kTickMs);
    last = at(2);
  });
  EXPECT_LT(fastest, 25.0) << "250 counts in 2 x 10 ms, and 10 a ms";
  EXPECT_EQ(motors[0].trajectory, position(2000));
  EXPECT_EQ(motors[1].trajectory, position(2000));
}

TEST_F(AxesOfMotors, MotorsOfInverseKinematicsAreNotMoved) {
  fit({"1000X"});
  ASSERT_EQ(host("I200=1 #2->I"), "");
  motors[1].loop = LOOP_CLOSED;
  ASSERT_EQ(host("I211=0"), "");
  store({"TM50 TA20 TS0 X1"});
  run();
  EXPECT_EQ(cs().motors, 1u);
  EXPECT_EQ(motors[1].path, PATH_STANDS);
}

}  // namespace
