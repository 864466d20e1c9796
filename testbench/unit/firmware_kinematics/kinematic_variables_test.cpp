// What kinematic programs share with motors that are not theirs (motion:8.1): P-variables, and a PSET that fails.
#include "testbench/unit/firmware_kinematics/arm.h"

namespace {

using namespace moving_motors;
using arm::Arm;

class KinematicVariables : public Arm {};

// The forward program finds motors of its system in P1 to P32, whatever moves them; the other ones are the user's.
TEST_F(KinematicVariables, TheForwardProgramFindsTheMotorsOfItsSystem) {
  fit_arm({400, 100}, {"1000Z", "I", "1000W"});
  ASSERT_EQ(host("&1#4->0 &2#4->500X &1"), "");  // out of &1
  motors[2].trajectory = 7 * 3072;
  motors[3].trajectory = 8 * 3072;
  motors[4].trajectory = -9 * 3072;
  const double stands[] = {at(1), at(2)};
  ASSERT_EQ(host("P1..32=5555"), "");
  program("FORWARD", {"P201=P1 P202=P2 P203=P3 P204=P4 P205=P5 P232=P32 Q7=400 Q8=100"});
  ASSERT_EQ(host("PMATCH"), "");
  platform::servo_ticks(6);
  EXPECT_NEAR(p(201), stands[0], 1e-3);
  EXPECT_NEAR(p(202), stands[1], 1e-3);
  EXPECT_EQ(p(203), 7);
  EXPECT_EQ(p(204), 5555) << "of another system";
  EXPECT_EQ(p(205), -9);
  EXPECT_EQ(p(232), 5555) << "of none";
  EXPECT_EQ(p(4), 5555);
  EXPECT_EQ(p(32), 5555);
}

// motion:8.1/6: nothing of a line is executed that the inverse program cannot solve: no axis of a PSET is set.
TEST_F(KinematicVariables, APsetThatFailsSetsNoAxis) {
  fit_arm({400, 100}, {"1000Z"});
  store({"PSET Z2", "PSET X600 Z5"});
  ASSERT_EQ(host("&1B1R"), "");
  for (int i = 0; i < 1000 && run_is_running(0); ++i) platform::servo_ticks(3);
  EXPECT_EQ(cs().error, RUN_TIME_BY_USER);
  EXPECT_EQ(motors[2].bias, 2000 * 3072) << "of the first";
  EXPECT_EQ(motors[0].bias, 0);
  EXPECT_EQ(motors[1].bias, 0);
  EXPECT_NEAR(axis(AXIS_X), 400, 0.01);
  EXPECT_EQ(axis(AXIS_Z), 2);
}

}  // namespace
