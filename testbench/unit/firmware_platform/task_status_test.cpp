// Global status bits 22, 20 and 9 and the words of task durations, an interrupt at a time (firmware:1.10, firmware:5.7,
// firmware:8.2).
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/image/background_pass.h"
#include "firmware/kernel/image_checksum.h"
#include "firmware/kernel/slice.h"
}

namespace brick {
namespace {

constexpr std::uint32_t kRealTime = 0x0B;  // X: last, Y: longest
const char *const kNone = "000000", *const kBoth = "400200", *const kReentry = "400000", *const kServo = "100000";

class TaskStatus : public ::testing::Test {
 protected:
  std::string status() { return c_.line("???").substr(0, 6); }
  // Servo interrupts while the tasks above leave the real-time task no time.
  void starve(unsigned interrupts) {
    for (unsigned i = 0; i < interrupts; ++i) fake_task_run_servo();
  }

  Controller c_;
};

TEST_F(TaskStatus, RealTimeTaskThatHasNotBegunWhenItIsDueAgainIsLate) {
  for (const unsigned i8 : {0u, 2u, 5u}) {
    SCOPED_TRACE(i8);
    c_.line("WX$6,0 I8=" + std::to_string(i8));
    c_.servo(10 * (i8 + 1));
    ASSERT_EQ(status(), kNone);
    starve(i8 + 1);
    EXPECT_EQ(status(), kNone) << "due once";
    starve(i8 + 1);
    EXPECT_EQ(status(), kBoth) << "and again";
    c_.servo(1);
    EXPECT_EQ(status(), kBoth) << "it began late";
    fake_task_run_real_time();
    EXPECT_EQ(status(), kBoth) << "one that is not due says nothing about those that are";
    c_.servo(2 * (i8 + 1));
    EXPECT_EQ(status(), kReentry) << "the last was in time; 22 stays";
  }
  EXPECT_EQ(c_.line("WX$6,$BFFFFF ???"), "000000000800");
}

TEST_F(TaskStatus, BothStayWhereTheyAreUntilTheyAreClearedOrTheReset) {
  starve(6);
  ASSERT_EQ(status(), kBoth);
  c_.line("WX$6,$FFFDFF");
  EXPECT_EQ(status(), kReentry);
  c_.servo(30);
  EXPECT_EQ(status(), kReentry);
  c_.line("$$$");
  EXPECT_EQ(status(), kNone);
}

TEST_F(TaskStatus, ServoTaskThatEndsWhenTheNextIsDueIsAServoError) {
  c_.servo(30);
  ASSERT_EQ(status(), kNone);
  fake_tasks_servo_waits(true);
  c_.servo(1);
  fake_tasks_servo_waits(false);
  EXPECT_EQ(status(), kServo);
  c_.servo(30);
  EXPECT_EQ(status(), kServo) << "it stays";
  EXPECT_EQ(c_.line("WX$6,$EFFFFF ???"), "000000000800");
  c_.servo(30);
  EXPECT_EQ(status(), kNone);
}

// A real-time task between two that are due adds to the duration of the period.
TEST_F(TaskStatus, DurationIsThatOfAllRealTimeTasksOfThePeriod) {
  c_.servo(3);
  const std::uint32_t once = *hal_x(kRealTime);
  ASSERT_GT(once, 0u);
  *hal_y(kRealTime) = 0;
  fake_task_run_real_time();
  const std::uint32_t twice = *hal_x(kRealTime);
  EXPECT_GT(twice, once);
  EXPECT_EQ(*hal_y(kRealTime), twice) << "the longest since it was written";
  c_.servo(3);
  EXPECT_LT(*hal_x(kRealTime), twice);
  EXPECT_EQ(*hal_y(kRealTime), twice);
}

// BREQ must not wait for it.
TEST_F(TaskStatus, ChecksumIsNotAddedUpWhileTheHostIsAtALine) {
  const auto looks = [] {
    const unsigned before = fake_hal_image_looks();
    image_checksum_pass();
    return fake_hal_image_looks() - before;
  };
  EXPECT_EQ(looks(), 1u);
  slice_hurry = 1;
  EXPECT_EQ(looks(), 0u);
  slice_hurry = 0;
  EXPECT_EQ(looks(), 1u);
}

// 1 + 2 + ... + n, however much of it the background has added already; not while the host is at a line.
TEST_F(TaskStatus, ChecksumIsTheSameAtAnyTime) {
  for (int pass = 0; pass < 30; ++pass) {
    slice_hurry = pass % 2 == 0 ? 1 : 0;
    background_pass();
    if (pass % 7 == 0) { EXPECT_EQ(image_checksum(), FAKE_IMAGE_WORDS * (FAKE_IMAGE_WORDS + 1) / 2); }
  }
  slice_hurry = 0;
}

}  // namespace
}  // namespace brick
