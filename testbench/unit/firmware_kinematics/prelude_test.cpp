// PRELUDE (motion:8.4): a call before each line that begins with a move.
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/motion_program.h"

namespace {

using motion_program::Lines;
using motion_program::MotionProgram;
using platform::host;

class Prelude : public MotionProgram {
 protected:
  void SetUp() override {
    MotionProgram::SetUp();
    ASSERT_EQ(host("P0..20=0 I5187=1 I5188=0"), "");
  }
};

TEST_F(Prelude, ComesBeforeEachMove) {
  store(500, {"P1=P1+1", "RETURN"});
  run({"F1000", "X1", "PRELUDE1 CALL500", "X2", "P2=P1", "Y3 X4", "PRELUDE0", "X5"});
  EXPECT_EQ(p(1), 2);
  EXPECT_EQ(p(2), 1) << "lines without a move have none";
  EXPECT_EQ(x(), 5);
}

// Of arcs too: I, J, K and R may come first.
TEST_F(Prelude, ComesBeforeLinesThatBeginWithAnArcVector) {
  store(500, {"P1=P1+1", "RETURN"});
  const char* lines[] = {"N1 I1 X1", "J1 X2", "K1 X3", "R1 X4"};
  for (const char* line : lines) {
    SCOPED_TRACE(line);
    ASSERT_EQ(host("P1=0"), "");
    run({"F1000", "CIRCLE1", "PRELUDE1 CALL500", line});
    EXPECT_EQ(p(1), 1);
  }
}

TEST_F(Prelude, ReadTakesTheMove) {
  store(500, {"READ(X,Y)", "X(Q124*2)", "P1=Q100", "RETURN"});
  run({"F1000", "PRELUDE1 CALL500", "X3 Y4", "P9=1"});
  EXPECT_EQ(x(), 6) << "the move within is executed as it stands";
  EXPECT_EQ(p(1), (1 << 23) + (1 << 24));
  EXPECT_EQ(coordinate_systems[0].position[AXIS_Y], 0) << "what was read is not executed";
  EXPECT_EQ(p(9), 1);
}

TEST_F(Prelude, WhatIsNotReadIsExecuted) {
  store(500, {"READ(X)", "P1=Q124", "RETURN"});
  run({"F1000", "PRELUDE1 CALL500", "X3 Y4"});
  EXPECT_EQ(p(1), 3);
  EXPECT_EQ(x(), 0);
  EXPECT_EQ(coordinate_systems[0].position[AXIS_Y], 4);
}

TEST_F(Prelude, ByLabelsAndCodes) {
  store(500, {"N100 P1=P1+1", "RETURN", "N200 P2=P2+1", "RETURN"});
  store(1000, {"N5000 P3=P3+1", "RETURN"});
  store(1001, {"N6000 P4=P4+1", "RETURN"});
  run({"F1000 P5=500.001", "PRELUDE1 CALL(P5)", "P5=7", "X0", "PRELUDE1 CALL500.002", "X1", "PRELUDE1 G5", "X2",
       "PRELUDE1M6", "X3"});
  EXPECT_EQ(p(1), 1);
  EXPECT_EQ(p(2), 1);
  EXPECT_EQ(p(3), 1);
  EXPECT_EQ(p(4), 1) << "each supersedes the one before";
}

// A call that fails stops the program, behind a label too; a stop needs no end of the line.
TEST_F(Prelude, ACallThatFailsBehindALabelStops) {
  store(1, {"F1000", "PRELUDE1 CALL501", "N10 X1"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(30);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(host("RY$2014"), "2");
}

TEST_F(Prelude, BehindALabelOnly) {
  store(500, {"P1=P1+1", "RETURN"});
  run({"F1000", "PRELUDE1 CALL500", "N10 X1", "N20N30 X2", "P2=1 X3", "IF(P2=1) X4", "LINEAR X5"});
  EXPECT_EQ(p(1), 2) << "behind something else the move has none";
  ASSERT_EQ(host("P1=0 M1->*"), "");
  std::string plcs = "DISABLEPLC";  // their mask is the number of the statement N
  for (unsigned n = 0; n < 32; ++n)
    if ((static_cast<unsigned>(KEY_N) >> n & 1u) != 0) plcs += (plcs.back() == 'C' ? "" : ",") + std::to_string(n);
  for (const std::string& other : Lines{plcs, "S5", "N40 S5", "S5 N40", "N40 P2=1", "F900", "N40 F900", "M1==1", "WAIT",
                                        "BLOCKSTART", "SEND\"\"", "N40 ABS", "ENABLEPLC1", "P2=1 N40"}) {
    run({"F1000", "PRELUDE1 CALL500", other + " X2", "X5"});
    EXPECT_EQ(p(1), 1) << other;
    EXPECT_EQ(x(), 5);
    ASSERT_EQ(host("P1=0"), "");
  }
  EXPECT_EQ(x(), 5);
}

TEST_F(Prelude, ExpressionsAndLoops) {
  store(500, {"READ(X)", "P1=P1+Q124", "RETURN"});
  run({"F1000", "PRELUDE1 CALL500", "WHILE(P2<5)", "P2=P2+1", "X(P2*10)", "ENDWHILE"});
  EXPECT_EQ(p(1), 150);
}

TEST_F(Prelude, NotWithinCalls) {
  store(500, {"P1=P1+1", "X7", "RETURN"});
  store(600, {"X9", "RETURN"});
  run({"F1000", "PRELUDE1 CALL500", "CALL600", "GOSUB50", "GOTO60", "N50 X3", "RETURN", "N60 X1"});
  EXPECT_EQ(p(1), 1);
  EXPECT_EQ(x(), 1);
}

TEST_F(Prelude, EndsWithTheProgram) {
  store(500, {"P1=P1+1", "RETURN"});
  run({"F1000", "PRELUDE1 CALL500", "X1"});
  EXPECT_EQ(p(1), 1);
  ASSERT_EQ(host("R"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(p(1), 2);
  run({"F1000", "X2"});
  EXPECT_EQ(p(1), 2);
}

TEST_F(Prelude, InARotaryBuffer) {
  store(500, {"READ(X)", "P1=P1+Q124", "RETURN"});
  ASSERT_EQ(host("&1DEFINE ROT 200 B0"), "");
  ASSERT_EQ(host("OPEN ROT P3=5"), "");
  for (const char* line : {"F1000", "PRELUDE1 CALL500", "X1", "X(P3*2) Y2", "PRELUDE0", "X4"})
    ASSERT_EQ(host(line), "") << line;
  ASSERT_EQ(host("CLOSE R"), "");
  platform::servo_ticks(3000);
  EXPECT_EQ(p(1), 11);
  EXPECT_EQ(x(), 4);
  EXPECT_EQ(coordinate_systems[0].position[AXIS_Y], 2);
  EXPECT_FALSE(error());
}

TEST_F(Prelude, WhatIsNoCallIsARunTimeError) {
  for (const char* line : {"PRELUDE1", "PRELUDE1 X1", "PRELUDE2 CALL500", "PRELUDE1 GOSUB5", "PRELUDE1 GOTO5"}) {
    SCOPED_TRACE(line);
    run({"F1000", line, "X1"});
    EXPECT_TRUE(error());
    EXPECT_EQ(coordinate_systems[0].error, RUN_TIME_STATEMENT);
  }
  run({"F1000", "PRELUDE1 CALL501", "X1"});
  EXPECT_EQ(coordinate_systems[0].error, RUN_TIME_PROGRAM) << "at the move, when the program is not there";
  EXPECT_EQ(x(), 0);
}

// Programs are moved in the middle of anything: each line has its call all the same, behind its labels too.
TEST_F(Prelude, WhileProgramsAreMoved) {
  unsigned moved = 0;
  for (unsigned slices = 1; slices < 300; ++slices) {
    SCOPED_TRACE(slices);
    platform::power_up();
    store(500, {"P3=3", "N20 P1=P1+1", "RETURN"});
    store(1, {"F1000", "P1=0", "PRELUDE1 CALL500.0002", "N10N11 X1", "Y(1+1)", "P2=1"});
    ASSERT_EQ(host("P1=0 P2=0 B1R"), "");
    fake_hal_on_pause([] {});
    fake_hal_slices_leave(true);
    for (unsigned i = 0; i < slices && p(2) == 0; ++i) fake_task_run_real_time();
    const bool over = p(2) != 0;
    const unsigned before = fixed_programs_generation();
    ASSERT_EQ(host("OPEN PLC 5 CLEAR P9=1 CLOSE"), "");
    moved += fixed_programs_generation() != before ? 1u : 0u;
    fake_hal_slices_leave(false);
    fake_hal_on_pause(nullptr);
    ASSERT_TRUE(finish());
    ASSERT_FALSE(error());
    ASSERT_EQ(p(1), 2);
    if (over) break;
  }
  EXPECT_GT(moved, 20u);
}

// Before its line has begun: PE shows that line, and an error leaves the program at it.
TEST_F(Prelude, TheCallIsOfTheLineThatItStandsBefore) {
  store(500, {"DWELL1000", "RETURN"});
  store(1, {"F1000", "PRELUDE1 CALL500", "N7", "X1"});
  ASSERT_EQ(host("B1.00007"), "");
  const std::string label = host("PC");
  ASSERT_EQ(label.substr(0, 3), "P1:");
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(30);
  const std::string line = "P1:" + std::to_string(std::stoi(label.substr(3)) + 1);
  EXPECT_EQ(host("PE"), line + ">P500.0");
  ASSERT_EQ(host("A"), "");
  platform::servo_ticks(30);
  store(1, {"F1000", "PRELUDE1 CALL501", "N7", "X1"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(30);
  EXPECT_EQ(coordinate_systems[0].error, RUN_TIME_PROGRAM);
  EXPECT_EQ(host("PC"), line) << "R begins there";
}

TEST_F(Prelude, AStepIsTheLineWithIt) {
  store(500, {"P1=P1+1", "RETURN"});
  store(1, {"F1000", "PRELUDE1 CALL500", "X1", "X2"});
  ASSERT_EQ(host("B1S"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 1);
  EXPECT_EQ(p(1), 1);
}

}  // namespace
