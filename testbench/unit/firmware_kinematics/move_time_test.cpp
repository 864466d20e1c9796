// MOVETIME (motion:8.3): the timer Isx11 counts down to the end of the next move.
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class MoveTime : public MovingMotors {
 protected:
  // ms before the end of the first move (from rest) at which I5111 reaches 0; -1: it never was above 0.
  static double left_at_zero(const Lines& lines, double length) {
    store(lines);
    double zero = -1;
    bool counted = false;
    run([&](double t) {
      const double value = std::stod(host("I5111"));
      counted = counted || value > 0;
      if (counted && value <= 0 && zero < 0) zero = t;
    });
    return counted ? length - zero : -1;
  }
  void SetUp() override {
    MovingMotors::SetUp();
    fit({"1000X"});
  }
};

constexpr double kSlack = 4 * kTickMs;  // the real-time task comes every third servo interrupt

TEST_F(MoveTime, ReachesZeroIsxFourteenBehindTheEnd) {
  for (const double ahead : {-20.0, -0.5, 30.0}) {
    SCOPED_TRACE(ahead);
    ASSERT_EQ(host("I5114=" + std::to_string(ahead) + " I5111=0"), "");
    EXPECT_NEAR(left_at_zero({"TM100 TA40 TS10", "MOVETIME X1", "DWELL100", "X0"}, 140), -ahead, kSlack);
  }
}

TEST_F(MoveTime, ZeroIsOff) {
  ASSERT_EQ(host("I5114=0"), "");
  EXPECT_EQ(left_at_zero({"TM100 TA40 TS10", "MOVETIME X1"}, 140), -1);
}

TEST_F(MoveTime, OfTheNextMoveOnly) {
  ASSERT_EQ(host("I5114=-1"), "");
  EXPECT_NEAR(left_at_zero({"TM100 TA40 TS10", "MVTM", "P1=1", "X1", "DWELL200", "X2", "DWELL200"}, 140), 1, kSlack);
  store({"TM100 TA40 TS10", "MVTM", "P1=1", "X1", "DWELL200", "X2", "DWELL200"});
  unsigned loads = 0;
  double before = 0;
  ASSERT_EQ(host("I5111=0"), "");
  run([&](double) {
    const double value = std::stod(host("I5111"));
    loads += value > before ? 1u : 0u;
    before = value;
  });
  EXPECT_EQ(loads, 1u) << "the second one does not load it";
}

TEST_F(MoveTime, InEachMode) {
  ASSERT_EQ(host("I5114=-1 I5113=10"), "");
  EXPECT_NEAR(left_at_zero({"TM100 TA40 TS10", "X1 MOVETIME", "DWELL100"}, 140), 1, kSlack) << "in segments";
  ASSERT_EQ(host("I5113=0"), "");
  EXPECT_NEAR(left_at_zero({"PVT120", "MOVETIME X2:0", "DWELL100"}, 120), 1, kSlack);
  ASSERT_EQ(host("I5114=30"), "");
  EXPECT_EQ(left_at_zero({"RAPID", "MOVETIME X3"}, 0), -1) << "nobody knows how long";
  EXPECT_EQ(at(1), 3000);
}

// A move of another kind that is calculated while segments execute: its own time, not that of the path.
TEST_F(MoveTime, BehindAPathInSegments) {
  ASSERT_EQ(host("I5114=-1 I5113=10 I5111=0"), "");
  store({"TM300 TA40 TS10", "X1", "MOVETIME PVT150", "X2:0"});
  double most = 0, begins = -1;
  const double end = run([&](double t) {
    const double value = std::stod(host("I5111"));
    if (value > most) most = value, begins = t;
  });
  EXPECT_NEAR(most * kTickMs, 149, 4 * kSlack);
  EXPECT_NEAR(end - begins, 150, 4 * kSlack);
}

// motion:8.3/1: a DWELL is no move, a DELAY is one; in segments and without.
TEST_F(MoveTime, ADwellIsNoMove) {
  for (const char* isx13 : {"0", "10"}) {
    SCOPED_TRACE(isx13);
    ASSERT_EQ(host(std::string("I5114=-1 I5111=0 I5113=") + isx13), "");
    store({"TM100 TA40 TS10", "MOVETIME DWELL50", "DWELL30", "INC X1", "DWELL200"});
    double begins = -1, most = 0;
    run([&](double t) {
      const double value = std::stod(host("I5111"));
      if (value > 0 && begins < 0) begins = t;
      most = std::max(most, value);
    });
    EXPECT_GE(begins, 80 - kSlack);
    EXPECT_NEAR(most * kTickMs, 139, kSlack);
    ASSERT_EQ(host("I5111=0"), "");
    EXPECT_NEAR(left_at_zero({"TM100 TA40 TS10", "MOVETIME DELAY100", "DWELL200"}, 140), 1, 2 * kSlack);
  }
}

// motion:8.3/3
TEST_F(MoveTime, WithoutASlotInLookaheadItIsLostAndSaidSo) {
  ASSERT_EQ(host("DELETE GATHER I5114=-1 I5113=10 I5120=60 I116=100 I117=1"), "");
  for (const bool slot : {true, false, true}) {
    ASSERT_EQ(host(std::string("&1DEFINE LOOKAHEAD 300,") + (slot ? "1" : "0")), "");
    ASSERT_EQ(host("I5111=0"), "");
    store({"TM100 TA40 TS10 INC", "MOVETIME X1"});
    double most = 0;
    run([&](double) { most = std::max(most, std::stod(host("I5111"))); });
    EXPECT_EQ(most > 0, slot);
    EXPECT_EQ(motion_cs_status(0, 2) >> 19 & 1u, slot ? 0u : 1u);
    ASSERT_EQ(host("DELETE LOOKAHEAD"), "");
  }
}

// motion:8.3/1: of 140 ms of the program, at half its rate too.
TEST_F(MoveTime, CyclesAreThoseOf100Percent) {
  ASSERT_EQ(host("I5114=-1 I5111=0 I5194=8388607"), "");
  ASSERT_EQ(host("&1%50"), "");
  platform::servo_ticks(10);
  store({"TM100 TA40 TS10", "MOVETIME X1"});
  double most = 0;
  EXPECT_NEAR(run([&](double) { most = std::max(most, std::stod(host("I5111"))); }), 280, kSlack);
  EXPECT_NEAR(most * kTickMs, 139, kSlack);
}

TEST_F(MoveTime, LongerThanNothingAtAll) {
  ASSERT_EQ(host("I5114=-500 I5111=77"), "");
  store({"TM100 TA40 TS10", "MOVETIME X1"});
  run();
  EXPECT_LE(std::stod(host("I5111")), 0);
}

// A timer has 24 bits, a move up to 2^23 ms.
TEST_F(MoveTime, LongerThanATimer) {
  for (const auto& [isx14, i10] : {std::pair{"1", "3713991"}, {"8388607", "1000"}}) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I5111=77 I5114=") + isx14 + " I10=" + i10 + " %100"), "");
    store({"TM5000000 TA20 TS0", "MOVETIME X1"});
    ASSERT_EQ(host("&1B1R"), "");
    for (int i = 0; i < 1000 && !cs().active; ++i) platform::servo_ticks(1);
    platform::servo_ticks(3);
    EXPECT_NEAR(std::stod(host("I5111")), 8388607, 10);
  }
}

// One that has asked for the time of its next move and is left for another program has asked for none of that one.
TEST_F(MoveTime, OfTheProgramThatAsksForIt) {
  store({"MOVETIME P1=1 WHILE(P2=0) WAIT", "X1"});
  store({"TM100 TA40 TS10 X1", "DWELL100"}, 2);
  ASSERT_EQ(host("I5114=-1 I5111=0 P2=0 B1R"), "");
  platform::servo_ticks(30);
  ASSERT_EQ(host("A"), "");
  platform::servo_ticks(30);
  double most = 0;
  run([&](double) { most = std::max(most, std::stod(host("I5111"))); }, "B2R");
  EXPECT_EQ(most, 0);
  EXPECT_EQ(at(1), 1000);
}

}  // namespace
