// A line that a program was stopped in, by a run-time error, an abort or a stop at a statement that waits: what has
// been collected of it is nothing of the next program (firmware:4.10, firmware:7.10).
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/motion_program.h"

namespace {

using namespace motion_program;

class BegunLines : public MotionProgram {
 protected:
  static coordinate_system& cs() { return coordinate_systems[0]; }
  // Behind it the queue of SENDs has no room for a text of 200 characters (firmware:6.7/9), the background does not
  // run.
  static Lines waits_at(const std::string& begun, const std::string& rest = "") {
    const std::string send = "SEND\"" + std::string(200, 'x') + "\"";
    return {"TM10TA2TS0", send, send, send, send, begun + " " + send + " " + rest};
  }
  static void wait(const Lines& lines) {
    store(1, lines);
    ASSERT_EQ(host("B1R"), "");
    platform::servo_ticks(30);
    ASSERT_TRUE(run_is_running(0));
    ASSERT_FALSE(text_queue_is_empty(&send_queues[PROGRAM_REAL_TIME]));
  }
  static void read_all() {
    platform::background(20);
    platform::sent();
  }
  static void nothing_is_left() {
    EXPECT_EQ(cs().pending_axes, 0u);
    EXPECT_EQ(cs().pending_velocities, 0u);
    EXPECT_EQ(cs().pending_triggers, 0u);
    EXPECT_EQ(cs().pending_vectors, 0u);
    EXPECT_FALSE(cs().sets_position);
    EXPECT_FALSE(cs().sets_normal);
  }
  // Y3 is made as of a program that is the first one: one move of Y alone, with an arc vector that is none of a plane.
  static void next_program_is_whole(double x_before) {
    store(2, {"LINEAR TM10TA2TS0", "Y3", "CIRCLE1", "J5 Y4", "LINEAR"});
    const std::uint32_t moves = cs().planned;
    const double normal = cs().normal[1];
    ASSERT_EQ(host("B2"), "");
    nothing_is_left();
    ASSERT_EQ(host("R"), "");
    ASSERT_TRUE(finish());
    EXPECT_FALSE(error());
    EXPECT_EQ(cs().planned - moves, 2u) << "both lines move";
    EXPECT_EQ(x(), x_before);
    EXPECT_EQ(cs().position[AXIS_Y], 4.0);
    EXPECT_EQ(cs().normal[1], normal);
  }
};

const char* const kBegun[] = {
    "X5",         "PSET",          "PSET X5",   "NORMAL",   "NORMAL K1", "PVT100 X5:7", "PVT100 X5:7 Y1:2",
    "CIRCLE1 I5", "CIRCLE1 R5 X5", "INC(X) X5", "X5 NORMAL"};

TEST_F(BegunLines, ARunTimeErrorForgetsIt) {
  for (const char* begun : kBegun) {
    SCOPED_TRACE(begun);
    platform::power_up();
    run({"TM10TA2TS0", std::string(begun) + " CC1"});
    ASSERT_TRUE(error());
    next_program_is_whole(0.0);
  }
}

// There the line goes, with all of it.
TEST_F(BegunLines, ARunTimeErrorTakesTheLineOfARotaryBuffer) {
  for (const char* begun : {"PSET", "NORMAL K1", "CIRCLE1 I5", "PVT100 X5:7"}) {
    SCOPED_TRACE(begun);
    platform::power_up();
    ASSERT_EQ(host("DEF ROT 100 OPEN ROT"), "");
    ASSERT_EQ(host("TM10TA2TS0"), "");
    ASSERT_EQ(host(std::string(begun) + " CC1"), "");
    ASSERT_EQ(host("CLOSE B0R"), "");
    platform::servo_ticks(30);
    ASSERT_TRUE(error());
    nothing_is_left();
  }
}

// A fixed program stands at the statement (firmware:7.10): R goes on in its line, of which PSET has been read.
TEST_F(BegunLines, RBehindARunTimeErrorGoesOnInTheLine) {
  ASSERT_EQ(host("DEF TBUF 1"), "");
  ASSERT_EQ(host("P1=99"), "");
  run({"TM10TA2TS0", "PSET TSELECT(P1) X5"});
  ASSERT_TRUE(error());
  const std::uint32_t moves = cs().planned;
  ASSERT_EQ(host("P1=1 R"), "");
  ASSERT_TRUE(finish());
  EXPECT_FALSE(error());
  EXPECT_EQ(x(), 5.0);
  EXPECT_EQ(cs().planned, moves) << "PSET X5 moves nothing";
}

TEST_F(BegunLines, AnAbortForgetsIt) {
  for (const char* begun : kBegun) {
    SCOPED_TRACE(begun);
    platform::power_up();
    wait(waits_at(begun));
    ASSERT_EQ(host("A"), "");
    platform::servo_ticks(9);
    nothing_is_left();
    read_all();
    next_program_is_whole(0.0);
  }
}

// With axes the line would be ended first.
TEST_F(BegunLines, AnotherProgramBehindAStopForgetsIt) {
  for (const char* begun : {"PSET", "NORMAL", "NORMAL K1", "CIRCLE1 I5", "CIRCLE1 R5"}) {
    SCOPED_TRACE(begun);
    platform::power_up();
    wait(waits_at(begun));
    ASSERT_EQ(host("Q"), "");
    platform::servo_ticks(9);
    ASSERT_FALSE(run_is_running(0));
    read_all();
    next_program_is_whole(0.0);
  }
}

TEST_F(BegunLines, TheSameProgramGoesOnInItBehindAStop) {
  wait(waits_at("PSET", "X7"));
  ASSERT_EQ(host("Q"), "");
  platform::servo_ticks(9);
  ASSERT_FALSE(run_is_running(0));
  read_all();
  const std::uint32_t moves = cs().planned;
  ASSERT_EQ(host("R"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 7.0);
  EXPECT_EQ(cs().planned, moves) << "PSET X7 moves nothing";
}

// Those of a line end with it, by RETURN too.
TEST_F(BegunLines, ALineEndsWithItsReturn) {
  store(7, {"PSET RETURN"});
  store(8, {"NORMAL RETURN"});
  store(9, {"CIRCLE1 I5 RETURN"});
  for (const char* call : {"CALL7", "CALL8", "CALL9", "PSET", "NORMAL", "CIRCLE1 I5"}) {
    SCOPED_TRACE(call);
    platform::power_up();
    store(7, {"PSET RETURN"});
    store(8, {"NORMAL RETURN"});
    store(9, {"CIRCLE1 I5 RETURN"});
    store(1, {"TM10TA2TS0", call, "WHILE(P1=0) WAIT", "LINEAR X7"});
    const std::uint32_t moves = cs().planned;
    ASSERT_EQ(host("P1=0 B1R"), "");
    platform::servo_ticks(30);
    nothing_is_left();
    ASSERT_EQ(host("P1=1"), "");
    ASSERT_TRUE(finish());
    EXPECT_EQ(cs().planned - moves, 1u);
    EXPECT_EQ(x(), 7.0);
  }
}

// Axes before a statement that moves, waits, calls, stops or sets positions move before it, those behind it then
// (firmware:7.1); other statements stand between axes of one move.
TEST_F(BegunLines, SomeStatementsEndTheMoveBeforeThem) {
  const struct {
    const char* between;
    unsigned moves;
  } cases[] = {{"DWELL1", 3},   {"DELAY1", 3},     {"CALL7", 2},     {"GOSUB7", 2}, {"G7", 2},     {"M7", 2},
               {"STOP", 2},     {"BLOCKSTART", 2}, {"BLOCKSTOP", 2}, {"WAIT", 2},   {"PSET", 1},   {"P1=1", 1},
               {"F100", 1},     {"TM20", 1},       {"TA5", 1},       {"TS1", 1},    {"INC(A)", 1}, {"FRAX(X)", 1},
               {"M1==1", 1},    {"SEND\"\"", 1},   {"LINEAR", 1},    {"N9", 1},     {"S5", 1},     {"DISPLC1", 1},
               {"MOVETIME", 1}, {"LOCK1", 1},      {"HOMEZ1", 2}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.between);
    platform::power_up();
    store(7, {"RETURN"});
    store(1000, {"N7000 RETURN"});
    store(1001, {"N7000 RETURN"});
    store(1, {"TM10TA2TS0", std::string("X1 ") + c.between + " Y2", "RETURN", "N7 RETURN"});
    const std::uint32_t moves = cs().planned;
    ASSERT_EQ(host("M1->* B1R"), "");
    ASSERT_TRUE(finish());
    if (c.between == std::string("STOP")) {
      EXPECT_EQ(cs().position[AXIS_Y], 0.0);
      ASSERT_EQ(host("R"), "");
      ASSERT_TRUE(finish());
    }
    EXPECT_FALSE(error());
    EXPECT_EQ(cs().planned - moves, c.moves);
    EXPECT_EQ(x(), 1.0);
    EXPECT_EQ(cs().position[AXIS_Y], 2.0);
  }
}

// So they do where that call or jump has no target: the program stands at it, behind the move.
TEST_F(BegunLines, AxesBeforeACallThatFailsHaveMoved) {
  for (const char* call : {"CALL99", "GOSUB5", "GOTO5", "G7", "M7", "T1", "D1", "CALL(-1)", "GOTO(P9)", "G(-1)"}) {
    SCOPED_TRACE(call);
    platform::power_up();
    ASSERT_EQ(host("P9=5"), "");
    run({"TM10TA2TS0", std::string("X1 ") + call + " Y2"});
    EXPECT_TRUE(error());
    EXPECT_EQ(x(), 1.0);
    EXPECT_EQ(cs().position[AXIS_Y], 0.0);
  }
}

// motion:5.6/5: a step by Isx53 bit 0 goes to the end of the line, whatever a PSET in it has done already.
TEST_F(BegunLines, AStepOfALineGoesOnBehindPset) {
  store(1, {"PSET X5 WAIT P1=1", "P2=1"});
  ASSERT_EQ(host("I5153=1 B1S"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 5.0);
  EXPECT_EQ(host("P1 P2"), "1|0");
}

// PE names the line that executes (firmware:4.9/2), one that is entered at a label within it, too.
TEST_F(BegunLines, OfALineThatIsEnteredAtALabelPeShowsItsBegin) {
  const Lines lines = {"GOTO10", "P1=1 N10 TM1000 X5"};  // 0, 1, 2, 3, 4
  store(1, lines);
  store(7, {"P1=1", "CALL1.0001"});
  for (const auto& [start, place] : {std::pair{"B1", "P1:1"}, {"B1.0001", "P1:1"}, {"B7", "P7:1>P1.1"}}) {
    SCOPED_TRACE(start);
    ASSERT_EQ(host(std::string(start) + "R"), "");
    platform::servo_ticks(12);
    ASSERT_TRUE(cs().active);
    EXPECT_EQ(host("PE"), place);
    ASSERT_EQ(host("A"), "");
    platform::servo_ticks(9);
  }
}

// A line behind ELSE is that of the ELSE.
TEST_F(BegunLines, OfALineWithElsePeShowsIt) {
  store(1, {"TM1000TA2TS0 P1=1", "IF(P1=0) X1", "ELSE X2"});  // 4 words, 4 and 1 of the condition and X1
  ASSERT_EQ(host("B1"), "");
  const std::string text = host("LIST PROG 1,0");
  const std::size_t line = text.find(":ELSE");
  ASSERT_NE(line, std::string::npos);
  const std::size_t from = text.rfind('|', line) + 1;
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(12);
  ASSERT_TRUE(cs().active);
  EXPECT_EQ(host("PE"), "P1:" + text.substr(from, line - from));
}

// firmware:4.10/4: at once, whatever is being calculated; the rest of that is not made first. Here it is the search for
// a label behind 300 lines, a place to be left in each.
TEST_F(BegunLines, AnAbortWaitsForNoWord) {
  Lines called(300, "P1=1");
  called.emplace_back("N7 P2=2");
  store(2, called);
  store(1, {"CALL2.00007"});
  ASSERT_EQ(host("B1R"), "");
  fake_hal_on_pause([] {});
  fake_hal_slices_leave(true);
  for (unsigned i = 0; i < 50; ++i) fake_task_run_real_time();
  ASSERT_TRUE(fake_hal_slice_is_left());
  ASSERT_EQ(host("A"), "");
  unsigned slices = 0;
  for (; cs().settling && slices < 500; ++slices) fake_task_run_real_time();
  EXPECT_LT(slices, 50u);
  fake_hal_slices_leave(false);
  fake_hal_on_pause(nullptr);
  platform::servo_ticks(9);
  EXPECT_EQ(host("P2 RY$2014"), "0|0");
}

// A program that is pointed to while an abort is still being settled, in any slice of that: it is about the new program
// then, all of whose first line is executed.
TEST_F(BegunLines, APointWithinAnAbortHasTheWholeProgram) {
  unsigned within = 0;
  for (unsigned slices = 1; slices <= 40; ++slices) {
    platform::power_up();
    Lines lines = {"TM10TA2TS0", "DWELL50"};
    for (unsigned i = 1; i <= 20; ++i) lines.back() += " P" + std::to_string(i) + "=1";
    store(1, lines);
    store(2, {"P30=1 P31=1 P32=1 P33=1", "P34=1"});
    ASSERT_EQ(host("B1R"), "");
    platform::servo_ticks(30);  // in the DWELL, within its line
    ASSERT_TRUE(cs().active);
    ASSERT_EQ(host("A"), "");
    fake_hal_on_pause([] {});
    fake_hal_slices_leave(true);
    for (unsigned i = 0; i < slices; ++i) fake_task_run_real_time();
    within += cs().settling ? 1u : 0u;
    ASSERT_EQ(host("B2"), "");
    fake_hal_slices_leave(false);
    fake_hal_on_pause(nullptr);
    platform::servo_ticks(9);
    EXPECT_FALSE(cs().settling);
    ASSERT_EQ(host("R"), "");
    ASSERT_TRUE(finish());
    EXPECT_FALSE(error());
    EXPECT_EQ(host("P30..34"), "1|1|1|1|1") << slices;
    EXPECT_EQ(host("P1"), "0");
  }
  EXPECT_GT(within, 10u) << "one for each word that is skipped";
}

// A block that was begun is of its program alone: a step in the next one is a move.
TEST_F(BegunLines, ABlockEndsWithItsProgram) {
  store(1, {"TM10TA2TS0 BLOCKSTART", "X1", "WHILE(P9=0) WAIT"});
  store(2, {"X2", "X3"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(150);
  ASSERT_EQ(host("A"), "");
  platform::servo_ticks(9);
  ASSERT_EQ(host("B2S"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 2.0);
}

// A value that READ was at is read by nobody, whatever is pointed to before the abort is settled.
TEST_F(BegunLines, AnAbortWithinReadLeavesNoPlaceToGoBackTo) {
  for (unsigned slices = 1; slices <= 60; slices += 3) {
    platform::power_up();
    store(7, {"READ(X,Y)", "P40=1"});
    store(1, {"CALL7 X(P1+P2+P3+P4+P5+P6) Y(P1+P2+P3+P4+P5+P6)", "P41=1"});
    store(2, {"P30=1 P31=1", "P32=1"});
    ASSERT_EQ(host("B1R"), "");
    fake_hal_on_pause([] {});
    fake_hal_slices_leave(true);
    for (unsigned i = 0; i < slices; ++i) fake_task_run_real_time();
    ASSERT_EQ(host("A"), "");
    ASSERT_EQ(host("B2"), "");
    fake_hal_slices_leave(false);
    fake_hal_on_pause(nullptr);
    platform::servo_ticks(9);
    ASSERT_EQ(host("R"), "");
    ASSERT_TRUE(finish());
    EXPECT_FALSE(error());
    EXPECT_EQ(host("P30..32 PC"), "1|1|1|P2:0") << slices;
  }
}

// A stop that comes right behind a start is one before the first word, be the program before it left within a line.
TEST_F(BegunLines, AResetWithinALineHoldsUpNoStop) {
  store(1, {"P1=1 P2=1 P3=1 P4=1 P5=1 P6=1 P7=1 P8=1 P9=1"});
  store(2, {"P5=1"});
  ASSERT_EQ(host("P1..9=0 SAVE B1R"), "");
  fake_hal_on_pause([] {});
  fake_hal_slices_leave(true);
  for (unsigned i = 0; i < 100 && p(4) == 0.0; ++i) fake_task_run_real_time();
  fake_hal_slices_leave(false);
  fake_hal_on_pause(nullptr);
  ASSERT_EQ(host("P4 P9"), "1|0");
  platform::reset();
  ASSERT_EQ(host("P5=0 B2R"), "");
  ASSERT_EQ(host("Q"), "");
  platform::servo_ticks(9);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(host("P5"), "0");
}

}  // namespace
