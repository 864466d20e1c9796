// The watchdog scoreboard itself: a trip by the rules passes, and each broken rule is found.
#include "testbench/checkers/watchdog_scoreboard.h"

#include <gtest/gtest.h>

namespace brick {
namespace {

constexpr Tick kServo = 640;

class WatchdogScoreboardTest : public ::testing::Test {
 protected:
  WatchdogScoreboard board;

  // A controller with counter `held` whose real-time task strobes every fourth servo interrupt, then trips `after` the
  // last strobe.
  void play(unsigned told, unsigned held, Tick after, bool real_time = true) {
    board.reset(0);
    Tick now = 100'000, last = now;
    board.strobe(now);
    board.starved(now, kServo, told);
    for (unsigned count = 1; count <= held; ++count) {
      board.servo_fell(now += kServo);
      if (count % 4 == 0) board.strobe(last = now + 50);
    }
    board.trip(last + after);
    board.judge(real_time);
  }
  std::string first() const { return board.violations().empty() ? "" : board.violations().front(); }
};

constexpr Tick kGood = 959 * 1024 * 3 + 1500;  // the first period of 38.4 kHz cut short by half

TEST_F(WatchdogScoreboardTest, TripByTheRulesPasses) {
  play(400, 400, kGood);
  EXPECT_EQ(first(), "");
  play(400, 400, 960 * 1024 * 3);
  EXPECT_EQ(first(), "");
}

TEST_F(WatchdogScoreboardTest, CircuitOnePeriodEarlyOrLateIsFound) {
  play(400, 400, kGood - 1024 * 3);
  EXPECT_NE(first().find("last strobe"), std::string::npos) << first();
  play(400, 400, kGood + 1024 * 3);
  EXPECT_NE(first().find("last strobe"), std::string::npos) << first();
}

TEST_F(WatchdogScoreboardTest, CounterOtherThanI40IsFound) {
  play(400, 320, kGood);
  EXPECT_NE(first().find("I40"), std::string::npos) << first();
  play(400, 410, kGood);
  EXPECT_NE(first().find("I40"), std::string::npos) << first();
}

TEST_F(WatchdogScoreboardTest, StrobesOfAStarvedRealTimeTaskAreFound) {
  play(400, 4, kGood, false);
  EXPECT_EQ(first(), "");
  play(400, 400, kGood, false);
  EXPECT_NE(first(), "");
}

TEST_F(WatchdogScoreboardTest, MissingTripAndStrobeAfterItAreFound) {
  board.reset(0);
  board.judge(false);
  EXPECT_EQ(first(), "did not trip");
  board.reset(0);
  board.trip(kGood);
  board.strobe(kGood + 10);
  EXPECT_NE(first().find("after the trip"), std::string::npos);
}

TEST_F(WatchdogScoreboardTest, I40ZeroStandsFor4095) {
  EXPECT_EQ(WatchdogScoreboard::counter_of(0), 4095u);
  EXPECT_EQ(WatchdogScoreboard::counter_of(65535), 65535u);
}

}  // namespace
}  // namespace brick
