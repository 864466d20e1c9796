// T_RISE with made-up times: what is in time, and each way to break the rule.
#include "testbench/checkers/rise_checker.h"

#include <gtest/gtest.h>

#include <functional>

#include "testbench/unit/checkers/microsecond.h"

namespace brick {
namespace {

constexpr TimeFs kPeriod = 442 * kUsInFs, kInterrupt = 60 * kUsInFs, kLine = 20 * kUsInFs;

// Five lines, I16 = 2: a line 20 us after each interrupt, the background goes on after 60 us. The fourth line leaves
// one.
struct RiseStory {
  TimeFs rise = 3 * kPeriod + kLine + 5 * kUsInFs;
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
  EXPECT_EQ(RiseStory{}.run(), "");
  RiseStory story;
  story.rise = 3 * kPeriod + kInterrupt - 1;
  EXPECT_EQ(story.run(), "") << "at its end";
}

TEST(RiseChecker, FindsTheRuleBroken) {
  const struct {
    const char* says;
    std::function<void(RiseStory&)> breaks;
  } cases[] = {
      {"BREQ rose 40.000 us after it, expected one within 40.000 us after line 4 of 5, I16=2",
       [](RiseStory& s) { s.rise = 3 * kPeriod + kInterrupt; }},
      {"BREQ rose 447.000 us after it", [](RiseStory& s) { s.rise += kPeriod; }},
      {"us before it", [](RiseStory& s) { s.rise -= kPeriod; }},
      {"BREQ rose 0 times", [](RiseStory& s) { s.rises = 0; }},
      {"BREQ rose 2 times", [](RiseStory& s) { s.rises = 2; }},
      {"4 lines calculated, expected 5", [](RiseStory& s) { s.lines = 4; }},
      {"the real-time interrupt did not end", [](RiseStory& s) { s.ends = 3; }},
  };
  for (const auto& c : cases) {
    RiseStory story;
    c.breaks(story);
    EXPECT_NE(story.run().find(c.says), std::string::npos) << c.says << " / " << story.run();
  }
}

}  // namespace
}  // namespace brick
