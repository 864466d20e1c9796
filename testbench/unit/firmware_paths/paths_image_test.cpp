// What segments and lookahead cost on the cross-compiled image: cycles of the CPU that they take for themselves.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "testbench/unit/firmware_platform/own_cycles.h"

namespace brick {
namespace {

class PathsImage : public ::testing::Test {
 protected:
  void SetUp() override { EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  double value(const std::string& name) { return std::stod(board.send(name + "\r")); }

  // Eight motors along blended lines and arcs, 5 ms a segment, P3 times.
  void start(int ahead, const std::string& acceleration, const std::vector<std::string>& lines) {
    const char* axes = "XYZABCUV";
    for (int m = 1; m <= 8; ++m) {
      const std::string n = std::to_string(m);
      accepted("I" + n + "00=1 I" + n + "24=$120001 I" + n + "11=0 I" + n + "16=60 I" + n + "17=" + acceleration);
      accepted("&1#" + n + "->1000" + axes[m - 1]);
    }
    accepted("I5113=5 I5120=" + std::to_string(ahead));
    accepted("DELETE GATHER");
    accepted("&1 DELETE LOOKAHEAD");
    accepted("&1 DEFINE LOOKAHEAD " + std::to_string(ahead + 20) + ",0");
    accepted("A");
    board.run_ms(20);
    accepted("OPEN PROG 1 CLEAR");
    accepted("TM40 TA10 TS0 INC P1=0 P2=0 P3=1000000 WHILE(P1<P3)");
    for (const std::string& line : lines) accepted(line);
    accepted("P1=P1+1 ENDWHILE CLOSE");
    accepted("B1R");
  }
  // Mean of `count` segments behind the first `before`. Steps of the sweeps: six a segment at most (docs/paths.md).
  double cycles_a_segment(OwnCycles& own, unsigned before, unsigned count) {
    for (int i = 0; own.points() < before && i < 1000; ++i) board.run_ms(5);
    own.from_here();
    for (int i = 0; own.points() < count && i < 3000; ++i) board.run_ms(5);
    EXPECT_GE(own.points(), count);
    const double mean = static_cast<double>(own.cycles()) / own.points();
    const double steps = static_cast<double>(own.steps()) / own.points();
    std::printf("%.0f cycles a segment, %.2f steps, %llu between two pauses at %s\n", mean, steps,
                static_cast<unsigned long long>(own.longest()), own.longest_at().c_str());
    EXPECT_LE(steps, 6);
    EXPECT_GE(steps, 1) << "of a sweep, each segment one at least";
    EXPECT_EQ(value("RY$2014"), 0) << "a run-time error: the servo task came to the end of the segments";
    return mean;
  }
  // To the end of the program: how often it has been along the lines.
  double finish() {
    accepted("P3=P1+2");
    std::string over;  // ERR001 until the last move has ended
    for (int i = 0; (over = board.send("B1\r")) != "\x06" && i < 200; ++i) board.run_ms(20);
    EXPECT_EQ(over, "\x06") << "it runs on";
    return value("P3");
  }
  ImageBoard board{firmware_image(), 0x3};
};

const std::vector<std::string> kCorners = {"LINEAR X.9 Y.2 Z(SIN(P2*10)) A-1 B.3 C.1 U1 V-.5",
                                           "CIRCLE1 X1 Y1 I1 J0 Z-.3 A1 B-.3 C-.1 U-1 V.5 P2=P2+1"};
// Tangents of circles: at speed, a stop takes 40 segments.
const std::vector<std::string> kSmooth = {
    "LINEAR X(COS(P2)) Y(SIN(P2)) Z.4 A-1 B.3 C.1 U1 V-.5",
    "CIRCLE2 X(COS(P2+2.387)) Y(SIN(P2+2.387)) R12 Z.4 A-1 B.3 C.1 U1 V-.5 P2=P2+4.7746"};

TEST_F(PathsImage, ASegmentOfEightAxesAtSpeed) {
  start(54, "0.06", kSmooth);
  OwnCycles own(board, "segment_work", "lookahead_add", "limits_reach");
  EXPECT_LE(cycles_a_segment(own, 60, 1000), 20000);
  EXPECT_LE(own.longest(), 500u) << own.longest_at();
}

// S-curves, and changes of velocity that have less room than they ask for.
TEST_F(PathsImage, ShortMovesPauseInTime) {
  start(54, "1",
        {"TM12 TA12 TS3 LINEAR X.1 Y.2 Z-.1 A.1 B.3 C.1 U.1 V-.1", "TM13 TA4 X-.1 Y.1 Z.2 A-.2 B.1 C-.1 U-.1"});
  OwnCycles own(board, "segment_work", "lookahead_add", "limits_reach");
  cycles_a_segment(own, 60, 100);
  EXPECT_LE(own.longest(), 500u) << own.longest_at();
}

// Arcs and turns that a stop has left, from another place: ways, times, corners are made anew (motion:7.1/8).
TEST_F(PathsImage, WhatWaitsPausesInTime) {
  accepted("I427=3000 I527=3000 I627=3000 I5183=.9");
  start(2, "1",
        {"F10 CIRCLE1 X1 Y1 Z-.3 I1 J0 ABS(Z,A,B,C) A1 B-.3 C-1", "U-1 V.5 X1 Y1 I1 J0 Z2 A2 B1 C1",
         "X2 Y1 I1 J1 Z1 A1 B2 C-1"});
  board.run_ms(60);
  accepted("&1Q");
  for (int i = 0; i < 50 && (std::stoul(board.send("??\r").substr(0, 6), nullptr, 16) & 1u) != 0; ++i) board.run_ms(20);
  accepted("#1HMZ#2HMZ#3HMZ#4HMZ#5HMZ#6HMZ");
  OwnCycles own(board, "plan_anew", "system_motors_turn", "corner_is_sharp");
  accepted("&1R");
  board.run_ms(20);
  std::printf("%llu between two pauses at %s, %llu in all\n", static_cast<unsigned long long>(own.longest()),
              own.longest_at().c_str(), static_cast<unsigned long long>(own.cycles()));
  EXPECT_GE(own.points(), 3u);
  EXPECT_GE(own.steps(), 1u);
  EXPECT_LE(own.longest(), 500u) << own.longest_at();
}

// Stops on the path, ways back, an override that changes, a jog from a part of a segment that changes its speed. What
// an order takes back goes in one piece.
TEST_F(PathsImage, OrdersPauseInTime) {
  start(54, "0.06", kSmooth);
  OwnCycles own(board, std::vector<std::string>{"segment_work", "jog_plan"}, "lookahead_add", "limits_reach");
  board.run_ms(100);
  for (const char* order : {"I5115=-.4 I5116=.01", "\\", "<", "\\", ">", "I5115=.3 I116=20"}) {
    accepted(std::string("&1") + order);
    board.run_ms(60);
  }
  accepted("\\");
  board.run_ms(4);
  accepted("A");
  board.run_ms(50);
  accepted("I116=20 B1R");  // its own limit now
  board.run_ms(100);
  EXPECT_LE(own.longest(), 600u) << own.longest_at();
}

TEST_F(PathsImage, ASegmentOfEightAxesWithCorners) {
  start(54, "1", kCorners);
  OwnCycles own(board, "segment_work", "lookahead_add", "limits_reach");
  const double few = cycles_a_segment(own, 60, 1000);
  EXPECT_LE(few, 20000);
  EXPECT_LE(own.longest(), 500u) << own.longest_at();
  accepted("M1->D:$88 M2->D:$108");
  const double rounds = finish();
  EXPECT_EQ(value("M1") / 3072, rounds * 1900);
  EXPECT_EQ(value("M2") / 3072, rounds * 1200);
  own.from_here();
  start(1000, "1", kCorners);
  const double many = cycles_a_segment(own, 1100, 1000);
  EXPECT_LE(own.longest(), 500u) << own.longest_at();
  EXPECT_LE(many, 1.2 * few);
  EXPECT_GE(many, few / 1.2);
}

}  // namespace
}  // namespace brick
