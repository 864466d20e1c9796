// Rules of the kernel natively, to the cycle: wait states and CPU clock (host-bus:2.4, host-bus:2.5), the watch for
// phase interrupts (firmware:8.4), times of tasks and slices (docs/firmware.md, Slices and Task load).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/bus_setup.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/slice.h"
#include "firmware/kernel/tasks.h"
#include "rtl/regs/brick_regs.h"
}

namespace brick {
namespace {

constexpr std::uint32_t bcr(std::uint32_t main, std::uint32_t ics, std::uint32_t ram, std::uint32_t flash,
                            std::uint32_t others) {
  return main | ics << 5 | ram << 10 | flash << 13 | others << 16;
}

// host-bus:2.5, by I52; I37 adds to four of the fields, each stays within itself.
TEST(BusSetup, WaitStatesFollowTheClockAndI37) {
  const struct {
    std::uint32_t i52, i37, bcr;
  } cases[] = {
      {0, 0, bcr(1, 8, 4, 7, 15)},         {4, 0, bcr(1, 8, 4, 7, 15)},        {5, 0, bcr(1, 8, 3, 7, 15)},
      {7, 0, bcr(1, 8, 3, 7, 15)},         {8, 0, bcr(1, 10, 4, 7, 15)},       {9, 0, bcr(1, 10, 4, 7, 15)},
      {10, 0, bcr(2, 16, 7, 7, 31)},       {15, 0, bcr(2, 16, 7, 7, 31)},      {16, 0, bcr(4, 24, 7, 7, 31)},
      {23, 0, bcr(4, 24, 7, 7, 31)},       {24, 0, bcr(5, 31, 7, 7, 31)},      {31, 0, bcr(5, 31, 7, 7, 31)},
      {7, 1, bcr(2, 8, 3, 7, 15)},         {7, 3, bcr(4, 8, 3, 7, 15)},        {7, 0x400, bcr(1, 8, 4, 7, 15)},
      {7, 0x2000, bcr(1, 8, 3, 7, 15)},    {7, 0x10000, bcr(1, 8, 3, 7, 16)},  {7, 0x30000, bcr(1, 8, 3, 7, 18)},
      {15, 0x32403, bcr(5, 16, 7, 7, 31)}, {31, 0x32403, bcr(8, 31, 7, 7, 31)}};
  fake_hal_power_on(0x3);
  for (const auto& c : cases) {
    SCOPED_TRACE("I52=" + std::to_string(c.i52) + " I37=" + std::to_string(c.i37));
    bus_setup(c.i52, c.i37);
    EXPECT_EQ(*hal_x(CPU_BUS_X_BCR), c.bcr);
    EXPECT_EQ(*hal_x(CPU_BUS_X_PCTL), c.i52);
    EXPECT_EQ(bus_setup_cpu_clock(), c.i52);
  }
}

// Before the variables are known: the clock after reset, main memory at its pace, all others the most there is.
TEST(BusSetup, AtFirstOnlyMainMemoryHasItsPace) {
  fake_hal_power_on(0x3);
  bus_setup(31, 0);
  bus_setup_first();
  EXPECT_EQ(*hal_x(CPU_BUS_X_BCR), bcr(1, 31, 7, 7, 31));
  EXPECT_EQ(*hal_x(CPU_BUS_X_PCTL), 7u);
  EXPECT_EQ(bus_setup_cpu_clock(), 7u);
}

class ClockWatch : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kPhase = 13057 * 8 / 12;  // CPU cycles
  // `cycles` later, with or without a phase interrupt just then.
  static void pass(std::uint32_t cycles, bool phase) {
    fake_hal_pass(cycles);
    if (phase) tasks_phase_stamp = hal_cycles();
    clock_watch_pass();
  }
  Controller c_;
};

// What a start finds is shown from then on.
TEST_F(ClockWatch, AStartShowsWhetherThereAreClocks) {
  fake_hal_stop_clocks(true);
  fake_hal_set_look(100);
  clock_watch_start();
  EXPECT_TRUE(clock_watch_close());
  EXPECT_FALSE(status_motors_may_enable());
  fake_hal_stop_clocks(false);
  clock_watch_start();
  EXPECT_FALSE(clock_watch_close());
  EXPECT_TRUE(status_motors_may_enable());
}

// A set-up that was changed is watched for fifteen of its phase periods, ten and half of that.
TEST_F(ClockWatch, AChangeIsWatchedForFifteenPeriods) {
  fake_hal_set_look(0);
  pass(0, true);
  ASSERT_FALSE(clock_watch_close());
  clock_watch_changed();
  const std::uint32_t began = hal_cycles();
  for (int period = 1; period <= 15; ++period) {
    pass(kPhase, true);
    EXPECT_TRUE(clock_watch_close()) << period;
  }
  while (hal_cycles() - began <= 15 * kPhase) fake_hal_pass(1);
  pass(0, true);
  EXPECT_FALSE(clock_watch_close());
}

// Without clocks the servo task runs each four phase periods, to the cycle.
TEST_F(ClockWatch, TheServoTaskRunsByTheCounterOfCycles) {
  fake_hal_stop_clocks(true);
  fake_hal_set_look(0);
  fake_hal_pass(11 * kPhase);
  clock_watch_poll();
  ASSERT_TRUE(clock_watch_close());
  for (std::uint32_t ran = tasks_servo_count(), n = 1; n <= 5; ++n) {
    fake_hal_pass(4 * kPhase - 1);
    clock_watch_poll();
    EXPECT_EQ(tasks_servo_count() - ran, n - 1);
    fake_hal_pass(1);
    clock_watch_poll();
    EXPECT_EQ(tasks_servo_count() - ran, n);
  }
  fake_hal_stop_clocks(false);
}

class TaskTimes : public ::testing::Test {
 protected:
  void SetUp() override { fake_hal_set_look(0); }
  Controller c_;
};

// Half of the time from one real-time interrupt to the next, 5 ms at most, also where the periods of I8 + 1 servo
// interrupts are more than the counter of cycles holds.
TEST_F(TaskTimes, ASliceIsHalfOfTheTimeBetweenRealTimeInterrupts) {
  const struct {
    std::uint32_t i8, servo, slice;
  } cases[] = {{2, 34816, 34816 * 3 / 2}, {0, 34816, 17408},       {255, 34816, 393215},   {3, 1u << 30, 393215},
               {0, 400000, 200000},       {0, 2 * 393215, 393215}, {0, 2 * 393214, 393214}};
  const std::uint32_t longest = 5 * hal_cycles_per_ms();
  for (const auto& c : cases) {
    tasks_set_real_time_period(c.i8);
    tasks_servo_interrupt();
    fake_hal_pass(c.servo);
    tasks_servo_interrupt();
    EXPECT_EQ(tasks_real_time_slice(), std::min(c.slice, longest)) << c.i8 << " " << c.servo;
  }
}

// What a run has left of its slice, whatever the counter of cycles was at its beginning.
TEST_F(TaskTimes, WhatIsLeftOfASlice) {
  tasks_servo_interrupt();
  fake_hal_pass(34816);
  tasks_servo_interrupt();
  const std::uint32_t slice = tasks_real_time_slice();
  for (const std::uint32_t began : {1000u, 0x90000000u}) {
    fake_hal_set_cycles(began);
    fake_task_run_real_time();
    fake_hal_pass(500);
    EXPECT_EQ(tasks_real_time_left(), slice - 500);
    fake_hal_pass(slice - 501);
    EXPECT_EQ(tasks_real_time_left(), 1u);
    fake_hal_pass(1);
    EXPECT_EQ(tasks_real_time_left(), 0u);
    fake_hal_pass(1000);
    EXPECT_EQ(tasks_real_time_left(), 0u);
  }
}

// Half of the cycles of a run, with the 122 of entry and return: of none here.
TEST_F(TaskTimes, DurationsAreThoseOfTheRun) {
  for (const std::uint32_t began : {1000u, 0x90000000u}) {
    fake_hal_set_cycles(began);
    fake_task_run_servo();
    EXPECT_EQ(*hal_y(0x37), 122u / 2);
    fake_task_run_real_time();
    EXPECT_LE(*hal_x(0x0B), 122u);
  }
}

// One cycle a piece: a slice ends 2,400 cycles early, one of less than 9,600 a quarter early.
TEST_F(TaskTimes, ASliceEndsBeforeItsLongestSection) {
  static std::uint32_t done;
  fake_hal_slices_leave(true);
  const struct {
    std::uint32_t slice, work;
  } cases[] = {{50000, 47600}, {11000, 8600}, {9604, 7204}, {9600, 7200}, {9599, 7200}, {4000, 3000}};
  for (const auto& c : cases) {
    done = 0;
    slice_initialize([] {
      for (; done < 60000; ++done) {
        fake_hal_pass(1);
        slice_pause();
      }
    });
    slice_run(c.slice);
    EXPECT_EQ(done + 1, c.work) << c.slice;
    EXPECT_TRUE(slice_is_under_way());
  }
  fake_hal_slices_leave(false);
}

// A line of the host stops what is under way. Work that comes to no pause is none: it is looked for all the same.
TEST_F(TaskTimes, ARoundWithoutWorkGivesWayToNobody) {
  static unsigned rounds;
  rounds = 0;
  slice_initialize([] {
    slice_pause();
    ++rounds;
  });
  slice_run(20000);
  ASSERT_EQ(rounds, 1u);
  slice_initialize([] { ++rounds; });
  slice_run(20000);
  slice_hurry = 1;
  slice_run(20000);
  slice_run(20000);
  EXPECT_EQ(rounds, 4u);
  slice_hurry = 0;
}

}  // namespace
}  // namespace brick
