// T_RISE with made-up times: what is in time, and each way to break the rule.
#include "testbench/checkers/rise_checker.h"

#include <gtest/gtest.h>

#include <functional>

namespace brick {
namespace {

constexpr TimeFs kUs = 1000 * kFsPerNs, kPeriod = 442 * kUs, kInterrupt = 60 * kUs, kLine = 20 * kUs;

// Five lines, I16 = 2: a line 20 us after each interrupt, the background goes on after 60 us. The fourth line leaves
// one.
struct Story {
  TimeFs rise = 3 * kPeriod + kLine + 5 * kUs;
  unsigned lines = 5, rises = 1, ends = 5;

  std::string run() const {
    RiseChecker checker(5, 2);
    for (unsigned i = 0; i < rises; ++i) checker.rose(rise + i * kPeriod);
    for (unsigned i = 0; i < ends; ++i) checker.background(i * kPeriod + kInterrupt);
    for (unsigned i = 0; i < lines; ++i) checker.calculated(i * kPeriod + kLine);
    return checker.difference();
  }
};

TEST(RiseChecker, TakesARiseWithinTheInterruptOfTheLine) {
  EXPECT_EQ(Story{}.run(), "");
  Story story;
  story.rise = 3 * kPeriod + kInterrupt - 1;
  EXPECT_EQ(story.run(), "") << "at its end";
}

TEST(RiseChecker, FindsTheRuleBroken) {
  const struct {
    const char* says;
    std::function<void(Story&)> breaks;
  } cases[] = {
      {"BREQ rose 40.000 us after it, expected one within 40.000 us after line 4 of 5, I16=2",
       [](Story& s) { s.rise = 3 * kPeriod + kInterrupt; }},
      {"BREQ rose 447.000 us after it", [](Story& s) { s.rise += kPeriod; }},
      {"us before it", [](Story& s) { s.rise -= kPeriod; }},
      {"BREQ rose 0 times", [](Story& s) { s.rises = 0; }},
      {"BREQ rose 2 times", [](Story& s) { s.rises = 2; }},
      {"4 lines calculated, expected 5", [](Story& s) { s.lines = 4; }},
      {"the real-time interrupt did not end", [](Story& s) { s.ends = 3; }},
  };
  for (const auto& c : cases) {
    Story story;
    c.breaks(story);
    EXPECT_NE(story.run().find(c.says), std::string::npos) << c.says << " / " << story.run();
  }
}

}  // namespace
}  // namespace brick
