// Lines as they come by the host port (firmware:6.1, firmware:5.9): each character in its place and its case.
#include <gtest/gtest.h>

#include <cctype>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/kernel/slice.h"
}

namespace brick {
namespace {

TEST(LineInput, ControlYReportsTheLastLineAsItCame) {
  Controller c;
  EXPECT_EQ(c.send("p1=5 ;Ab~\r"), "\x06");
  EXPECT_EQ(c.send("\x19"), "p1=5 ;Ab~\r\x06");
  EXPECT_EQ(c.send("P1\r"), "5\r\x06");
  EXPECT_EQ(c.send("\x19"), "P1\r\x06") << "nothing of the longer one";
  EXPECT_EQ(c.send("P1=\x19\x37\r"), "P1\r\x06\x06") << "the line that comes is not disturbed";
  EXPECT_EQ(c.send("\x19"), "P1=7\r\x06");
  EXPECT_EQ(c.send("\t\x19"), "\x06P1=7\r\x06") << "repeated by ^I";
  EXPECT_EQ(c.send("\r\x19"), "\x06\r\x06");
  const std::string longest = "P1=" + std::string(251, '0') + "8";
  EXPECT_EQ(c.send(longest + "\r\x19"), "\x06" + longest + "\r\x06");
}

// firmware:6.5: of the line that is reported its sum behind its CR; of what was sent, a control character, none.
TEST(LineInput, ControlYHasItsChecksums) {
  Controller c;
  EXPECT_EQ(c.send("I4=1\r"), std::string("\x06") + static_cast<char>('I' + '4' + '=' + '1'));
  const std::string line = std::string("I4=1\r") + static_cast<char>('I' + '4' + '=' + '1' + '\r');
  EXPECT_EQ(c.send("\x19"), line + std::string("\x06\0", 2));
}

// The queue is a ring of 8192 characters: any of a line may be the first behind its seam.
TEST(LineInput, EachCharacterKeepsItsPlaceAtTheSeamOfTheQueue) {
  constexpr std::uint32_t kQueue = 8192;
  const std::string line = "p 1=5 ;a!~\"z ";
  for (std::size_t at = 0; at <= line.size(); ++at) {
    Controller c;
    const std::uint32_t before = kQueue - host_port_received_count % kQueue - static_cast<std::uint32_t>(at);
    EXPECT_EQ(c.send(std::string(before, '\n')), "");
    ASSERT_EQ((host_port_received_count + at) % kQueue, 0u);
    EXPECT_EQ(c.send(line + "\r"), "\x06");
    EXPECT_EQ(c.send("\x19"), line + "\r\x06") << at;
    EXPECT_EQ(c.line("P1"), "5") << at;
  }
}

// Small letters are capitals: a program is the same in either.
TEST(LineInput, EachLetterIsRaised) {
  const auto entered = [](bool small) {
    Controller c;
    std::string replies;
    for (std::string line : {"OPEN PROG 1 CLEAR", "A1B2C3U4V5W6X7Y8Z9", "ABS FRAX(X) INC(Y,Z)", "DWELL5 TA6 TM8",
                             "Z-2.5", "CIRCLE1 LINEAR NORMAL K-1", "M1==2 GOTO5 WAIT", "WHILE(P1>0 AND Q2<3) F9",
                             "HOME1", "G01", "CALL5", "JOG", "CLOSE"}) {
      if (small)
        for (char& letter : line) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
      replies += c.line(line) + "\n";
    }
    return replies + c.line("LIST PROG 1");
  };
  EXPECT_EQ(entered(true), entered(false));
  EXPECT_NE(entered(true).find("A1B2C3U4V5W6X7Y8Z9"), std::string::npos);
}

// A line is under way from its first character until the background finds nothing more of it.
TEST(LineInput, APauseOfTheHostEndsTheHurry) {
  Controller c;
  (void)c.send("VER\r");
  EXPECT_EQ(slice_hurry, 0u);
  host_port_character('X');
  host_port_character('1');
  line_input_text();
  EXPECT_NE(slice_hurry, 0u) << "more of it may come";
  line_input_text();
  EXPECT_EQ(slice_hurry, 0u) << "nothing has";
  host_port_character('0');
  EXPECT_NE(slice_hurry, 0u);
}

}  // namespace
}  // namespace brick
