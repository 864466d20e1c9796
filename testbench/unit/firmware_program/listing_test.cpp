// Listings of programs (firmware:4.8): text in both forms, offsets, what a listing refuses.
#include <algorithm>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::host;
using platform::host_lines;
using Lines = std::vector<std::string>;

class Listing : public FirmwareTest {
 protected:
  static void enter(const std::string& buffer, const Lines& lines) {
    ASSERT_EQ(host("OPEN " + buffer + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
  }
  static std::string listed(const std::string& line) {
    enter("PROG 1", {line});
    return host_lines("LIST PROG 1").at(0);  // then RETURN
  }
};

TEST_F(Listing, ShortAndLongForm) {
  BRICK_COVERS("I9-1");
  const Lines lines = {"rapid X1 Y2.50 ; comment", "Linear F(P1*2)", "dwell 100",
                       "IF (P1 != 2 AND Q3 > .5)", "return",         "end if"};
  enter("PROG 1", lines);
  const Lines brief = {"RPD X1Y2.5", "LIN F(P1*2)", "DWE100", "IF(P1!=2 AND Q3>0.5)", "RET", "ENDI", "RET"};
  const Lines full = {"RAPID X1Y2.5", "LINEAR F(P1*2)", "DWELL100", "IF(P1!=2 AND Q3>0.5)",
                      "RETURN",       "ENDIF",          "RETURN"};
  for (const int i9 : {0, 2, 1, 3}) {
    ASSERT_EQ(host("I9=" + std::to_string(i9)), "");
    EXPECT_EQ(host_lines("LIST PROG 1"), i9 % 2 == 0 ? brief : full) << i9;
  }
}

TEST_F(Listing, PlcsAreListedOneStatementALine) {  // as recorded: firmware:4.8
  enter("PLC 5", {"IF(P1=1) AND (M2=0) CMD\"#1K\" disable plc 3,4", "ELSE", "WHILE(M1=0) ENDWHILE ENDIF RETURN"});
  EXPECT_EQ(host_lines("LIST PLC 5"),
            (Lines{"IF(P1=1)", "AND(M2=0)", "CMD\"#1K\"", "DISPLC3,4", "ELSE", "WHILE(M1=0)", "ENDW", "ENDI", "RET"}));
}

TEST_F(Listing, AddressesAreListedAsTheyAreEntered) {
  const Lines lines = {"ADR#32",        "ADR&16",   "ADR#1&2",  "ADR#P0", "ADR&P8191",
                       "ADR#P400&P401", "ADR#7&P3", "ADR#P3&7", "RET"};
  enter("PLC 5", lines);
  EXPECT_EQ(host_lines("LIST PLC 5"), lines);
}

TEST_F(Listing, NumbersInARowAreARange) {
  EXPECT_EQ(listed("HM1..32"), "HM1..32");
  EXPECT_EQ(listed("HM1,2,4,5,6,8,31,32"), "HM1,2,4..6,8,31,32");
  EXPECT_EQ(listed("ENA PLC 0..31"), "ENAPLC0..31");
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  while (times-- != 0) all += text;
  return all;
}

// A host line has 255 characters (firmware:6.1). What is longer in long form is listed in short form, and what is
// longer in that too is not taken. Each text, and how it is listed in both forms with another of them behind it.
TEST_F(Listing, ALineIsListedSoThatItGoesBack) {
  const struct {
    std::string text, brief, full;
  } cases[] = {{"RET", "RET ", "RETURN "},     {"LIN", "LIN ", "LINEAR "},
               {"DWE1", "DWE1", "DWELL1"},     {"X.1", "X0.1", "X0.1"},
               {"X$1", "X$1 ", "X$1 "},        {"CMD\"A\"", "CMD\"A\"", "COMMAND\"A\""},
               {"SEND^A", "SEND^A", "SEND^A"}, {"X(--5)", "X(-(-5))", "X(-(-5))"}};
  for (const auto& c : cases) {
    const std::size_t blank = c.brief.back() == ' ' ? 1 : 0;  // none at the end of a line
    for (std::size_t times = 1; times * c.text.size() <= 255; ++times) {
      const std::string line = repeated(c.text, times);
      std::string brief = repeated(c.brief, times), full = repeated(c.full, times);
      brief.resize(brief.size() - blank);
      full.resize(full.size() - blank);
      ASSERT_EQ(host("I9=0 OPEN PROG 1 CLEAR"), "");
      ASSERT_EQ(host(line), brief.size() <= 255 ? "" : "ERR003") << line;
      ASSERT_EQ(host("CLOSE"), "");
      ASSERT_EQ(host_lines("LIST PROG 1").at(0), brief.size() <= 255 ? brief : "ERR003") << line;
      ASSERT_EQ(host_lines("I9=1 LIST PROG 1").at(0), brief.size() > 255   ? "ERR003"
                                                      : full.size() <= 255 ? full
                                                                           : brief)
          << line;
    }
  }
}

TEST_F(Listing, EachLineOfAPlcIsMeasuredAlone) {
  const std::string text = "CMD\"" + std::string(250, 'x') + "\"", many = repeated("P1=.1", 51);
  ASSERT_EQ(text.size(), 255u);
  ASSERT_EQ(many.size(), 255u);
  enter("PLC 1", {text, many});
  Lines expected(53, "P1=0.1");
  expected.front() = text;
  expected.back() = "RET";
  EXPECT_EQ(host_lines("LIST PLC 1"), expected);
  ASSERT_EQ(host("I9=1"), "");
  expected.back() = "RETURN";
  EXPECT_EQ(host_lines("LIST PLC 1"), expected) << "COMMAND would make 259 characters";
}

// A host that streams lines does not download their listing.
TEST_F(Listing, RotaryBuffersTakeLinesOfAnyListing) {
  ASSERT_EQ(host("DEF ROT 200 OPEN ROT"), "");
  ASSERT_EQ(host(repeated("LIN", 85)), "");
  EXPECT_EQ(host("LIST").size(), 4u * 85u - 1u);
}

// Clients take 1,400 characters at a time (firmware:4.8): lines of any length, of what grows most and what does not.
TEST_F(Listing, APartEndsBefore1400Characters) {
  std::size_t longest = 0;
  for (const std::string text : {"RET", "LIN", "HM1..32", "P1=.1 ", "X1"})
    for (std::size_t size = text.size(); size <= 255; size += 17) {
      const std::string line = repeated(text, size * 3 / 4 / text.size());
      if (line.empty()) continue;
      enter("PROG 1", Lines(250, line));
      ASSERT_EQ(host("I9=1"), "");
      const std::string part = host("LIST PROG 1,0");
      longest = std::max(longest, part.size());
      EXPECT_LT(part.size(), 1350u) << line;
      EXPECT_GT(part.size(), 1050u) << line;
    }
  EXPECT_GT(longest, 1250u);
}

TEST_F(Listing, ConstantsKeepTheirForm) {
  BRICK_COVERS("I9-3");
  for (const int i9 : {0, 1, 2, 3}) {
    ASSERT_EQ(host("I9=" + std::to_string(i9)), "");
    EXPECT_EQ(listed("I102=$78002"), "I102=$78002");
    EXPECT_EQ(listed("I102=491522"), "I102=491522");
    EXPECT_EQ(listed("P1=-$1f*.125"), "P1=-$1F*0.125");
    EXPECT_EQ(listed("X0.1 Y-0.300 Z1234567890.5"), "X0.1Y-0.3Z1234567890.5");
    EXPECT_EQ(listed("P1=0.123456789012345678"), "P1=0.123456789013");  // these name its 35 bits, 0.1234567890132
  }
}

TEST_F(Listing, BracketsAreThoseThatAreNeeded) {
  EXPECT_EQ(listed("P1=((1+2)+3)"), "P1=1+2+3");
  EXPECT_EQ(listed("P1=1+(2+3)"), "P1=1+(2+3)");
  EXPECT_EQ(listed("P1=(1+2)*3"), "P1=(1+2)*3");
  EXPECT_EQ(listed("P1=(1*2)+(3&4)"), "P1=1*2+3&4");
  EXPECT_EQ(listed("P1=8/(4/2)"), "P1=8/(4/2)");
  EXPECT_EQ(listed("P1=-(P2+1)-(-(5))"), "P1=-(P2+1)--(5)");
  EXPECT_EQ(listed("P1=P2*(-P3)/(-(P4+1))"), "P1=P2*-P3/-(P4+1)");
  EXPECT_EQ(listed("P1=-(-(P2))"), "P1=--P2");
  EXPECT_EQ(listed("P(P2+1)=SIN((Q(3)))"), "P(P2+1)=SIN(Q(3))");
}

TEST_F(Listing, ABlankStandsWhereWordsWouldRunTogether) {
  EXPECT_EQ(listed("P1=$A B5"), "P1=$A B5");
  EXPECT_EQ(listed("P1=Q1+$A F5"), "P1=Q1+$A F5");
  EXPECT_EQ(listed("IF(P1=$1 AND P2=$F)X5"), "IF(P1=$1 AND P2=$F)X5");
  EXPECT_EQ(listed("ABS A5"), "ABS A5");
  EXPECT_EQ(listed("X$A:$B Y$C^$D Z5"), "X$A:$B Y$C^$D Z5") << "what follows an axis is its own";
}

TEST_F(Listing, TextIsKeptAsItWas) { EXPECT_EQ(listed("SENDP\"It; is  (5)\" CMD^x"), "SENDP\"It; is  (5)\"CMD^X"); }

TEST_F(Listing, FormOfADisplayIsAWidthOfSixteenAtMostAndOneDigit) {
  for (const char* text : {"DISP5,1.0,P1", "DISP5,16.9,P1"}) EXPECT_EQ(listed(text), text);
  ASSERT_EQ(host("OPEN PROG 2"), "");
  for (const char* text : {"DISP5,8.", "DISP5,8.,P1", "DISP5,8./,P1", "DISP5,8.:,P1", "DISP5,0.1,P1", "DISP5,17.1,P1",
                           "DISP5,.1,P1", "DISP5,8.12,P1", "DISP5,8.1"})
    EXPECT_EQ(host(text), "ERR003") << text;
}

TEST_F(Listing, BlanksInADisplayAreNothing) {
  for (const char* text : {"DISP5,8.2,P1", "DISP 5, 8.2, P1", "DISPLAY 5 ,\t8.2 , P1"})
    EXPECT_EQ(listed(text), "DISP5,8.2,P1") << text;
  ASSERT_EQ(host("OPEN PROG 2"), "");
  for (const char* text : {"DISP 5, ,P1", "DISP 5, ;8.2,P1", "DISP 5, 8 .2,P1"})
    EXPECT_EQ(host(text), "ERR003") << text;
}

TEST_F(Listing, OffsetsCountWordsAndPartsAreCut) {
  enter("PLC 5", {"IF(M4900=0)", "M4900=1", "ENDIF"});  // 3 words (two values, comparison), 2 (value, M4900=), 1
  EXPECT_EQ(host_lines("LIST PLC5,0,80"), (Lines{"0:IF(M4900=0)", "3:M4900=1", "5:ENDI", "6:RET"}));
  EXPECT_EQ(host_lines("LIST PLC5,3"), (Lines{"3:M4900=1", "5:ENDI", "6:RET"}));
  EXPECT_EQ(host_lines("LIST PLC5,1,3"), (Lines{"3:M4900=1"}));
  EXPECT_EQ(host_lines("LIST PLC5,0,5"), (Lines{"0:IF(M4900=0)", "3:M4900=1"})) << "lines that begin in it";
  EXPECT_EQ(host("LIST PLC5,7"), "ERR003");  // past its end
  EXPECT_EQ(host("LIST PLC6"), "ERR003");
  EXPECT_EQ(host("LIST PLC5,-1"), "ERR003");
  EXPECT_EQ(host("LIST PLC5,0,X"), "ERR003");
  EXPECT_EQ(host("LIST PLC5,0,-1"), "ERR003");
  EXPECT_EQ(host("LIST PROG 99"), "ERR003");
  EXPECT_EQ(host("LIST FORWARD"), "ERR003");
  EXPECT_EQ(host("LIST UNKNOWN"), "ERR003");
}

TEST_F(Listing, KinematicProgramsBelongToTheirCoordinateSystem) {
  enter("FORWARD", {"Q7=P1*2"});
  ASSERT_EQ(host("&3"), "");
  EXPECT_EQ(host("LIST FORWARD"), "ERR003");
  enter("INVERSE", {"P1=Q7/2"});
  EXPECT_EQ(host("LIST INV,0"), "0:P1=Q7/2|4:RET");
  EXPECT_EQ(host("&1LIST FWD"), "Q7=P1*2|RET");
}

TEST_F(Listing, TheOpenBufferAndTheRotaryOne) {
  EXPECT_EQ(host("LIST"), "ERR003");
  ASSERT_EQ(host("OPEN PROG 3 X1"), "");
  EXPECT_EQ(host("LIST"), "X1");
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("LIST ROT"), "ERR003");
  ASSERT_EQ(host("DEF ROT 20 B0 OPEN ROT"), "");
  ASSERT_EQ(host("X1 Y(P1)"), "");
  ASSERT_EQ(host("F5"), "");
  EXPECT_EQ(host_lines("LIST"), (Lines{"X1Y(P1)", "F5"}));
  EXPECT_EQ(host_lines("LIST ROT"), (Lines{"X1Y(P1)", "F5"}));
  EXPECT_EQ(host("LIST PC"), "0:X1Y(P1)");
  EXPECT_EQ(host_lines("LIST PC,5"), (Lines{"0:X1Y(P1)", "3:F5"}));
  for (const char* wrong : {"LIST PC,0", "LIST PC,-1", "LIST PC,1.5"}) EXPECT_EQ(host(wrong), "ERR003") << wrong;
}

TEST_F(Listing, GatherIsListedInLongWords) {
  EXPECT_EQ(host("LIST GATHER"), "ERR003");
  ASSERT_EQ(host("WX$20,$123456 WY$20,$ABCDEF I5001=$800020 I5050=1 I5049=1"), "");
  ASSERT_EQ(host("DEF GAT 3"), "");
  EXPECT_EQ(host("LIST GATHER"), "ERR003") << "nothing has been gathered";
  ASSERT_EQ(host("GATHER"), "");
  platform::servo_ticks(3);
  ASSERT_EQ(host("WX$107FF,0"), "");  // its three words end at $010800
  EXPECT_EQ(host_lines("LIST GAT,1,2"), (Lines{"123456ABCDEF", "000000ABCDEF"}));
}

}  // namespace
