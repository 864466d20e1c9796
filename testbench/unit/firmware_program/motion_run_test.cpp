// Run control of fixed motion programs: steps, stops, pointers, synchronous M, errors, programs that move in memory,
// several systems and tasks at once (firmware:4.3, firmware:4.9, firmware:4.10, firmware:7.9).
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_program/motion_program.h"

extern "C" bool synchronous_waits(void);

namespace {

using namespace motion_program;

TEST_F(MotionProgram, StepTakesAMoveOrABlock) {
  store(1, {"TM10TA2TS0 P1=1", "X1", "BLOCKSTART", "X2", "DWELL5", "X3", "BLOCKSTOP", "X4 DWELL5", "P2=1"});
  ASSERT_EQ(host("B1S"), "");
  for (const double end : {1.0, 3.0, 4.0}) {
    ASSERT_TRUE(finish());
    EXPECT_EQ(x(), end);
    ASSERT_EQ(host("S"), "");
  }
  ASSERT_TRUE(finish());
  EXPECT_EQ(p(2), 0.0) << "the DWELL was a step";
  ASSERT_EQ(host("S"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(p(2), 1.0);
  EXPECT_EQ(host("PC"), "P1:0");
}

TEST_F(MotionProgram, StopIsGoneOnFromByRun) {
  run({"TM10TA2TS0", "X1 STOP", "X2", "P1=1"});
  EXPECT_EQ(x(), 1.0);
  EXPECT_EQ(p(1), 0.0);
  EXPECT_EQ(host("LIST PC"), "5:X2");
  ASSERT_EQ(host("R"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 2.0);
}

TEST_F(MotionProgram, QuitAndAbortKeepTheProgramWhereItIs) {
  store(1, {"TM50TA10TS0", "WHILE(P1<6)", "P1=P1+1", "X(P1)", "ENDWHILE"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(12);
  ASSERT_EQ(p(1), 2.0) << "one move ahead";
  ASSERT_EQ(host("Q"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 2.0);
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(30);
  ASSERT_EQ(host("A"), "");
  platform::real_time();
  EXPECT_FALSE(coordinate_systems[0].active);
  const double lost = p(1);
  ASSERT_EQ(host("R"), "");
  ASSERT_TRUE(finish());
  EXPECT_GT(lost, 2.0);
  EXPECT_EQ(x(), 6.0);
  EXPECT_EQ(host("PC"), "P1:0");
}

TEST_F(MotionProgram, PointersShowProgramAndLine) {
  store(7, {"TM10TA2TS0", "X1", "DWELL100", "Y1"});
  store(1, {"P1=1", "CALL 7", "P2=1"});
  ASSERT_EQ(host("B1.0"), "");
  EXPECT_EQ(host("PC PE"), "P1:0|P1:0");
  EXPECT_EQ(host("LIST PC,2"), "0:P1=1|1:CALL7");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(9);
  EXPECT_EQ(host("PC PE"), "P1:1>P7.5|P1:1>P7.3");
  EXPECT_EQ(host("LIST PC"), "5:Y1");
  EXPECT_EQ(host("LIST PE"), "3:X1");
  ASSERT_TRUE(finish());
}

// firmware:7.2. The value is that of its place, the time that of the next move.
TEST_F(MotionProgram, SynchronousAssignmentsAreMadeWhenTheNextMoveStarts) {
  ASSERT_EQ(host("M1->X:$10F0,0,24 M2->X:$10F1,0,24 M2=12 M3->X:$10F2,0,24 M4->*"), "");
  store(1, {"TM4000TA10TS0 P1=5", "X1", "M1==P1 P1=6 M2&=6 M3|=5 M(P1-3)^=7", "X2", "M1==9"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(30);
  ASSERT_TRUE(coordinate_systems[0].next_valid);
  EXPECT_EQ(host("M1 M2 M3 P1"), "0|12|0|6") << "X2 is calculated, X1 executes";
  while (coordinate_systems[0].started < 2) {
    if (!fake_interrupts_are_on()) { EXPECT_EQ(host("M1"), "0"); }
    platform::servo_ticks(1);
  }
  platform::servo_ticks(3);
  EXPECT_EQ(host("M1 M2 M3"), "5|4|2") << "12 & 6, then 5 ^ 7";
  ASSERT_TRUE(finish());
  platform::real_time();
  EXPECT_EQ(host("M1"), "9") << "no move comes any more";
}

// One that waits for its move at a reset is made by no program behind it.
TEST_F(MotionProgram, AResetForgetsAssignmentsThatWait) {
  store(1, {"TM4000TA10TS0", "X1", "M1==5 X2"});
  store(2, {"M2==7"});
  ASSERT_EQ(host("M1->X:$10F0,0,24 M2->X:$10F1,0,24 M1=0 M2=0 SAVE B1R"), "");
  platform::servo_ticks(30);
  ASSERT_TRUE(coordinate_systems[0].next_valid);
  ASSERT_TRUE(synchronous_waits());
  platform::reset();
  EXPECT_FALSE(synchronous_waits());
  ASSERT_EQ(host("M1=0 M2=0 B2R"), "");
  ASSERT_TRUE(finish());
  platform::real_time();
  EXPECT_EQ(host("M1 M2"), "0|7");
}

// 0.875 & 1.75, 2.5 | 0.25, 2.5 ^ 0.75 (firmware:1.7/2).
TEST_F(MotionProgram, SynchronousBitOperatorsTakeTheFractionToo) {
  ASSERT_EQ(host("M1->L:$10F0 M2->L:$10F1 M3->L:$10F2 M1=.875 M2=2.5 M3=2.5"), "");
  store(1, {"TM10 TA10 TS0 X1 M1&=1.75 M2|=.25 M3^=.75"});
  ASSERT_EQ(host("B1R"), "");
  ASSERT_TRUE(finish());
  platform::real_time();
  EXPECT_EQ(host("M1..3"), "0.75|2.75|2.25");
}

TEST_F(MotionProgram, MoreSynchronousAssignmentsThanFitAreARunTimeError) {
  Lines lines(32, "M1==P1");
  store(1, lines);
  ASSERT_EQ(host("M1->X:$10F0,0,24 P1=3 B1R"), "");
  ASSERT_TRUE(finish());
  EXPECT_FALSE(error());
  platform::real_time();
  EXPECT_EQ(host("M1"), "3");
  lines.push_back("M1==P1");
  run(lines);
  EXPECT_TRUE(error());
}

TEST_F(MotionProgram, WhatCannotBeExecutedIsARunTimeError) {
  store(8, {"CALL 8"});
  for (const char* line : {"GOTO 5", "GOSUB 5", "CALL 9", "CALL 1.00005", "CALL 8", "CALL(0-1)", "CALL 0.5",
                           "GOTO(0-3)", "G1", "READ(X)", "CC1", "X1:5", "X1^5", "HOME1", "ADIS1", "TSEL1"}) {
    run({"P1=1", std::string("P2=1 ") + line, "P1=2"});
    EXPECT_TRUE(error()) << line;
    EXPECT_EQ(p(1), 1.0) << line;
    ASSERT_EQ(host("B1"), "");
  }
}

// ENDWHILE leads to the condition, not to what stands before it on its line.
TEST_F(MotionProgram, ALoopGoesBackToItsConditionAlone) {
  for (const char* before :
       {"X(P5)", "X2", "P4=0 X(P5)", "X2 F(P5)", "X2 P(P5+4)=0", "X2 P6=P5", "X(P5) M(P5)==P5", "X2 DWELL(P5)"}) {
    platform::power_up();
    ASSERT_EQ(host("M2->* P5=2"), "");
    run({"INC TM10 TA2 TS0", std::string(before) + " WHILE(P1+P4<3)", "P1=P1+1", "ENDWHILE"});
    EXPECT_EQ(p(1), 3.0) << before;
    EXPECT_EQ(x(), 2.0) << before;
    EXPECT_FALSE(error());
  }
}

TEST_F(MotionProgram, RunNeedsAProgramThatFitsTogether) {
  EXPECT_EQ(host("B1R"), "ERR015");
  store(1, {"N7 P1=1"});
  EXPECT_EQ(host("B1.00008R"), "ERR015") << "no such label";
  EXPECT_EQ(host("B1.00007R"), "");
  ASSERT_TRUE(finish());
  ASSERT_EQ(host("OPEN PROG 1"), "");
  EXPECT_EQ(host("R"), "ERR015") << "a motion buffer is open";
  ASSERT_EQ(host("IF(P1=1)"), "");
  EXPECT_EQ(host("CLOSE"), "ERR009");
  EXPECT_EQ(host("R"), "ERR015") << "it has to be pointed to again";
  EXPECT_EQ(host("B1R"), "ERR016");
}

TEST_F(MotionProgram, OpenAndPointAreRefusedWhileItRuns) {
  store(1, {"WHILE(1=1) WAIT"});
  ASSERT_EQ(host("B1R"), "");
  for (const char* line : {"OPEN PROG 1", "OPEN PROG 2", "OPEN FORWARD", "B1", "B0"})
    EXPECT_EQ(host(line), "ERR001") << line;
  ASSERT_EQ(host("&2"), "");
  EXPECT_EQ(host("OPEN PROG 2"), "ERR001");
}

// OPEN PLC turns that PLC to the top of memory, below a program that runs; also in the middle of one of its lines.
TEST_F(MotionProgram, GoesOnWhenItIsMovedInMemory) {
  ASSERT_EQ(host("OPEN PLC 3 CLEAR P90=1 P91=2 P92=(3+P4) CLOSE"), "");
  const Lines lines = {
      "WHILE(P1<40)", "P1=P1+1 P3=P3+SQRT(4)", "IF(P1%2=0)", "P2=P2+1", "ELSE", "GOSUB 9", "ENDIF", "ENDWHILE",
      "RETURN",       "N9 P4=P4+1 RET"};
  store(1, lines);
  ASSERT_EQ(host("OPEN PLC 4 CLEAR P94=1 CLOSE B1R"), "");
  unsigned turn = 0;
  std::uint32_t lowest = USER_MEMORY_WORDS, highest = 0;
  for (int i = 0; i < 200 && run_is_running(0); ++i)
    platform::real_time_in_slices([&] {
      if (++turn % 3 != 0) return;
      ASSERT_EQ(host(turn % 2 == 0 ? "OPEN PLC 3" : "OPEN PLC 4"), "");
      ASSERT_EQ(host("CLOSE"), "");
      lowest = std::min(lowest, fixed_program_find(FIXED_PROG, 1)->base);
      highest = std::max(highest, fixed_program_find(FIXED_PROG, 1)->base);
    });
  EXPECT_FALSE(run_is_running(0));
  EXPECT_FALSE(error());
  EXPECT_EQ(lowest, 0u);
  EXPECT_EQ(host("P1 P2 P3 P4"), "40|20|80|20");
}

// A word each: what another system has to calculate does not hold up the next move of this one.
TEST_F(MotionProgram, SystemsTakeTurns) {
  store(1, Lines(32, "P1=P1+1"));
  store(2, {"TM10TA2TS0", "X1", "X2"});
  ASSERT_EQ(host("&1B1R&2B2R"), "");
  unsigned pauses = 0, waited = 0;
  platform::real_time_in_slices([&] {
    ++pauses;
    if (!coordinate_systems[1].next_valid) ++waited;
  });
  EXPECT_GT(pauses, 100u) << "four words a line";
  EXPECT_LT(waited, 40u) << "its own words and the planning of its move";
}

TEST_F(MotionProgram, SavedProgramsRunAfterAReset) {
  store(1, {"P1=P1+5", "IF(P1>100)", "P2=1", "ENDIF"});
  ASSERT_EQ(host("SAVE"), "");
  platform::reset();
  EXPECT_EQ(host("R"), "ERR015") << "B comes first";
  ASSERT_EQ(host("B1R"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(p(1), 5.0);
}

TEST_F(MotionProgram, RotaryLinesCallFixedPrograms) {
  store(1000, {"N2000 READ(P) P1=P1+1 Y(Q116) RET"});
  ASSERT_EQ(host("DEF ROT 100 B0 OPEN ROT"), "");
  for (const char* line : {"TM10TA2TS0", "G2P7X1", "G2P(3*3)", "X2"}) ASSERT_EQ(host(line), "");
  EXPECT_EQ(host("PR"), "4");
  ASSERT_EQ(host("CLOSE R"), "");
  platform::servo_ticks(300);
  EXPECT_EQ(p(1), 2.0);
  EXPECT_EQ(x(), 2.0);
  EXPECT_EQ(coordinate_systems[0].position[AXIS_Y], 9.0);
  EXPECT_EQ(host("PR"), "0");
  EXPECT_FALSE(error());
  ASSERT_EQ(host("OPEN ROT G3"), "");
  platform::servo_ticks(6);
  EXPECT_TRUE(error());
  EXPECT_EQ(host("PR"), "0") << "the line goes";
}

// A line that was begun is lost, whatever was pointed to before its buffer is again.
TEST_F(MotionProgram, RotaryBufferGoesOnWithAWholeLineAfterAnAbort) {
  store(2, {"WHILE(P1=P1)", "ENDWHILE"});
  store(3, {"P9=1"});
  for (const std::string other : {"", "B3"}) {
    ASSERT_EQ(host("DEL ROT"), "");
    ASSERT_EQ(host("DEF ROT 200 B0 OPEN ROT"), "");
    ASSERT_EQ(host("CALL2 P5=1"), "");
    ASSERT_EQ(host("P6=P6+1"), "");
    ASSERT_EQ(host("CLOSE P5=0 P6=0 R"), "");
    platform::servo_ticks(9);
    ASSERT_TRUE(run_is_running(0));
    ASSERT_EQ(host("A"), "");
    ASSERT_EQ(host(other), "");
    platform::servo_ticks(9);  // it settles
    ASSERT_EQ(host("B0"), "");
    ASSERT_EQ(host("R"), "");
    platform::servo_ticks(9);
    EXPECT_EQ(p(5), 0.0) << other;
    EXPECT_EQ(p(6), 1.0) << other;
    ASSERT_EQ(host("A"), "");
    platform::servo_ticks(9);
  }
}

TEST_F(MotionProgram, QuitStopsAStatementThatWaitsForRoom) {
  const std::string text(200, 'x');
  Lines lines(8, "P2=1SEND\"" + text + "\"");  // more than the queue holds
  lines.emplace_back("P1=1");
  store(1, lines);
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(9);  // the background does not run
  ASSERT_TRUE(run_is_running(0));
  run_quit(0);
  platform::servo_ticks(9);  // the word under way has its pauses, and interrupts in them
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(p(1), 0.0);
  EXPECT_EQ(host("R").find("ERR"), std::string::npos);
  for (unsigned i = 0; i < 40 && run_is_running(0); ++i) {
    platform::servo_ticks(3);
    platform::background(3);
  }
  EXPECT_EQ(p(1), 1.0);
  EXPECT_FALSE(error());
}

// I62 = 1: what a PLC has put together so far is not part of a command of a motion program.
TEST_F(MotionProgram, CommandsInPartsAreThoseOfTheirTask) {
  ASSERT_EQ(host("OPEN PLC 1 CLEAR"), "");
  for (const char* line : {"CMD\"P11=\"", "WHILE(P3=0)", "ENDWHILE", "CMD\"7\"", "CMD^M", "DISABLE PLC 1"})
    ASSERT_EQ(host(line), "") << line;
  ASSERT_EQ(host("CLOSE P3=0 P11=0 P12=0 I62=1 I5=2 ENABLE PLC 1"), "");
  platform::background(4);
  run({"CMD\"P12=\"", "CMD\"5\"", "CMD^M"});
  platform::background(8);
  EXPECT_EQ(p(12), 5.0);
  EXPECT_EQ(p(11), 0.0);
  ASSERT_EQ(host("P3=1"), "");
  platform::background(12);
  EXPECT_EQ(p(11), 7.0);
}

// Programs that move while a called one is looked through for its blocks or a label: the call is made later.
TEST_F(MotionProgram, CallsAndJumpsWaitWhileProgramsMove) {
  ASSERT_EQ(host("OPEN PLC 3 CLEAR P2=0 CLOSE"), "");
  Lines called(30, "P1=P1+1");
  called.insert(called.begin(), "GOTO7");
  called.emplace_back("N7P3=P3+1");
  store(2, called);
  store(1, {"CALL2", "P4=1"});
  ASSERT_EQ(host("B1R"), "");
  bool moved = false;
  const std::uint32_t before = fixed_programs_generation();
  unsigned looks = 0;
  platform::real_time_in_slices([&] {
    if (++looks != 12) return;
    EXPECT_EQ(host("OPEN PLC 3"), "");
    EXPECT_EQ(host("CLOSE"), "");
    moved = fixed_programs_generation() != before;
  });
  ASSERT_TRUE(moved);
  EXPECT_FALSE(error());
  ASSERT_TRUE(finish());
  EXPECT_EQ(p(1), 0.0);
  EXPECT_EQ(p(3), 1.0);
  EXPECT_EQ(p(4), 1.0);
  EXPECT_FALSE(error());
}

TEST_F(MotionProgram, ControlsPlcs) {
  ASSERT_EQ(host("OPEN PLC 3 CLEAR P90=1 CLOSE OPEN PLC 4 CLEAR P91=1 CLOSE ENABLE PLC 4"), "");
  run({"ENABLE PLC 3", "DISABLE PLC 4", "P1=1"});
  EXPECT_FALSE(error());
  EXPECT_EQ(plc_enabled() >> 3 & 3u, 1u);
}

// firmware:7.2/1: fifteen calls in each other, and not one more.
TEST_F(MotionProgram, FifteenCallsStandInEachOther) {
  for (int n = 1; n <= 16; ++n)
    store(n, {"P1=" + std::to_string(n), n < 16 ? "CALL" + std::to_string(n + 1) : "P2=P2+1"});
  ASSERT_EQ(host("B1R"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(p(2), 1.0);
  EXPECT_EQ(host("??").substr(6, 1), "0") << "no run-time error";
  store(16, {"P1=16 CALL17"});
  store(17, {"P1=17"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(60);
  EXPECT_EQ(p(1), 16.0);
  EXPECT_EQ(host("??").substr(6, 1), "4") << "run-time error, bit 22";
}

}  // namespace
