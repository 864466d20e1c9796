// Statements of fixed motion programs: logic, loops, jumps, calls, letter codes, what limits them at an interrupt
// (firmware:7.2, firmware:7.3, firmware:7.9).
#include "testbench/unit/firmware_program/motion_program.h"

namespace {

using namespace motion_program;

TEST_F(MotionProgram, StatementsInSequenceThenItStopsAtItsTop) {
  run({"P1=3 P2=P1*2", "TM10 TA2 TS0", "X(P2)", "INC X2", "ABS Y4", "P(P1)=P(P1)+Q1+1"});
  EXPECT_EQ(p(2), 6.0);
  EXPECT_EQ(x(), 8.0);
  EXPECT_EQ(coordinate_systems[0].position[AXIS_Y], 4.0);
  EXPECT_EQ(p(3), 1.0);
  EXPECT_FALSE(error());
  EXPECT_EQ(host("PC"), "P1:0");
  ASSERT_EQ(host("R"), "") << "once more";
  ASSERT_TRUE(finish());
  EXPECT_EQ(p(3), 2.0);
}

TEST_F(MotionProgram, OneLineIfAndElse) {
  run({"P1=1", "IF(P1=1) P2=1 P3=1", "ELSE P2=2", "IF(P1=2) P4=1 P5=1", "ELSE P4=2", "P6=1", "IF(P1=1)",
       "IF(P1=7) P7=1", "ELSE IF(P1=1) P7=2", "ELSE P7=3", "P8=1", "ELSE P8=2", "P9=1"});
  EXPECT_EQ(p(2), 1.0);
  EXPECT_EQ(p(3), 1.0);
  EXPECT_EQ(p(4), 2.0);
  EXPECT_EQ(p(5), 0.0);
  EXPECT_EQ(p(6), 1.0);
  EXPECT_EQ(p(7), 2.0);
  EXPECT_EQ(p(8), 1.0);
  EXPECT_EQ(p(9), 1.0);
}

TEST_F(MotionProgram, BlocksInEachOther) {
  run({"P1=0",     "WHILE(P1<5)", "P1=P1+1",  "IF(P1%2=0)", "P2=P2+1", "ELSE",         "P3=P3+1",
       "IF(P1=3)", "P4=P1",       "ENDIF",    "ENDIF",      "P5=0",    "WHILE(P5!>2)", "P5=P5+1",
       "P6=P6+1",  "ENDWHILE",    "ENDWHILE", "IF(P1=9)",   "P7=1",    "ENDIF P8=1"});
  EXPECT_EQ(p(1), 5.0);
  EXPECT_EQ(p(2), 2.0);
  EXPECT_EQ(p(3), 3.0);
  EXPECT_EQ(p(4), 3.0);
  EXPECT_EQ(p(6), 15.0);
  EXPECT_EQ(p(7), 0.0);
  EXPECT_EQ(p(8), 1.0);
}

TEST_F(MotionProgram, AndBindsTighterThanOr) {
  run({"IF(P0=0 OR P0=1 AND P0=2) P1=1", "IF(P0=1 AND P0=0 OR P0=0) P2=1", "IF(P0=1 OR P0=0 AND P0=1) P3=1",
       "IF(P0=0) OR(P0=1) AND(P0=2) P4=1", "IF(P0=1) AND(P0=0) OR(P0=0) P5=1", "IF(P0=1) OR(P0=0) AND(P0=1) P6=1",
       "IF(P0=0 OR P0=1) AND(P0=1 OR P0=0)", "P7=1", "ENDIF", "WHILE(P8<3) AND(P8<2) P8=P8+1"});
  for (const unsigned is : {1, 2, 4, 5, 7}) EXPECT_EQ(p(is), 1.0) << is;
  for (const unsigned is : {3, 6}) EXPECT_EQ(p(is), 0.0) << is;
  EXPECT_EQ(p(8), 2.0);
}

TEST_F(MotionProgram, ComparatorsAndTheirOpposites) {
  run({"P0=2", "IF(P0=2) P1=1", "IF(P0!=2) P2=1", "IF(P0>1) P3=1", "IF(P0!>1) P4=1", "IF(P0<3) P5=1", "IF(P0!<3) P6=1",
       "IF(P0~2.4) P7=1", "IF(P0!~2.4) P8=1", "IF(P0~2.6) P9=1"});
  for (const unsigned is : {1, 3, 5, 7}) EXPECT_EQ(p(is), 1.0) << is;
  for (const unsigned is : {2, 4, 6, 8, 9}) EXPECT_EQ(p(is), 0.0) << is;
}

TEST_F(MotionProgram, LoopsOfOneLine) {
  run({"WHILE(P1<7) P1=P1+1 P2=P2+2", "WHILE(P3<2) WHILE(P4<4) P4=P4+1 P3=P3+1", "P5=1"});
  EXPECT_EQ(p(1), 7.0);
  EXPECT_EQ(p(2), 14.0);
  EXPECT_EQ(p(3), 4.0) << "the outer condition is looked at when the inner loop has ended";
  EXPECT_EQ(p(5), 1.0);
}

// An ELSE belongs to the IF with which the line before it begins; a line that begins with WHILE has none, so the ELSE
// is that of the block.
TEST_F(MotionProgram, ElseBehindLoopsOfOneLine) {
  run({"IF(P0=0) WHILE(P1<3) P1=P1+1", "ELSE P2=1", "IF(P0=1) WHILE(P3<3) P3=P3+1", "ELSE P4=1", "IF(P0=0)",
       "WHILE(P5<3) P5=P5+1 IF(P5<3) P6=P6+1", "ELSE", "P7=1", "ENDIF", "P8=1"});
  EXPECT_FALSE(error());
  EXPECT_EQ(p(1), 3.0);
  EXPECT_EQ(p(2), 0.0) << "the IF was true";
  EXPECT_EQ(p(3), 0.0);
  EXPECT_EQ(p(4), 1.0) << "it was not";
  EXPECT_EQ(p(6), 2.0);
  EXPECT_EQ(p(7), 0.0) << "the block's IF was true";
  EXPECT_EQ(p(8), 1.0);
  for (const char* condition : {"1", "0"}) {  // inside a block, the IF of the line still comes first
    run({"P9=0 P10=0", "IF(P0=0)", std::string("IF(P0=") + condition + ") WHILE(P9<2) P9=P9+1", "ELSE P10=1", "ENDIF"});
    EXPECT_FALSE(error());
    EXPECT_EQ(p(9), condition[0] == '0' ? 2.0 : 0.0);
    EXPECT_EQ(p(10), condition[0] == '0' ? 0.0 : 1.0);
  }
}

TEST_F(MotionProgram, JumpsAndSubroutines) {
  run({"GOTO 30", "N10 P1=P1+1", "IF(P1<3) GOTO 10", "GOSUB 100 P2=P2+1", "CALL 7.025 P3=P3+1", "CALL 7", "GOTO(P9+50)",
       "N30 P9=2", "GOTO 10", "O52 P4=1 RETURN", "P5=1", "N100 P6=P6+1", "GOSUB 200", "RETURN", "N200 P7=P7+1 RET"});
  EXPECT_TRUE(error()) << "program 7 is not there";
  EXPECT_EQ(p(3), 0.0);
  EXPECT_EQ(host("LIST PC"), "15:CALL7.025P3=P3+1") << "1 + 5 + 4 + 5 words before it";
  EXPECT_EQ(p(1), 3.0);
  EXPECT_EQ(p(2), 1.0);
  EXPECT_EQ(p(6), 1.0);
  EXPECT_EQ(p(7), 1.0);
  store(7, {"N2500 P8=P8+1"});
  ASSERT_EQ(host("B1.00010 R"), "") << "label 10";
  ASSERT_TRUE(finish());
  EXPECT_FALSE(error());
  EXPECT_EQ(p(8), 2.0) << "called twice, by its label and from its top";
  EXPECT_EQ(p(4), 1.0);
  EXPECT_EQ(p(5), 0.0) << "RETURN without a call ends the program";
}

TEST_F(MotionProgram, CallsOtherPrograms) {
  store(7, {"P10=P10+1", "RETURN", "N2500 P11=P11+1 X(P11)", "N2600P12=P12+1"});
  run({"TM10TA2TS0", "CALL7.025 P3=P3+1", "CALL 7", "CALL 7.026 Y2", "P4=1"});
  EXPECT_FALSE(error());
  EXPECT_EQ(p(10), 1.0);
  EXPECT_EQ(p(11), 1.0);
  EXPECT_EQ(p(12), 2.0) << "it went on behind N2500";
  EXPECT_EQ(p(3), 1.0);
  EXPECT_EQ(p(4), 1.0);
  EXPECT_EQ(x(), 1.0);
  EXPECT_EQ(coordinate_systems[0].position[AXIS_Y], 2.0) << "what stands behind a call on its line comes after it";
}

TEST_F(MotionProgram, LetterCodesAreCallsAndReadTakesTheirValues) {
  store(1000, {"P1=1 RET", "N1000 LINEAR RET", "N4000 READ(P) IF(Q100&32768>0) DWELL(Q116*10) RET", "N17100 P2=1 RET",
               "N92000 READ(X,Y) RET"});
  store(1010, {"N54000 P3=1 RET"});
  store(1001, {"N3000 P4=1 RET"});
  store(1002, {"N5000 P5=1 RET"});
  store(1003, {"N6000 READ(A,Z) P6=1"});
  run({"TM10TA2TS0", "G00 G01 X5", "G4P2", "G17.1 G154", "M3 T5", "D6 A1.5 Z(2*4) X6", "G92 X3 F100 Y4", "S1500"});
  EXPECT_FALSE(error());
  for (const unsigned is : {1, 2, 3, 4, 5, 6}) EXPECT_EQ(p(is), 1.0) << is;
  EXPECT_EQ(q(116), 2.0);
  EXPECT_EQ(q(101), 1.5);
  EXPECT_EQ(q(126), 8.0);
  EXPECT_EQ(q(124), 3.0) << "of G92: X alone, F ends the list";
  EXPECT_EQ(q(100), 1u << 23);
  EXPECT_EQ(coordinate_systems[0].position[AXIS_Y], 4.0);
  EXPECT_EQ(coordinate_systems[0].position[AXIS_A], 0.0) << "read, not moved";
  EXPECT_EQ(x(), 6.0);
  EXPECT_EQ(q(127), 1500.0);
}

// firmware:7.3/2: the Nth letter of the alphabet is Q(100 + N) and bit N - 1 of Q100, whatever it is elsewhere; N and O
// are none.
TEST_F(MotionProgram, ReadTakesEachLetter) {
  const std::string letters = "ABCDEFGHIJKLMPQRSTUVWXYZ";
  std::string call = "G92", list;
  double mask = 0;
  for (const char letter : letters) {
    const unsigned n = static_cast<unsigned>(letter - 'A') + 1;
    call += std::string(" ") + letter + std::to_string(n + 200);
    list += (list.empty() ? "" : ",") + std::string(1, letter);
    mask += static_cast<double>(1u << (n - 1));
  }
  store(1000, {"N92000 READ(" + list + ") RET"});
  run({"Q114=5 Q115=6", call});
  EXPECT_FALSE(error());
  for (const char letter : letters)
    EXPECT_EQ(q(101 + static_cast<unsigned>(letter - 'A')), letter - 'A' + 201) << letter;
  EXPECT_EQ(q(100), mask);
  EXPECT_EQ(q(114), 5.0);
  EXPECT_EQ(q(115), 6.0);
}

// Two jumps back without a move, or 32 lines, at one real-time interrupt; nothing else waits for them.
TEST_F(MotionProgram, EndlessLoopsTakeTwoTurnsAnInterrupt) {
  for (const Lines& lines :
       {Lines{"WHILE(1=1)", "P1=P1+1", "ENDWHILE"}, Lines{"N1 P1=P1+1 GOTO 1"}, Lines{"WHILE(1=1) P1=P1+1"}}) {
    store(1, lines);
    ASSERT_EQ(host("P1=0 B1R"), "");
    for (int i = 0; i < 50; ++i) platform::real_time();
    EXPECT_GE(p(1), 100.0) << lines[0];
    EXPECT_LE(p(1), 101.0) << lines[0];
    EXPECT_TRUE(run_is_running(0));
    ASSERT_EQ(host("Q"), "");
    platform::real_time();
    platform::real_time();
    EXPECT_FALSE(run_is_running(0)) << lines[0];
  }
}

TEST_F(MotionProgram, LinesWithoutAMoveAreLimited) {
  store(1, Lines(100, "P1=P1+1"));
  ASSERT_EQ(host("B1R"), "");
  platform::real_time();
  EXPECT_EQ(p(1), 32.0);
}

TEST_F(MotionProgram, WaitHoldsTheProgramAndEndsBlending) {
  store(1, {"TM20TA10TS0", "X1", "WHILE(P1=0) WAIT", "X2", "P2=1"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(300);
  EXPECT_EQ(x(), 1.0);
  EXPECT_TRUE(run_is_running(0));
  ASSERT_EQ(host("P1=1"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 2.0);
  EXPECT_EQ(p(2), 1.0);
}

}  // namespace
