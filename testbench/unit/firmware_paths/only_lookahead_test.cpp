// A Geo PMAC (firmware:3.8) has one segmentation time, I13, and one length of lookahead, I1020, for the one system that
// has the buffer. On other boards I13 is a switch and I1020 belongs to motor 10.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/protection.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
}

namespace {

using namespace moving_motors;

class OnlyLookahead : public MovingMotors {
 protected:
  static void become(unsigned product) {
    fake_hal_set_strap(HAL_STRAP_PRODUCT, product);
    platform::reset("$$$***");
  }
  void SetUp() override {
    platform::power_up();
    become(HAL_PRODUCT_GEO_PMAC);
  }
};

TEST_F(OnlyLookahead, IsOneValueForAllSystems) {
  BRICK_COVERS("LA-1");
  EXPECT_EQ(host("I13 I1020"), "0|0");
  ASSERT_EQ(host("I13=7 I1020=65535"), "");
  EXPECT_EQ(host("I13 I1020"), "7|65535");
  EXPECT_EQ(host("I5113 I6613 I5120 I6620"), "7|7|65535|65535");
  ASSERT_EQ(host("I6613=9 I5120=12"), "");
  EXPECT_EQ(host("I13 I5113 I6613 I1020 I5120 I6620"), "9|9|9|12|12|12");
  ASSERT_EQ(host("I13=256 I1020=65537"), "");  // eight bits, sixteen
  EXPECT_EQ(host("I13 I5213 I1020 I5220"), "0|0|1|1");
  ASSERT_EQ(host("I13=5 I1020=54"), "");
  EXPECT_EQ(host("I12 I14 I1120 I5112"), host("I12=* I14=* I1120=* I12 I14 I1120 I5112")) << "its neighbours";
  ASSERT_EQ(host("I13=* I1020=*"), "");
  EXPECT_EQ(host("I5113 I5120"), "0|0");
}

TEST_F(OnlyLookahead, IsLockedWithSystemsAndSaved) {
  BRICK_COVERS("LA-1");
  ASSERT_EQ(host("I13=5 I1020=54 I41=2"), "");
  ASSERT_EQ(host("I13=6 I1020=55 I5113=6 I5120=55"), "");
  EXPECT_EQ(host("I13 I5113 I1020 I5120"), "5|5|54|54");
  ASSERT_EQ(host("I41=1 I1020=55"), "") << "it is none of a motor's";
  EXPECT_EQ(host("I1020"), "55");
  ASSERT_EQ(host("I41=0 SAVE"), "");
  ASSERT_EQ(host("I13=1 I1020=1"), "");
  platform::reset();
  EXPECT_EQ(host("I13 I5113 I6613 I1020 I5120 I6620"), "5|5|5|55|55|55");
}

// LA-1 to LA-4 by I13 and I1020: `ALineIsLimited`, in a system that is not the first one.
TEST_F(OnlyLookahead, LimitsThePathOfTheSystemThatHasTheBuffer) {
  BRICK_COVERS("LA-1 LA-2 LA-3 LA-4");
  double times[3];
  const char* const lengths[] = {"0", "1", "40"};
  for (int i = 0; i < 3; ++i) {
    platform::power_up();
    become(HAL_PRODUCT_GEO_PMAC);
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I13=5 I116=50 I117=1 I1020=") + lengths[i]), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
    store({"F100 TA10 TS0", "X20"});
    double before = 0, fastest = 0;
    times[i] = run([&](double) {
      fastest = std::max(fastest, (at(1) - before) / kTickMs);
      before = at(1);
    });
    EXPECT_EQ(motors[0].trajectory, 20000 * 3072);
    EXPECT_NEAR(fastest, i == 2 ? 50 : 100, 0.5);
  }
  EXPECT_NEAR(times[0], 200 + 10 + 2 * 5, 1) << "segments: 2 I13 longer than motion:5.2 says";
  EXPECT_NEAR(times[1], times[0], kTickMs);
  EXPECT_GE(times[2], 400 + 50);
  EXPECT_LE(times[2], 1.1 * (400 + 50));
}

// [PS215]: there may be no lookahead and no gather buffer, of whatever system.
TEST_F(OnlyLookahead, HasOneBuffer) {
  BRICK_COVERS("LA-3");
  for (const char* order : {"&1DEFINE LOOKAHEAD 50,10", "&2DEFINE LOOKAHEAD 50,10", "&3DEFINE LOOKAHEAD 50,10"}) {
    EXPECT_EQ(host("&2DEFINE LOOKAHEAD 40,0"), "");
    const std::string size = host("SIZE");
    EXPECT_EQ(host(order), "ERR003") << order;
    EXPECT_EQ(host("SIZE"), size);
    EXPECT_EQ(host("&2DELETE LOOKAHEAD"), "");
  }
  EXPECT_EQ(host("DEFINE GATHER"), "");
  EXPECT_EQ(host("&1DEFINE LOOKAHEAD 50,10"), "ERR003");
  EXPECT_EQ(host("DELETE GATHER"), "");
  EXPECT_EQ(host("&1DEFINE LOOKAHEAD 50,10"), "");
}

TEST_F(OnlyLookahead, IsNoSwitchOfInPosition) {
  for (const unsigned product : {0u, unsigned{HAL_PRODUCT_GEO_PMAC}}) {
    become(product);
    ASSERT_EQ(host("I13=1"), "");
    EXPECT_EQ(i_variable_foreground_in_position(), product == 0);
    protection_pass();
    protection_begin_servo();  // the next interrupt
    EXPECT_EQ(protection_watched == UINT32_MAX, product == 0) << "every motor at each interrupt";
  }
}

TEST_F(OnlyLookahead, OnOtherBoardsIsMotorTensAndASwitch) {
  become(0);
  EXPECT_EQ(host("I1020 I1120"), "0|0");
  ASSERT_EQ(host("I1020=8388607 I13=3"), "");
  EXPECT_EQ(host("I1020 I13"), "8388607|1");
  EXPECT_EQ(host("I5113 I5120"), "0|0");
  ASSERT_EQ(host("I5113=9 I5120=12"), "");
  EXPECT_EQ(host("I5213 I5220 I13 I1020"), "0|0|1|8388607");
  EXPECT_EQ(host("&2DEFINE LOOKAHEAD 50,10 &1DEFINE LOOKAHEAD 50,10"), "") << "one of each system";
}

}  // namespace
