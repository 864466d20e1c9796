// The watchdog counter natively, a servo interrupt at a time: how long it lets the real-time task strobe, and the
// strobes between two such tasks (firmware:8.3, servo-ic:10/2, servo-ic:10/8).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/tasks.h"
#include "firmware/kernel/watchdog.h"
}

namespace brick {
namespace {

constexpr std::uint32_t kCounter = 0x25;  // Y: the counter, X: the lowest value

class WatchdogTask : public ::testing::Test {
 protected:
  // Strobes of so many servo interrupts, the real-time task behind each and no background.
  unsigned strobes(unsigned interrupts) {
    const unsigned before = fake_hal_strobes();
    c_.servo(interrupts);
    return fake_hal_strobes() - before;
  }
  std::int32_t counter() { return hal_signed(*hal_y(kCounter)); }

  Controller c_;
};

// I40 interrupts take the counter from I40 to 0, a strobe behind each of them; the next makes it -1.
TEST_F(WatchdogTask, StrobesDownToZeroAndNotBelow) {
  for (const unsigned i40 : {1u, 2u, 3u, 100u, 65535u, 0u}) {
    const unsigned load = i40 == 0 ? 4095 : i40;
    c_.line("I8=0 I40=" + std::to_string(i40));
    ASSERT_EQ(counter(), static_cast<std::int32_t>(load)) << "at the end of a background pass";
    EXPECT_EQ(strobes(load - 1), load - 1);
    EXPECT_EQ(counter(), 1);
    EXPECT_EQ(strobes(1), 1u) << "at 0 it still does";
    EXPECT_EQ(counter(), 0);
    EXPECT_EQ(strobes(5), 0u) << "below 0 no more";
    EXPECT_EQ(counter(), -5);
    EXPECT_EQ(hal_signed(*hal_x(kCounter)), -5) << "the lowest value";
  }
  c_.line("I40=10");
  EXPECT_EQ(strobes(3), 3u) << "a background that comes back is forgiven";
  EXPECT_EQ(hal_signed(*hal_x(kCounter)), -5) << "and remembered";
}

// A reset shows the count that it begins with as the lowest.
TEST_F(WatchdogTask, TheLowestValueBeginsAtTheCount) {
  for (const std::int32_t i40 : {7, 3000}) {
    c_.line("I40=" + std::to_string(i40) + " SAVE");
    *hal_x(kCounter) = 0x123456;
    c_.restart();
    watchdog_initialize();
    EXPECT_EQ(counter(), i40);
    EXPECT_EQ(hal_signed(*hal_x(kCounter)), i40);
  }
}

// A background that sleeps until the next real-time interrupt is woken in time to reload.
TEST_F(WatchdogTask, WakesTheBackgroundAtHalfOfItsCount) {
  c_.line("I40=10");
  background_work = 0;
  for (int i = 0; i < 4; ++i) watchdog_count();
  EXPECT_EQ(background_work, 0u) << "6 of 10 are left";
  watchdog_count();
  EXPECT_NE(background_work, 0u);
}

// Where both words end, the hardware having tripped an hour ago.
TEST_F(WatchdogTask, CountsDownToTheLowestWordAndStays) {
  for (int i = 0; i < (1 << 23) + 5000; ++i) watchdog_count();
  EXPECT_EQ(counter(), -8388607);
  EXPECT_EQ(hal_signed(*hal_x(kCounter)), -8388607);
}

// Programs may calculate for half a period of the real-time task, but no longer than 5 ms: nothing strobes meanwhile.
TEST_F(WatchdogTask, SlicesEndLongBeforeTheHardwareTrips) {
  c_.line("I8=0");
  c_.servo(1);
  for (const std::uint32_t begin = hal_cycles(); hal_cycles() - begin < hal_cycles_per_ms() / 2;) {}
  c_.servo(1);
  const std::uint32_t half = tasks_real_time_slice();
  EXPECT_NEAR(half, hal_cycles_per_ms() / 4.0, hal_cycles_per_ms() / 100.0);
  c_.line("I8=9");
  EXPECT_NEAR(tasks_real_time_slice(), 10 * half, 10);
  c_.line("I8=255");
  EXPECT_EQ(tasks_real_time_slice(), 5 * hal_cycles_per_ms());
}

// A real-time task every 256 servo cycles of 0.5 ms would strobe every 128 ms. The servo task does within each, when
// 10 ms have passed: with the 21st cycle at the latest. The hardware trips after 25 ms, with slow servo clocks too.
TEST_F(WatchdogTask, ServoTaskStrobesBetweenRareRealTimeTasks) {
  for (const auto& [half_ms, longest_ms] : {std::pair{1u, 10.5}, {18u, 18.0}, {40u, 20.0}}) {
    for (const unsigned i8 : {3u, 9u, 255u}) {
      c_.line("I40=0 I8=" + std::to_string(i8));
      unsigned longest = 0, since = 0;
      for (int cycle = 0; cycle < 1000; ++cycle) {
        fake_hal_pass(half_ms * hal_cycles_per_ms() / 2);
        ++since;
        if (strobes(1) == 0) continue;
        longest = std::max(longest, since);
        since = 0;
      }
      EXPECT_LE(longest * half_ms / 2.0, longest_ms) << "I8=" << i8;
      if (i8 == 255) { EXPECT_GT(longest * half_ms / 2.0, 9.5) << "not more often than it must"; }
    }
  }
}

// Due once in the 100 cycles at least.
TEST_F(WatchdogTask, NobodyStrobesForARealTimeTaskThatDoesNotRun) {
  for (const unsigned i8 : {0u, 9u}) {
    c_.line("I40=0 I8=" + std::to_string(i8));
    c_.servo(2 * (i8 + 1));
    const unsigned before = fake_hal_strobes();
    for (int cycle = 0; cycle < 100; ++cycle) {
      fake_hal_pass(hal_cycles_per_ms() / 2);
      fake_task_run_servo();
    }
    EXPECT_EQ(fake_hal_strobes(), before) << "I8=" << i8;
  }
}

}  // namespace
}  // namespace brick
