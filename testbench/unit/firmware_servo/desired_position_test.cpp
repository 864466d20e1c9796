// Net desired position (motion:1.2), natively.
#include <algorithm>
#include <string>
#include <utility>

#include "testbench/unit/firmware_servo/desired_position_rig.h"

namespace brick {
namespace {

TEST_F(DesiredPosition, IsTheTrajectory) {
  close();
  EXPECT_EQ(desired(7), 7);
  EXPECT_EQ(motors[0].desired_step, 7 * kCount);
  EXPECT_EQ(desired(7), 7);
  EXPECT_EQ(motors[0].desired_step, 0);
}

// A step that 32 bits do not hold is the last that they do, with a master and without.
TEST_F(DesiredPosition, AStepHasTheEndsOf32Bits) {
  for (const char* mode : {"I106=0", "I106=1"}) {
    c_.line(mode);
    close();
    for (const std::int64_t step :
         {INT64_C(0x7FFFFFFE), INT64_C(0x7FFFFFFF), INT64_C(0x80000000), INT64_C(1) << 40, -INT64_C(0x7FFFFFFF),
          -INT64_C(0x80000000), -INT64_C(0x80000001), -(INT64_C(1) << 40)}) {
      motors[0].commanded = 0;
      motors[0].trajectory = step;
      desired_position_servo(0);
      EXPECT_EQ(motors[0].desired_step, std::max<std::int64_t>(INT32_MIN, std::min<std::int64_t>(step, INT32_MAX)))
          << mode << ", " << step;
      EXPECT_EQ(motors[0].commanded, step);
    }
    motors[0].commanded = motors[0].trajectory = 0;
  }
}

// Ixx07/Ixx08 counts a count of the master.
TEST_F(DesiredPosition, FollowsAMaster) {
  master(1000);
  c_.line("I105=$10F5 I107=-48 I106=1");
  close();
  EXPECT_EQ(desired(5), 5) << "where the master was is no movement";
  master(1010);
  EXPECT_EQ(desired(5), 0);
  c_.line("I106=0");
  master(2000);
  EXPECT_EQ(desired(5), 0);
  c_.line("I106=1");
  EXPECT_EQ(desired(5), 0) << "nor is what it did meanwhile";
  master(2001);
  EXPECT_EQ(desired(5), -0.5);
  master(262144 - 1);  // of 24 bits at 1/32 count
  desired(5);
  const double before = desired(5);
  master(-262144);
  EXPECT_EQ(desired(5), before - 0.5) << "rolls over";
}

// A motor that is switched on begins where it is, whatever its master has done meanwhile.
TEST_F(DesiredPosition, AMasterThatMovesWhileTheLoopIsOpenIsNotCaughtUpWith) {
  c_.line("I105=$10F5 I107=96 I106=1");
  const auto servo_tasks = [] {
    desired_position_servo(0);
    position_loop_servo(0);
  };
  master(1000);
  servo_tasks();
  close();
  EXPECT_EQ(desired(0), 0);
  master(1002);
  EXPECT_EQ(desired(0), 2);
  motor_kill(0);
  master(1500);
  servo_tasks();
  close();
  const double there = static_cast<double>(motors[0].trajectory) / kCount;
  EXPECT_EQ(desired(there), 0) << "the motor has not turned";
  master(1501);
  EXPECT_EQ(desired(there), 1);
  ASSERT_TRUE(motor_open(0, 0));
  master(1600);
  servo_tasks();
  close();
  EXPECT_EQ(desired(static_cast<double>(motors[0].trajectory) / kCount), 0);
}

TEST_F(DesiredPosition, AnotherMasterBeginsWhereItStands) {
  c_.line("I105=$10F5 I107=96 I106=1");
  close();
  master(10);
  EXPECT_EQ(desired(0), 10);
  *hal_x(0x10F6) = 500 * 32;
  c_.line("I105=$10F6");
  EXPECT_EQ(desired(0), 10);
  *hal_x(0x10F6) = 501 * 32;
  EXPECT_EQ(desired(0), 11);
}

// Ixx05 of a place without memory: a master that stands at 0.
TEST_F(DesiredPosition, AMasterThatIsNoWordMovesNothing) {
  c_.line("I105=$50000 I107=96 I106=1");
  close();
  *hal_x(0x50000) = 500 * 32;
  EXPECT_EQ(desired(0), 0);
  c_.line("I105=$10F5");
  master(1);
  EXPECT_EQ(desired(0), 1);
}

// Ixx06 = 3, offset mode: replies do not show what the master has moved.
TEST_F(DesiredPosition, RepliesInOffsetModeAreWithoutTheMaster) {
  c_.line("I105=$10F5 I107=96 I106=3");
  close();
  c_.line("#1J/");
  master(10);
  EXPECT_EQ(desired(3), 13);
  *hal_x(0x10F0) = 13 * 32;
  position_loop_servo(0);
  EXPECT_EQ(c_.line("#1P"), "3");
  EXPECT_EQ(c_.line("#1F"), "0");
  c_.line("I106=1");
  EXPECT_EQ(c_.line("#1P"), "13");
  c_.line("I106=2");
  EXPECT_EQ(c_.line("#1P"), "3");
}

TEST_F(DesiredPosition, AMotorInALimitFollowsOutOfItOnly) {
  c_.line("I105=$10F5 I107=96 I106=1");
  close();
  motors[0].found.positive_limit = true;
  master(10);
  EXPECT_EQ(desired(0), 0);
  master(4);
  EXPECT_EQ(desired(0), -6);
  motors[0].found.positive_limit = false;
  motors[0].found.negative_limit = true;
  master(-10);
  EXPECT_EQ(desired(0), -6);
  master(-7);
  EXPECT_EQ(desired(0), -3);
}

// y = K y + (1-K) x, and exact in the end.
TEST_F(DesiredPosition, Filter) {
  c_.line("I140=0.819");
  close();
  double y = 0;
  for (int n = 0; n < 50; ++n) {
    y = 0.819 * y + (1 - 0.819) * 1000;
    EXPECT_NEAR(desired(1000), y, 0.001) << n;
  }
  c_.line("I140=0.999");
  for (int n = 0; n < 40000; ++n) desired(1000);
  EXPECT_EQ(desired(1000), 1000);
  for (int n = 0; n < 40000; ++n) desired(-3);
  EXPECT_EQ(desired(-3), -3);
  c_.line("I140=1");
  for (int n = 0; n < 100; ++n) desired(1000);
  EXPECT_NEAR(desired(1000), -3, 0.01) << "K = 1 stays";
}

// Ixx24 bit 13: what Ixx67 cuts of the error is taken off the master position and comes back when the motor does.
TEST_F(DesiredPosition, ErrorBeyondIxx67WaitsInTheMasterPosition) {
  c_.line("I167=160");
  close();
  EXPECT_EQ(desired(50), 50) << "bit 13 = 0: the error stays";
  EXPECT_EQ(desired(0), 0);
  c_.line("I124=$802001");
  const auto actual = [](double counts) { motors[0].actual = std::llround(counts * kCount); };
  const auto word = [this] { return std::pair<std::string, std::string>(c_.line("RX$8D"), c_.line("RY$8D")); };
  EXPECT_EQ(desired(7), 7) << "within 10 counts";
  EXPECT_EQ(word(), std::make_pair(std::string("0"), std::string("0")));
  EXPECT_EQ(desired(50), 10);
  EXPECT_EQ(motors[0].desired_step, 3 * kCount);
  EXPECT_EQ(word().second, std::to_string(-40 * kCount)) << "40 counts less";
  EXPECT_EQ(hal_signed(*hal_y(0x8D)), -40 * kCount) << "in memory too";
  c_.line("WX$8D," + word().first);
  c_.line("WY$8D," + word().second);
  EXPECT_EQ(desired(50), 10) << "what is read can be written back: nothing moves";
  EXPECT_EQ(word().second, std::to_string(-40 * kCount));
  actual(25);
  EXPECT_EQ(desired(50), 35);
  actual(45);
  EXPECT_EQ(desired(50), 50) << "all of it has come back";
  EXPECT_EQ(word().second, "0");
  EXPECT_EQ(desired(0), 35) << "the other way";
  EXPECT_EQ(word().second, std::to_string(35 * kCount));
  motor_kill(0);
  position_loop_servo(0);
  close();
  EXPECT_EQ(motors[0].commanded, motors[0].actual);
  EXPECT_EQ(desired(static_cast<double>(motors[0].trajectory) / kCount), static_cast<double>(motors[0].actual) / kCount)
      << "a loop that is opened forgets what it had not reached";
  EXPECT_EQ(word().second, std::to_string(35 * kCount)) << "and its master position is what it was";
  const double there = static_cast<double>(motors[0].trajectory) / kCount;
  EXPECT_EQ(desired(there + 50), 55);
  EXPECT_EQ(word().second, std::to_string(-5 * kCount));
  c_.line("I124=$800001");
  EXPECT_EQ(word().second, std::to_string(35 * kCount)) << "off: nothing is held back";
  EXPECT_EQ(desired(there + 50), 95);
  c_.line("I167=0");
  actual(0);
  motors[0].master = 0;
  EXPECT_EQ(desired(50), 50) << "a velocity loop has no error to cut";
}

TEST_F(DesiredPosition, ErrorBeyondIxx67WaitsBehindTheFilterToo) {
  c_.line("I167=160 I124=$802001 I140=0.5");
  close();
  EXPECT_EQ(desired(16), 8);
  EXPECT_EQ(desired(16), 10) << "12 by the filter";
  EXPECT_EQ(desired(16), 10) << "13";
  motors[0].actual = 100 * kCount;
  EXPECT_EQ(desired(100), 90) << "55";
  motors[0].actual = 50 * kCount;
  EXPECT_EQ(desired(100), 60) << "95";
  motors[0].actual = 75 * kCount;
  EXPECT_EQ(desired(100), 80);
}

// Between closures (Ixx60) a motor that follows is no further behind than when its loop looks.
TEST_F(DesiredPosition, ErrorBeyondIxx67IsTheOneOfTheMoment) {
  c_.line("I167=160 I124=$802001 I160=7");
  close();
  int closures = 0;
  for (int n = 1; n <= 100; ++n) {  // 2 counts an interrupt, 5 behind
    *hal_x(0x10F0) = static_cast<std::uint32_t>((2 * n - 5) * 32) & HAL_WORD_MASK;
    EXPECT_EQ(desired(2 * n), 2 * n);
    const std::int64_t before = motors[0].actual;
    position_loop_servo(0);
    if (motors[0].actual == before) continue;
    closures++;
    EXPECT_EQ(motors[0].commanded - motors[0].actual, 5 * kCount);
  }
  EXPECT_GE(closures, 12);
  for (int n = 0; n < 16; ++n) {
    EXPECT_EQ(desired(300), 205) << "10 counts from where it stands";
    position_loop_servo(0);
  }
}

// Ixx85 a background pass, when the direction has turned by more than Ixx87.
TEST_F(DesiredPosition, Backlash) {
  c_.line("I185=16 I186=80 I187=64");
  close();
  const auto desired = [](double trajectory) {
    desired_position_pass();
    return DesiredPosition::desired(trajectory);
  };
  EXPECT_EQ(desired(100), 100);
  EXPECT_EQ(desired(96), 96) << "4 counts back are hysteresis";
  EXPECT_FALSE(desired_position_backlash_is_down(0));
  EXPECT_EQ(desired(95), 94);
  EXPECT_TRUE(desired_position_backlash_is_down(0));
  for (const double left : {93, 92, 91, 90, 90}) EXPECT_EQ(desired(95), left);
  EXPECT_EQ(desired(99), 94);
  EXPECT_EQ(desired(99.5), 95.5);
  EXPECT_EQ(desired(99.5), 96.5);
  c_.line("I185=8388607");
  EXPECT_EQ(desired(99.5), 99.5) << "at once";
  EXPECT_EQ(desired(95), 90);
  EXPECT_EQ(desired(99.25), 99.25) << "hysteresis is counted from where it has turned";
}

TEST_F(DesiredPosition, BacklashWaitsForTheBackground) {
  c_.line("I185=16 I186=80 I187=0");
  close();
  c_.line("");
  EXPECT_EQ(desired(100), 100);
  for (int n = 0; n < 5; ++n) EXPECT_EQ(desired(99), 99 - 0) << "no pass yet";
  c_.line("");
  EXPECT_EQ(desired(99), 98);
  EXPECT_EQ(desired(99), 98);
  c_.line("");
  EXPECT_EQ(desired(99), 97);
  c_.line("I186=0");
  EXPECT_EQ(desired(99), 98) << "it goes as it comes";
  c_.line("I185=0");
  EXPECT_EQ(desired(99), 99) << "off: at once";
  EXPECT_EQ(motors[0].compensation, 0);
  EXPECT_EQ(desired(98), 98);
  c_.line("I185=16 I186=80");
  EXPECT_EQ(desired(98), 97) << "downwards it begins anew";
}

// A loop that is closed has moved nowhere yet, whatever its master has done before.
TEST_F(DesiredPosition, BacklashBeginsWhereTheLoopIsClosed) {
  c_.line("I185=8388607 I186=80 I187=64 I105=$10F5 I107=96 I106=1");
  for (const double counts : {-300.0, 300.0, -300.0}) {
    close();
    master(counts);
    const double there = static_cast<double>(motors[0].trajectory) / kCount;
    (void)desired(there);
    (void)desired(there + (counts < 0 ? 10 : -10));  // the last movement is the other way
    motor_kill(0);
    *hal_x(0x10F0) = static_cast<std::uint32_t>(-2 * counts * 32) & HAL_WORD_MASK;  // turned by hand meanwhile
    position_loop_servo(0);
    close();
    const bool down = desired_position_backlash_is_down(0);
    desired_position_pass();
    (void)desired(static_cast<double>(motors[0].trajectory) / kCount);
    EXPECT_EQ(desired_position_backlash_is_down(0), down) << counts;
  }
}

// Positions are counted from elsewhere: no movement.
TEST_F(DesiredPosition, BacklashKnowsNothingOfAnotherZero) {
  c_.line("I185=8388607 I186=80 I187=64");
  close();
  for (const double by : {-1000.0, 1000.0}) {
    const double there = static_cast<double>(motors[0].trajectory) / kCount;
    desired_position_shift(0, std::llround(by * kCount), 0);
    desired_position_pass();
    EXPECT_EQ(desired(there + by), there + by);
    EXPECT_FALSE(desired_position_backlash_is_down(0));
  }
}

TEST_F(DesiredPosition, ACountedPositionMovesNothing) {
  c_.line("I130=2000 I131=0");
  close();
  for (int n = 0; n < 3; ++n) {
    desired(10);
    position_loop_servo(0);
  }
  const std::int32_t output = motors[0].output;
  desired_position_shift(0, 1000 * kCount, 0);
  EXPECT_EQ(desired(1010), 1010);
  EXPECT_EQ(motors[0].desired_step, 0);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].output, output);
  EXPECT_EQ(position_loop_step(0), 0);
}

// motion:1.3: D:$8D of motor 1, + $80 a motor, is what it has followed.
TEST_F(DesiredPosition, TheMasterPositionIsShownAtItsMotor) {
  c_.line("I105=$10F5 I107=96 I106=1 I205=$10F5 I207=-48 I206=1");
  close();
  master(-300);
  desired(0);
  desired(0, 1);
  const std::int64_t ways[] = {-300 * kCount, 150 * kCount};
  for (std::uint32_t motor = 0; motor < 2; ++motor) {
    const std::uint32_t word = 0x8D + 0x80 * motor;
    EXPECT_EQ(*hal_x(word), static_cast<std::uint32_t>(ways[motor] >> 24) & HAL_WORD_MASK) << motor;
    EXPECT_EQ(*hal_y(word), static_cast<std::uint32_t>(ways[motor]) & HAL_WORD_MASK) << motor;
  }
}

// motion:1.2/3, to the unit: one more of its master's ways, Ixx07 = 1, leads out of a limit, none into it.
TEST_F(DesiredPosition, AMotorInALimitFollowsNoUnitFurther) {
  c_.line("I105=$10F5 I107=1 I106=1");
  close();
  std::int64_t word = 0;
  *hal_x(0x10F5) = 0;
  const auto follows = [&](int by) {
    const std::int64_t before = motors[0].master;
    word += by;
    *hal_x(0x10F5) = static_cast<std::uint32_t>(word) & HAL_WORD_MASK;
    desired(0);
    return motors[0].master - before;
  };
  ASSERT_EQ(follows(1), 1);
  for (const bool up : {true, false}) {
    motors[0].found.positive_limit = up;
    motors[0].found.negative_limit = !up;
    EXPECT_EQ(follows(up ? 1 : -1), 0) << "further in";
    EXPECT_EQ(follows(up ? -1 : 1), up ? -1 : 1) << "out";
  }
}

}  // namespace
}  // namespace brick
