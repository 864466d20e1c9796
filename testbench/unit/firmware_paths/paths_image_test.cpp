// What segments and lookahead cost on the cross-compiled image: cycles of the CPU while it is on the stack of slices.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "testbench/unit/firmware_platform/image_board.h"

namespace brick {
namespace {

constexpr std::uint32_t kSideStack = 0x20000000, kSideStackBytes = 8192;

class PathsImage : public ::testing::Test {
 protected:
  void SetUp() override { EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  double value(const std::string& name) { return std::stod(board.send(name + "\r")); }

  // Eight motors along blended lines and arcs, 5 ms a segment: cycles of planning a segment, the longest time between
  // two pauses.
  double cycles_a_segment(int ahead, int moves) {
    const char* axes = "XYZABCUV";
    for (int m = 1; m <= 8; ++m) {
      const std::string n = std::to_string(m);
      accepted("I" + n + "00=1 I" + n + "24=$120001 I" + n + "11=0 I" + n + "16=60 I" + n + "17=1");
      accepted("&1#" + n + "->1000" + axes[m - 1]);
    }
    accepted("I5113=5 I5120=" + std::to_string(ahead));
    accepted("DELETE GATHER");
    accepted("&1 DEFINE LOOKAHEAD " + std::to_string(ahead + 20) + ",0");
    accepted("A");
    board.run_ms(20);
    accepted("OPEN PROG 1 CLEAR");
    accepted("TM40 TA10 TS0 INC P1=0 WHILE(P1<" + std::to_string(moves) + ")");
    accepted("LINEAR X.9 Y.2 Z(SIN(P1*10)) A-1 B.3 C.1 U1 V-.5");
    accepted("CIRCLE1 X1 Y1 I1 J0 Z-.3 A1 B-.3 C-.1 U-1 V.5 P1=P1+1");
    accepted("ENDWHILE CLOSE");
    std::uint64_t spent = 0, last = 0;
    board.on_instruction = [&] {
      const std::uint64_t now = board.cpu().cycle();
      const std::uint32_t sp = board.cpu().reg(2) - kSideStack;
      if (sp < kSideStackBytes) spent += now - last;
      last = now;
    };
    accepted("B1R");
    for (int i = 0; i < 400 && value("P1") < moves; ++i) board.run_ms(50);
    for (int i = 0; i < 400 && (std::stoul(board.send("??\r").substr(0, 6), nullptr, 16) & 1u) != 0; ++i)
      board.run_ms(20);
    board.on_instruction = nullptr;
    EXPECT_EQ(value("P1"), moves);
    const double segments = (moves * 2 * 40.0 + 10) / 5;
    return static_cast<double>(spent) / segments;
  }
  ImageBoard board{BRICK_FIRMWARE_ELF, 0x3};
};

TEST_F(PathsImage, ASegmentOfEightAxes) {
  const double cycles = cycles_a_segment(54, 40);
  RecordProperty("cycles", std::to_string(cycles));
  std::printf("%.0f cycles a segment\n", cycles);
  EXPECT_EQ(value("RY$2014"), 0) << "a run-time error: the servo task came to the end of the segments";
  accepted("M1->D:$88 M2->D:$108");
  EXPECT_EQ(value("M1") / 3072, 40 * 1900);
  EXPECT_EQ(value("M2") / 3072, 40 * 1200);
}

}  // namespace
}  // namespace brick
