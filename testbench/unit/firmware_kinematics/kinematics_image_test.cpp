// What kinematic programs cost on the cross-compiled image: cycles of the CPU on the stack of slices, a segment, and
// the longest way from pause to pause.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "testbench/unit/firmware_platform/own_cycles.h"

namespace brick {
namespace {

class KinematicsImage : public ::testing::Test {
 protected:
  void SetUp() override {
    EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06");
    accepted("I68=15 I15=0");
  }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  double value(const std::string& name) { return std::stod(board.send(name + "\r")); }
  static std::string text(int n) { return std::to_string(n); }

  void motor(int n, int cs, const std::string& definition) {
    accepted("I" + text(n) + "00=1 I" + text(n) + "24=$120001 I" + text(n) + "11=0");
    accepted("&" + text(cs) + "#" + text(n) + "->" + definition);
  }
  // An arm of two joints, its elbow at 60 degrees when its motors are at 0.
  void fit_arm(int cs, int isx13) {
    const std::string a = text(2 * cs - 1), b = text(2 * cs), error = "M" + text(5082 + 100 * cs);
    motor(2 * cs - 1, cs, "I");
    motor(2 * cs, cs, "I");
    accepted("OPEN FORWARD CLEAR");
    accepted("Q30=P" + a + "/1000 Q31=Q30+60+P" + b + "/1000");
    accepted("Q7=300*COS(Q30)+250*COS(Q31) Q8=300*SIN(Q30)+250*SIN(Q31) CLOSE");
    accepted("OPEN INVERSE CLEAR");
    accepted("Q20=(Q7*Q7+Q8*Q8-152500)/150000 IF (ABS(Q20)!>1)");
    accepted("Q21=ACOS(Q20) Q0=Q7 Q22=ATAN2(Q8) Q0=300+250*COS(Q21) Q23=ATAN2(250*SIN(Q21))");
    accepted("P" + a + "=(Q22-Q23)*1000 P" + b + "=(Q21-60)*1000 P100=P100+1");
    accepted("ELSE " + error + "=1 ENDIF CLOSE");
    char address[16];
    std::snprintf(address, sizeof address, "%X", 0x203F + 0x100 * (cs - 1));
    accepted(error + "->Y:$" + address + ",22");
    accepted("I5" + text(cs) + "50=1 I5" + text(cs) + "13=" + text(isx13));
  }
  void path(int isx13) {
    accepted("OPEN PROG 1 CLEAR TM100 TA20 TS0 INC Q50=0 WHILE(Q50<4)");
    accepted("LINEAR X-20 Y5");
    accepted("CIRCLE1 X20 Y-5 I10 J0 Q50=Q50+1");
    accepted("ENDWHILE CLOSE");
    const int whole = (8 * 100 + 20) / isx13;
    segments = whole + 3;
  }
  // Of programs that run in systems 1 to `count` at once.
  double run(int count) {
    for (int cs = 1; cs <= count; ++cs) accepted("&" + text(cs) + "A");
    board.run_ms(30);
    OwnCycles own(board, "segment_work", "segment_ring_hand_over");
    accepted("P100=0");
    for (int cs = 1; cs <= count; ++cs) accepted("&" + text(cs) + "B1R");
    for (int i = 0; i < 200 && running(count); ++i) board.run_ms(20);
    EXPECT_FALSE(running(count));
    for (int cs = 0; cs < count; ++cs) {
      char name[16];
      std::snprintf(name, sizeof name, "RY$%X", 0x2014 + 0x100 * cs);
      EXPECT_EQ(value(name), 0) << "a run-time error of &" << cs + 1;
    }
    longest = own.longest(), longest_at = own.longest_at();
    return static_cast<double>(own.cycles()) / (count * segments);
  }
  bool running(int count) {
    for (int cs = 1; cs <= count; ++cs)
      if (board.send("&" + text(cs) + "B1\r") != "\x06") return true;  // ERR001 until its last move has ended
    return false;
  }

  double segments = 0;
  std::uint64_t longest = 0;  // own cycles between two pauses
  std::string longest_at;
  ImageBoard board{firmware_image(), 0x3};
};

// With all others beside it, half of the time is for planning: 39,322 cycles a ms.
TEST_F(KinematicsImage, ASegmentOfAnArm) {
  motor(1, 1, "1000X");
  motor(2, 1, "1000Y");
  accepted("I5113=5");
  path(5);
  const double plain = run(1);
  fit_arm(1, 5);
  path(5);
  const double arm = run(1);
  EXPECT_NEAR(value("P100"), segments, 3) << "executions of the inverse program";
  std::printf("%.0f cycles a segment by definitions, %.0f by the inverse program\n", plain, arm);
  RecordProperty("cycles", std::to_string(arm));
  EXPECT_LT(arm / 5, ImageBoard::kCyclesPerMs / 2);
  std::printf("%llu between two pauses at %s\n", static_cast<unsigned long long>(longest), longest_at.c_str());
  EXPECT_LE(longest, 500u) << longest_at;
}

TEST_F(KinematicsImage, TwoArmsAtOnce) {
  for (int cs = 1; cs <= 2; ++cs) fit_arm(cs, 10);
  path(10);
  const double cycles = run(2);
  std::printf("%.0f cycles a segment of each of two arms\n", cycles);
  EXPECT_LT(2 * cycles / 10, ImageBoard::kCyclesPerMs / 2);
}

// motion:8.1/7: 10 ms of calculation are 20 ms in all, 10 more for its start. So long paths of others last: seven
// motors of &2 go on, without lookahead, to which it would be an error to come to the end of their segments.
TEST_F(KinematicsImage, ARunawayEnds) {
  fit_arm(1, 10);
  path(10);
  accepted("&1OPEN INVERSE CLEAR WHILE(1=1) ENDWHILE CLOSE");
  const char* const axes = "XYZABCU";
  for (int n = 3; n <= 9; ++n) motor(n, 2, std::string("1000") + axes[n - 3]);
  accepted("I5213=5 OPEN PROG 2 CLEAR TM40 TA10 TS0 INC P7=0 WHILE(P7<30)");
  accepted("CIRCLE1 X1 Y1 I1 J0 Z.3 A1 B1 C1 U1 P7=P7+1 ENDWHILE CLOSE");
  accepted("&1A&2A");
  board.run_ms(30);
  accepted("&2B2R");
  for (int i = 0; i < 6; ++i) {
    board.run_ms(90 + 7 * i);
    accepted("&1B1R");
    board.run_ms(8);
    EXPECT_EQ(value("RY$2014"), 0);
    board.run_ms(25);
    EXPECT_EQ(value("RY$2014"), 12);
    EXPECT_EQ(value("RY$2114"), 0);
  }
  for (int i = 0; i < 100 && board.send("&2B2\r") != "\x06"; ++i) board.run_ms(20);
  EXPECT_EQ(value("RY$2114"), 0);
  EXPECT_EQ(value("P7"), 30);
  accepted("M1->D:$208");
  EXPECT_EQ(value("M1") / 3072, 30 * 1000);
}

}  // namespace
}  // namespace brick
