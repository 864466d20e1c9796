// The scoreboard itself: sequences from host-bus:5.2 that obey the rules pass, and each broken rule is found.
#include "testbench/checkers/breq_scoreboard.h"

#include <gtest/gtest.h>

#include "testbench/unit/checkers/microsecond.h"

namespace brick {
namespace {

constexpr Tick kLine = 52'228;  // one servo period

class BreqScoreboardTest : public ::testing::Test {
 protected:
  BreqScoreboard board{kLine};
  Tick now = 0;

  void start(unsigned i16, unsigned i17) {
    board.limits(i16, i17);
    board.select(0, now);
    board.edge(now += kUs, true);
    settle();
  }
  void settle() { board.settled(now += BreqScoreboard::kSettled); }
  // A line as the controller should take it.
  void line(bool becomes_full, bool was_full = false) {
    board.line_sent(now += 10 * kUs);
    if (!was_full) board.edge(now += 5 * kUs, false);
    if (!was_full && !becomes_full) board.edge(now += 2 * kUs, true);
    board.line_stored(now += 20 * kUs);
    settle();
  }
  void ask(unsigned pr, bool full) {
    board.lines_ahead(now, now + 50 * kUs, pr);
    board.full_bit(now + 50 * kUs, now + 90 * kUs, full);
    now += 90 * kUs;
  }
  std::size_t violations() const { return board.violations().size(); }
  std::string first() const { return board.violations().empty() ? "" : board.violations().front(); }
};

TEST_F(BreqScoreboardTest, TenthLineOfI17Equal10StaysLow) {
  start(5, 10);
  for (unsigned n = 1; n <= 12; ++n) {
    line(n >= 10, n > 10);
    ask(n, n >= 10);
  }
  EXPECT_EQ(violations(), 0u) << first();
  EXPECT_EQ(board.counts().pulses, 9u);
  EXPECT_EQ(board.counts().stays_low, 1u);
}

TEST_F(BreqScoreboardTest, StayingLowOneLineLateIsFound) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(false);
  EXPECT_EQ(violations(), 1u);
  EXPECT_NE(first().find("rule 3"), std::string::npos) << first();
}

TEST_F(BreqScoreboardTest, StayingLowOneLineEarlyIsFound) {
  start(5, 10);
  for (unsigned n = 1; n <= 8; ++n) line(false);
  line(true);
  EXPECT_NE(first().find("rule 2"), std::string::npos) << first();
}

TEST_F(BreqScoreboardTest, LineWithoutPulseIsFound) {
  start(5, 10);
  board.line_sent(now += kUs);
  board.line_stored(now += 20 * kUs);
  settle();
  EXPECT_NE(first().find("rule 1"), std::string::npos) << first();
}

TEST_F(BreqScoreboardTest, TooShortBetweenTwoPulsesIsFound) {
  start(5, 10);
  board.line_sent(now += kUs);
  board.edge(now += 20 * kUs, false);
  board.edge(now += 2 * kUs, true);
  board.line_sent(now);
  board.edge(now += kUs / 2, false);
  EXPECT_NE(first().find("BREQ was high for 0.5"), std::string::npos) << first();
}

TEST_F(BreqScoreboardTest, ExecutionRaisesBelowI16) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 6 * kLine;
  board.edge(now, true);  // 10 lines, the sixth has just been taken
  ask(4, false);
  EXPECT_EQ(violations(), 0u) << first();
}

TEST_F(BreqScoreboardTest, RaisedAtI16InsteadOfBelowIsFound) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 5 * kLine;
  board.edge(now, true);
  ask(5, false);
  EXPECT_GT(violations(), 0u);
}

TEST_F(BreqScoreboardTest, RaisedALineLateIsFound) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 7 * kLine;
  board.edge(now, true);
  ask(3, false);
  EXPECT_GT(violations(), 0u);
}

TEST_F(BreqScoreboardTest, RaisedTooEarlyToBePossibleIsFound) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 2 * kLine;
  board.edge(now, true);
  EXPECT_NE(first().find("rule 4"), std::string::npos) << first();
}

TEST_F(BreqScoreboardTest, LineBetweenThePointsLeavesFull) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 3 * kLine;
  ask(7, true);
  line(true, true);
  ask(8, true);
  EXPECT_EQ(violations(), 0u) << first();
}

TEST_F(BreqScoreboardTest, PulseBetweenThePointsIsFound) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 3 * kLine;
  ask(7, true);
  board.line_sent(now += kUs);
  board.edge(now += 5 * kUs, true);  // without hysteresis the line would end Full
  board.line_stored(now += kUs);
  EXPECT_GT(violations(), 0u);
}

TEST_F(BreqScoreboardTest, PinFollowsTheAddressedSystem) {
  start(2, 3);
  for (unsigned n = 1; n <= 3; ++n) line(n == 3);
  board.select(1, now);
  board.edge(now += kUs, true);
  settle();
  ask(0, false);
  board.select(0, now);
  board.edge(now += kUs, false);
  settle();
  ask(3, true);
  EXPECT_EQ(violations(), 0u) << first();
}

TEST_F(BreqScoreboardTest, PinThatKeepsTheOldSystemIsFound) {
  start(2, 3);
  for (unsigned n = 1; n <= 3; ++n) line(n == 3);
  board.select(1, now);
  settle();
  EXPECT_EQ(violations(), 1u);
}

TEST_F(BreqScoreboardTest, WrongFullBitIsFound) {
  start(5, 10);
  line(false);
  ask(1, true);
  EXPECT_NE(first().find("Rotary Buffer Full"), std::string::npos) << first();
}

TEST_F(BreqScoreboardTest, EdgeWithoutCauseIsFound) {
  start(5, 10);
  board.edge(now += kUs, false);
  EXPECT_EQ(violations(), 1u);
}

TEST_F(BreqScoreboardTest, APulseThatIsTooShortIsFound) {
  start(5, 10);
  board.line_sent(now += 10 * kUs);
  board.edge(now += 5 * kUs, false);
  board.edge(now += kUs / 2, true);
  EXPECT_EQ(violations(), 1u);
  EXPECT_NE(first().find("T_PULSE"), std::string::npos) << first();
}

TEST_F(BreqScoreboardTest, ARiseThatNothingExplainsIsFound) {
  start(5, 10);
  board.edge(now += kUs, true);
  EXPECT_EQ(violations(), 1u);
  EXPECT_NE(first().find("Full is 0"), std::string::npos) << first();
}

// Both at I16 - 1 lines: the pin that has not risen is found by PR alone.
TEST_F(BreqScoreboardTest, BelowI16AndStillLowIsFound) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 6 * kLine;
  board.lines_ahead(now, now + 50 * kUs, 5);
  EXPECT_EQ(violations(), 0u) << first();
  now += kLine;
  board.lines_ahead(now, now + 50 * kUs, 4);
  EXPECT_EQ(violations(), 1u);
  EXPECT_NE(first().find("rule 4"), std::string::npos) << first();
}

// CLEAR empties a buffer, and a program that stands takes nothing.
TEST_F(BreqScoreboardTest, AnEmptiedBufferHasNoLinesAndAHaltedOneLosesNone) {
  start(5, 10);
  for (unsigned n = 1; n <= 10; ++n) line(n == 10);
  board.run(0, now);
  now += 3 * kLine;
  board.halt(0, now);
  now += 20 * kLine;
  board.lines_ahead(now, now + 50 * kUs, 6);  // three, and one more that may have been taken at once
  EXPECT_EQ(violations(), 0u) << first();
  now += 20 * kLine;
  board.lines_ahead(now, now + 50 * kUs, 5);
  EXPECT_EQ(violations(), 1u) << "nobody has taken one";
  board.empty(0);
  board.select(0, now);
  board.edge(now += kUs, true);
  settle();
  ask(0, false);
  EXPECT_EQ(violations(), 1u);
}

TEST_F(BreqScoreboardTest, AReadOfThePinThatShowsAnotherLevelIsFound) {
  start(5, 10);
  board.signal(now, now + kUs, true, "SIG");
  board.edge(now += 10 * kUs, true);
  const std::size_t before = violations();
  board.signal(now - kUs, now + kUs, false, "SIG");  // an edge while it was asked
  EXPECT_EQ(violations(), before);
  now += 10 * kUs;
  board.signal(now, now + kUs, false, "SIG");
  EXPECT_EQ(violations(), before + 1);
  EXPECT_NE(board.violations().back().find("SIG shows BREQ 0; expected: 1"), std::string::npos);
}

}  // namespace
}  // namespace brick
