// The scoreboard of the binary rotary transfer against each of its rules broken.
#include "testbench/checkers/binary_scoreboard.h"

#include <gtest/gtest.h>

#include <functional>

#include "testbench/unit/checkers/microsecond.h"

namespace brick {
namespace {

// Two lines of &1 with I17 = 2: a pulse, then a fall that stays.
class Story {
 public:
  BinaryScoreboard board;
  Tick first_low = 2 * kUs, between = 5 * kUs;
  bool second_rises = false, falls_twice = false, in_real_time = false, before_the_index = false, only_one = false;
  unsigned first_index = 2, ring = 8, second_status = 0;
  std::string told = "X1";

  std::string run() {
    board.limits(2);
    board.defined(0, ring);
    board.shown(0, true);
    board.line(0, told, 1, 2);
    if (!before_the_index) board.advanced(0, 10);
    fall(100 * kUs, first_low);
    if (falls_twice) fall(100 * kUs + first_low + between, 2 * kUs);
    board.pmac_index(0, first_index, in_real_time, 120 * kUs);
    if (only_one) {
      board.settled(180 * kUs);
      return board.violations().empty() ? "" : board.violations().front();
    }
    board.line(0, "X2", 1, 4);
    board.advanced(0, 130 * kUs);
    fall(200 * kUs, second_rises ? 2 * kUs : 0);
    board.pmac_index(0, 4, in_real_time, 220 * kUs);
    if (second_status != 0) board.status(0, second_status, 230 * kUs);
    board.settled(300 * kUs);
    return board.violations().empty() ? "" : board.violations().front();
  }

 private:
  void fall(Tick at, Tick low) {
    board.edge(at, false);
    if (low != 0) board.edge(at + low, true);
  }
};

TEST(BinaryScoreboardTest, TakesWhatIsRight) {
  Story story;
  EXPECT_EQ(story.run(), "");
  EXPECT_EQ(story.board.listing(0), "X1|X2");
  EXPECT_EQ(story.board.copied(0), 2u);
  ASSERT_EQ(story.board.delays().size(), 2u);
  EXPECT_EQ(story.board.delays()[1], 70 * kUs);
  EXPECT_EQ(story.board.counts().pulses, 1u);
  EXPECT_EQ(story.board.counts().stays_low, 1u) << "the line that takes L to I17";
}

TEST(BinaryScoreboardTest, FindsEachRuleBroken) {
  struct Case {
    const char* says;
    std::function<void(Story&)> breaks;
  };
  const Case cases[] = {
      {"PMAC index 4, expected 2", [](Story& s) { s.first_index = 4; }},
      {"expected none: no line waits", [](Story& s) { s.before_the_index = true; }},
      {"copied by the real-time task", [](Story& s) { s.in_real_time = true; }},
      {"2 words in a ring of 1", [](Story& s) { s.ring = 1; }},
      {"BREQ low for", [](Story& s) { s.first_low = kUs / 2; }},
      {"BREQ low for", [](Story& s) { s.first_low = 51 * kUs; }},
      {"BREQ fell 2 times", [](Story& s) { s.falls_twice = true; }},
      {"BREQ high for", [](Story& s) { s.falls_twice = true, s.between = kUs / 2; }},
      {"BREQ high with 2 lines", [](Story& s) { s.second_rises = true; }},
      {"settled with 1 lines: BREQ 0, expected 1", [](Story& s) { s.first_low = 0, s.only_one = true; }},
      {"error 5, expected 0", [](Story& s) { s.second_status = 0x8005; }},
      {"busy with 2 of 8 words", [](Story& s) { s.second_status = 0x4000; }},
      {"status 0003", [](Story& s) { s.second_status = 3; }},
  };
  for (const Case& c : cases) {
    Story story;
    c.breaks(story);
    EXPECT_NE(story.run().find(c.says), std::string::npos) << c.says;
  }
}

// host-bus:7.5: behind an error nothing is copied until the host has set the indices to 0; then it begins anew.
TEST(BinaryScoreboardTest, BeginsAnewBehindAnError) {
  BinaryScoreboard board;
  board.defined(3, 8);
  board.line(3, "X1", 1, 2);
  board.advanced(3, 10);
  EXPECT_FALSE(board.all_copied());
  board.expect_error(3, 5);
  board.status(3, 0x8005, 20);
  EXPECT_TRUE(board.has_error(3));
  EXPECT_TRUE(board.all_copied()) << "that line never is";
  board.recovered(3);
  EXPECT_FALSE(board.has_error(3));
  EXPECT_TRUE(board.violations().empty());
  board.status(3, 0x8005, 30);
  ASSERT_EQ(board.violations().size(), 1u) << "the error is over";
  EXPECT_NE(board.violations()[0].find("error 5, expected 0"), std::string::npos);
  board.pmac_index(3, 2, false, 40);
  ASSERT_EQ(board.violations().size(), 2u) << "and the line is forgotten";
  EXPECT_NE(board.violations()[1].find("no line waits"), std::string::npos);
}

// CLOSE: what is not copied never is, and BREQ is anybody's until a system is shown.
TEST(BinaryScoreboardTest, ForgetsWhatACloseLeaves) {
  BinaryScoreboard board;
  board.defined(0, 8);
  board.shown(0, false);
  ASSERT_EQ(board.violations().size(), 1u) << "an empty ring is not full";
  board.line(0, "X1", 1, 2);
  board.closed();
  EXPECT_TRUE(board.all_copied());
  board.edge(10, true);
  board.edge(11, false);
  board.settled(100 * kUs);
  EXPECT_EQ(board.violations().size(), 1u);
}

}  // namespace
}  // namespace brick
