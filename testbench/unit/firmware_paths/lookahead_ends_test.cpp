// What ends lookahead or breaks into it (motion:7.3, motion:7.5): DWELL and the end of a program, WHILE..WAIT, a buffer
// that is too small, aborts, kills, DELETE LOOKAHEAD, holds with jogs. What is executed keeps the limits throughout.
#include "testbench/unit/firmware_program/moving_motors.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/command/control_characters.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/segment.h"
}

namespace {

using namespace moving_motors;

class LookaheadEnds : public MovingMotors {
 protected:
  void SetUp() override {
    platform::power_up();
    prepare();
  }
  // 50 counts/ms and 1 count/ms^2; an abort asks for as much.
  static void prepare(unsigned records = 300) {
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I115=1 I216=50 I217=1 I215=1 I5195=200000"), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD " + std::to_string(records) + ",10"), "");
  }
  // Over `ms`: no first or second difference of a motor is beyond its limits, from before the call on.
  void go(double ms) {
    for (unsigned n = ticks_of(ms); n > 0; --n) {
      platform::servo_ticks(1);
      for (unsigned i = 0; i < 2; ++i) {
        const double x = at(i + 1), v = (x - last_[i]) / kTickMs;
        const double bend = ticks_ > 1 ? std::abs(v - velocity_[i]) : 0;
        if (ticks_ > 0) fastest_ = std::max(fastest_, std::abs(v));
        ASSERT_LE(bend, 1.02 * kTickMs + 0.004) << "#" << i + 1 << " at " << x;
        ASSERT_LE(fastest_, 50 * 1.005 + 0.002);
        last_[i] = x;
        velocity_[i] = v;
      }
      ++ticks_;
    }
  }
  bool stands() {
    const double x = at(1), y = at(2);
    go(3);
    return at(1) == x && at(2) == y;
  }
  void forget() { ticks_ = 0; }
  static unsigned word3() { return static_cast<unsigned>(std::stoul(host("??").substr(12, 6), nullptr, 16)); }
  // Bits 23 to 20 and 11 to 8: nothing of lookahead is under way.
  static void expect_clean() {
    EXPECT_EQ(word3() & 0xF00F00, 0u);
    EXPECT_EQ(host("I5121"), "0");
    EXPECT_FALSE(segment_looks(0));
    EXPECT_FALSE(segment_is_busy(0));
  }

 private:
  double last_[2] = {}, velocity_[2] = {}, fastest_ = 0;
  unsigned ticks_ = 0;
};

// motion:7.3/1: back to the sequence behind a DWELL, not beyond it.
TEST_F(LookaheadEnds, BackIsNotBeyondADwell) {
  store({"TM200 TA20 TS0", "X5", "DWELL50", "X10"});
  ASSERT_EQ(host("&1B1R"), "");
  go(200 + 20 + 10 + 50 + 120);
  ASSERT_GT(at(1), 6000);
  ASSERT_EQ(host("&1<"), "");
  go(600);
  EXPECT_EQ(motors[0].trajectory, 5000 * 3072) << "where this sequence began";
  EXPECT_EQ(word3() >> 21 & 3, 3u) << "at the oldest";
  ASSERT_EQ(host("&1<"), "");
  go(50);
  EXPECT_EQ(motors[0].trajectory, 5000 * 3072);
  ASSERT_EQ(host("&1>"), "");
  go(600);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
  EXPECT_FALSE(run_is_running(0));
  expect_clean();
}

// motion:7.1/1: Isx13 counts when a sequence begins. One that waits at its corner, here for 100 real-time interrupts or
// 133 ms, and finds it 0 has segments of 1 ms.
TEST_F(LookaheadEnds, SegmentsThatAreSwitchedOffWhileACornerWaits) {
  ASSERT_EQ(host("I5183=0.9 I5185=0.9 I5182=100"), "");
  store({"TM200 TA20 TS0", "X5", "Y5"});
  ASSERT_EQ(host("&1B1R"), "");
  go(200 + 20 + 10 + 100);
  ASSERT_EQ(motors[0].trajectory, 5000 * 3072);
  ASSERT_EQ(motors[1].trajectory, 0) << "it waits";
  ASSERT_EQ(host("I5113=0"), "");
  go(500);
  EXPECT_EQ(motors[1].trajectory, 5000 * 3072);
  EXPECT_FALSE(run_is_running(0));
  expect_clean();
}

// `<` at whatever time about a DWELL and the end of the program, then `>`: it comes to its end.
TEST_F(LookaheadEnds, BackAndForthAboutADwellAndTheEnd) {
  store({"TM100 TA20 TS0", "X2", "DWELL20", "X4"});
  const double length = 2 * (100 + 20 + 10) + 20;
  unsigned dwells = 0, backwards = 0;
  for (double t = 3; t < length + 15; t += 7) {
    SCOPED_TRACE(t);
    ASSERT_EQ(host("#1HMZ B1R"), "");
    forget();
    go(t);
    const double before = at(1);
    dwells += before == 2000;
    ASSERT_EQ(host("&1<"), "");
    for (unsigned n = ticks_of(400); n > 0; --n) platform::servo_ticks(1);  // H is of no limit
    backwards += at(1) < before - 100;
    EXPECT_GE(at(1), before >= 2000 ? 2000 : 0);
    forget();
    ASSERT_EQ(host("&1>"), "");
    platform::servo_ticks(ticks_of(600));
    ASSERT_EQ(motors[0].trajectory, 4000 * 3072);
    ASSERT_FALSE(run_is_running(0));
    expect_clean();
  }
  EXPECT_GT(dwells, 2u);
  EXPECT_GT(backwards, 10u);
}

// Behind the end there is nothing to go back along.
TEST_F(LookaheadEnds, BehindTheEndOfAProgramNothingGoesBack) {
  store({"TM100 TA20 TS0", "X2"});
  ASSERT_EQ(host("&1B1R"), "");
  go(160);
  ASSERT_FALSE(run_is_running(0));
  expect_clean();
  for (const char* order : {"&1<", "&1\\", "I5121=7", "I5121=15", "I5121=4"}) {
    (void)host(order);
    go(50);
    EXPECT_EQ(motors[0].trajectory, 2000 * 3072) << order;
  }
}

// WHILE..WAIT: a sequence ends there, at rest and exactly; the next one begins when the condition is over.
TEST_F(LookaheadEnds, AWaitEndsTheSequence) {
  store({"TM200 TA20 TS0", "X5", "WHILE(P1=0) WAIT", "X10"});
  ASSERT_EQ(host("P1=0 &1B1R"), "");
  go(400);
  EXPECT_EQ(motors[0].trajectory, 5000 * 3072);
  EXPECT_TRUE(run_is_running(0));
  EXPECT_TRUE(stands());
  EXPECT_EQ(host("I5121"), "0");
  ASSERT_EQ(host("P1=1"), "");
  go(150);
  ASSERT_EQ(host("&1<"), "");
  go(500);
  EXPECT_EQ(motors[0].trajectory, 5000 * 3072) << "not beyond it back";
  ASSERT_EQ(host("&1>"), "");
  go(600);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
  expect_clean();
}

// `<` at a WAIT is H: what is stored belongs to no sequence any more.
TEST_F(LookaheadEnds, BackAtAWaitIsAHold) {
  store({"TM200 TA20 TS0", "X5", "WHILE(P1=0) WAIT", "X10"});
  ASSERT_EQ(host("P1=0 &1B1R"), "");
  go(400);
  ASSERT_EQ(host("&1<"), "");
  go(200);
  EXPECT_EQ(motors[0].trajectory, 5000 * 3072);
  ASSERT_EQ(host("P1=1"), "");
  go(100);
  EXPECT_EQ(motors[0].trajectory, 5000 * 3072) << "it is held";
  ASSERT_EQ(host("&1R"), "");
  platform::servo_ticks(ticks_of(600));
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
}

// motion:7.3/2: Isx20 beyond the buffer is its size less eight.
TEST_F(LookaheadEnds, ALengthBeyondTheBufferIsTakenForItsSize) {
  double times[3];
  const char* const lengths[] = {"32", "65535", "28"};
  for (int i = 0; i < 3; ++i) {
    platform::power_up();
    prepare(40);
    ASSERT_EQ(host(std::string("I5120=") + lengths[i] + " I116=400 I117=1 I216=400"), "");
    store({"F400 TA10 TS0", "X200"});
    times[i] = run();
    EXPECT_EQ(motors[0].trajectory, 200000 * 3072);
  }
  EXPECT_EQ(times[1], times[0]);
  EXPECT_GT(times[2], times[0] + 1) << "as long as the buffer counts";
}

// A contour of lines, an arc and a corner, 20 counts/ms.
Lines contour() { return {"F20 TA10 TS0", "X2", "X2 Y2", "CIRCLE1 X4 Y4 I2 J0", "LINEAR X0 Y0"}; }

// motion:4.5/1, motion:5.6/3: at any time, going forwards, back, or stopped, motors leave the path at Ixx15, nothing
// leaps, nothing of the sequence is left, and a start begins where they are.
TEST_F(LookaheadEnds, AnAbortAtAnyTimeEndsItWithinTheLimits) {
  store(contour());
  unsigned seed = 1;
  const auto random = [&](unsigned below) { return (seed = seed * 1664525u + 1013904223u) / 65536 % below; };
  unsigned moved = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    ASSERT_EQ(host("#1HMZ#2HMZ&1B1R"), "");
    forget();
    go(20 + random(500));
    const char* const orders[] = {"", "&1<", "&1\\", "I5121=15", "&1>"};
    ASSERT_EQ(host(orders[random(5)]), "");
    go(random(200));
    moved += !stands();
    const double from[] = {at(1), at(2)};
    ASSERT_EQ(host("&1A"), "");
    go(3);
    expect_clean();
    go(57);  // 50 counts/ms at 1 count/ms^2
    EXPECT_TRUE(stands());
    for (unsigned m = 0; m < 2; ++m)
      ASSERT_NEAR(at(m + 1), from[m], 20 * 20 / 2.0 + 4 * 20 * kTickMs) << "the ramp begins with a real-time interrupt";
    expect_clean();
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(moved, 20u);
  ASSERT_EQ(host("&1B1R"), "");
  go(1500);
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_EQ(motors[1].trajectory, 0);
  expect_clean();
}

// Orders one behind the other, before the one before has been obeyed: what is known of the rates on one way is not
// taken for the other.
TEST_F(LookaheadEnds, OrdersInHasteKeepTheLimits) {
  unsigned seed = brick::random_seed(13000101);  // one of ten tells if rates of the other way are taken
  const auto random = [&](unsigned below) { return (seed = seed * 1664525u + 1013904223u) / 65536 % below; };
  for (const char* isx13 : {"2", "1", "5"}) {
    platform::power_up();
    prepare(600);
    ASSERT_EQ(host(std::string("I5113=") + isx13), "");
    store(contour());
    for (int i = 0; i < 4 && !HasFailure(); ++i) {
      SCOPED_TRACE(std::string("Isx13 ") + isx13 + ", " + std::to_string(i));
      ASSERT_EQ(host("B1R"), "");
      forget();
      go(10 + random(400));
      for (unsigned burst = 0; burst < 6; ++burst) {
        for (unsigned n = 2 + random(6); n > 0; --n) {
          const char* const orders[] = {"&1<", "&1>", "&1>", "&1\\"};
          ASSERT_EQ(host(orders[random(4)]), "");
          go(1 + random(25));
        }
        go(random(60));
      }
      ASSERT_EQ(host("&1>"), "");
      go(1500);
      ASSERT_FALSE(run_is_running(0));
      EXPECT_EQ(motors[0].trajectory, 0);
      EXPECT_EQ(motors[1].trajectory, 0);
    }
  }
}

// From a stand that is nearer to the end than what is made ahead: all of the rest is handed over at once. The program
// runs, and orders are those of lookahead, until the end is reached.
TEST_F(LookaheadEnds, FromAStandNearItsEndItRunsUntilThat) {
  ASSERT_EQ(host("I5113=2"), "");
  store({"F20 TA10 TS0", "X2"});
  for (unsigned t = 60; t < 90; t += 3) {
    SCOPED_TRACE(t);
    ASSERT_EQ(host("#1HMZ B1R"), "");
    forget();
    go(t);
    ASSERT_EQ(host("&1\\"), "");
    go(100);
    ASSERT_TRUE(segment_stands(0));
    ASSERT_EQ(host("&1>"), "");
    for (unsigned n = 0; n < 2000 && motors[0].trajectory != 2000 * 3072; ++n) {
      go(kTickMs);
      ASSERT_TRUE(run_is_running(0) || stands()) << at(1);
      ASSERT_TRUE(segment_looks(0) || stands()) << at(1);
    }
    go(20);
    EXPECT_FALSE(run_is_running(0));
    expect_clean();
  }
}

// Assignments that waited with the sequence are not made any more.
TEST_F(LookaheadEnds, AnAbortForgetsItsAssignments) {
  ASSERT_EQ(host("M1->* M1=0"), "");
  store({"TM200 TA20 TS0", "X5", "M1==7 X10"});
  ASSERT_EQ(host("&1B1R"), "");
  go(100);
  EXPECT_EQ(word3() >> 20 & 1, 1u);
  ASSERT_EQ(host("&1A"), "");
  go(600);
  EXPECT_EQ(m_variable_read(1), 0);
  expect_clean();
}

// ^K: the same without a ramp, motors killed; with loops closed again a start begins where they are.
TEST_F(LookaheadEnds, AKillOfAllEndsIt) {
  store(contour());
  for (const char* order : {"", "&1<", "&1\\"}) {
    SCOPED_TRACE(order);
    ASSERT_EQ(host("&1B1R"), "");
    forget();
    go(200);
    ASSERT_EQ(host(order), "");
    go(30);
    (void)control_character(0x0B);
    EXPECT_FALSE(run_is_running(0));
    for (unsigned m = 0; m < 2; ++m) EXPECT_EQ(motors[m].loop, LOOP_KILLED);
    platform::servo_ticks(5);
    expect_clean();
    for (unsigned m = 0; m < 2; ++m) EXPECT_EQ(at(m + 1), 0) << "where nothing has moved, as it is killed";
    platform::servo_ticks(100);
    EXPECT_EQ(host("&1R"), "ERR012");
    EXPECT_EQ(host("&1>"), "ERR012");
    ASSERT_EQ(host("#1J/#2J/"), "");
    forget();
    go(100);
  }
  ASSERT_EQ(host("&1B1R"), "");
  go(1500);
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_EQ(motors[1].trajectory, 0);
}

// firmware:4.2/6: its buffer stays while it runs, and while it stands on its path; then it goes, and with it lookahead.
TEST_F(LookaheadEnds, ItsBufferStaysUntilItHasEnded) {
  store({"F100 TA10 TS0", "X20"});
  const std::string size = host("SIZE");
  ASSERT_EQ(host("&1B1R"), "");
  go(100);
  for (const char* order : {"", "&1\\", "&1<", "&1H"}) {
    ASSERT_EQ(host(order), "");
    EXPECT_EQ(host("&1DELETE LOOKAHEAD"), "ERR001") << order;
    platform::servo_ticks(ticks_of(100));
    EXPECT_EQ(host("&1DELETE LOOKAHEAD"), "ERR001") << order;
    EXPECT_EQ(host("&1DEFINE LOOKAHEAD 20,0"), "ERR001") << order;
    EXPECT_EQ(host("DELETE ALL TEMPS"), "ERR001") << order;
    EXPECT_EQ(host("SIZE"), size);
  }
  ASSERT_EQ(host("&1>"), "");
  forget();
  platform::servo_ticks(ticks_of(100));
  go(600);
  EXPECT_EQ(motors[0].trajectory, 20000 * 3072);
  EXPECT_EQ(host("&1DELETE LOOKAHEAD"), "");
  EXPECT_NE(host("SIZE"), size);
  store({"F100 TA10 TS0", "X0"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(100));
  EXPECT_FALSE(segment_looks(0));
  platform::servo_ticks(ticks_of(140));
  EXPECT_EQ(motors[0].trajectory, 0) << "20 at 100 a second, unlimited: 220 ms";
}

// A program that has been quit still moves: so long the buffer is not taken away.
TEST_F(LookaheadEnds, ItsBufferStaysUntilAQuitProgramStands) {
  store({"F5 TA10 TS0", "X2", "X4"});  // 400 ms each, 200 ms are looked ahead
  ASSERT_EQ(host("&1B1R"), "");
  go(50);
  ASSERT_EQ(host("&1Q"), "");
  unsigned refused = 0;
  for (; refused < 2000 && host("&1DELETE LOOKAHEAD") == "ERR001"; ++refused) go(kTickMs);
  EXPECT_GT(refused, 50u);
  EXPECT_TRUE(stands());
  EXPECT_EQ(motors[0].trajectory, 2000 * 3072);
}

// motion:5.6/4: a hold in lookahead, a motor jogged away and back, then on along the path, both ways.
TEST_F(LookaheadEnds, AHoldAndAJog) {
  ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=20 I192=1 I219=1"), "");
  store(contour());
  for (const char* order : {"&1>", "&1R", "&1<"}) {
    SCOPED_TRACE(order);
    ASSERT_EQ(host("&1B1R"), "");
    forget();
    go(250);
    ASSERT_EQ(host("&1H"), "");
    platform::servo_ticks(ticks_of(200));
    const double x = at(1), y = at(2);
    forget();
    EXPECT_TRUE(stands());
    ASSERT_EQ(host("#1J:300"), "");
    go(200);
    EXPECT_EQ(motors[0].trajectory, std::llround((x + 300) * kUnit));
    for (const char* refused : {"&1>", "&1R", "&1<"}) EXPECT_EQ(host(refused), "ERR017");
    ASSERT_EQ(host("#1J="), "");
    go(200);
    EXPECT_EQ(at(1), x);
    EXPECT_EQ(at(2), y);
    ASSERT_EQ(host(order), "");
    platform::servo_ticks(ticks_of(1500));
    if (order[2] == '<') {
      EXPECT_EQ(word3() >> 21 & 3, 3u) << "at the oldest";
      ASSERT_EQ(host("&1>"), "");
      platform::servo_ticks(ticks_of(1500));
    }
    EXPECT_EQ(motors[0].trajectory, 0);
    EXPECT_EQ(motors[1].trajectory, 0);
    expect_clean();
  }
}

}  // namespace
