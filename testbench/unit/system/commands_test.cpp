// Command lines and their replies, as the manual's examples give them (firmware:13), on the real image.
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class Commands : public Controller {};

TEST_P(Commands, Identification) {
  start();
  EXPECT_EQ(ask("VERSION"), "1.947");
  EXPECT_EQ(ask("ver"), "1.947");
  EXPECT_EQ(ask("CID"), "603382");
  EXPECT_EQ(ask("TYPE").substr(0, 7), "TURBO2,");
}

TEST_P(Commands, SeveralCommandsOnALineRunLeftToRight) {
  start();
  EXPECT_EQ(ask("i6=1 i3=2 ver"), "1.947");
  EXPECT_EQ(ask("P1=25 P2=50 P3=75"), "");
  EXPECT_EQ(ask("P1..3"), "25|50|75");
  EXPECT_EQ(ask("P1=26 UUU P1=27"), "ERR003") << "the rest of the line is dropped";
  EXPECT_EQ(ask("P1"), "26") << "what stood before the error has taken effect";
}

TEST_P(Commands, ErrorsCarryTheirNumber) {
  start();
  EXPECT_EQ(ask("UUU"), "ERR003");
  EXPECT_EQ(ask("X1000"), "ERR005");
  const Reply reply = link().command("UUU");
  EXPECT_EQ(reply.raw, "\aERR003\r");
  EXPECT_TRUE(reply.error);
}

TEST_P(Commands, LimitedRangesWrap) {
  start();
  EXPECT_EQ(ask("I9=6"), "");  // modulo 4
  EXPECT_EQ(ask("I9"), "2");
  EXPECT_EQ(ask("I17=8388608"), "");
  EXPECT_EQ(ask("I17"), "0");
}

TEST_P(Commands, AddressVariablesAreHexWhenI9AsksForIt) {
  BRICK_COVERS("I9-2 I9-3");
  start();
  EXPECT_EQ(ask("I124"), "$1");
  EXPECT_EQ(ask("I124=I124|$20000"), "");
  EXPECT_EQ(ask("I124"), "$20001");
  EXPECT_EQ(ask("I9=0"), "");
  EXPECT_EQ(ask("I124"), "131073");
  EXPECT_EQ(ask("I124=$10"), "") << "hex is accepted whatever I9 is";
  EXPECT_EQ(ask("I124"), "16");
}

TEST_P(Commands, LongFormReportsFullStatements) {
  start();
  EXPECT_EQ(ask("I9=3"), "");
  EXPECT_EQ(ask("I16"), "I16=5");
  EXPECT_EQ(ask("I124"), "I124=$1");
}

TEST_P(Commands, ExpressionsAndComputedIndices) {
  start();
  EXPECT_EQ(ask("P10=1+2*3"), "");
  EXPECT_EQ(ask("P10"), "7");
  EXPECT_EQ(ask("P(P10+1)=SQRT(2)*SQRT(2)/4"), "");
  EXPECT_EQ(ask("P8"), "0.5");
  EXPECT_EQ(ask("&1Q5=-3.25"), "");
  EXPECT_EQ(ask("&2Q5"), "0");
  EXPECT_EQ(ask("&1Q5"), "-3.25");
  EXPECT_EQ(ask("342"), "");
  EXPECT_EQ(ask("P0"), "342");
}

TEST_P(Commands, FramingFollowsI3) {
  start();
  EXPECT_EQ(link().command("I16").raw, "5\r\x06");
  link().command("I3=1");
  EXPECT_EQ(link().command("I16", ms_to_ticks(20)).raw, "\n5\r\n");
  link().command("I3=0");
  EXPECT_EQ(link().command("I16", ms_to_ticks(20)).raw, "5\r");
  link().command("I3=3");
  EXPECT_EQ(link().command("I16", ms_to_ticks(20)).raw, "\n5\r\x06");
}

TEST_P(Commands, RotaryBuffersAreDefinedFromTheHighestCoordinateSystemDown) {
  BRICK_COVERS("BIN-2");
  start();
  EXPECT_EQ(ask("&2DEFINE ROTARY 200"), "");
  EXPECT_EQ(ask("&1DEFINE ROTARY 200"), "");
  EXPECT_EQ(ask("&2DEFINE ROTARY 50"), "ERR003");
  EXPECT_EQ(ask("&2DELETE ROTARY"), "ERR003") << "lowest first";
  EXPECT_EQ(ask("&1DELETE ROTARY"), "");
  EXPECT_EQ(ask("&2DELETE ROTARY"), "");
}

BRICK_ON_ENGINES(Commands, Engine::kRtl, Engine::kSystemC);

}  // namespace
}  // namespace brick
