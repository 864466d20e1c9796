// Limits of desired positions in lookahead (motion:7.5/6): motors that stand beyond theirs, and what comes behind a
// sequence in which they were held.
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class DesiredLimits : public MovingMotors {
 protected:
  static void fit_x(const char* ixx24) {
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I113=50000"), "");
    ASSERT_EQ(host("I124=" + std::string(ixx24)), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 600,10"), "");
  }
  // The program to its end: the largest step between two interrupts, in counts a ms.
  double fastest() {
    double most = 0, before = at(1);
    highest_ = lowest_ = before;
    turns_ = 0;
    run([&](double) {
      most = std::max(most, std::abs(at(1) - before) / kTickMs);
      if (at(1) > highest_) highest_ = lowest_ = at(1);
      lowest_ = std::min(lowest_, at(1));
      turns_ = std::max(turns_, at(1) - lowest_);
      before = at(1);
    });
    return most;
  }

  double highest_ = 0, lowest_ = 0;  // where it has been; behind the highest
  double turns_ = 0;                 // by so much it has gone up again
};

// It comes in, and goes no further out.
TEST_F(DesiredLimits, AMotorBeyondItsLimitDoesNotJump) {
  for (const char* ixx24 : {"$8001", "$C001"})
    for (const bool comes_in : {true, false}) {
      SCOPED_TRACE(std::string(ixx24) + (comes_in ? " in" : " out"));
      platform::power_up();
      fit_x(ixx24);
      motors[0].trajectory = 60000LL * 3072;
      store({"F40 TA50 TS0", comes_in ? "X40" : "X70"});
      if (comes_in || ixx24[1] == 'C') {
        EXPECT_LE(fastest(), 40.1);
      } else {
        ASSERT_EQ(host("&1B1R"), "");
        platform::servo_ticks(ticks_of(500));
        EXPECT_TRUE(run_is_running(0)) << "it stands on its path";
      }
      EXPECT_EQ(motors[0].trajectory, (comes_in ? 40000LL : 60000LL) * 3072);
    }
}

// motion:7.5/7. The axes are where the program has them; the motor comes from where it was held.
TEST_F(DesiredLimits, BehindASequenceItGoesOnFromWhereItWasHeld) {
  const Lines next[] = {{"X20"},
                        {"DWELL100", "X20"},
                        {"DWELL100", "INC", "X-34"},
                        {"DWELL100", "X46", "X20"},
                        {"RAPID X20"},
                        {"DWELL0", "RAPID X20"},
                        {"DWELL100 I5113=0", "X20"},
                        {"PVT1000", "X20:0"},
                        {"SPLINE1 TM400", "X45", "X30", "X20"},
                        {"I5113=0", "X20"}};
  for (const bool by_program : {false, true})
    for (const Lines& lines : next) {
      SCOPED_TRACE(lines.front() + " " + lines.back() + (by_program ? " I" : ""));
      platform::power_up();
      fit_x("$C001");
      if (by_program) {
        ASSERT_EQ(host("&1#1->I I5150=1"), "");
        for (const char* line :
             {"&1OPEN FORWARD CLEAR", "Q7=P1/1000", "CLOSE", "&1OPEN INVERSE CLEAR", "P1=Q7*1000", "CLOSE"})
          ASSERT_EQ(host(line), "");
      }
      // behind a DWELL moves may blend
      ASSERT_EQ(host(lines.front().rfind("DWELL", 0) == 0 ? "I5192=0" : "I5192=1"), "");
      Lines all = {"F40 TA50 TS0", "X54"};
      all.insert(all.end(), lines.begin(), lines.end());
      store(all);
      ASSERT_EQ(host("I122=40 I119=1 I120=50 I121=0"), "");
      EXPECT_LE(fastest(), 95);
      EXPECT_LE(highest_, 50000) << "never outward";
      EXPECT_LE(turns_, 3 / kUnit) << "straight in";
      EXPECT_EQ(cs().error, RUN_TIME_NONE);
      EXPECT_EQ(motors[0].trajectory, 20000LL * 3072);
    }
}

// motion:7.5/6: the first segment already leads beyond the limit, so it stops at the knot before it, the start.
TEST_F(DesiredLimits, InTheFirstSegmentItDoesNotLeaveTheStart) {
  for (const char* far : {"X6", "X-6"}) {
    SCOPED_TRACE(far);
    platform::power_up();
    fit_x("$8001");
    ASSERT_EQ(host("I113=5 I114=-5"), "");
    store({"TM150 TA2 TS0", far});  // 40 counts a ms
    ASSERT_EQ(host("&1B1R"), "");
    for (unsigned n = ticks_of(100); n > 0; --n) {
      platform::servo_ticks(1);
      ASSERT_EQ(motors[0].trajectory, 0);
    }
    EXPECT_TRUE(run_is_running(0));
    EXPECT_EQ(std::stoul(host("??").substr(12, 6), nullptr, 16) & 2u, 2u);
  }
}

// motion:7.5/6: `>` to a program that goes forward is no order for the stop at the limit, be it that a `\` before it
// has just begun to act: only one that comes there leads a segment further.
TEST_F(DesiredLimits, AnOrderThatChangesNothingIsForgotten) {
  for (const bool stops : {false, true})
    for (const bool at_limit : {false, true}) {
      SCOPED_TRACE(std::to_string(at_limit) + " " + std::to_string(stops));
      platform::power_up();
      fit_x("$8001");
      store({"F40 TA50 TS0", "X70"});
      ASSERT_EQ(host("&1B1R"), "");
      platform::servo_ticks(ticks_of(at_limit ? 2000 : 300));
      if (stops) {
        ASSERT_EQ(host("&1\\"), "");
        platform::servo_ticks(3);
      }
      ASSERT_EQ(host("&1>"), "");
      platform::servo_ticks(ticks_of(2000));
      EXPECT_EQ(std::stoul(host("??").substr(12, 6), nullptr, 16) & 2u, 2u);
      const double before = at_limit ? 200 : 0;  // 40 counts/ms, 5 ms a segment
      EXPECT_LE(at(1), 50000 + before);
      EXPECT_GT(at(1), 50000 + before - 200 - 50);
    }
}

// One whose limit is taken away goes by its axes again, beside another one that has its own.
TEST_F(DesiredLimits, AMotorThatIsHeldNoMoreStandsWhereItsAxesAre) {
  fit({"1000X", "1000Y"});
  for (const char* motor : {"1", "2"}) {
    const std::string i = "I" + std::string(motor);
    ASSERT_EQ(host(i + "16=50 " + i + "17=1 " + i + "13=50000 " + i + "24=$C001"), "");
  }
  ASSERT_EQ(host("I5113=5 I5120=40"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 600,10"), "");
  store({"F40 TA50 TS0", "X54 Y10", "DWELL20 I124=$1", "X20 Y20", "DWELL20", "X30"});
  EXPECT_LE(fastest(), 50 * 1.01);
  EXPECT_EQ(motors[0].trajectory, 30000LL * 3072);
  EXPECT_EQ(motors[1].trajectory, 20000LL * 3072);
}

}  // namespace
