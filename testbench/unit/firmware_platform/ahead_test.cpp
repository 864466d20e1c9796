// Lines are compiled while they come (firmware/command/program_line.h): whatever comes, and however it is cut, replies
// and programs are those of the same characters that come at once.
#include <gtest/gtest.h>

#include "testbench/unit/firmware_platform/controller.h"
#include "testbench/unit/random_lines.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
}

namespace brick {
namespace {

const std::string kOpen = "&2DEF ROT 500 B0 &1DEF ROT 500 B0 OPEN ROT\r";

// The background looks after each character, as it does while it has nothing else to do.
std::string slowly(Controller& c, const std::string& characters) {
  std::string reply;
  for (const char one : characters) {
    host_port_character(static_cast<std::uint8_t>(one));
    line_input_text();
    if (one < ' ') reply += c.send("");
  }
  return reply;
}

void same(const std::string& characters, const std::string& open = kOpen) {
  const auto all = [&](bool in_pieces) {
    Controller c;
    std::string reply = c.send(open);
    reply += in_pieces ? slowly(c, characters) : c.send(characters);
    return reply + c.send("\rSIZE\rPR\rLIST\r&2LIST\rCLOSE\r");
  };
  EXPECT_EQ(all(true), all(false)) << characters;
}

TEST(Ahead, ALineIsTheSameInPieces) {
  same("X1 Y2\r");
  same(" X1\r X2\r X3\r X4\r  X12 Y5\r  X34 Y6\r  X7 Y8\r");
  same("X1 Y2 Z3 A4 B5 C6 U7 V8\rX-1.25Y.5\rX 1 Y - 2\r");
  same("x1 y2 dwell5 z3\rX1Y2F100\rF100X1Y2\rX1DELAY5\r");
  same("X1Y2;Z3\rX1Y2\"Z3\"\rX$10Y$1Z2\rX1^2Y3\rX1:2Y3\rX1.Y2\rX1..2Y3\rX1.5.5Y3\r");
}

TEST(Ahead, AnErrorStoresNothing) {
  same("X1 Y2 Z\r");
  same("X1 Y2 G(\rX5\r");
  same("X1 Y2 &3 Z4\r&1X1\r");
  same(std::string("X1Y2") + std::string(260, ' ') + "Z3\rX4Y5\r");
  same("X1Y2\xC1\rX3Y4\r");
}

TEST(Ahead, TextThatIsTakenBackIsForgotten) {
  same("X1Y2\b\b\bY3Z4\r");
  same("X1 Y2Z3\b\b0Z5\r");
  same("X1 Y2 A\x18X5Y6\r");
  same("X1 Y2 A\x18\rX3Y4\r");
  same("X1Y2\r\t");
  same("X7Y8\rX1Y2A\t");
}

TEST(Ahead, AddressesAndOtherCommandsInALine) {
  same("X1Y2&2X3Y4\rX5Y6\r");
  same("X1 Y2 CLOSE\rX3Y4\r");
  same("&2X1Y2A3\r&1X1Y2A3\r");
  same("X1Y2\x0bZ3A4\rX5Y6\r");  // ^K acts in its place
}

// ^U and ^L are commands of their own, and what has come of the line is not theirs (firmware:6.1/3).
TEST(Ahead, BuffersThatAreOpenedAndClosedInsideALine) {
  for (const char* key : {"\x15", "\x0c", "\x0c\x15"}) {
    same(std::string("X1 Y2 A") + key + "3\rX4Y5\r");
    same(std::string("P1=5 P") + key + "1\rX4Y5\r");
  }
  Controller c;
  c.send(kOpen);
  EXPECT_EQ(slowly(c,
                   "X1 Y2 A\x15"
                   "3\r"),
            "\x06");
  EXPECT_EQ(c.send("PR\rLIST\r"), "1\r\x06X1Y2A3\r\x06");
}

TEST(Ahead, InFixedBuffersToo) {
  same("X1Y2Z3\rGOTO5 X1\rN5X1Y2\r", "OPEN PROG 1 CLEAR\r");
  same("X1Y2Z3\rP1=5\r", "OPEN PLC 1 CLEAR\r");
  same("X1Y2Z3\r", "P1=5\r");
}

TEST(Ahead, RandomLines) {
  RandomLines random(random_seed(5));
  for (int i = 0; i < 20; ++i) {
    std::string characters;
    for (int line = 0; line < 20; ++line) {
      const std::string next = random.next();
      if (next.find('\x18') == std::string::npos) characters += next + "\r";  // ^X flushes what has come: no sequence
    }
    same(characters);
  }
}

}  // namespace
}  // namespace brick
