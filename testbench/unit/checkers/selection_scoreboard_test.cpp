// The scoreboard of the shown coordinate system: T_CS with and without tasks that come between (host-bus:5.7/9).
#include "testbench/checkers/selection_scoreboard.h"

#include <gtest/gtest.h>

#include "testbench/unit/checkers/microsecond.h"

namespace brick {
namespace {

constexpr Tick kBegin = 1'000 * kUs, kLong = 10 * kBegin;

// `&2`, whose buffer has room, after `&1`, which has none; the pin rises that long after the command has begun.
std::string judge(Tick rise, Tick calculation, Tick phase, Tick real_time) {
  SelectionScoreboard board(false, 0);
  board.buffer(1, SelectionScoreboard::Buffer::kReady);
  board.calculation(calculation);
  board.host(1, kBegin - 100 * kUs);
  board.executed(kBegin);
  if (phase != 0) board.phase_fell(kBegin + phase);
  if (real_time != 0) board.real_time_began(kBegin + real_time);
  board.edge(kBegin + rise, true, true);
  board.phase_fell(kBegin + kLong / 2);
  board.real_time_began(kBegin + kLong / 2);
  board.settled(kBegin + kLong, true, true);
  return board.violations().empty() ? "" : board.violations().front();
}

TEST(SelectionScoreboardTest, TasksAloneLengthenTheTimeOfACommand) {
  EXPECT_EQ(judge(10 * kUs, 0, 0, 0), "");
  EXPECT_NE(judge(11 * kUs, 0, 0, 0), "");
  EXPECT_EQ(judge(30 * kUs, 0, 5 * kUs, 0), "");
  EXPECT_NE(judge(31 * kUs, 0, 5 * kUs, 0), "");
}

TEST(SelectionScoreboardTest, ARunningProgramCountsWhereItsTaskCameBetween) {
  const Tick calculation = 200 * kUs;
  EXPECT_EQ(judge(10 * kUs, calculation, 0, 0), "");
  EXPECT_NE(judge(11 * kUs, calculation, 0, 0), "") << "no task came";
  EXPECT_NE(judge(11 * kUs, calculation, -50 * kUs, -50 * kUs), "") << "it had come before";
  EXPECT_NE(judge(31 * kUs, calculation, 5 * kUs, 0), "") << "the phase task alone calculates nothing";
  EXPECT_EQ(judge(229 * kUs, calculation, 5 * kUs, 5 * kUs), "");
  EXPECT_NE(judge(231 * kUs, calculation, 5 * kUs, 5 * kUs), "");
}

}  // namespace
}  // namespace brick
