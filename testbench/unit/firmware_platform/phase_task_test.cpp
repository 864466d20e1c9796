// The phase task natively: when it works, and its arithmetic against the definition worked out in 64 bits
// (firmware:8.1, firmware:9.6).
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

#include "testbench/unit/firmware_platform/controller.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/motion/phase_task.h"
}

namespace brick {
namespace {

constexpr std::uint32_t kSource = 0x10F0, kPosition1 = 0xB4, kDuration = 0x37;

std::int64_t wrap24(std::int64_t value) { return ((value % 16777216) + 16777216 + 8388608) % 16777216 - 8388608; }

// -cycle/2 .. cycle/2-1, for an odd number of counts one more on the positive side; without a cycle the register's own
// 24 bits.
std::int64_t into_cycle(std::int64_t value, std::int64_t cycle) {
  if (cycle == 0) return wrap24(value);
  const std::int64_t rest = ((value % cycle) + cycle) % cycle;
  return rest >= cycle - cycle / 2 ? rest - cycle : rest;
}

class PhaseTaskArithmetic : public ::testing::Test {
 protected:
  void SetUp() override { c_.line("I183=$10F0 I101=1"); }

  std::int32_t position(unsigned motor = 1) { return hal_signed(*hal_x(0x80 * motor + 0x34)); }
  void set(std::uint32_t address, std::int64_t value) {
    *hal_x(address) = static_cast<std::uint32_t>(value) & HAL_WORD_MASK;
  }
  void reads(std::int64_t value) {
    set(kSource, value);
    phase_task_interrupt();
  }
  void cycle(unsigned n, unsigned counts) { c_.line("I170=" + std::to_string(n) + " I171=" + std::to_string(counts)); }

  Controller c_;
};

TEST_F(PhaseTaskArithmetic, AgreesWithTheDefinitionOverRandomMovement) {
  std::mt19937 random(random_seed(1));
  const auto pick = [&random](std::int64_t first, std::int64_t last) {
    return std::uniform_int_distribution<std::int64_t>(first, last)(random);
  };
  std::int64_t reading = 0;
  for (const unsigned counts : {0u, 1u, 2u, 3u, 5u, 1000u, 4095u, 65536u, 8388607u, 8388608u, 16777214u, 16777215u})
    for (const unsigned n : {0u, 1u, 3u, 255u}) {
      cycle(n, counts);
      set(kPosition1, 0);
      std::int64_t expected = 0;
      for (int step = 0; step < 200; ++step) {
        const std::int64_t reach = step % 4 == 0 ? 8388607 : 1 << pick(0, 22);
        const std::int64_t moved = step % 50 == 49 ? -8388608 : pick(-reach, reach);
        reading = wrap24(reading + moved);
        reads(reading);
        expected = into_cycle(expected + moved * n, counts);
        ASSERT_EQ(position(), expected) << "I170=" << n << " I171=" << counts << " step " << step << " moved " << moved;
      }
    }
}

TEST_F(PhaseTaskArithmetic, TakesAPositionWrittenByTheUser) {
  cycle(2, 1000);
  reads(7);
  set(kPosition1, -123);
  reads(10);
  EXPECT_EQ(position(), -117);
  set(kPosition1, 8388607);  // outside the cycle
  reads(10);
  EXPECT_EQ(position(), -393);
}

TEST_F(PhaseTaskArithmetic, TheFirstReadingIsNoMovement) {
  c_.line("I101=0");
  set(kPosition1, 5);
  set(kSource, 777);
  phase_task_interrupt();
  EXPECT_EQ(position(), 5);
  c_.line("I101=1");
  phase_task_interrupt();
  EXPECT_EQ(position(), 5);
  set(kSource + 1, 999);
  c_.line("I183=$10F1");
  phase_task_interrupt();
  EXPECT_EQ(position(), 5);
  set(kSource + 1, 1000);
  c_.line("I101=1 I100=1 I183=$10F1");  // nothing new: the count that came meanwhile stays
  phase_task_interrupt();
  EXPECT_EQ(position(), 6);
}

TEST_F(PhaseTaskArithmetic, WorksForActivatedCommutatedMotorsOnly) {
  EXPECT_EQ(phase_task_work, 1u);
  c_.line("I100=0");
  EXPECT_EQ(phase_task_work, 0u);
  c_.line("I100=1 I3200=1 I3201=1");
  EXPECT_EQ(phase_task_work, 0x80000001u);
  c_.line("I101=2 I3201=3");
  EXPECT_EQ(phase_task_work, 0x80000000u);
  c_.line("I200=1 I201=1");
  EXPECT_EQ(phase_task_work, 0x80000002u);
  c_.line("I200..3200=0");
  EXPECT_EQ(phase_task_work, 0u);
}

TEST_F(PhaseTaskArithmetic, EachMotorHasItsOwnBlock) {
  c_.line("I3283=$10F1 I3200=1 I3201=3");  // a Y register
  *hal_y(kSource + 1) = 12;
  reads(3);
  EXPECT_EQ(position(1), 3);
  EXPECT_EQ(position(32), 12);
}

TEST_F(PhaseTaskArithmetic, APointerToNothingReads0) {
  c_.line("I183=$50000");
  set(kPosition1, 5);
  phase_task_interrupt();
  EXPECT_EQ(position(), 5);
}

TEST_F(PhaseTaskArithmetic, WorksEveryI7PlusOneInterrupts) {
  cycle(1, 10000);
  for (const unsigned i7 : {0u, 1u, 2u, 255u}) {
    c_.line("I7=0");
    reads(0);
    c_.line("I7=" + std::to_string(i7));
    set(kPosition1, 0);
    for (unsigned interrupt = 1; interrupt <= 3 * (i7 + 1); ++interrupt) {
      reads(interrupt);
      ASSERT_EQ(position(), static_cast<std::int32_t>(interrupt / (i7 + 1) * (i7 + 1))) << "I7=" << i7;
    }
  }
}

TEST_F(PhaseTaskArithmetic, ASmallerI7ActsAtTheNextInterrupt) {
  c_.line("I7=0");
  reads(0);
  c_.line("I7=255");
  for (int i = 1; i <= 100; ++i) reads(i);
  EXPECT_EQ(position(), 0);
  c_.line("I7=1");
  reads(200);
  EXPECT_EQ(position(), 200);
  reads(201);
  EXPECT_EQ(position(), 200);
  reads(202);
  EXPECT_EQ(position(), 202);
}

TEST_F(PhaseTaskArithmetic, DurationIsThatOfTheShortPathWithoutWork) {
  c_.line("I101=0");
  EXPECT_EQ(*hal_x(kDuration), 16u);  // 32 cycles, docs/watchdog.md
}

TEST_F(PhaseTaskArithmetic, IsThereAgainAfterSaveAndReset) {
  c_.line("I7=2 SAVE");
  c_.restart();
  EXPECT_EQ(phase_task_work, 1u);
  for (int i = 1; i <= 3; ++i) reads(i);
  EXPECT_EQ(position(), 3);
}

}  // namespace
}  // namespace brick
