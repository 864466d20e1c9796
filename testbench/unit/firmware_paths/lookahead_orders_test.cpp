// Orders to a program that is looked ahead: what they leave as it was, where it stops, which line it shows
// (motion:7.1/8, motion:7.1/9, motion:7.5).
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/segment.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
}

namespace {

using namespace moving_motors;

constexpr int kAhead = 40, kSegmentMs = 5;

class LookaheadOrders : public MovingMotors {
 protected:
  static void begin(const Lines& lines) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 M1->*"), "");
    ASSERT_EQ(host("DELETE GATHER"), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 600,10"), "");
    store(lines);
  }
  static void wait_ms(double ms) { platform::servo_ticks(ticks_of(ms)); }
};

// A step stays one, however it is stopped and sent back on its way, by `>`; R makes a run of it.
TEST_F(LookaheadOrders, AStepStaysAStepUntilR) {
  for (const char* stop : {"&1\\", "&1<", "I5121=4", "I5121=7"})
    for (const auto& [on, end] : {std::pair{"&1>", 5000}, {"I5121=6", 5000}, {"&1R", 15000}}) {
      SCOPED_TRACE(std::string(stop) + " " + on);
      begin({"TM200 TA20 TS0", "X5", "X10", "X15"});
      ASSERT_EQ(host("&1B1S"), "");
      wait_ms(130);
      ASSERT_EQ(host(stop), "");
      wait_ms(400);
      ASSERT_LT(at(1), 5000);
      ASSERT_TRUE(run_is_running(0));
      ASSERT_EQ(host(on), "");
      wait_ms(1200);
      EXPECT_EQ(motors[0].trajectory, end * 3072);
      EXPECT_FALSE(run_is_running(0));
      ASSERT_EQ(host("&1R"), "") << "what is left, or all of it again";
      wait_ms(1200);
      EXPECT_EQ(motors[0].trajectory, 15000 * 3072);
    }
}

// Q, `/` and S: the move in which the last segment lies that is made; what is calculated behind it waits for R.
TEST_F(LookaheadOrders, QuitStopsAtTheEndOfTheMoveThatIsMade) {
  Lines lines = {"TM100 TA20 TS0 INC"};
  for (int i = 0; i < 30; ++i) lines.emplace_back("X2");
  for (const char* command : {"&1Q", "&1/", "&1S"}) {
    SCOPED_TRACE(command);
    begin(lines);
    ASSERT_EQ(host("&1B1R"), "");
    wait_ms(300);
    const double made = at(1) + 20 * kAhead * kSegmentMs;  // 20 counts/ms
    ASSERT_EQ(host(command), "");
    wait_ms(1500);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_NEAR(std::remainder(at(1), 2000), 0, 1e-9) << at(1);
    EXPECT_GE(at(1), made - 500);
    EXPECT_LE(at(1), made + 2000 + 500) << "and 12 ms that are handed over";
    ASSERT_EQ(host("&1R"), "");
    wait_ms(4000);
    EXPECT_EQ(motors[0].trajectory, 60000 * 3072);
  }
}

// motion:7.5: from the knot next to the oldest one it is back at that, from rest to rest within one segment.
TEST_F(LookaheadOrders, BackOverOneSegmentToTheOldestPoint) {
  begin({"TM4000 TA20 TS0", "X80"});  // 20 counts/ms, 100 a segment
  ASSERT_EQ(host("&1B1R"), "");
  wait_ms(3000);  // all of its records hold segments of it
  ASSERT_EQ(host("&1\\"), "");
  wait_ms(200);
  ASSERT_EQ(host("&1<"), "");
  wait_ms(3500);
  const double oldest = at(1);
  EXPECT_GT(oldest, 1000) << "not the start of the path";
  ASSERT_EQ(host("I5121=14"), "") << "a segment forward";
  wait_ms(300);
  EXPECT_NEAR(at(1), oldest + 100, 1e-9);
  ASSERT_EQ(host("&1<"), "");
  wait_ms(300);
  EXPECT_NEAR(at(1), oldest, 1e-9);
  ASSERT_EQ(host("&1>"), "");
  wait_ms(5000);
  EXPECT_EQ(motors[0].trajectory, 80000 * 3072);
}

// PE is the line that executes, on the way back too: away from the corners it goes by the place alone.
TEST_F(LookaheadOrders, PeIsTheLineThatExecutesBackwardsToo) {
  begin({"TM200 TA20 TS0", "X5", "M1==1 X10", "X15"});
  const char* lines[] = {"P1:3", "P1:4", "P1:6"};  // numbers of statements: TM, TA, TS, X, M, X, X
  ASSERT_EQ(host("&1B1R"), "");
  const auto go = [&](double ms) {  // which lines were seen
    unsigned seen = 0;
    for (unsigned tick = 0; tick < ticks_of(ms) && !HasFailure(); tick += 5) {
      platform::servo_ticks(5);
      const int move = static_cast<int>(at(1)) / 5000;
      const double within = std::fmod(at(1), 5000);
      if (within < 1000 || within > 4000) continue;
      EXPECT_EQ(host("&1PE"), lines[move]) << at(1);
      seen |= 1u << move;
    }
    return seen;
  };
  EXPECT_EQ(go(580), 7u);
  ASSERT_EQ(host("&1<"), "");
  EXPECT_EQ(go(1500), 7u);
  EXPECT_EQ(motors[0].trajectory, 0);
  ASSERT_EQ(host("&1>"), "");
  EXPECT_EQ(go(1500), 7u);
  EXPECT_EQ(motors[0].trajectory, 15000 * 3072);
}

// At every pause of the interrupt that hands over the last pieces, and of those about it: an order is obeyed that was
// accepted, be it given while the sequence is found to be over.
TEST_F(LookaheadOrders, AnOrderThatMeetsTheLastPieceIsObeyed) {
  const auto start = [](unsigned ticks) {
    begin({"TM200 TA20 TS0", "X5"});
    ASSERT_EQ(host("I5195=200000 I115=1 &1B1R"), "");
    platform::servo_ticks(ticks);
  };
  start(ticks_of(100));
  unsigned last = ticks_of(100);
  for (; segment_is_under_way(0); ++last) platform::servo_ticks(1);
  // What can be seen of each: `<` goes back, `\\` and H stand on the path until `>`, Q and S ask for the motors'
  // return;
  // `>` has nothing to change.
  for (const char order : {'<', '\\', '>', 'H', 'Q', 'A', 'S'}) {
    unsigned orders = 0;
    for (unsigned before = 0; before < 3; ++before)
      for (unsigned at_pause = 1, pauses = 1; pauses >= at_pause; ++at_pause) {
        SCOPED_TRACE(std::string(1, order) + " at pause " + std::to_string(at_pause) + ", " + std::to_string(before));
        start(last - 1 - before);
        fake_task_run_servo();
        pauses = 0;
        platform::real_time_in_slices([&] {
          if (++pauses != at_pause) return;
          ASSERT_TRUE(segment_looks(0) && run_is_running(0));
          ASSERT_EQ(host(std::string("&1") + order), "");
        });
        if (pauses < at_pause) break;
        ++orders;
        wait_ms(600);
        const bool stands = order == '<' || order == '\\' || order == 'H';
        ASSERT_EQ(run_is_running(0), stands);
        if (order == '<') { ASSERT_EQ(motors[0].trajectory, 0); }
        if (order == 'A') continue;
        if (stands) { ASSERT_EQ(host("&1>"), ""); }
        wait_ms(600);
        ASSERT_EQ(motors[0].trajectory, 5000 * 3072);
        ASSERT_FALSE(run_is_running(0)) << "it begins anew";
        if (order != 'Q' && order != 'S') continue;
        ASSERT_EQ(host("#1J:100"), "");
        wait_ms(500);
        ASSERT_EQ(host("&1R"), "ERR017");
      }
    EXPECT_GT(orders, 10u) << order;
  }
}

// motion:7.5/2: a sequence that waits behind another move is not executed from lookahead yet. `\` and `<` are H, `>`
// and R change nothing, nor do single segments; then R goes on. X and Y make a corner; 10 counts/ms are twice what any
// move asks for.
TEST_F(LookaheadOrders, OrdersInAMoveBeforeTheSequenceLeaveItAlone) {
  const std::pair<const char*, double> befores[] = {
      {"SPLINE1 INC TM100 X1 Y1", 120},
      {"PVT300 INC X1:0 Y1:0", 120},
      {"INC TM300 TA40 TS0 X1 Y1", 320}};  // a sequence, of 360 ms: its pieces are all made by then
  const std::pair<const char*, bool> orders[] = {
      {"&1H", true},  {"&1\\", true}, {"&1<", true},      {"I5121=4", true},   {"I5121=7", true},
      {"&1R", false}, {"&1>", false}, {"I5121=6", false}, {"I5121=14", false}, {"I5121=15", false}};
  for (const auto& [before, ms] : befores)
    for (const auto& [order, stops] : orders) {
      SCOPED_TRACE(std::string(before) + " " + order);
      platform::power_up();
      fit({"1000X", "1000Y"});
      ASSERT_EQ(host("I5113=10 I5120=40 I116=100 I117=1 I216=100 I217=1 I5192=1 I5195=50000 P1=0"), "");
      ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=20 I192=1"), "");
      ASSERT_EQ(host("DELETE GATHER"), "");
      ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,20"), "");
      store({before, "LINEAR INC TA40 TS10 TM600 X3 Y-3", "DWELL10", "P1=1"});
      ASSERT_EQ(host("&1B1R"), "");
      for (int i = 0; i < 1000 && at(1) == 0.0; ++i) platform::servo_ticks(1);
      double x = at(1);
      const auto go = [&](double time) {
        for (unsigned n = ticks_of(time); n > 0; --n) {
          platform::servo_ticks(1);
          ASSERT_NEAR(at(2), x <= 1000 && at(1) <= 1000 ? at(1) : 2000 - at(1), 0.01) << "on the path";
          ASSERT_LE(std::abs(at(1) - x), 10 * kTickMs) << "at " << x;
          x = at(1);
        }
      };
      go(ms);
      ASSERT_LT(x, 1000);
      ASSERT_EQ(host(order), "");
      go(150);
      EXPECT_EQ(cs().held, stops);
      if (order[0] == '&' && ms < 300) { EXPECT_EQ(host("I5121"), "0") << "it does not execute"; }
      if (stops) {
        const double stood = x;
        ASSERT_LT(stood, 1000);
        go(50);
        ASSERT_EQ(x, stood);
        EXPECT_EQ(host("#1J:10"), "") << "as in H";
        platform::servo_ticks(ticks_of(200));
        EXPECT_EQ(host("&1R"), "ERR017");
        ASSERT_EQ(host("#1J="), "");
        platform::servo_ticks(ticks_of(200));
        ASSERT_EQ(host("&1R"), "");
      }
      go(1500);
      EXPECT_EQ(motors[0].trajectory, 4000 * 3072);
      EXPECT_EQ(motors[1].trajectory, -2000 * 3072);
      EXPECT_EQ(p_variable_read(1), 1.0);
      EXPECT_FALSE(run_is_running(0));
      EXPECT_EQ(cs().error, RUN_TIME_NONE);
    }
}

// At pauses of the interrupts in which a sequence begins, behind one whose last pieces are executed: it is of either.
TEST_F(LookaheadOrders, AnOrderWhileTheNextSequenceBeginsChangesNoPath) {
  const auto start = [](unsigned ticks) {
    begin({"INC TM100 TA20 TS0", "X2", "X3"});
    ASSERT_EQ(host("I5195=50000 I5192=1 &1B1R"), "");
    platform::servo_ticks(ticks);
  };
  unsigned last = ticks_of(60), orders = 0;
  for (start(last); !cs().next_valid; ++last) platform::servo_ticks(1);
  for (unsigned before = 0; before < 12; ++before)
    for (unsigned at_pause = 1, pauses = 1; pauses >= at_pause; ++at_pause) {
      SCOPED_TRACE("at pause " + std::to_string(at_pause) + ", " + std::to_string(before));
      start(last - 1 - before);
      fake_task_run_servo();
      pauses = 0;
      platform::real_time_in_slices([&] {
        if (++pauses == at_pause) { ASSERT_EQ(host("&1\\"), ""); }
      });
      if (pauses < at_pause) break;
      ++orders;
      double x = at(1);
      const auto go = [&](double ms) {
        for (unsigned n = ticks_of(ms); n > 0; --n, x = at(1)) {
          platform::servo_ticks(1);
          ASSERT_LE(std::abs(at(1) - x), 30 * 1.005 * kTickMs) << "at " << x;
        }
      };
      go(150);
      ASSERT_EQ(host("&1\\"), "");
      go(150);
      const double stood = x;
      ASSERT_LT(stood, 5000);
      go(20);
      ASSERT_EQ(x, stood);
      ASSERT_EQ(host("&1R"), "");
      go(600);
      ASSERT_EQ(motors[0].trajectory, 5000 * 3072);
      ASSERT_FALSE(run_is_running(0));
    }
  EXPECT_GT(orders, 20u);
}

// motion:7.5/5, whatever is calculated behind the sequence.
TEST_F(LookaheadOrders, WhereItStandsMotorsMayBeJogged) {
  for (const char* behind : {"DWELL50", "RAPID X10", "SPLINE1 TM50 X10", "P1=1"}) {
    SCOPED_TRACE(behind);
    begin({"TM200 TA20 TS0", "X5", behind});
    ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=20 I192=1 &1B1R"), "");
    wait_ms(130);
    ASSERT_EQ(host("&1\\"), "");
    wait_ms(200);
    const std::int64_t stands = motors[0].trajectory;
    ASSERT_LT(stands, 5000 * 3072);
    ASSERT_EQ(host("#1J:100"), "");
    wait_ms(200);
    EXPECT_EQ(motors[0].trajectory, stands + 100 * 3072);
    EXPECT_EQ(host("&1R"), "ERR017");
    ASSERT_EQ(host("#1J="), "");
    wait_ms(200);
    ASSERT_EQ(host("&1R"), "");
    wait_ms(1200);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(motors[0].trajectory, (std::string(behind).find('X') == std::string::npos ? 5000 : 10000) * 3072);
  }
}

// One more stop leaves it standing: a motor that jogs there is stopped at once.
TEST_F(LookaheadOrders, AStopWhereItStandsKeepsNoJogFromItsEnd) {
  begin({"TM200 TA20 TS0", "X5", "X10"});
  ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=20 I192=1"), "");
  ASSERT_EQ(host("&1B1R"), "");
  wait_ms(130);
  for (const char* stop : {"&1\\", "I5121=4"}) {
    ASSERT_EQ(host(stop), "");
    wait_ms(200);
    ASSERT_EQ(host("#1J+"), "");
    wait_ms(50);
    ASSERT_EQ(host(stop), "");
    EXPECT_EQ(host("#1J/"), "");
    wait_ms(100);
  }
  ASSERT_EQ(host("#1J="), "");
  wait_ms(400);
  ASSERT_EQ(host("&1R"), "");
  wait_ms(1200);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
}

}  // namespace
