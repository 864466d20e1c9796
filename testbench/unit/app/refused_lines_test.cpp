// What a user is told of lines that the controller refuses, and of replies that make no sense.
#include "app/refused_lines.h"

#include <gmock/gmock.h>

#include "app/byte_text.h"

namespace brick {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

TEST(RefusedLines, AreToldWithPlaceErrorAndMeaning) {
  RefusedLines lines;
  EXPECT_EQ(lines.summary(3), "");
  EXPECT_EQ(lines.add("job.pmc:7", "X10", "ERR005"),
            "job.pmc:7: `X10`: ERR005: text of a program, but no buffer is open");
  EXPECT_THAT(lines.add("job.pmc:8", std::string(300, 'P'), "ERR003"),
              EndsWith("the line has 300 characters, expected at most 255"));
  EXPECT_THAT(lines.add("job.pmc:9", "X", "ERR020"), EndsWith("ERR020: not a known error"));
  EXPECT_EQ(lines.count(), 3u);
  EXPECT_EQ(lines.summary(9), "3 of 9 lines refused: 1 x ERR003, 1 x ERR005, 1 x ERR020");
}

TEST(RefusedLines, AreCountedWhenThereAreMany) {
  RefusedLines lines;
  for (std::size_t i = 0; i < RefusedLines::kTold; ++i) EXPECT_NE(lines.add("a:1", "X", "ERR005"), "");
  EXPECT_EQ(lines.add("a:2", "X", "ERR005"), "");
  EXPECT_EQ(lines.summary(100), "51 of 100 lines refused: 51 x ERR005; the first 50 are told above");
}

// The numbers of firmware:6.4 that a host can meet.
TEST(RefusedLines, EveryErrorHasAMeaning) {
  for (int number = 1; number <= 22; ++number) {
    if (number == 20) continue;  // not published
    EXPECT_NE(error_meaning((number < 10 ? "ERR00" : "ERR0") + std::to_string(number)), "not a known error") << number;
  }
  EXPECT_THAT(error_meaning("ERR"), HasSubstr("I6"));
}

TEST(ByteText, CutsWhatIsEndless) {
  EXPECT_EQ(beginning_of("25\r\x06"), "`25<0D><06>`");
  EXPECT_EQ(beginning_of(std::string(1 << 20, 'X')), "`" + std::string(60, 'X') + "`... (1048576 bytes)");
}

// U+00FC, a half of a pair, U+0085 (a control character), a form longer than needed, U+20AC cut short, beyond the end.
TEST(ByteText, LetsNothingThroughThatActsOnATerminal) {
  EXPECT_EQ(readable_text("\xC3\xBC \x1B[2J\x7F\xFF"), "\xC3\xBC <1B>[2J<7F><FF>");
  EXPECT_EQ(readable_text("\xED\xA0\x80|\xC2\x85|\xC0\x8A|\xE2\x82|\xF4\x90\x80\x80"),
            "<ED><A0><80>|<C2><85>|<C0><8A>|<E2><82>|<F4><90><80><80>");
  EXPECT_EQ(readable_text("\xE2\x82\xAC\xF0\x9F\x98\x80"), "\xE2\x82\xAC\xF0\x9F\x98\x80");
  EXPECT_EQ(readable_text("\xF8\x90\x80\x80|\xFB\x90\x80\x80"), "<F8><90><80><80>|<FB><90><80><80>");
  EXPECT_EQ(utf8_text("a\x06\xC3\xBC\xC3"), "a\x06\xC3\xBC<C3>");
  EXPECT_EQ(visible_bytes("a\x06\xC3\xBC~\x7F"), "a<06><C3><BC>~<7F>");
  EXPECT_EQ(cut_text("12", 2), "12");
  EXPECT_EQ(beginning_of("12", 2), "`12`");
  EXPECT_EQ(cut_text("\x1B"
                     "234",
                     2),
            "<1B>2...");
}

}  // namespace
}  // namespace brick
