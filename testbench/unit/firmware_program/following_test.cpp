// Jogs and programs of a motor that follows (motion:1.2/4): in normal mode they take back what has been followed before
// they begin, in offset mode their positions go with the master.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/jog.h"
}

namespace {

using namespace moving_motors;

constexpr std::uint32_t kMaster = 0x10F0;

class Following : public MovingMotors {
 protected:
  void SetUp() override { begin(1); }
  // `mode`: Ixx06. The master has gone on by 500 counts.
  static void begin(unsigned mode) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=20 I192=1 I115=1 I105=$10F0 I107=96"), "");
    ASSERT_EQ(host("I123=15 I125=$78000 I124=$120001 I106=" + std::to_string(mode)), "");
    platform::servo_ticks(3);
    master(500);
    ASSERT_EQ(commanded(), 500);
  }
  static void master(double counts) {
    *hal_x(kMaster) = static_cast<std::uint32_t>(std::llround(counts * 32)) & 0xFFFFFF;
    platform::servo_ticks(1);
  }
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
  static double commanded() { return static_cast<double>(motors[0].commanded) / kUnit; }
  static double after(const std::string& line) {
    EXPECT_EQ(host(line), "") << line;
    ticks(20);
    for (int i = 0; i < 2000 && (jog_is_moving(0) || run_is_running(0)); ++i) ticks(5);
    EXPECT_FALSE(jog_is_moving(0) || run_is_running(0)) << line;
    return commanded();
  }
};

TEST_F(Following, JogsGoToPlacesOfTheMotorOrBesideTheMaster) {
  struct Case {
    const char* line;
    double normal, offset;
  };
  const Case cases[] = {{"#1J=1000", 1000, 1500}, {"#1J:100", 600, 600}, {"#1J==40", 40, 540},
                        {"#1J/", 500, 500},       {"#1J=", 500, 500},    {"#1J=1000^40", 1000, 1500}};
  for (const Case& c : cases) {
    begin(1);
    EXPECT_NEAR(after(c.line), c.normal, 1e-9) << c.line;
    begin(3);
    EXPECT_NEAR(after(c.line), c.offset, 1e-9) << c.line;
    begin(1);
    ASSERT_EQ(host("I106=0"), "");
    EXPECT_NEAR(after(c.line), c.normal, 1e-9) << c.line << ", following turned off";
    begin(3);
    ASSERT_EQ(host("I106=2"), "");
    EXPECT_NEAR(after(c.line), c.offset, 1e-9) << c.line << ", in offset mode";
  }
}

TEST_F(Following, FromWhereItIsIsFromWhereItIs) {
  for (const unsigned mode : {1u, 3u}) {
    begin(mode);
    motors[0].actual = motors[0].commanded;
    EXPECT_NEAR(after("#1J^10"), 510, 1e-9) << mode;
  }
}

TEST_F(Following, WhatIsFollowedOnTheWayIsTakenBackByTheNextMotion) {
  ASSERT_EQ(host("#1J=2000"), "");
  ticks(30);
  master(700);
  ticks(400);
  EXPECT_NEAR(commanded(), 2200, 1e-9) << "added to a motion that has begun";
  EXPECT_NEAR(after("J=2000"), 2000, 1e-9);
  ASSERT_EQ(host("J=1000"), "");
  ticks(30);
  master(900);
  EXPECT_NEAR(after("J=1500"), 1500, 1e-9) << "a new target on the way";
}

TEST_F(Following, JEqualsTakesBackWhatHasBeenFollowedSince) {
  ASSERT_NEAR(after("#1J=1000"), 1000, 1e-9);
  master(750);
  EXPECT_NEAR(commanded(), 1250, 1e-9);
  EXPECT_NEAR(after("J="), 500, 1e-9) << "where it was before it was jogged";
  begin(3);
  ASSERT_NEAR(after("#1J=1000"), 1500, 1e-9);
  master(750);
  EXPECT_NEAR(after("J="), 750, 1e-9) << "0 beside the master";
}

TEST_F(Following, JBangMakesTheCommandedPositionWhole) {
  master(500.4375);
  ASSERT_EQ(host("#1J!"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(commanded(), 500.0);
}

// motion:5.1/4: axes are where the motors are when a program begins.
TEST_F(Following, ProgramsEndWhereTheirAxesSay) {
  struct Case {
    const char* line;
    double normal, offset;
  };
  const Case cases[] = {{"TM100 TA20 TS0 X1", 1000, 1500},
                        {"INC TM100 TA20 TS0 X1", 1500, 1500},
                        {"RAPID X1", 1000, 1500},
                        {"SPLINE1 TM50 X1", 1000, 1500}};
  for (const Case& c : cases) {
    for (const unsigned mode : {1u, 3u}) {
      begin(mode);
      store({c.line});
      EXPECT_NEAR(after("&1B1R"), mode == 1 ? c.normal : c.offset, 1e-3) << c.line;
      EXPECT_EQ(motors[0].bias, 0);
    }
  }
  begin(1);
  store({"TM100 TA20 TS0 X1"});
  after("&1B1R");
  master(750);
  EXPECT_NEAR(commanded(), 1250, 1e-9);
  EXPECT_NEAR(after("&1B1R"), 1000, 1e-9) << "the second run takes back what came between them";
  EXPECT_NEAR(cs().position[AXIS_X], 1.0, 1e-12);
}

// motion:4.3: home is 0 of what `P` shows.
TEST_F(Following, HomeIsWhereTheMotorIsOrBesideTheMaster) {
  for (const unsigned mode : {1u, 3u}) {
    begin(mode);
    ASSERT_EQ(host("#1HMZ"), "");
    platform::servo_ticks(1);
    EXPECT_NEAR(commanded(), mode == 1 ? 0 : 500, 1e-9);
    EXPECT_NEAR(after("J=100"), mode == 1 ? 100 : 600, 1e-9);
    EXPECT_NEAR(after("J="), mode == 1 ? 0 : 500, 1e-9);
    begin(mode);
    ASSERT_EQ(host("#1HM"), "");
    ticks(50);
    *hal_x(kCaptured) = 200;  // the encoder stands at 0, where the motor is taken to be
    *hal_x(kStatus) |= kCaptureFlag;
    platform::servo_ticks(1);
    *hal_x(kStatus) &= ~kCaptureFlag;
    ticks(400);
    EXPECT_TRUE(motors[0].status.home_complete);
    EXPECT_EQ(motors[0].actual, std::llround((mode == 1 ? -200 : 300) * kUnit))
        << "0 of P is where the encoder has 200";
    EXPECT_NEAR(commanded(), mode == 1 ? 0 : 500, 1e-9);
    EXPECT_NEAR(after("J=100"), mode == 1 ? 100 : 600, 1e-9);
    EXPECT_NEAR(after("J="), mode == 1 ? 0 : 500, 1e-9);
  }
}

}  // namespace
