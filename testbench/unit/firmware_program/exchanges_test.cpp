// Golden exchanges of firmware:13 that concern buffers and programs.
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::host;

class Exchange : public FirmwareTest {};

bool full() { return host("??")[7] & 1; }  // 8th character: bits 19..16 of word 2; bit 16 is its lowest

TEST_F(Exchange, DefineOrderIsHighestFirst) {  // 14, 15
  BRICK_COVERS("BIN-2");
  EXPECT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("DEL GAT"), "");
  EXPECT_EQ(host("&1DEF ROT 20"), "");
  EXPECT_EQ(host("&2DEF ROT 20"), "ERR003");
  platform::power_up();
  EXPECT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("DEL GAT"), "");
  EXPECT_EQ(host("&2DEF ROT 20"), "");
  EXPECT_EQ(host("&1DEF ROT 20"), "");
}

TEST_F(Exchange, FullBitOnTheLineThatMakesPrI17AndFallsBelowI16) {  // 16, 17
  BRICK_COVERS("BREQ-3 BREQ-4 BREQ-5");
  ASSERT_EQ(host("&1DEF ROT 100"), "");
  ASSERT_EQ(host("&1B0"), "");
  ASSERT_EQ(host("OPEN ROT"), "");
  for (int line = 1; line <= 10; ++line) {
    ASSERT_EQ(host("X" + std::to_string(line)), "");
    EXPECT_EQ(host("PR"), std::to_string(line));
    EXPECT_EQ(full(), line == 10) << line;
  }
  ASSERT_EQ(host("&1R"), "");
  int lines = 10;
  for (int tick = 0; tick < 20000 && lines > 0; ++tick) {
    platform::servo_ticks(1);
    lines = std::stoi(host("PR"));
    EXPECT_EQ(full(), lines >= 5) << lines;
    EXPECT_EQ(platform::breq(), lines < 5) << lines;
  }
  EXPECT_EQ(lines, 0);
}

TEST_F(Exchange, BinaryRotaryRejectsText) {  // 18
  ASSERT_EQ(host("DEF ROT 20"), "");
  EXPECT_EQ(host("OPEN BIN ROT"), "");
  EXPECT_EQ(host("X10"), "ERR005");
}

TEST_F(Exchange, LookaheadIsRefusedBelowAGatherBuffer) {  // 19
  ASSERT_EQ(host("DEF GAT"), "");
  EXPECT_EQ(host("&2DEFINE LOOKAHEAD 50,10"), "ERR003");
}

TEST_F(Exchange, SizeIsNegativeWhileABufferIsOpen) {  // 21
  BRICK_COVERS("I18-3");
  EXPECT_EQ(host("SIZE"), "26624");
  ASSERT_EQ(host("DEF ROT 24"), "");
  EXPECT_EQ(host("SIZE"), "26600");
  ASSERT_EQ(host("OPEN ROT"), "");
  EXPECT_EQ(host("SIZE"), "-26601");  // as 41301 and -41302 in firmware:4.3
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("SIZE"), "26600");
}

TEST_F(Exchange, AxisMoveOnLineNeedsABuffer) {  // 5
  EXPECT_EQ(host("X1000"), "ERR005");
  EXPECT_EQ(host("UUU"), "ERR003");
}

}  // namespace
