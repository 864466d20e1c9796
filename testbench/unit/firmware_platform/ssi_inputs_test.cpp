// I1015 to I1019 on a Geo PMAC (servo-ic:11.4): what they are there, with and without Feedback Option 2, and on boards
// where they are motor 10's. And the page of main memory that its registers take.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
}

namespace brick {
namespace {

constexpr std::uint32_t kSsiChannel1 = 0xFF54, kSsiChannel2 = 0xFF74, kSsiClock = 0xFF55, kSsiPageEnd = 0x10000;

class SsiInputs : public ::testing::Test {
 protected:
  void start(unsigned product) {
    fake_hal_set_strap(HAL_STRAP_PRODUCT, product);
    for (std::uint32_t address = 0xFF00; address < kSsiPageEnd; ++address) *hal_x(address) = *hal_y(address) = 0x5A5A5A;
    c.restart();
  }
  // X words of both channels, then of the clock.
  static std::array<std::uint32_t, 3> words() {
    return {*hal_x(kSsiChannel1), *hal_x(kSsiChannel2), *hal_x(kSsiClock)};
  }
  using Words = std::array<std::uint32_t, 3>;

  Controller c{0x1};
};

TEST_F(SsiInputs, AreSetByTheDefaults) {
  BRICK_COVERS("SSI-1");
  start(HAL_PRODUCT_GEO_PMAC | HAL_PRODUCT_FEEDBACK_2);
  EXPECT_EQ(c.line("I1015..1019"), "0|3|3|3|3");
  EXPECT_EQ(words(), (Words{0xF, 0xF, 0}));  // 24 bits, Gray: 4 x 3 + 3
}

TEST_F(SsiInputs, FollowTheirVariables) {
  BRICK_COVERS("SSI-1");
  start(HAL_PRODUCT_GEO_PMAC | HAL_PRODUCT_FEEDBACK_2);
  c.line("I1015=2 I1016=2 I1017=1 I1018=0 I1019=2");
  EXPECT_EQ(words(), (Words{4 * 1 + 2, 4 * 2 + 0, 2}));
  c.line("I1018=3");
  EXPECT_EQ(words(), (Words{4 * 1 + 2, 4 * 2 + 3, 2}));
  c.line("I1019=4 I1017=7");  // two bits
  EXPECT_EQ(c.line("I1017 I1019"), "3|0");
  EXPECT_EQ(words(), (Words{4 * 3 + 2, 3, 2}));
  c.line("I1015..1019=*");
  EXPECT_EQ(words(), (Words{0xF, 0xF, 0}));
}

TEST_F(SsiInputs, AreKeptBySave) {
  BRICK_COVERS("SSI-1");
  start(HAL_PRODUCT_GEO_PMAC | HAL_PRODUCT_FEEDBACK_2);
  c.line("I1015=1 I1016=2 I1017=0 I1018=2 I1019=1");
  c.line("SAVE");
  start(HAL_PRODUCT_GEO_PMAC | HAL_PRODUCT_FEEDBACK_2);
  EXPECT_EQ(c.line("I1015..1019"), "1|2|0|2|1");
  EXPECT_EQ(words(), (Words{2, 4 * 1 + 2, 1}));
}

TEST_F(SsiInputs, WithoutTheOptionVariablesAreKeptAndDriveNothing) {
  BRICK_COVERS("SSI-2");
  start(HAL_PRODUCT_GEO_PMAC);
  EXPECT_EQ(c.line("I1015..1019"), "0|3|3|3|3");
  c.line("I1015=2 I1019=1");
  EXPECT_EQ(c.line("I1015 I1019"), "2|1");
  EXPECT_EQ(words(), (Words{0x5A5A5A, 0x5A5A5A, 0x5A5A5A}));
}

TEST_F(SsiInputs, OnOtherBoardsTheyAreMotorTens) {
  BRICK_COVERS("SSI-2");
  start(0);
  EXPECT_EQ(c.line("I1015..1019"), c.line("I1115..1119"));
  c.line("I1019=0.5");
  EXPECT_EQ(c.line("I1019"), "0.5");
}

// The page belongs to devices: a start leaves it alone, buffers end below it.
TEST_F(SsiInputs, BuffersEndBelowThePage) {
  start(HAL_PRODUCT_GEO_PMAC);
  for (std::uint32_t address = 0xFF00; address < kSsiPageEnd; ++address) {
    ASSERT_EQ(*hal_x(address), 0x5A5A5Au) << address;
    ASSERT_EQ(*hal_y(address), 0x5A5A5Au) << address;
  }
  EXPECT_EQ(*hal_x(0xFEFF), 0u);
  EXPECT_EQ(c.line("I4908 SIZE"), "$FF00|24320");
  EXPECT_EQ(c.line("DEF UBUFFER 256 I4908 SIZE"), "$FE00|24064");
}

// The first word begins with a servo clock: where a motor takes its position or its phase from one of the inputs, a
// start waits for that, where none comes for the 25 ms of the watchdog (servo-ic:10/5), and for the longest frame: 25
// clocks of 153.6 kHz and 20 us of rest (servo-ic:11.4), 183 us, rounded up.
TEST_F(SsiInputs, AStartWaitsForTheFirstWord) {
  const auto milliseconds = [this](const std::string& variable, unsigned product) {
    start(product);
    c.line("I110=0 I181=0 I3281=0");
    if (!variable.empty()) c.line(variable);
    c.line("SAVE");
    const std::uint64_t before = hal_long_cycles();
    start(product);
    return static_cast<double>(hal_long_cycles() - before) / hal_cycles_per_ms();
  };
  constexpr unsigned kFitted = HAL_PRODUCT_GEO_PMAC | HAL_PRODUCT_FEEDBACK_2;
  const double none = milliseconds("", kFitted);
  for (const char* variable : {"I110=$FF54", "I181=$FF74", "I3281=$FF54"})
    EXPECT_NEAR(milliseconds(variable, kFitted) - none, 25.2, 0.1) << variable;
  EXPECT_NEAR(milliseconds("I110=$FF55", kFitted), none, 0.1) << "no input";
  EXPECT_NEAR(milliseconds("I110=$FF54", HAL_PRODUCT_GEO_PMAC), milliseconds("", HAL_PRODUCT_GEO_PMAC), 0.1)
      << "there are none";
}

}  // namespace
}  // namespace brick
