// Lines as drivers of whole installations send them: many queries glued into one, a comma behind some, assignments
// between them. Every part of the answer is asserted, each worked out here from the settings that the test makes.
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::host;
using platform::host_lines;
using Lines = std::vector<std::string>;

// 8 motors in three coordinate systems: 1 and 2 are X and Y of &1, 3 to 5 are A, B and C of &2, 6 is W of &3; 7 and 8
// are in none.
class DriverPolls : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    for (const char* line : {"I68=2", "&1#1->1000X #2->-Y+2.5", "&2#3->A #4->0.5B #5->C", "&3#6->20W-3"})
      ASSERT_EQ(host(line), "") << line;
  }
  // Queries and what each is answered, played singly, then glued in one line with `glue` between.
  struct Poll {
    const char *query, *answer;
  };
  static void play(const std::vector<Poll>& polls, const char* glue) {
    std::string line;
    Lines expected;
    for (const Poll& poll : polls) {
      EXPECT_EQ(host(poll.query), poll.answer) << poll.query;
      line += (line.empty() ? "" : glue) + std::string(poll.query);
      expected.push_back(poll.answer);
    }
    ASSERT_LE(line.size(), 255u) << "a line's limit";
    EXPECT_EQ(host_lines(line), expected) << line;
  }
};

// firmware:1.1/7, firmware:7.4/2. A motor of another system is in none of this one.
TEST_F(DriverPolls, CommasBehindAxisDefinitionsDivide) {
  const std::vector<Poll> polls = {{"&1#1->,", "1000X"}, {"&1#2->,", "-Y+2.5"}, {"&1#3->,", "0"}, {"&2#3->,", "A"},
                                   {"&2#4->,", "0.5B"},  {"&2#5->,", "C"},      {"&2#1->,", "0"}, {"&3#6->,", "20W-3"},
                                   {"&3#8->,", "0"},     {"I68", "2"}};
  play(polls, "");
  play(polls, " ");
}

TEST_F(DriverPolls, CommasDivideOtherQueriesToo) {
  EXPECT_EQ(host_lines("#1?,#7?,"), (Lines{"850000078000", "050000000000"})) << "as in the poll below";
  EXPECT_EQ(host_lines("#1P,#2P , CID,"), (Lines{"0", "0", "603382"}));
  EXPECT_EQ(host_lines("M1->,M2->,"), (Lines{"*", "*"}));
  EXPECT_EQ(host_lines("#,&,"), (Lines{"2", "3"})) << "the ones addressed last";
}

// A comma that divides nothing: behind no query, a second one, before the first command.
TEST_F(DriverPolls, OtherCommasAreErrors) {
  for (const char* line : {",", ",CID", "CID,,", "P1=5,", "P1=5,CID", "&2,", "#3,CID", "&1#1->,,", "CID,P1=5,"})
    EXPECT_EQ(host_lines(line).back(), "ERR003") << line;
}

// Behind these a number is a count or a start (firmware:1.1/7); anything else is the next command.
TEST_F(DriverPolls, CommasThatNoNumberFollowsDivideQueriesThatTakeOne) {
  ASSERT_EQ(host("I5213..5215=7 P1=1 P2=2 P3=3 P5=5 WX$10,4,6"), "");
  EXPECT_EQ(host_lines("P1,CID"), (Lines{"1", "603382"}));
  EXPECT_EQ(host_lines("P1,P2 , P3,"), (Lines{"1", "2", "3"}));
  EXPECT_EQ(host_lines("P1,3,CID"), (Lines{"1", "2", "3", "603382"})) << "three of them";
  EXPECT_EQ(host_lines("P1,2,2,P2,"), (Lines{"1", "3", "2"})) << "two, each second";
  EXPECT_EQ(host_lines("P1..2,P5"), (Lines{"1", "2", "5"}));
  EXPECT_EQ(host_lines("P1,(P2),P5"), (Lines{"1", "2", "5"})) << "a computed count";
  EXPECT_EQ(host_lines("I5213,&1#1->,I68,"), (Lines{"7", "1000X", "2"}));
  EXPECT_EQ(host_lines("RX$10,CID,RX$10,2,RX$10,$2,#1P"), (Lines{"4", "603382", "4 6", "4 6", "0"}));
  ASSERT_EQ(host("OPEN PROG 1 CLEAR P1=1 X1"), "");
  ASSERT_EQ(host("P2=2"), "");
  ASSERT_EQ(host("CLOSE B1"), "");
  EXPECT_EQ(host_lines("LIST PC,CID"), (Lines{"0:P1=1X1", "603382"}));
  EXPECT_EQ(host_lines("LIST PC,2,P5"), (Lines{"0:P1=1X1", "2:P2=2", "5"}));
  EXPECT_EQ(host_lines("LIST PROG 1,P5"), (Lines{"P1=1X1", "P2=2", "RET", "5"}));
  EXPECT_EQ(host_lines("LIST PROG 1,2,P5"), (Lines{"2:P2=2", "3:RET", "5"}));
  ASSERT_EQ(host("DEF ROT 50 B0"), "");
  EXPECT_EQ(host_lines("LIST PC,P5"), (Lines{"5"})) << "a buffer without a line";
}

TEST_F(DriverPolls, NumbersThatAreNoCountAreStillErrors) {
  for (const char* line : {"P1,-5", "P1,.5", "P1,0", "P1,8192", "P1,3,-1", "RX$10,0", "RX$10,-1", "RX$10,65",
                           "LIST PC,0", "LIST PC,-1", "LIST PROG 1,-1", "P1,=5", "P1,,CID"})
    EXPECT_EQ(host_lines(line).back(), "ERR003") << line;
}

// Status, positions, PLCs and settings of all motors and systems, as a driver polls them several times a second.
TEST_F(DriverPolls, StatusPositionsAndVariablesInOneLine) {
  fake_interrupts_leave_time();
  ASSERT_EQ(host("I108=96 P575=38.7 I10=1705244 M7000->* M7000=0"), "");
  ASSERT_EQ(host("&2Q81=12.5 Q82=-3"), "");
  ASSERT_EQ(host("M5003->Y:$3103,22 M5004->Y:$3104,22 OPEN PLC 4 CLEAR P1=P1 CLOSE I5=2 DISABLE PLC 3 ENABLE PLC 4"),
            "");
  // Motor 1 alone is activated (bit 23); all are open loop with integration at rest (bits 18, 16); the second word says
  // system less one, axis (7 X Y Z, 1 A, 2 B, 3 C, 4 U V W) and bit 15.
  const std::vector<Poll> fast = {{"#1?", "850000078000"},
                                  {"#2?", "050000078000"},
                                  {"#3?", "050000118000"},
                                  {"#4?", "050000128000"},
                                  {"#5?", "050000138000"},
                                  {"#6?", "050000248000"},
                                  {"#7?", "050000000000"},
                                  {"#1P", "0"},
                                  {"#2F", "0"},
                                  {"#3V", "0"},
                                  {"???", "000000000800"},
                                  {"##", "0"}};
  play(fast, "");
  play(fast, " ");
  // Feedrate axes X, Y, Z and the arc vector (A80020); nothing runs, but motors whose loops are open are not in
  // position.
  const std::vector<Poll> slow = {{"&1??", "A80020000000000000"},
                                  {"&2??", "A80020000000000000"},
                                  {"&3??", "A80020000000000000"},
                                  {"&2Q81", "12.5"},
                                  {"Q82", "-3"},
                                  {"&1%", "100"},
                                  {"I5113", "0"},
                                  {"I10", "1705244"},
                                  {"P575", "38.7"},
                                  {"M5003", "1"},
                                  {"M5004", "0"},
                                  {"M7000", "0"},
                                  {"cid", "603382"},
                                  {"I124", "$1"}};
  play(slow, " ");
}

// firmware:5.1/20
TEST_F(DriverPolls, PVAndFStandOneBehindTheOtherAndBeforeAVariable) {
  ASSERT_EQ(host("M190->* M190=5 I68=2 Q3=4"), "");
  EXPECT_EQ(host_lines("PVF"), (Lines{"0", "0", "0"}));
  EXPECT_EQ(host_lines("FPVVFP"), (Lines(6, "0")));
  EXPECT_EQ(host_lines("#1?PVFM190#2?PVF"), (Lines{"850000078000", "0", "0", "0", "5", "050000078000", "0", "0", "0"}));
  for (const char* line : {"PM190", "VM190", "FM190", "PVFM(180+10)"}) EXPECT_EQ(host_lines(line).back(), "5") << line;
  EXPECT_EQ(host_lines("VI68FQ3VP0"), (Lines{"0", "2", "0", "4", "0", "0"}));
  for (const char* line : {"PVERSION", "VCID", "PVFCPU", "FSIZE"}) {
    const Lines answer = host_lines(line);
    ASSERT_EQ(answer.size(), 1u) << line;
    EXPECT_EQ(answer.front(), "ERR003") << line;
  }
}

// firmware:1.1/6: what stands before an error is done, what stands behind it is not. The bytes of such an answer are in
// the exchanges that are played on every engine.
TEST_F(DriverPolls, WhatStandsBehindAnErrorIsNotExecuted) {
  EXPECT_EQ(host("#1P P1=7 UUU #2P P2=7 CID"), "ERR003");
  EXPECT_EQ(host("P1 P2 #"), "7|0|1");
  EXPECT_EQ(host("&2#4->, &9#1->, &1#1->, P3=7"), "ERR003") << "&9 is beyond I68";
  EXPECT_EQ(host("& # P3"), "2|4|0") << "the addresses before it stand";
}

}  // namespace
