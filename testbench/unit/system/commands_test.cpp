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

// firmware:13, those of variables, byte for byte.
TEST_P(Commands, GoldenExchangesOfVariables) {
  BRICK_COVERS("I9-1 I9-2 I19-1");
  start();
  const auto bytes = [this](const std::string& line) { return link().command(line).raw; };
  EXPECT_EQ(bytes("I3"), "2\r\x06");  // 1
  bytes("P1=25 P2=50 P3=75");
  EXPECT_EQ(bytes("P1..3"), "25\r50\r75\r\x06");  // 2
  EXPECT_EQ(bytes("I124"), "$1\r\x06");           // 8
  EXPECT_EQ(bytes("I124=I124|$20000"), "\x06");   // 9
  EXPECT_EQ(bytes("I124"), "$20001\r\x06");
  EXPECT_EQ(bytes("i20 i21 i22 i23"), "$0\r$0\r$0\r$0\r\x06");  // 10
  EXPECT_EQ(bytes("i6=1 i3=2 ver"), "1.947\r\x06");             // 11
  EXPECT_EQ(bytes("cid"), "603382\r\x06");                      // 12
  EXPECT_EQ(bytes("I41=1"), "\x06");                            // 23
  EXPECT_EQ(bytes("I100=0"), "\x06");
  EXPECT_EQ(bytes("I100"), "1\r\x06");
  EXPECT_EQ(bytes("I41=0"), "\x06");
  for (const char* style : {"I9=0", "I9=2"}) {
    bytes(style);
    EXPECT_EQ(bytes("I19"), "7007\r\x06");  // 28
  }
  bytes("I9=3");
  EXPECT_EQ(bytes("I16"), "I16=5\r\x06");  // 7
  EXPECT_EQ(bytes("I19"), "I19=7007\r\x06");
  bytes("I9=2 I5111=10000");
  wait(ms_to_ticks(10));
  EXPECT_NEAR(std::stoi(ask("I5111")), 10000 - 23, 4);  // 26: 2258.7 servo interrupts a second
}

// Counter, status and control words of servo IC 0, as their M-variables have them, and the words that the firmware
// keeps.
TEST_P(Commands, MVariablesReachTheChipsAndTheStatus) {
  start();
  EXPECT_EQ(ask("M1->X:$78001,24,S M2->X:$78005,14 M3->Y:$78002,8,16,S M4->X:$78005,4,4"), "");
  EXPECT_EQ(ask("M1 M2 M4"), "0|0|" + ask("I7012"));
  EXPECT_EQ(ask("M2=1 M3=-1000 M4=9"), "");
  EXPECT_EQ(ask("M2..4"), "1|-1000|9");
  EXPECT_EQ(ask("RHY$78002"), "FC1800");
  EXPECT_EQ(ask("M5->X:$0,24 P1=M5"), "");
  wait(ms_to_ticks(10));
  EXPECT_NEAR(std::stoi(ask("P2=M5-P1 P2")), 23, 4);
  EXPECT_EQ(ask("M6->X:$B0,23 M7->X:$2000,24,S M8->Y:$203F,17 M6..8"), "1|3713991|1");
  EXPECT_EQ(ask("M9->DP:$60010 M10->F:$60011 M9=-70000 M10=0.375 M9..10 RHX$60010,2"), "-70000|0.375|FFFE 3EC0");
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
