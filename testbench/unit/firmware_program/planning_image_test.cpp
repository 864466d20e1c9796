// How long the planning of moves keeps the CPU on the cross-compiled image: its ways from pause to pause.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "testbench/unit/firmware_platform/own_cycles.h"

namespace brick {
namespace {

// What programs ask motion for (firmware/run/calculate.c), but for segments.
const std::vector<std::string> kPlanning = {"plan_line",
                                            "plan_wait",
                                            "plan_home",
                                            "move_place",
                                            "system_motors_match",
                                            "cs_present_position",
                                            "axis_matrix_line",
                                            "axis_matrix_change",
                                            "axis_matrix_select",
                                            "plan_path_delay",
                                            "system_motors_set_position"};

class PlanningImage : public ::testing::Test {
 protected:
  void SetUp() override { EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  double value(const std::string& name) { return std::stod(board.send(name + "\r")); }
  void motors(int count) {
    const char* axes = "XYZABCUV";
    for (int m = 1; m <= count; ++m) {
      const std::string n = std::to_string(m);
      accepted("I" + n + "00=1 I" + n + "24=$120001 I" + n + "11=0 I" + n + "16=60 I" + n + "17=1 I" + n + "22=40 I" +
               n + "15=10");
      accepted("&1#" + n + "->1000.5" + axes[m - 1] + (m == 1 ? "+3.7" : m == 2 ? "+20.5X" : ""));
    }
    accepted("I427=360180 I527=-360180 I528=1");
    accepted("A");
    board.run_ms(20);
  }
  void store(const std::vector<std::string>& lines) {
    accepted("OPEN PROG 1 CLEAR");
    for (const std::string& line : lines) accepted(line);
    accepted("CLOSE");
  }
  void finish() {
    for (int i = 0; board.send("B1\r") != "\x06"; ++i) {
      ASSERT_LT(i, 300) << "it runs on";
      board.run_ms(5);
    }
    EXPECT_EQ(value("RY$2014"), 0) << "no run-time error";
  }
  // LONGEST_SECTION of firmware/kernel/slice.c without what the real-time task does beside the slice.
  void pauses_in_time(const OwnCycles& own) {
    std::printf("%llu between two pauses at %s\n", static_cast<unsigned long long>(own.longest()),
                own.longest_at().c_str());
    EXPECT_LE(own.longest(), 1400u) << own.longest_at();
  }
  ImageBoard board{firmware_image(), 0x3};
};

TEST_F(PlanningImage, LinearMovesAndWaits) {
  motors(8);
  OwnCycles own(board, kPlanning, "plan_line");
  store({"INC LINEAR TA20 TS6 F100.3", "X.3 Y.21 Z-.17 A-.3 B.3 C.1 U.1 V-.15", "X.2 Y-.1 Z.1 A.33 B-.3 C.1 U.3 V-.2",
         "FRAX(X,Y) Z.3 DELAY13.3", "TM30 X.11 V.3", "DWELL7 X.1", "ABS A2 B-3", "INC X3 Y2"});
  accepted("B1R");
  finish();
  for (int i = 0; i < 3; ++i) {
    accepted("B1R");
    board.run_ms(11 + 5 * i);
    accepted("A");
    board.run_ms(60);
  }
  pauses_in_time(own);
}

TEST_F(PlanningImage, CubicMoves) {
  motors(8);
  OwnCycles own(board, kPlanning, "plan_line");
  store({"INC PVT11.3 X.3:17.1 Y.21:8.3 Z-.17:-7 A-.3:9 B.3:3 C.1:4 U.1:5 V-.15:6",
         "X.2:3 Y-.1 Z.1 A.33 B-.3 C.1 U.3 V-.2", "X.1 Y.1 Z.1", "SPLINE1 TM13.7 X.1 Y.21 Z.33 A.1 B-.2 C.1 U.3 V-.1",
         "X.2 Y.1 Z.3 A-.1 B.2 C-.1 U-.3 V.1", "TM11 X.3", "SPLINE2 X.3 Y.1", "TM13 X.1"});
  accepted("B1R");
  finish();
  for (int i = 0; i < 3; ++i) {
    accepted("B1R");
    board.run_ms(15 + 20 * i);
    accepted("A");
    board.run_ms(60);
  }
  pauses_in_time(own);
}

TEST_F(PlanningImage, Arcs) {
  motors(8);
  accepted("I5113=5 I5178=100000 I5196=0 I5197=.01");
  OwnCycles own(board, kPlanning, "plan_line");
  store({"INC F100 TA10 TS2 CIRCLE1 X1 Y1 I1 J0 Z-.3 A1 B-.3 C-.1 U.2 V.3", "CIRCLE2 X1 Y1 R1.3 Z.2", "FRAX(X,Y,Z,A)",
         "CIRCLE1 X.5 Y.5 I.3 J0 Z.3 A.2", "NORMAL I.1 J.2 K-1", "CIRCLE1 X.5 Y.2 Z.3 I.3 J.1 K.2 A.3", "NORMAL K-1",
         "X.1 Y.1 R.01", "X0 Y0 I.3 J.1", "LINEAR X.1 Y.2 A.2", "DELAY10 CIRCLE1 X.5 Y.5 I.5 J0", "TM30 X.1 Y.3 R-1"});
  accepted("B1R");
  finish();
  pauses_in_time(own);
}

// The inverse program is asked for knots, the forward one by PMATCH.
TEST_F(PlanningImage, KinematicMoves) {
  motors(3);
  for (const char* line : {"&1#1->I#2->I", "I5150=1", "OPEN FORWARD CLEAR", "Q7=P1/1000 Q8=P2/1000", "CLOSE",
                           "OPEN INVERSE CLEAR", "P1=Q7*1000 P2=Q8*1000", "CLOSE"})
    accepted(line);
  OwnCycles own(board, kPlanning, "plan_line");
  store({"INC PVT11.3 X.3:17.1 Y.21:8.3 Z.2:3", "X.2 Y-.1:2 Z.3:4", "X.1 Y.1 Z.1", "LINEAR TM20 TA5 X.2 Y.1",
         "SPLINE1 TM11 X.3 Y.2 Z.1"});
  accepted("B1R");
  finish();
  pauses_in_time(own);
}

TEST_F(PlanningImage, MotorsThatGoForThemselves) {
  motors(8);
  OwnCycles own(board, kPlanning, "plan_line");
  store({"INC RAPID X.3 Y.21 Z-.17 A-.3 B.3 C.1 U.1 V-.15", "X.3^.1 Y.2", "HOME1,2", "HOMEZ3", "PSET X3 Y2", "X.1"});
  accepted("B1R");
  board.run_ms(600);
  accepted("A");
  board.run_ms(60);
  pauses_in_time(own);
}

TEST_F(PlanningImage, Matrices) {
  motors(3);
  accepted("DEFINE TBUF 2");
  OwnCycles own(board, kPlanning, "plan_line");
  store({"Q40=.6 Q41=.8 Q42=.1 Q43=-.8 Q44=.6 Q45=.3 Q46=.2 Q47=.3 Q48=1.1 Q50=.1 Q51=.2 Q52=.3",
         "TSEL1 TINIT AROT40 IROT40 ADIS50 IDIS50", "ABS LINEAR TM20 TA5 X.1 Y.2", "INC X.1 Y.2 Z.3", "PVT10 X.1:3 Y.2",
         "TSEL2 TINIT TSEL0"});
  accepted("B1R");
  finish();
  pauses_in_time(own);
}

}  // namespace
}  // namespace brick
