// Fixed motion programs on the cross-compiled image: what endless ones cost, and that nothing waits for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/own_cycles.h"

namespace brick {
namespace {

class MotionImage : public ::testing::Test {
 protected:
  void SetUp() override { EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  void store(int number, const std::vector<std::string>& lines) {
    accepted("OPEN PROG " + std::to_string(number) + " CLEAR");
    for (const std::string& line : lines) accepted(line);
    accepted("CLOSE");
  }
  double value(const std::string& name) { return std::stod(board.send(name + "\r")); }
  ImageBoard board{firmware_image(), 0x3};
};

TEST_F(MotionImage, FifteenEndlessProgramsLeaveHostWatchdogAndBlending) {
  store(1, {"WHILE(1=1)", "P(Q1)=P(Q1)+1 IF(P(Q1)<0)P0=ASIN(.5)+ATAN2(3)", "ENDWHILE"});
  store(2, {"N1 GOSUB 10 P(Q1)=P(Q1)+1 P0=LN(5)+SIN(30)", "GOTO 1", "N10 WHILE(P0!<0) P0=-1", "RETURN"});
  store(16, {"TM20TA10TS0INC", "WHILE(P40<50) P40=P40+1 X1", "DWELL0", "P41=1"});
  for (int cs = 1; cs <= 15; ++cs)
    accepted("&" + std::to_string(cs) + "Q1=" + std::to_string(20 + cs) + "B" + (cs % 2 == 0 ? "1R" : "2R"));
  accepted("&16B16R");
  const double began = board.now_ms();
  double longest = 0.0;
  while (value("P41") == 0.0 && board.now_ms() - began < 2000.0) {
    const double asked = board.now_ms();
    EXPECT_EQ(board.send("I3\r"), "2\r\x06");
    longest = std::max(longest, board.now_ms() - asked);
  }
  // 50 moves of 20 ms and the last deceleration; blended all of them, else 30 ms each.
  EXPECT_NEAR(board.now_ms() - began, 50 * 20.0 + 10.0, 15.0);
  EXPECT_LT(longest, 5.0);
  RecordProperty("reply_ms", std::to_string(longest));
  for (int cs = 1; cs <= 15; ++cs) EXPECT_GT(value("P" + std::to_string(20 + cs)), 20.0) << cs;
  EXPECT_EQ(std::stoul(board.send("???\r").substr(0, 6), nullptr, 16) & 0x508200u, 0u);
  EXPECT_LT(board.longest_strobe_gap_ms(), 12.0);
  accepted("&1A");
  board.run_ms(4.0);
  EXPECT_EQ(board.send("&1??\r").at(7) & 2, 2) << "in position, while the others go on";
}

// As of paths: 500 cycles hold two or three products of doubles, or two divisions. LONGEST_SECTION of
// firmware/kernel/slice.c is more, what the real-time task does beside the slice is in it.
TEST_F(MotionImage, JogsPauseInTime) {
  accepted("I100=1 I124=$120001 I111=0 I122=20 I119=.1 I120=50 I121=10");
  board.run_ms(20);
  OwnCycles own(board, "jog_plan", "own_path_stay", "own_path_stay_for_ever");
  for (const char* jog : {"#1J+", "J/", "J:1000000", "J:-100", "J/", "J:30", "J-", "J^2000", "J="}) {
    accepted(jog);
    board.run_ms(5);
  }
  // A new end too near to become faster before it: 10 counts/ms stop within 100 + 10 ms, 550 counts, and a change to
  // the new speed lasts 50 ms at least, 500 counts.
  const std::pair<const char*, double> jogs[] = {
      {"I122=10 J+", 150}, {"I122=20 J:900", 5}, {"I122=10 J-", 300}, {"I122=20 J:-900", 5}};
  accepted("M88->D:$88");  // 1/3072 count
  for (const auto& [jog, ms] : jogs) {
    accepted(jog);
    board.run_ms(ms);
    if (ms < 100) continue;
    const double from = value("M88");
    board.run_ms(10);
    EXPECT_NEAR(std::abs(value("M88") - from) / 3072, 10 * 10, 15) << "at the speed of the jog, and of two replies";
  }
  // A ramp from the cubic of a move.
  accepted("J/");
  board.run_ms(300);
  store(1, {"INC LINEAR TA100 TS0 TM500 X10000"});
  accepted("&1#1->X B1R");
  board.run_ms(60);
  accepted("&1A");
  board.run_ms(5);
  std::printf("%llu between two pauses at %s\n", static_cast<unsigned long long>(own.longest()),
              own.longest_at().c_str());
  EXPECT_GE(own.points(), 1u);
  EXPECT_GE(own.steps(), 1u);
  EXPECT_LE(own.longest(), 500u) << own.longest_at();
}

TEST_F(MotionImage, LoopsWithoutAMoveGoRoundTwiceAnInterrupt) {
  store(1, {"WHILE(P1<1000) P1=P1+1", "P2=1"});
  accepted("B1R");
  const double began = board.now_ms();
  while (value("P2") == 0.0) ASSERT_LT(board.now_ms() - began, 1000.0);
  RecordProperty("loop_ms", std::to_string(board.now_ms() - began));
  EXPECT_NEAR(board.now_ms() - began, 500 * 3 * 3713991.0 / 8388608.0, 15.0) << "500 real-time interrupts";
}

// motion:5.4/6: eight axes, a point each 3 ms; each 1 ms is too much, and is said.
TEST_F(MotionImage, SplinePointsOfEightAxesAreInTimeOrAnError) {
  const char* axes = "XYZABCUV";
  for (int m = 1; m <= 8; ++m) {
    const std::string n = std::to_string(m);
    accepted("I" + n + "00=1 I" + n + "24=$120001 I" + n + "11=0 &1#" + n + "->1000" + axes[m - 1]);
  }
  accepted("A");
  board.run_ms(20);
  accepted("M1->D:$88 M2->D:$408");  // motors 1 and 8
  for (const int time : {3, 1}) {
    store(1, {"SPLINE1 INC TM" + std::to_string(time) + " P1=0 WHILE(P1<40)",
              "X.1 Y.2 Z(SIN(P1*10)) A-1 B.3 C.1 U1 V-.5 P1=P1+1", "ENDWHILE"});
    const double first = value("M1"), eighth = value("M2");
    accepted("B1R");
    const double began = board.now_ms();
    while (board.send("B1\r") != "\x06") board.run_ms(1);  // ERR001 until its last move has ended
    const double took = board.now_ms() - began;
    EXPECT_EQ(value("RY$2014"), time == 3 ? 0 : 9);
    if (time != 3) continue;
    EXPECT_NEAR(took, (40 + 2) * 3, 8) << "one sequence";
    EXPECT_EQ(value("M1") - first, 4000 * 3072.0);
    EXPECT_EQ(value("M2") - eighth, -20000 * 3072.0);
  }
}

// motion:6.6/1: within 2 ms, also where planning and PLC 0 come every 113 ms only.
TEST_F(MotionImage, ProtectionDoesNotWaitForI8) {
  accepted("I100=1 I124=$100001 I111=0 I112=0 I122=10 I119=1 I120=0 I121=0");
  const auto status = [this](unsigned word) {
    return std::stoul(board.send("#1?\r").substr(6 * word, 6), nullptr, 16);
  };
  for (const char* period : {"I8=2", "I8=255"}) {
    accepted(std::string(period) + " WX$78000,0");
    board.run_ms(120);
    accepted("#1J/");
    board.run_ms(250);
    accepted("J+");
    board.run_ms(400);
    ASSERT_EQ(status(0) >> 21 & 3u, 0u) << period;
    ASSERT_EQ(status(1) >> 11 & 1u, 0u) << period << ": no limit has stopped it";
    accepted("WX$78000,$20000");  // PLIM
    board.run_ms(2);
    EXPECT_EQ(status(1) >> 11 & 1u, 1u) << period << ": stopped on a limit";
    accepted("WX$78000,0 I111=16");
    board.run_ms(2);
    EXPECT_EQ(status(1) >> 2 & 1u, 1u) << period << ": it has jogged, but stands at 0";
    EXPECT_EQ(status(0) >> 18 & 1u, 1u) << period << ": the loop is open";
    accepted("I111=0");
  }
}

// motion:4.3/1: what was captured before is read away when a search begins; a jog leaves it to the user.
class ReadsOfCapture : public ImageBoard {
 public:
  ReadsOfCapture() : ImageBoard(firmware_image(), 0x3) {}
  Result access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data, Cycle now) override {
    constexpr std::uint32_t kCaptured = 0x78003 * 8 + 4;  // X, behind the base of the PMAC words
    if (!write && address % 0x1000000 == kCaptured) ++reads;
    return ImageBoard::access(address, bytes, write, data, now);
  }
  unsigned reads = 0;
};

TEST(MotionOfCapture, ASearchReadsTheRegisterWhenItBegins) {
  ReadsOfCapture board;
  ASSERT_EQ(board.send("I6=1 I3=2 I100=1 I124=$120001 I111=0 I192=10\r"), "\x06");
  ASSERT_EQ(board.send("#1J/\r"), "\x06");
  board.run_ms(30);
  const unsigned before = board.reads;
  ASSERT_EQ(board.send("J:100\r"), "\x06");
  board.run_ms(30);
  EXPECT_EQ(board.reads, before) << "a jog";
  ASSERT_EQ(board.send("HM\r"), "\x06");
  board.run_ms(5);
  EXPECT_EQ(board.reads, before) << "Ixx92 is not over";
  board.run_ms(20);
  EXPECT_EQ(board.reads, before + 1);
}

}  // namespace
}  // namespace brick
