// S (motion:5.6/5): a run ends as with Q, a step makes one move, one that waits behind a stop too.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/segment.h"
}

namespace {

using namespace moving_motors;

// Moves of a count a 100 ms each, at 10 counts/ms; TA is up to all of it.
struct Way {
  const char* name;
  const char* prepare;
  int ta;
};
constexpr Way kWays[] = {{"one at a time", "I5113=0", 20},
                         {"all blends", "I5113=0", 100},
                         {"segments", "I5113=5", 20},
                         {"segments, all blends", "I5113=5", 100},
                         {"stored", "I5113=5 I5120=1", 20},
                         {"lookahead", "I5113=5 I5120=40", 20},
                         {"lookahead, all blends", "I5113=2 I5120=100", 100}};
constexpr int kMoves = 14;

class Steps : public MovingMotors {
 protected:
  void begin(const Way& w, const std::string& start = "&1B1R") {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I116=50 I117=1 ") + w.prepare), "");
    ASSERT_EQ(host("DELETE GATHER"), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,10"), "");
    Lines lines = {"TM100 TA" + std::to_string(w.ta) + " TS0 INC"};
    for (int i = 0; i < kMoves; ++i) lines.emplace_back("X1");
    store(lines);
    if (!start.empty()) { ASSERT_EQ(host(start), ""); }
    last_ = at(1);
  }
  // At most the speed of the program: nothing is made twice, nothing jumps.
  void go(double ms) {
    for (unsigned n = ticks_of(ms); n > 0; --n) {
      platform::servo_ticks(1);
      ASSERT_LE(std::abs(at(1) - last_), 10.01 * kTickMs);
      last_ = at(1);
    }
  }
  // Whole moves that are made, when the program stands.
  int stands() {
    for (int i = 0; i < 100 && run_is_running(0); ++i) go(20);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(motors[0].trajectory % (1000 * 3072), 0) << at(1) << ": at the end of a move";
    return static_cast<int>(motors[0].trajectory / (1000 * 3072));
  }
  // From a stop at 150 ms.
  int stopped_by(const Way& w, const char* order) {
    begin(w);
    go(150);
    EXPECT_EQ(host(order), "");
    return stands();
  }

 private:
  double last_ = 0;
};

TEST_F(Steps, SWhileItRunsIsQ) {
  for (const Way& w : kWays) {
    SCOPED_TRACE(w.name);
    const int quit = stopped_by(w, "&1Q");
    if (std::string(w.prepare) == "I5113=5") { EXPECT_EQ(quit, 2) << "the executing move"; }
    EXPECT_EQ(stopped_by(w, "&1S"), quit);
    ASSERT_EQ(host("&1R"), "");
    EXPECT_EQ(stands(), kMoves);
  }
}

TEST_F(Steps, BehindAStopSMakesOneMove) {
  for (const Way& w : kWays)
    for (const char* stop : {"&1Q", "&1/", "&1S"}) {
      SCOPED_TRACE(std::string(w.name) + " " + stop);
      int made = stopped_by(w, stop);
      while (made < kMoves) {
        ASSERT_EQ(host("&1S"), "");
        go(5);
        ASSERT_EQ(host("&1S"), "") << "one more changes nothing";
        ASSERT_EQ(stands(), ++made);
      }
    }
}

// All that is left, be it the rest of what waits or of the program.
TEST_F(Steps, BehindStepsRMakesTheRest) {
  for (const Way& w : kWays)
    for (int steps = 1; steps < 6; ++steps) {
      SCOPED_TRACE(std::string(w.name) + " " + std::to_string(steps));
      (void)stopped_by(w, "&1Q");
      for (int i = 0; i < steps; ++i) {
        ASSERT_EQ(host("&1S"), "");
        (void)stands();
      }
      ASSERT_EQ(host("&1R"), "");
      EXPECT_EQ(stands(), kMoves);
    }
}

// At every pause while R lets what waits begin: no more than the move that begins.
TEST_F(Steps, AStopThatMeetsTheBeginIsObeyed) {
  for (const Way& w : {kWays[2], kWays[5]})
    for (const char* stop : {"&1Q", "&1/", "&1S"}) {
      unsigned at_pause = 0;
      for (bool begins = false; !begins && !HasFailure();) {
        SCOPED_TRACE(std::string(w.name) + " " + stop + " at pause " + std::to_string(++at_pause));
        const int made = stopped_by(w, "&1Q");
        ASSERT_LT(made + 2, kMoves);
        ASSERT_EQ(host("&1R"), "");
        unsigned pauses = 0;
        platform::real_time_in_slices([&] {
          if (++pauses != at_pause) return;
          begins = segment_is_under_way(0);
          ASSERT_EQ(host(stop), "");
        });
        ASSERT_GE(pauses, at_pause);
        if (!begins) { EXPECT_LE(stands(), made + 1); }
      }
      ASSERT_GT(at_pause, 20u) << "pauses of a begin";
    }
}

// R makes a run of a step, of one that waits too.
TEST_F(Steps, RWhileAStepMovesMakesTheRest) {
  for (const Way& w : kWays) {
    SCOPED_TRACE(w.name);
    (void)stopped_by(w, "&1Q");
    ASSERT_EQ(host("&1S"), "");
    go(30);
    ASSERT_EQ(host("&1R"), "");
    EXPECT_EQ(stands(), kMoves);
  }
}

// The same from a PLC and from the program itself.
TEST_F(Steps, FromProgramsToo) {
  for (const Way& w : kWays) {
    SCOPED_TRACE(w.name);
    const int quit = stopped_by(w, "&1Q");
    begin(w, "");
    ASSERT_EQ(host("I5=2 P1=0"), "");
    for (const char* line : {"OPEN PLC 1 CLEAR", "CMD\"&1S\"", "DISABLE PLC 1", "CLOSE"}) ASSERT_EQ(host(line), "");
    ASSERT_EQ(host("&1B1R"), "");
    go(150);
    for (int made = quit; made < quit + 5; ++made) {
      ASSERT_EQ(host("ENABLE PLC 1"), "");
      platform::background(3);
      EXPECT_EQ(stands(), made);
    }
    // it comes while the moves behind it are calculated
    const auto stopped_by_line = [&](const std::string& order) {
      Lines lines = {"TM100 TA" + std::to_string(w.ta) + " TS0 INC", "X1", "CMD\"" + order + "\" X1"};
      for (int i = 2; i < kMoves; ++i) lines.emplace_back("X1");
      begin(w, "");
      store(lines);
      EXPECT_EQ(host("&1B1R"), "");
      for (int i = 0; i < 40; ++i) {
        go(5);
        platform::background(3);
      }
      return stands();
    };
    const int by_quit = stopped_by_line("&1Q");
    if (std::string(w.prepare) == "I5113=5") { EXPECT_EQ(by_quit, 1) << "the executing move"; }
    EXPECT_EQ(stopped_by_line("&1S"), by_quit);
    ASSERT_EQ(host("&1R"), "");
    EXPECT_EQ(stands(), kMoves);
  }
}

// The end of the program is calculated: Q and S leave the same moves, R makes those and does not begin anew
// (motion:5.6/6).
TEST_F(Steps, NearTheEndItDoesNotBeginAnew) {
  for (const Way& w : kWays) {
    unsigned left = 0;
    for (int before = 4; before > 0; --before) {
      int quit = 0;
      for (const char* stop : {"&1Q", "&1S"}) {
        SCOPED_TRACE(std::string(w.name) + " " + stop + " " + std::to_string(before));
        begin(w);
        go(100 * (kMoves - before) - 20);
        const bool ended = cs().ended;
        ASSERT_EQ(host(stop), "");
        const int made = stands();
        if (stop[2] == 'Q') quit = made;
        EXPECT_EQ(made, quit);
        if (made == kMoves) continue;
        left += ended;
        ASSERT_EQ(host("&1R"), "");
        EXPECT_EQ(stands(), kMoves);
      }
    }
    const bool may = std::string(w.prepare).find("I5113=0") == std::string::npos;
    EXPECT_EQ(left > 0, may) << "moves waited, and the end was calculated";
  }
}

// Held, or stopped on its path in lookahead: S goes on and ends as Q would.
TEST_F(Steps, BehindAHoldSIsQ) {
  for (const Way& w : kWays)
    for (const char* hold : {"&1H", "&1\\"}) {
      SCOPED_TRACE(std::string(w.name) + " " + hold);
      const int quit = stopped_by(w, "&1Q");
      begin(w);
      ASSERT_EQ(host("I5195=200000"), "");
      go(150);
      ASSERT_EQ(host(hold), "");
      go(200);
      ASSERT_EQ(host("&1S"), "");
      const int made = stands();
      EXPECT_GE(made, quit);
      EXPECT_LE(made, quit + 1);
      ASSERT_EQ(host("&1R"), "");
      EXPECT_EQ(stands(), kMoves);
    }
}

}  // namespace
