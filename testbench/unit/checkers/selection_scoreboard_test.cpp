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

// host-bus:5.3, host-bus:5.6: the panel's number with I2 = 0, 1 to 8 or with an odd I59 9 to 16; else the host's.
TEST(SelectionScoreboardTest, ThePanelSelectsWhereItIsFittedAndOn) {
  SelectionScoreboard board(true, 4);
  EXPECT_EQ(board.selected(), 4u);
  board.i2(0, 10);
  const std::pair<unsigned, unsigned> numbers[] = {
      {0, SelectionScoreboard::kNone}, {1, 0}, {8, 7}, {9, SelectionScoreboard::kNone}};
  for (const auto& [number, selected] : numbers) {
    board.panel(number, 20);
    EXPECT_EQ(board.selected(), selected) << number;
  }
  board.panel(3, 30);
  for (const auto& [i59, selected] : {std::pair{1u, 10u}, {2u, 2u}, {3u, 10u}}) {
    board.i59(i59, 40);
    EXPECT_EQ(board.selected(), selected) << i59;
  }
  SelectionScoreboard without(false, 4);
  without.i2(0, 10);
  without.panel(3, 20);
  EXPECT_EQ(without.selected(), 4u);
}

TEST(SelectionScoreboardTest, FindsALevelThatIsNotThatOfTheBuffer) {
  using Buffer = SelectionScoreboard::Buffer;
  for (const auto& [state, level] : {std::pair{Buffer::kIdle, false}, {Buffer::kReady, true}, {Buffer::kFull, false}})
    for (const bool breq : {false, true}) {
      SelectionScoreboard board(false, 0);
      board.buffer(1, state);
      board.host(1, kBegin);
      board.executed(kBegin);
      if (breq) board.edge(kBegin + kUs, true, true);
      board.settled(kBegin + kLong, breq, breq);
      ASSERT_EQ(board.violations().size(), breq == level ? 0u : 1u);
      if (breq != level) {
        EXPECT_NE(board.violations()[0].find(breq ? "BREQ=1 after 1 edges, expected 0 after 0"
                                                  : "BREQ=0 after 0 edges, expected 1 after 1"),
                  std::string::npos);
      }
      const SelectionScoreboard::Counts counts = board.take_counts();
      EXPECT_EQ(counts.idle, state == Buffer::kIdle ? 1u : 0u);
      EXPECT_EQ(counts.ready, state == Buffer::kReady ? 1u : 0u);
      EXPECT_EQ(counts.full, state == Buffer::kFull ? 1u : 0u);
    }
}

}  // namespace
}  // namespace brick
