// What a program stops by itself for, its STOP or a run-time error, is calculated ahead of the moves before it: no
// start that comes while those execute, or wait behind a stop, goes on behind it (motion:5.6/6).
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class OwnStops : public MovingMotors {
 protected:
  void begin(const std::string& prepare) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I115=1 I119=1 I120=20 I121=0 I192=1 I116=50 I117=1 I5195=200000 P11=0 DELETE GATHER"), "");
    ASSERT_EQ(host("&1 DEFINE LOOKAHEAD 300,10 " + prepare), "");
  }
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
  // 100 ms apart from each other, beginning 100 ms behind the start.
  static void orders(const Lines& lines) {
    for (const std::string& order : lines) {
      ticks(100);
      ASSERT_EQ(host(order), "") << order;
    }
  }
  static void stands_at(double counts) {
    for (int i = 0; i < 100 && run_is_running(0); ++i) ticks(20);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(motors[0].trajectory, std::llround(counts * kUnit));
  }
  static std::string number() { return host("RY$2014"); }
};

constexpr const char* kWays[] = {"I5113=0", "I5113=5", "I5113=5 I5120=40"};
const Lines kOrders[] = {{"R"}, {"H", "R"}, {"\\", "R"}, {"\\", ">"}, {"Q", "R"}, {"/", "R"}, {"S", "R"}};

TEST_F(OwnStops, StopHoldsWhateverStartsComeBeforeIt) {
  for (const char* way : kWays)
    for (const Lines& between : kOrders) {
      SCOPED_TRACE(way + (" " + between.front()) + " " + between.back());
      begin(way);
      store({"LINEAR TM500 TA20 TS0 X1", "P11=1", "STOP", "P11=2", "X2", "X3"});
      ASSERT_EQ(host("B1R"), "");
      orders(between);
      stands_at(1000);
      EXPECT_EQ(p_variable_read(11), 1.0);
      ASSERT_EQ(host("R"), "") << "at the STOP it goes on";
      stands_at(3000);
      EXPECT_EQ(p_variable_read(11), 2.0);
    }
}

// Of a rotary buffer the line in error goes: nothing would tell of it any more.
TEST_F(OwnStops, ARunTimeErrorIsNotForgottenBeforeItsPlace) {
  for (const char* way : kWays)
    for (const Lines& between : kOrders) {
      SCOPED_TRACE(way + (" " + between.front()) + " " + between.back());
      begin(way);
      ASSERT_EQ(host("DEFINE ROT 100 B0 OPEN ROT"), "");
      for (const char* line : {"LINEAR TM500 TA20 TS0 X1", "CC1", "X2", "CLOSE R"}) ASSERT_EQ(host(line), "") << line;
      ticks(50);
      ASSERT_EQ(number(), "1") << "found ahead";
      orders(between);
      EXPECT_EQ(number(), "1");
      stands_at(1000);
      EXPECT_EQ(number(), "1");
      ASSERT_EQ(host("R"), "");
      EXPECT_EQ(number(), "0");
      ticks(600);
      EXPECT_EQ(motors[0].trajectory, std::llround(2000 * kUnit));
    }
}

// A hold that slows down for so long that the moves before it are over: R ends the hold, and is no start behind it.
TEST_F(OwnStops, AHoldThatEndsThereIsEndedAlone) {
  const struct {
    const char *line, *number;
    double ends;
  } stops[] = {{"STOP", "0", 2000}, {"CC1", "1", 1000}, {"RETURN", "0", 1000}};
  for (const auto& stop : stops)
    for (const char* start : {"R", ">", "S"}) {
      SCOPED_TRACE(stop.line + std::string(start));
      begin("I5195=1644");  // a second, half of it of trajectory time
      store({"P11=P11+1", "LINEAR TM300 TA20 TS0 X1", stop.line, "X2"});
      ASSERT_EQ(host("B1R"), "");
      orders({"H"});
      ticks(1200);
      EXPECT_FALSE(run_is_running(0));
      EXPECT_EQ(host("%"), "0");
      ASSERT_EQ(host(start), "");
      stands_at(1000);
      EXPECT_EQ(number(), stop.number);
      ticks(1200);
      EXPECT_EQ(host("%"), "100");
      stands_at(1000);
      EXPECT_EQ(p_variable_read(11), 1.0);
      ASSERT_EQ(host("R"), "");
      stands_at(stop.ends);
      EXPECT_EQ(p_variable_read(11), stop.line[0] == 'R' ? 2.0 : 1.0) << "behind its end from the top";
    }
}

// Another program is another start.
TEST_F(OwnStops, AHoldIsEndedByTheStartOfAnotherProgram) {
  begin("I5195=1644");
  store({"LINEAR TM300 TA20 TS0 X1", "STOP", "X2"});
  store({"X3"}, 2);
  ASSERT_EQ(host("B1R"), "");
  orders({"H"});
  ticks(1200);
  ASSERT_EQ(host("B2R"), "");
  ticks(2000);
  stands_at(3000);
}

// What stands behind it on its line too: a move, an assignment.
TEST_F(OwnStops, TheRestOfTheLineOfAStopIsForAnotherStart) {
  begin("I5113=0");
  store({"LINEAR TM100 TA20 TS0 X1", "P11=1 STOP P11=2 X2", "X3"});
  ASSERT_EQ(host("B1R"), "");
  stands_at(1000);
  EXPECT_EQ(p_variable_read(11), 1.0);
  ASSERT_EQ(host("R"), "");
  stands_at(3000);
  EXPECT_EQ(p_variable_read(11), 2.0);
}

// Behind a BLOCKSTOP the same in a step; a run goes on.
TEST_F(OwnStops, TheRestOfTheLineOfABlockIsForAnotherStep) {
  for (const char* way : {"I5113=0", "I5113=5", "I5113=0 I5153=1"})
    for (const char* start : {"S", "R"}) {
      SCOPED_TRACE(way + std::string(start));
      begin(way);
      store({"LINEAR TM100 TA20 TS0", "BLOCKSTART X1 X2 BLOCKSTOP P11=1 X3", "BLOCKSTOP P11=2 X4"});
      ASSERT_EQ(host("B1"), "");
      if (way[std::string(way).size() - 1] == '1' && *start == 'S') {
        ASSERT_EQ(host("S"), "");
        stands_at(0);
      }
      ASSERT_EQ(host(start), "");
      if (*start == 'S') {
        stands_at(2000);
        EXPECT_EQ(p_variable_read(11), 0.0);
        ASSERT_EQ(host("S"), "");
        stands_at(3000);
        EXPECT_EQ(p_variable_read(11), 1.0);
        ASSERT_EQ(host("S"), "");
      }
      stands_at(4000);
      EXPECT_EQ(p_variable_read(11), 2.0);
    }
}

// Moves that Q has left between it and the STOP are made first, by steps too.
TEST_F(OwnStops, StopHoldsBehindMovesThatWait) {
  for (const char* start : {"R", "S"}) {
    begin("I5113=5");
    store({"LINEAR TM100 TA20 TS0 X1", "X2", "X3", "STOP", "P11=1 X4"});
    ASSERT_EQ(host("B1R"), "");
    ticks(30);
    ASSERT_EQ(host("Q"), "");
    stands_at(1000);
    if (*start == 'S') {
      ASSERT_EQ(host("S"), "");
      stands_at(2000);
    }
    ASSERT_EQ(host(start), "");
    stands_at(3000);
    EXPECT_EQ(p_variable_read(11), 0.0);
    ASSERT_EQ(host(start), "");
    stands_at(4000);
    EXPECT_EQ(p_variable_read(11), 1.0);
  }
}

// A start that has not yet taken its motors, which stand where a jog has left them, is one already.
TEST_F(OwnStops, AStartBehindAStopRightBehindAStartIsNotRefused) {
  begin("I122=50");
  store({"LINEAR TM30 TA20 TS0 X1"});
  ASSERT_EQ(host("#1J:300"), "");
  ticks(100);
  for (const char* again : {"R", ">"}) {
    ASSERT_EQ(host("B1R"), "");
    ASSERT_EQ(host("Q"), "");
    EXPECT_EQ(host(again), "") << again;
    stands_at(1000);
    ASSERT_EQ(host("#1J:-200"), "");
    ticks(100);
  }
}

// motion:5.6/4: what a program moves itself is nowhere to come back from, at no servo interrupt, in whichever mode.
TEST_F(OwnStops, AStartBehindAStopOfWhatStillMovesIsNeverRefused) {
  const Lines programs[] = {{"RAPID X1", "X2", "X1.5"},
                            {"LINEAR TM30 TA20 TS0 X1", "RAPID X2", "LINEAR X1", "DWELL10"},
                            {"HOMEZ1", "RAPID X1", "HOMEZ1", "RAPID X1"}};
  for (const Lines& lines : programs)
    for (const char* stop : {"Q", "/", "S"}) {
      SCOPED_TRACE(lines.front() + " " + stop);
      begin("I122=50 I119=1");
      store(lines);
      ASSERT_EQ(host("B1R"), "");
      unsigned starts = 0;
      for (unsigned i = 0; i < 2000 && !HasFailure(); ++i) {
        platform::servo_ticks(1);
        if (!run_is_running(0)) break;
        ASSERT_EQ(host(stop), "");
        ASSERT_EQ(host("R"), "") << i;
        ++starts;
      }
      EXPECT_GT(starts, 100u);
      EXPECT_FALSE(run_is_running(0));
      EXPECT_EQ(number(), "0");
    }
}

// Bits 5 and 2 of word 3, a dwell at a corner and a start that was refused: an abort ends the one, an error that stops
// the program the other.
TEST_F(OwnStops, WhatAProgramStoodForIsOverWithIt) {
  const auto word3 = [] { return static_cast<unsigned>(std::stoul(host("??").substr(12, 6), nullptr, 16)); };
  begin("I5192=1 I5182=1000");
  store({"LINEAR TM30 TA20 TS0 X1", "X2"});
  ASSERT_EQ(host("B1R"), "");
  ticks(100);
  ASSERT_EQ(word3() >> 5 & 1u, 1u);
  ASSERT_EQ(host("A"), "");
  ticks(20);
  EXPECT_EQ(word3() >> 5 & 1u, 0u);

  begin("I122=50");
  store({"LINEAR TM500 TA20 TS0 X1"});
  ASSERT_EQ(host("B1R"), "");
  orders({"H"});
  ticks(100);
  ASSERT_EQ(host("#1J:50"), "");
  ticks(100);
  ASSERT_EQ(host("R"), "ERR017");
  ASSERT_EQ(word3() >> 2 & 1u, 1u);
  ASSERT_EQ(host("WY$203F,$400000"), "");
  ticks(50);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(number(), "13");
  EXPECT_EQ(word3() >> 2 & 1u, 0u);
  EXPECT_EQ(host("R"), "") << "there is no way back";
}

// A PVT move that ends in motion is ramped to rest behind the end of its program: the next start begins from rest.
TEST_F(OwnStops, ASpeedEndsWithItsProgram) {
  begin("I5190=1");
  store({"PVT100 X1:0.02"});
  store({"PVT100 X3:0"}, 2);
  ASSERT_EQ(host("B1R"), "");
  ticks(500);
  ASSERT_FALSE(run_is_running(0));
  ASSERT_EQ(host("B2R"), "");
  for (int i = 0; i < 100 && !cs().active; ++i) platform::servo_ticks(1);
  ASSERT_TRUE(cs().active);
  EXPECT_EQ(cs().moves[cs().executing].knots[0].velocity[AXIS_X], 0.0);
  ticks(500);
  EXPECT_EQ(motors[0].trajectory, std::llround(3000 * kUnit));
}

}  // namespace
