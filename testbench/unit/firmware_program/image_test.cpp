// Rotary program on the cross-compiled image and the CPU model: BREQ edges in CPU time, execution in servo time, cost
// of the tasks.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "rtl/regs/brick_regs.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/image_board.h"

namespace brick {
namespace {

constexpr double kCyclesPerUs = ImageBoard::kCyclesPerMs / 1000.0;
constexpr std::uint32_t kBreq = 2;  // bit 1 of the host signals latch

// Notes when a carriage return is read from the host port, and every change of BREQ.
class ObservedBoard : public ImageBoard {
 public:
  struct Edge {
    bool high;
    double us;
  };
  using ImageBoard::ImageBoard;

  Result access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data, Cycle now) override {
    const Result result = ImageBoard::access(address, bytes, write, data, now);
    const std::uint32_t word = (address - 0xC0000000u) / 8;
    const double us = static_cast<double>(now) / kCyclesPerUs;
    if (!write && word == HI08_X_HORX && result.data == '\r') return_us = us;
    if (write && word == BOARD_LATCHES_X_HOST_SIGNALS && (data & kBreq) != (level_ ? kBreq : 0)) {
      level_ = !level_;
      edges.push_back({level_, us});
    }
    return result;
  }
  bool breq() const { return level_; }

  std::vector<Edge> edges;
  double return_us = 0.0;

 private:
  bool level_ = false;
};

class RotaryImage : public ::testing::Test {
 protected:
  void SetUp() override { EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  int lines() { return std::stoi(board.send("PR\r")); }
  bool full() { return (board.send("??\r").at(7) - '0') & 1; }
  ObservedBoard board{firmware_image(), 0x3};
};

TEST_F(RotaryImage, FillsToI17AndDrainsBelowI16) {
  BRICK_COVERS("BREQ-1 BREQ-2 BREQ-3 BREQ-4 BREQ-5 CARD-3");
  accepted("DELETE GATHER &1DEF ROT 200");
  accepted("&1B0");
  EXPECT_FALSE(board.breq());
  accepted("OPEN ROT");
  EXPECT_TRUE(board.breq());
  accepted("TM20 TA10 TS0 INC");
  for (int line = 2; line <= 10; ++line) {
    board.edges.clear();
    accepted("X1 Y2");
    ASSERT_EQ(board.edges.size(), line < 10 ? 2u : 1u) << "line " << line;
    EXPECT_FALSE(board.edges[0].high);
    const double fall = board.edges[0].us - board.return_us;
    EXPECT_GE(fall, 0.0);
    EXPECT_LE(fall, 50.0) << "T_FALL";
    if (line < 10) {
      EXPECT_GE(board.edges[1].us - board.edges[0].us, 1.0);
      EXPECT_LE(board.edges[1].us - board.edges[0].us, 50.0);
      RecordProperty("low_us", std::to_string(board.edges[1].us - board.edges[0].us));
    }
    EXPECT_EQ(full(), line == 10);
    RecordProperty("fall_us", std::to_string(fall));
  }
  board.edges.clear();
  accepted("R");
  for (int poll = 0; poll < 200 && full(); ++poll) board.run_ms(1.0);
  EXPECT_FALSE(full());
  EXPECT_EQ(lines(), 4);
  ASSERT_EQ(board.edges.size(), 1u);
  EXPECT_TRUE(board.edges[0].high);
  board.run_ms(300.0);
  EXPECT_EQ(lines(), 0);
  accepted("A");
}

TEST_F(RotaryImage, NineMovesTakeTheirTime) {  // 9 x 20 ms + 10 ms: 429.2 servo periods of 442.7 us
  accepted("&1DEF ROT 200");
  accepted("B0 OPEN ROT");
  accepted("TM20 TA10 TS0 INC");
  for (int i = 0; i < 9; ++i) accepted("X1 Y2");
  accepted("P1=1");
  accepted("CLOSE R");
  const double start = board.now_ms();
  board.run_ms(5.0);                                                            // the first move is under way
  while ((std::stoi(board.send("??\r").substr(7, 1), nullptr, 16) & 2) == 0) {  // in position: bit 17
    board.run_ms(0.2);
    ASSERT_LT(board.now_ms() - start, 1000.0);
  }
  // A servo period before the first move, up to a real-time period (1.33 ms) until it is calculated, and the poll.
  EXPECT_GE(board.now_ms() - start, 190.0);
  EXPECT_LE(board.now_ms() - start, 190.0 + 3.5);
  EXPECT_EQ(board.send("P1\r"), "1\r\x06");
}

TEST_F(RotaryImage, FastLinesReachTheControllerInOrder) {
  accepted("&1DEF ROT 2000");
  accepted("B0 OPEN ROT");
  accepted("R");
  for (int i = 0; i < 200; ++i) accepted("P(P0+10)=P0 P0=P0+1");
  board.run_ms(200.0);
  EXPECT_EQ(lines(), 0);
  EXPECT_EQ(board.send("P0 P10 P109 P209\r"), "200\r0\r99\r199\r\x06");
}

TEST_F(RotaryImage, SixteenProgramsRunWithoutOverrun) {
  for (int cs = 16; cs >= 1; --cs) accepted("&" + std::to_string(cs) + "DEF ROT 200 B0");
  accepted("OPEN ROT");
  for (int cs = 1; cs <= 16; ++cs) {
    accepted("&" + std::to_string(cs) + "TM10 TA5 TS0 INC");
    for (int i = 0; i < 10; ++i) accepted("X1 Y0.5");
  }
  accepted("CLOSE");
  for (int cs = 1; cs <= 16; ++cs) accepted("&" + std::to_string(cs) + "R");
  board.run_ms(300.0);
  for (int cs = 1; cs <= 16; ++cs) EXPECT_EQ(board.send("&" + std::to_string(cs) + "PR\r"), "0\r\x06");
  EXPECT_EQ(board.send("???\r").at(1) & 1, 0) << "servo error (bit 20)";
}

}  // namespace
}  // namespace brick
