// Nothing that a host sends stops the controller: programs whose lines take longer than the real-time interrupt, on the
// cross-compiled image and the CPU model. The hardware watchdog allows 25 ms from strobe to strobe.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/image_board.h"
#include "testbench/unit/firmware_platform/stack_room.h"

namespace brick {
namespace {

constexpr double kStrobeLimitMs = 25.0;
constexpr unsigned kLineLimit = 255;

// `head`, then `term` as often as a line of 255 characters holds it, joined by `joint`.
std::string longest(const std::string& head, const std::string& term, const std::string& joint) {
  std::string line = head + term;
  while (line.size() + joint.size() + term.size() <= kLineLimit) line += joint + term;
  return line;
}

class Survival : public ::testing::Test {
 protected:
  void SetUp() override { EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  std::string ask(const std::string& line) {
    std::string reply = board.send(line + "\r", 500.0);
    EXPECT_EQ(reply.empty() ? 0 : reply.back(), '\x06') << line;
    return reply.substr(0, reply.find('\r'));
  }
  // The rings of the first `systems` coordinate systems hold `lines`, and all run.
  void run(unsigned systems, const std::vector<std::string>& lines) {
    for (unsigned cs = systems; cs >= 1; --cs) accepted("&" + std::to_string(cs) + "DEF ROT 1500 B0");
    accepted("OPEN ROT");
    for (unsigned cs = 1; cs <= systems; ++cs) {
      accepted("&" + std::to_string(cs));
      for (const std::string& line : lines) accepted(line);
    }
    accepted("CLOSE");
    for (unsigned cs = 1; cs <= systems; ++cs) accepted("&" + std::to_string(cs) + "R");
  }
  // Time passes until nothing is left to calculate; the controller answers all the while.
  void finish(unsigned systems, double limit_ms) {
    const double start = board.now_ms();
    for (unsigned cs = 1; cs <= systems; ++cs)
      while (ask("&" + std::to_string(cs) + "PR") != "0") {
        board.run_ms(20.0);
        ASSERT_LT(board.now_ms() - start, limit_ms) << "&" << cs;
      }
  }
  void expect_alive() {
    EXPECT_LT(board.longest_strobe_gap_ms(), kStrobeLimitMs);
    EXPECT_EQ(std::stoul(ask("???").substr(0, 6), nullptr, 16) & 0x400200u, 0u)
        << "real-time task too long: bits 22 and 9";  // bit 20: this board gives a line faster than any host bus
    RecordProperty("strobe_gap_us", static_cast<int>(board.longest_strobe_gap_ms() * 1000.0));
    expect_stack_room(board.cpu(), elf);
  }
  const ElfFile elf{firmware_image()};
  ImageBoard board{firmware_image(), 0x3};
};

// P1 = 28 ASIN(.5) = 28 x 30 degrees.
TEST_F(Survival, EightLinesOfTwentyEightArcSines) {
  BRICK_COVERS("WDT-1");
  run(1, std::vector<std::string>(8, longest("P1=", "ASIN(.5)", "+")));
  finish(1, 2000.0);
  EXPECT_EQ(ask("P1"), "840");
  expect_alive();
}

// The longest functions inside each other and beside each other, moves of eight axes by expressions, full lines.
std::vector<std::string> worst_lines() {
  std::string nested = "P2=";
  std::string close;
  for (unsigned i = 0; nested.size() + close.size() + 12 < kLineLimit; ++i) {
    static const char* const functions[] = {"ACOS(", "EXP(", "SIN(", "ATAN2(", "SQRT(", "TAN(", "LN(", "ASIN("};
    nested += functions[i % 8];
    close += ')';
  }
  nested += ".5" + close;
  return {"TA0 TS0 F1000000 INC FRAX(A,B,U,V,W,X,Y,Z)",
          nested,
          longest("P3=", "ACOS(Q1)", "*"),
          "A(ASIN(.1))B(ASIN(.2))U(ASIN(.3))V(ASIN(.4))W(ACOS(.5))X(ACOS(.6))Y(ACOS(.7))Z(ACOS(.8))",
          longest("P4=", "EXP(80)", "/"),
          longest("", "Q(SQRT(2))=1", " "),
          longest("", "TA(LN(2))", " "),
          longest("P5=", "Q(Q(1))", "%"),
          "A1B1U1V1W1X1Y1Z1",
          longest("", "Q1=ASIN(1)", " ")};
}

TEST_F(Survival, SixteenSystemsOfTheLongestLines) {
  BRICK_COVERS("WDT-1");
  for (const std::string& line : worst_lines()) ASSERT_LE(line.size(), kLineLimit);
  run(16, worst_lines());
  finish(16, 10000.0);
  expect_alive();
}

// All that is deep at once: the longest functions in each other in sixteen programs, in PLCs of both tasks and in lines
// of the host, bracket in bracket, calls in calls, and what interrupts them. The image shows what is left.
TEST_F(Survival, StacksKeepRoomUnderAllThatIsDeep) {
  const std::string nested = worst_lines()[1];
  const std::string brackets = "P9=" + std::string(125, '(') + "7" + std::string(125, ')');
  for (unsigned n = 2; n <= 15; ++n) {
    accepted("OPEN PROG " + std::to_string(n) + " CLEAR");
    accepted(nested);
    accepted(n < 15 ? "CALL" + std::to_string(n + 1) : "RET");
    accepted("CLOSE");
  }
  accepted("OPEN PLC 0 CLEAR P8=ATAN2(.5) CLOSE");  // short: it makes whole scans in the real-time task
  accepted("OPEN PLC 1 CLEAR");
  accepted(nested);
  accepted(brackets);
  accepted("CLOSE");
  std::vector<std::string> lines = worst_lines();
  lines.emplace_back("CALL2");
  run(16, lines);
  // Eight motors: what the times of the tasks are for (motion:1.6). 32 leave the background too little for half a
  // second.
  accepted("I100,8,100=1 I101,8,100=1 I5=3 I47=1 I48=1 I57=0 ENABLE PLC 0,1");
  for (int i = 0; i < 5; ++i)
    for (const std::string& line : {nested, brackets, std::string("P1..99"), std::string("LIST PLC 1")})
      (void)ask(line);
  accepted("DISABLE PLC 0,1");
  board.run_ms(1000.0);
  board.send("\x01", 5.0);
  (void)ask("SAVE");
  board.run_ms(3500.0);
  const StackRoom main = stack_room(board.cpu(), elf, "stack"), side = stack_room(board.cpu(), elf, "side_stack");
  EXPECT_EQ(ask("RX$73"), std::to_string(main.unused));
  EXPECT_EQ(ask("RY$73"), std::to_string(side.unused));
  expect_stack_room(board.cpu(), elf);
}

// 512 assignments for moves that start in the same servo interrupt take some slices. All are made when these start, and
// no real-time task is late for it. For that the systems stand at 0 % in the move before and go on in one line.
TEST_F(Survival, SynchronousAssignmentsOfSixteenSystemsAtOnce) {
  BRICK_COVERS("WDT-1");
  constexpr unsigned kSystems = 16, kEach = 32;
  accepted("I8=0 I5194,16,100=8388607 M100..1699->* M100..1699=0");
  accepted("OPEN PROG 1 CLEAR TM200 TA10 TS0 X1");
  for (unsigned i = 0; i < kEach; i += 4)
    accepted("M(Q1)==Q1 Q1=Q1+1 M(Q1)==Q1 Q1=Q1+1 M(Q1)==Q1 Q1=Q1+1 M(Q1)==Q1 Q1=Q1+1");
  accepted("X2");
  accepted("CLOSE");
  for (unsigned cs = 1; cs <= kSystems; ++cs) {
    char time_base[40];
    std::snprintf(time_base, sizeof time_base, "M%u->X:$%X,24,S", 2000 + cs, 0x2000 + 0x100 * (cs - 1));
    accepted(time_base);
    accepted("&" + std::to_string(cs) + "Q1=" + std::to_string(100 * cs) + "B1");
  }
  accepted("M2001..2016=0");
  board.send("\x12", 5.0);  // ^R
  board.run_ms(300.0);
  // Of system n M(100 n) and on: how many are made, each with its own number.
  const auto made = [&] {
    unsigned count = 0;
    for (unsigned cs = 1; cs <= kSystems; ++cs)
      for (unsigned m = 100 * cs; m < 100 * cs + kEach; ++m) {
        const std::string value = ask("M" + std::to_string(m));
        if (value == std::to_string(m))
          ++count;
        else
          EXPECT_EQ(value, "0") << "M" << m;
      }
    return count;
  };
  for (unsigned cs = 1; cs <= kSystems; ++cs)
    EXPECT_EQ(ask("&" + std::to_string(cs) + "Q1"), std::to_string(100 * cs + kEach)) << "all are calculated";
  EXPECT_EQ(made(), 0u) << "no move has started";
  accepted("M2001..2016=" + ask("I10"));
  board.run_ms(180.0);  // of the 200 ms to the start of X2
  for (unsigned cs = 1; cs <= kSystems; ++cs) EXPECT_EQ(ask("M" + std::to_string(100 * cs)), "0");
  board.run_ms(60.0);
  EXPECT_EQ(made(), kSystems * kEach);
  board.run_ms(500.0);
  for (unsigned cs = 1; cs <= kSystems; ++cs) {
    const unsigned long status = std::stoul(ask("&" + std::to_string(cs) + "??").substr(0, 6), nullptr, 16);
    EXPECT_EQ(status & 1u, 0u) << "&" << cs << " has not ended";
  }
  expect_alive();
}

// The same line all the time: 20 arc sines take more than two slices, so `A` finds it half calculated.
TEST_F(Survival, AbortForgetsALineThatIsHalfCalculated) {
  constexpr int kLines = 14;
  const std::string line = longest("P1=P1+1+0*(", "ASIN(1)", "+") + ")";
  std::vector<std::string> lines(kLines, line.substr(0, 11 + 8 * 25 - 1) + ")");
  run(1, lines);
  int aborts = 0;
  for (; ask("PR") != "0" && aborts < 100; ++aborts) {
    accepted("A");
    EXPECT_EQ(std::stoul(ask("??").substr(0, 6), nullptr, 16) & 1u, 0u) << "running";
    board.run_ms(0.7 * aborts);
    accepted("R");
    board.run_ms(5.0 * (1 + aborts % 3));
  }
  EXPECT_GE(aborts, 3) << "nothing was interrupted";
  const int done = std::stoi(ask("P1"));
  EXPECT_GE(done, kLines - aborts) << "an abort loses one line at most";
  EXPECT_LT(done, kLines) << "no line was aborted";
  expect_alive();
}

// Lines without a move are stopped between two of them, not behind all that one round may take.
TEST_F(Survival, QuitStopsBehindTheLineUnderWay) {
  constexpr int kLines = 16;
  run(1, std::vector<std::string>(kLines, longest("P1=", "ASIN(.5)", "+")));
  accepted("Q");
  const int left = std::stoi(ask("PR"));
  EXPECT_GT(left, kLines / 2);
  board.run_ms(60.0);  // a line takes 20 ms
  EXPECT_EQ(std::stoul(ask("??").substr(0, 6), nullptr, 16) & 1u, 0u) << "running";
  EXPECT_GE(std::stoi(ask("PR")), left - 1);
  expect_alive();
}

// The blocks of a called program are read in the real-time task, a line without a pause. Each word of these lines is
// looked at as often as every other: were it once for each condition, a line would take longer than the task may.
TEST_F(Survival, CallOfAProgramWithLinesOfConditions) {
  std::string line;
  while (line.size() + 7 + 7 <= kLineLimit) line += "IF(1=1)";
  const std::vector<std::string> program = {"OPEN PROG 2 CLEAR", line + "P1=P1+1", line + "P1=P1+1", "CLOSE",
                                            "OPEN PROG 1 CLEAR", "CALL2 P2=1",     "CLOSE",          "B1R"};
  for (const std::string& text : program) accepted(text);
  board.run_ms(200.0);
  EXPECT_EQ(ask("P1"), "2");
  EXPECT_EQ(ask("P2"), "1");
  expect_alive();
}

// From the character to the call of run_abort, whatever the controller is at.
class AbortLatency : public Survival {
 protected:
  double ms_to_abort() {
    double began = board.now_ms(), found = -1.0;
    board.cpu().on_flow = [this, &found](std::uint32_t pc, Cycle) {
      if (found < 0.0 && elf.symbol_at(pc) == "run_abort") found = board.now_ms();
    };
    board.send("\x01", 2.0);
    board.cpu().on_flow = nullptr;
    EXPECT_GE(found, 0.0) << "no abort within 2 ms";
    return found - began;
  }
};

TEST_F(AbortLatency, IsBelowAMillisecond) {
  EXPECT_LE(ms_to_abort(), 1.0) << "idle";
  for (const char* line : {"SAVE\r", "P0..8191\r", "M0..8191=5\r", "I5192..6599,1=0\r"}) {
    board.send(line, 3.0);
    EXPECT_LE(ms_to_abort(), 1.0) << line;
    board.run_ms(400.0);
    board.send("", 1.0);
  }
  board.send("SAVE\r", 1.0);
  board.send(std::string(2050, 'U'), 10.0);  // as many as the queue and a host port hold, while SAVE goes on
  EXPECT_LE(ms_to_abort(), 1.0) << "behind a full queue";
  board.run_ms(400.0);
  board.send("", 1.0);
  EXPECT_EQ(board.send("\x18I3\r"),
            "\x18"
            "2\r\x06");
  run(16, worst_lines());
  board.run_ms(5.0);
  EXPECT_LE(ms_to_abort(), 1.0) << "16 programs";
  EXPECT_EQ(std::stoul(ask("&16??").substr(0, 6), nullptr, 16) & 1u, 0u) << "running";
  expect_alive();
}

}  // namespace
}  // namespace brick
