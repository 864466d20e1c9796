// The limits of T_FALL and of the tasks beside it (host-bus:5.7/5): each passes at its limit and fails beyond it.
#include "testbench/checkers/fall_limits.h"

#include <gtest/gtest.h>

#include "testbench/unit/checkers/microsecond.h"

namespace brick {
namespace {

std::vector<Fall> lines(std::size_t count, TimeFs net, TimeFs most = 50 * kUsInFs) {
  return std::vector<Fall>(count, Fall{net + 100 * kUsInFs, net, most});
}

TEST(FallLimits, ALineOfAxesHas50MicrosecondsOthersSixMoreACharacter) {
  EXPECT_EQ(FallLimits::of_line(true, 255), 50 * kUsInFs);
  EXPECT_EQ(FallLimits::of_line(false, 0), 50 * kUsInFs);
  EXPECT_EQ(FallLimits::of_line(false, 255), (50 + 255 * 6) * kUsInFs);
}

TEST(FallLimits, EachLineIsHeldToItsOwn) {
  std::vector<Fall> falls = lines(40, 40 * kUsInFs);
  falls[7].net = 50 * kUsInFs;
  EXPECT_TRUE(FallLimits::keeps(falls, 40));
  falls[7].net += 1;
  EXPECT_FALSE(FallLimits::keeps(falls, 40)) << "a femtosecond beyond it";
  falls[7].net = falls[7].most = 56 * kUsInFs;
  EXPECT_TRUE(FallLimits::keeps(falls, 40)) << "a longer line";
  falls[20].net = 51 * kUsInFs;
  EXPECT_FALSE(FallLimits::keeps(falls, 40)) << "shorter than that one, but beyond its own";
  EXPECT_EQ(FallLimits::worst(falls).net, 51 * kUsInFs);
}

TEST(FallLimits, TheTimeWithTheTasksIsNotJudged) {
  std::vector<Fall> falls = lines(40, 10 * kUsInFs);
  for (Fall& f : falls) f.whole = 5'000 * kUsInFs;
  EXPECT_TRUE(FallLimits::keeps(falls, 40));
  EXPECT_TRUE(FallLimits::keeps_median(falls));
}

TEST(FallLimits, LinesThatAreMissingFail) {
  EXPECT_FALSE(FallLimits::keeps(lines(39, kUsInFs), 40));
  EXPECT_FALSE(FallLimits::keeps({}, 0));
  EXPECT_FALSE(FallLimits::keeps_median({}));
}

TEST(FallLimits, TheMedianIs24MicrosecondsAtMost) {
  std::vector<Fall> falls = lines(41, 24 * kUsInFs);
  EXPECT_TRUE(FallLimits::keeps_median(falls));
  for (std::size_t i = 0; i < 20; ++i) falls[i].net = 50 * kUsInFs;
  EXPECT_TRUE(FallLimits::keeps_median(falls)) << "half of the others may be longer";
  falls[20].net = 24 * kUsInFs + 1;
  EXPECT_FALSE(FallLimits::keeps_median(falls)) << "21 of 41 are";
}

TEST(FallLimits, TasksHaveTheirOwnCycles) {
  for (const std::uint64_t most : {FallLimits::kPhaseCycles, FallLimits::kServoCycles}) {
    EXPECT_TRUE(FallLimits::keeps_cycles(1, most, most));
    EXPECT_FALSE(FallLimits::keeps_cycles(1, most + 1, most));
    EXPECT_FALSE(FallLimits::keeps_cycles(0, 0, most)) << "it never ran";
  }
  EXPECT_EQ(FallLimits::kPhaseCycles, 4'400u);
  EXPECT_EQ(FallLimits::kServoCycles, 8'000u);
}

}  // namespace
}  // namespace brick
