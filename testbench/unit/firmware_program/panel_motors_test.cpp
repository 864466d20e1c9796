// The control panel's inputs of motors: JOG+, JOG-, PREJ, HOME (motion:4.5/4). Inputs are given as 1 = pulled low.
#include <string>

#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/motor.h"
}

namespace {

using platform::host;
using platform::panel;

constexpr std::uint32_t kJogMinus = 1u << 0, kJogPlus = 1u << 1, kPrejog = 1u << 2, kHome = 1u << 6;
constexpr std::uint32_t fpd(std::uint32_t n) { return n << 8; }

class PanelMotors : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    platform::fit_panel();
    for (const unsigned motor : {1u, 3u, 18u}) {
      const std::string i = "I" + std::to_string(motor);
      ASSERT_EQ(
          host(i + "00=1 " + i + "19=1 " + i + "21=10 " + i + "22=20 " + i + "11=0 " + i + "23=-10 " + i + "92=2"), "");
    }
  }
  // Position less that of 100 servo interrupts ago, counts.
  static double way(unsigned motor) {
    platform::servo_ticks(100);
    const std::int64_t before = motors[motor - 1].trajectory;
    platform::servo_ticks(100);
    return static_cast<double>(motors[motor - 1].trajectory - before) / 3072;
  }
};

TEST_F(PanelMotors, JogInputsMoveTheSelectedMotorWhileTheyAreLow) {
  for (const int sign : {1, -1}) {
    panel(fpd(3));
    panel(fpd(3) | (sign > 0 ? kJogPlus : kJogMinus));
    EXPECT_NEAR(way(3), sign * 885.5, 1);
    EXPECT_EQ(way(1), 0);
    panel(fpd(3) | kJogPlus | kJogMinus);
    EXPECT_NEAR(way(3), sign * 885.5, 1) << "both at once change nothing";
    panel(fpd(3));
    EXPECT_EQ(way(3), 0);
  }
}

// Not the one that is still low, and that one has to go low for it.
TEST_F(PanelMotors, TheInputThatMovesAMotorStopsIt) {
  panel(fpd(3) | kJogPlus);
  panel(fpd(3) | kJogPlus | kJogMinus);
  panel(fpd(3) | kJogMinus);
  EXPECT_EQ(way(3), 0);
  panel(fpd(3));
  panel(fpd(3) | kJogMinus);
  EXPECT_LT(way(3), -800);
  panel(fpd(3) | kJogPlus | kJogMinus);
  panel(fpd(3) | kJogPlus);
  EXPECT_EQ(way(3), 0);
}

TEST_F(PanelMotors, AnotherSelectionStopsTheMotorThatJogs) {
  panel(fpd(1) | kJogPlus);
  EXPECT_GT(way(1), 800);
  panel(fpd(3) | kJogPlus);
  EXPECT_EQ(way(1), 0);
  EXPECT_EQ(way(3), 0) << "the input has to go low for it";
  panel(fpd(1) | kJogPlus);
  panel(fpd(1));
  panel(fpd(1) | kJogPlus);
  EXPECT_GT(way(1), 800);
  ASSERT_EQ(host("I2=1"), "");
  platform::background(1);
  EXPECT_EQ(way(1), 0) << "the panel is off";
}

TEST_F(PanelMotors, PrejogAndHome) {
  ASSERT_EQ(host("#1J==100"), "");
  platform::servo_ticks(300);
  ASSERT_EQ(host("J=500"), "");
  platform::servo_ticks(1000);
  panel(fpd(1) | kPrejog);
  platform::servo_ticks(1000);
  EXPECT_EQ(motors[0].trajectory, 100 * 3072);
  panel(fpd(1));
  panel(fpd(1) | kHome);
  EXPECT_LT(way(1), -400);
  EXPECT_TRUE(motors[0].status.home_search);
  panel(fpd(1));
  EXPECT_LT(way(1), -400) << "it goes on";
}

TEST_F(PanelMotors, GroupsOfI59ReachAllMotors) {
  ASSERT_EQ(host("I59=2"), "");
  panel(fpd(2));
  panel(fpd(2) | kJogPlus);
  EXPECT_GT(way(18), 800);
}

TEST_F(PanelMotors, WhatMayNotMoveStands) {
  panel(fpd(2));
  panel(fpd(2) | kJogPlus);
  EXPECT_EQ(way(2), 0) << "not activated";
  panel(fpd(12) | kJogPlus);
  panel(kJogPlus);
  panel(0);
}

}  // namespace
