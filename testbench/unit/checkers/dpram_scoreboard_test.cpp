// The scoreboard of the dual-ported RAM: each value is old or new, and what is over does not come back (host-bus:6.9).
#include "testbench/checkers/dpram_scoreboard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace brick {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr TimeFs kNanosecond = kFsPerNs;

// 1 from 100 to 200 ns, 2 from 300 to 400 ns, and reads of the same word.
std::vector<std::string> judge(const std::vector<std::pair<std::uint16_t, TimeFs>>& reads) {
  DpramScoreboard board(7);
  board.write(9, 1, 100 * kNanosecond, 200 * kNanosecond);
  board.write(9, 2, 300 * kNanosecond, 400 * kNanosecond);
  board.write(8, 3, 0, 10 * kNanosecond);
  for (const auto& [value, from] : reads) board.read(9, value, from * kNanosecond, (from + 50) * kNanosecond);
  EXPECT_EQ(board.counts().reads, reads.size());
  EXPECT_EQ(board.counts().writes, 3u);
  return board.judge();
}

TEST(DpramScoreboard, TakesOldAndNewWhereTheyMeet) {
  EXPECT_THAT(judge({{7, 0}, {7, 60}, {7, 120}, {1, 160}, {1, 220}, {1, 260}, {2, 320}, {2, 500}}), IsEmpty());
}

TEST(DpramScoreboard, FindsWhatNobodyHasWritten) {
  EXPECT_THAT(judge({{5, 500}}), ElementsAre("word 9: read 0005 at 500.0 ns, which nobody has written there"));
  EXPECT_THAT(judge({{3, 500}}), ElementsAre(HasSubstr("nobody")));
  EXPECT_THAT(judge({{1, 40}}), ElementsAre(HasSubstr("nobody"))) << "not yet";
}

TEST(DpramScoreboard, FindsWhatIsOver) {
  const std::string over = "word 9: read 0001 at 500.0 ns, which was over with the write that began at 300.0 ns";
  EXPECT_THAT(judge({{1, 500}}), ElementsAre(over));
  EXPECT_THAT(judge({{7, 500}}), ElementsAre(HasSubstr("over with the write that began at 300.0 ns")));
  EXPECT_THAT(judge({{7, 210}}), ElementsAre(HasSubstr("over with the write that began at 100.0 ns")));
  EXPECT_THAT(judge({{2, 310}, {1, 370}}), ElementsAre(HasSubstr("began at 300.0 ns"))) << "the new one has been seen";
}

TEST(DpramScoreboard, CountsReadsThatMetAWrite) {
  DpramScoreboard board;
  board.write(1, 1, 100, 200);
  board.read(1, 0, 0, 100);
  board.read(1, 0, 50, 101);
  board.read(1, 1, 199, 300);
  board.read(2, 0, 150, 160);
  EXPECT_EQ(board.counts().met, 2u);
}

}  // namespace
}  // namespace brick
