// `ABR{n}`: an abort, then a program that begins when the motors stand (motion:5.6/8).
#include <algorithm>

#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/image/background_pass.h"
#include "firmware/run/run_control.h"
}

namespace {

using namespace moving_motors;

class Restart : public MovingMotors {
 protected:
  void SetUp() override {
    MovingMotors::SetUp();
    fit({"1000X"});
    ASSERT_EQ(host("I115=0.5"), "");
    store({"TM500 TA20 TS0 X10"}, 1);  // 20 counts a ms: a ramp of 40 ms and 400 counts
    store({"P5=P5+1", "TM50 TA20 TS0 X0"}, 2);
    ASSERT_EQ(host("P5=0"), "");
  }
  static void ticks(double ms) {
    for (unsigned n = ticks_of(ms); n > 0; --n) {
      platform::servo_ticks(1);
      background_pass();
    }
  }
  static void move() {
    ASSERT_EQ(host("&1B1R"), "");
    ticks(120);
    ASSERT_TRUE(run_is_running(0));
  }
};

TEST_F(Restart, BeginsWhenTheMotorStands) {
  move();
  const double aborted = at(1);
  ASSERT_EQ(host("ABR2"), "");
  EXPECT_FALSE(run_is_running(0));
  ticks(36);
  EXPECT_EQ(host("P5"), "0") << "it ramps still";
  EXPECT_GT(at(1), aborted + 350);
  double farthest = 0.0;
  for (int ms = 0; ms < 20; ++ms) {
    ticks(1);
    farthest = std::max(farthest, at(1));
  }
  EXPECT_EQ(host("P5"), "1");
  EXPECT_NEAR(farthest, aborted + 400, 40);
  ticks(150);
  EXPECT_EQ(at(1), 0);
  EXPECT_FALSE(run_is_running(0));
  ticks(100);
  EXPECT_EQ(host("P5"), "1") << "once";
}

TEST_F(Restart, WithoutANumberItIsTheSameProgram) {
  ASSERT_EQ(host("&1B2R"), "");
  ticks(20);
  ASSERT_EQ(host("ABR"), "");
  ticks(100);
  EXPECT_EQ(host("P5"), "2");
}

TEST_F(Restart, AnotherOrderTakesItsPlace) {
  for (const char* order : {"A", "B1", "#1K"}) {
    move();
    ASSERT_EQ(host("ABR2"), "");
    ticks(10);
    ASSERT_EQ(host(order), "") << order;
    ticks(200);
    EXPECT_EQ(host("P5"), "0") << order;
    EXPECT_FALSE(run_is_running(0)) << order;
    ASSERT_EQ(host("#1J/"), "");
    ticks(10);
  }
}

TEST_F(Restart, ClearsTheRotaryBuffer) {
  ASSERT_EQ(host("&1 DEF ROT 200 B0 OPEN ROT"), "");
  ASSERT_EQ(host("TM500 TA20 TS0 X5"), "");
  ASSERT_EQ(host("R"), "");
  ticks(100);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(host("X7"), "");
  ASSERT_NE(host("PR"), "0");
  ASSERT_EQ(host("ABR0"), "");
  EXPECT_EQ(host("PR"), "0");
  ticks(100);
  EXPECT_TRUE(run_is_running(0)) << "it waits for lines";
  const double stands = at(1);
  EXPECT_LT(stands, 3000);
  ASSERT_EQ(host("X1"), "");
  ticks(700);
  EXPECT_EQ(at(1), 1000);
}

TEST_F(Restart, ErrorsAbortAllTheSame) {
  for (const char* line : {"ABR77", "ABR0"}) {
    move();
    EXPECT_EQ(host(line), "ERR015") << line;
    EXPECT_FALSE(run_is_running(0)) << line;
    ticks(200);
    EXPECT_FALSE(run_is_running(0)) << line;
  }
  EXPECT_EQ(host("ABRX"), "ERR003");
}

}  // namespace
