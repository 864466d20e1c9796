// What the answer to ^B says about I3 and I4, and which lines the host link looks at before it asks.
#include <gtest/gtest.h>

#include "testbench/host/framing_probe.h"
#include "testbench/unit/firmware_platform/framing.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

// 96 zeros, 7 spaces and a CR add up to $12ED, eleven nines and a five make it $1355.
const std::string kWords = [] {
  std::string words = "999999999995";
  for (int word = 1; word < 8; ++word) words += " 000000000000";
  return words;
}();

TEST(FramingProbe, KnowsTheLinesThatMayChangeI3AndI4) {
  for (const char* line :
       {"I3=0", "i4 = 1", "P1=2 I3=P1", "I03=1", "I0..9=*", "I2..40=0", "I1,5=2", "I(P1)=2", "I3..4=0", "I3,2=1",
        "#1J+I3=2", "I16 I3=0 I17", "I3=1;I5=2", "CLOSE I4=1", "A I4=1", "SAVE I3=0"})
    EXPECT_TRUE(may_change_framing(line)) << line;
  for (const char* line : {"I3", "I3 I4", "I13=2", "I30=0", "I5..9=*", "I16=3", "P1=I3", "SIN(3)=4", "CMD\"I3=0\"",
                           "I0..99", "M3->I4", "P3=0 ; I3=0", "", "I", "I(P1)", "I4900..4999=0", "I34=I3"})
    EXPECT_FALSE(may_change_framing(line)) << line;
  for (const char* line : {"I33\x08=0", "\x09", "P1\x1F"}) EXPECT_TRUE(has_control_characters(line)) << line;
  for (const char* line : {"", "P1=2 ; I3", "\xC3\xBC"}) EXPECT_FALSE(has_control_characters(line)) << line;
  for (const char* line : {"$$$", "I16=3 $$$***", " $ $$"}) EXPECT_TRUE(may_restart(line)) << line;
  for (const char* line : {"$$", "CMD\"$$$\"", "P1=$12 ; $$$", "M1->X:$78000,24"})
    EXPECT_FALSE(may_restart(line)) << line;
  EXPECT_TRUE(may_take_long("save"));
  EXPECT_TRUE(may_restart("$$$ PASSWORD=x"));
  EXPECT_TRUE(may_restart("CMD\"a;b\" $$$")) << "a semicolon in a text begins no comment";
}

// Everything behind PASSWORD= is the password, quotation marks and semicolons too; texts and comments are no commands.
TEST(FramingProbe, TextsAreNoCommands) {
  for (const char* before : {"PASSWORD=", "password = x", "I16 PASSWORD=\"", "PASSWORD=\"\"", "PASSWORD=a;b", "SEND\"",
                             "; ", "P1=1;", "CMD\"a\" DISPLAY 5\"b;", "SEND\"PASSWORD=\";"})
    for (const char* text : {"$$$", "$$$***", "I3=0", "I(3)=1", "SAVE"}) {
      const std::string line = std::string(before) + text;
      EXPECT_FALSE(may_restart(line)) << line;
      EXPECT_FALSE(may_change_framing(line)) << line;
      EXPECT_FALSE(may_take_long(line)) << line;
    }
  for (const char* line : {"PASSWORD $$$", "SEND\"PASSWORD=\"$$$", "P1=1 $$$ ;PASSWORD="})
    EXPECT_TRUE(may_restart(line)) << line;
}

// Every setting answers ^B in its own form; what came before it is not taken for a part of it.
TEST(FramingProbe, ReadsEverySettingOffAnAnswer) {
  for (unsigned i3 = 0; i3 <= 3; ++i3)
    for (unsigned i4 = 0; i4 <= 1; ++i4)
      for (const std::string& before : Lines{"", "25\r", "\n25\r", "\x06", kWords + "\r\x06"}) {
        const std::string answer = framed({i3, i4}, "", {kWords});
        const auto found = framing_answers(before + answer, before.size());
        ASSERT_EQ(found.size(), 1u) << i3 << i4;
        EXPECT_EQ(found[0].begin, before.size());
        EXPECT_EQ(found[0].end, before.size() + answer.size()) << i3 << i4;
        EXPECT_TRUE(found[0].framing == (Framing{i3, i4})) << i3 << i4;
      }
  EXPECT_TRUE(framing_answers("25\r\x06", 0).empty());
  EXPECT_TRUE(framing_answers(kWords.substr(1) + "\r\x06", 0).empty()) << "eleven digits";
  EXPECT_TRUE(framing_answers(kWords.substr(13) + "\r\x06", 0).empty()) << "seven words";
  EXPECT_TRUE(framing_answers("000000000800\r\x06", 0).empty()) << "? and ??? are answered so";
  EXPECT_TRUE(framing_answers(kWords + "\r\x06", 140).empty());
}

// What follows an answer shows what it is where its own bytes do not: the sum of these words and their CR is `U`.
TEST(FramingProbe, ReadsAnAnswerAmongTexts) {
  const std::string digits = kWords + "\r", lf = "\n" + digits;
  const std::string text = "UP\r", summed = text + checksum(text), tail = "UP";
  struct Case {
    std::string answer, behind;
    Framing framing;
  };
  ASSERT_EQ(checksum(digits), 'U');
  for (const Case& c : std::vector<Case>{{digits, text + text, {0, 0}},
                                         {digits, text + tail, {0, 0}},
                                         {digits + "U", summed + summed, {0, 1}},
                                         {digits + "\x06", text + tail, {2, 0}},
                                         {digits + "U\x06\x07", summed + tail, {2, 1}},
                                         {lf + "\n", "\n" + text + tail, {1, 0}},
                                         {lf + "\x06", "\n" + text + tail, {3, 0}},
                                         {lf + checksum(lf) + "\n\x07", "\nUP", {1, 1}},
                                         {lf + checksum(lf) + "\x06\x07", "\nUP", {3, 1}}}) {
    const std::string all = text + c.answer + c.behind;
    const auto found = framing_answers(all, 0);
    ASSERT_EQ(found.size(), 1u) << c.framing.i3 << c.framing.i4;
    EXPECT_EQ(all.substr(found[0].begin, found[0].end - found[0].begin), c.answer);
    EXPECT_TRUE(found[0].framing == c.framing) << c.framing.i3 << c.framing.i4;
  }
  EXPECT_TRUE(framing_answers("\x02" + digits + text, 0).empty()) << "a program's, by its tag";
  const auto three = framing_answers(lf + lf + "\x06\n" + text + lf, 0);  // a text, whose end looks like an acknowledge
  ASSERT_EQ(three.size(), 3u);
  EXPECT_TRUE(three[1].framing == (Framing{3, 0}));
  EXPECT_EQ(three[1].begin, lf.size());
}

// That of ^B itself is a tag's code: $02.
TEST(FramingProbe, AChecksumIsNoTag) {
  const std::string words = kWords + "\r", answer = words + checksum(words) + "\x06\x02";
  EXPECT_EQ(framing_answers("\x06\x02" + answer + answer, 0).size(), 2u);
  EXPECT_TRUE(framing_answers("\x06\x02" + words, 0).empty()) << "without checksums";
  EXPECT_TRUE(framing_answers("\x06u\x02" + words + checksum("\x02" + words), 0).empty());
  EXPECT_TRUE(framing_answers("25\r\x74\x02" + words + checksum("\x02" + words), 0).empty());
}

// An answer among them: what follows it shows what it is.
TEST(FramingProbe, ErrorsOfProgramsSayNothingAboutChecksums) {
  const std::string answer = framed({0, 1}, "", {kWords}), text = framed({0, 1}, "", {"AB"});
  const auto found = framing_answers(answer +
                                         "\x02"
                                         "ERR003\r" +
                                         text,
                                     0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].framing == (Framing{0, 1}));
}

}  // namespace
}  // namespace brick
