// A move that goes by a feedrate of 0 or below (firmware:7.5/11, firmware:7.10/8): a run-time error when it is planned,
// whoever has set it; moves that need none are made.
#include "testbench/unit/firmware_program/motion_program.h"

namespace {

using namespace motion_program;

class Feedrate : public MotionProgram {
 protected:
  static double y() { return coordinate_systems[0].position[AXIS_Y]; }
  static double a() { return coordinate_systems[0].position[AXIS_A]; }
  static std::uint32_t started() { return coordinate_systems[0].started; }
};

TEST_F(Feedrate, NoneIsAnErrorOfTheMoveThatNeedsIt) {
  for (const char* feed : {"F0", "F(P1)", "F(0-0.001)", "I5189=0", "I5189=-1000", "F10I5189=0-1", "I5190=0", "I5190=-5",
                           "F0FRAX(A)"})  // X goes by F when Isx86 is 0
    for (const char* mode : {"", "RAPID"}) {
      platform::power_up();
      ASSERT_EQ(host("P1=-5"), "");
      const std::uint32_t before = started();
      run({"TA10TS0 LINEAR", mode, feed, "P3=1", "X1Y2", "P4=1"});
      EXPECT_TRUE(error()) << feed;
      EXPECT_EQ(p(3), 1.0) << feed << " itself is accepted";
      EXPECT_EQ(p(4), 0.0) << feed;
      EXPECT_EQ(host("RY$2014"), "8") << "firmware:7.10";
      EXPECT_EQ(started(), before) << feed << ": no move";
      EXPECT_EQ(x(), 0.0);
    }
}

TEST_F(Feedrate, IsNotNeededByOtherMoves) {
  run({"TA10TS0 F0", "X0", "P2=1"});
  EXPECT_FALSE(error()) << "no distance";
  EXPECT_EQ(p(2), 1.0);
  ASSERT_EQ(host("I5186=20 I5113=10"), "");
  run({"TA10TS0 F0", "DELAY5 DWELL5", "X0", "A1", "TM20", "X3", "INC Y0 ABS", "P1=1"});
  EXPECT_FALSE(error()) << "no distance, an axis that goes by Isx86, by time";
  EXPECT_EQ(p(1), 1.0);
  EXPECT_EQ(x(), 3.0);
  EXPECT_EQ(a(), 1.0);
}

TEST_F(Feedrate, AnAxisWithItsOwnMakesTheOthersNeedItAllTheSame) {
  ASSERT_EQ(host("I5186=20 I5113=10"), "");
  run({"TA10TS0 F0", "A1X1"});
  EXPECT_TRUE(error());
  EXPECT_EQ(a(), 0.0) << "all axes of a line move, or none";
}

// The program stands at the move, with all of its axes: R makes it when there is a feedrate, once.
TEST_F(Feedrate, RunGoesOnWithTheWholeMove) {
  run({"INC TA10TS0 F0 P1=P1+1", "P2=P2+1 X1 Y(P2) DWELL1 P3=P3+1", "X10"});
  EXPECT_TRUE(error());
  EXPECT_EQ(p(2), 1.0);
  EXPECT_EQ(p(3), 0.0);
  ASSERT_EQ(host("R"), "");
  ASSERT_TRUE(finish());
  EXPECT_TRUE(error()) << "nothing has changed";
  ASSERT_EQ(host("I5189=1000 R"), "");
  ASSERT_TRUE(finish());
  EXPECT_FALSE(error());
  EXPECT_EQ(p(1), 1.0);
  EXPECT_EQ(p(2), 1.0) << "what stands before the axes is not executed again";
  EXPECT_EQ(p(3), 1.0);
  EXPECT_EQ(x(), 11.0);
  EXPECT_EQ(y(), 1.0);
}

TEST_F(Feedrate, ErrorAtTheEndOfALineKeepsItsAxesToo) {
  run({"INC TA10TS0 F0", "X1 Y2", "P1=1"});
  EXPECT_TRUE(error());
  EXPECT_EQ(host("LIST PC"), "4:X1Y2") << "INC TA TS F";
  ASSERT_EQ(host("I5189=1000 R"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(x(), 1.0);
  EXPECT_EQ(y(), 2.0);
  EXPECT_EQ(p(1), 1.0);
}

// The loop that a line begins with goes on, from the pass in which the move had no feedrate.
TEST_F(Feedrate, ALoopOfOneLineGoesOnWithTheMove) {
  const struct {
    const char* line;
    double x, y, passes;
  } loops[] = {
      {"WHILE(P2<3) P2=P2+1 X1 Y2", 3, 6, 3},                       // found at the end of the line
      {"WHILE(P2<3) P2=P2+1 X1 DWELL1 Y2", 3, 6, 3},                // and within it
      {"WHILE(P2<3) P2=P2+1 WHILE(P3<P2) P3=P3+1 X1 Y2", 3, 6, 3},  // a loop in a loop
      {"X1 WHILE(P2<3) P2=P2+1 Y1", 1, 2, 3},                       // X stands before it: all is met again
  };
  for (const auto& loop : loops) {
    SCOPED_TRACE(loop.line);
    platform::power_up();
    run({"INC TA10TS0 F0", loop.line, "P1=1"});
    ASSERT_TRUE(error());
    EXPECT_EQ(p(1), 0.0);
    ASSERT_EQ(host("I5189=1000 R"), "");
    ASSERT_TRUE(finish());
    EXPECT_FALSE(error());
    EXPECT_EQ(p(1), 1.0) << "what stands behind the loop";
    EXPECT_EQ(p(2), loop.passes);
    EXPECT_EQ(x(), loop.x);
    EXPECT_EQ(y(), loop.y);
  }
}

TEST_F(Feedrate, OfARotaryBufferTheLineGoesAndTheNextIsKept) {
  for (const char* line : {"X1", "X1Y(P1)", "X1 DWELL5", "X1DWELL(P1)", "G7X1"}) {
    platform::power_up();
    store(1000, {"N7000 RET"});
    ASSERT_EQ(host("DEF ROT 100 B0 OPEN ROT"), "");
    for (const char* text : {"TA10TS0 F0", line, "F1000", "X5"}) ASSERT_EQ(host(text), "") << text;
    ASSERT_EQ(host("R"), "");
    platform::servo_ticks(30);
    EXPECT_TRUE(error()) << line;
    EXPECT_FALSE(run_is_running(0)) << line;
    EXPECT_EQ(host("PR"), "2") << line;
    ASSERT_EQ(host("R"), "");
    platform::servo_ticks(300);
    EXPECT_FALSE(error()) << line;
    EXPECT_EQ(x(), 5.0) << line;
    EXPECT_EQ(host("PR"), "0") << line;
  }
}

TEST_F(Feedrate, MovesThatAreCalculatedAreFinished) {
  run({"TA10TS0 F1000", "X1", "F0X2"});
  EXPECT_TRUE(error());
  EXPECT_EQ(x(), 1.0);
}

}  // namespace
