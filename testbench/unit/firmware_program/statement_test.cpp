// Compilation of program lines: which text is a statement, what a line costs in words, what a rotary buffer refuses.
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

class Statement : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(platform::host("DEF ROT 1000"), "");
    ASSERT_EQ(platform::host("B0"), "");
    ASSERT_EQ(platform::host("OPEN ROT"), "");
  }
  static unsigned words(const std::string& line) {
    const std::uint32_t before = rotary_buffers[0].used;
    EXPECT_EQ(platform::host(line), "") << line;
    return rotary_buffers[0].used - before;
  }
  static bool starts(const char* text) { return statement_starts(lexer{text}); }
};

TEST_F(Statement, EachValueCostsOneWord) {
  BRICK_COVERS("BIN-2");
  EXPECT_EQ(words("X1000 Y1200 Z1400 A1600"), 4u);  // firmware:4.4
  EXPECT_EQ(words("X1250.1"), 1u);
  EXPECT_EQ(words("F100"), 1u);
  EXPECT_EQ(words("LINEAR ABS TM100 TA50 TS10 DWELL100 DELAY5"), 7u);
  EXPECT_EQ(words("P5=2"), 1u);
  EXPECT_EQ(words("FRAX(X,Y)X1"), 2u);
}

TEST_F(Statement, AnExpressionCostsOneWordAToken) {
  EXPECT_EQ(words("X(P1*2)"), 4u);     // P1, 2, *, X; brackets are free
  EXPECT_EQ(words("P2000=P1+1"), 4u);  // P1, 1, +, P2000=
  EXPECT_EQ(words("X(SIN(P1))"), 3u);
  EXPECT_EQ(words("P1=P2+16777217"), 4u);  // 2^24 + 1
  EXPECT_EQ(words("P1=P2+8589934593"), 5u) << "2^33 + 1: 33 bits do not hold it";
}

TEST_F(Statement, LongAndShortKeywordsGiveTheSameWords) {
  const char* const pairs[][2] = {
      {"LINEAR", "LIN"}, {"RAPID", "RPD"}, {"DWELL100", "DWE100"}, {"DELAY100", "DLY100"}, {"dwell (100)", "DWE(100)"}};
  for (const auto& pair : pairs) {
    word48_t a = 0, b = 0;
    ASSERT_EQ(platform::host("CLEAR"), "");
    ASSERT_EQ(words(pair[0]), words(pair[1]));
    ASSERT_TRUE(rotary_peek(0, 0, &a));
    ASSERT_TRUE(rotary_peek(0, rotary_buffers[0].used / 2, &b));
    EXPECT_EQ(a, b) << pair[0];
  }
}

TEST_F(Statement, RecognisesWhatBeginsAStatement) {
  for (const char* text :
       {"X1",      "A10",      "B0",          "C-5",    "Y.5",     "Z(P1)",     "F100",   "TM10",    "TA(P1)",
        "DWELL10", "LINEAR",   "RAPID",       "ABS",    "INC(X)",  "FRAX(X,Y)", "P1=5",   "Q(P1)=2", "I5111=100",
        "M70=1",   "IF(P1=1)", "WHILE(P1<2)", "GOTO10", "CIRCLE1", "N100",      "CALL 5", "PVT200"})
    EXPECT_TRUE(starts(text)) << text;
  for (const char* text : {"A",  "H", "R",    "Q",   "S",     "F", "P5", "Q7",   "I17", "M1",
                           "PR", "?", "TYPE", "UUU", "CLOSE", "",  "J+", "SIZE", "/",   "\\"})
    EXPECT_FALSE(starts(text)) << text;
}

TEST_F(Statement, BranchesAreRefusedInARotaryBuffer) {
  for (const char* text : {"IF(P1=1)", "WHILE(P1=1)", "GOTO10", "GOSUB10", "ELSE", "ENDWHILE", "RETURN", "X1 IF(P1=1)"})
    EXPECT_EQ(platform::host(text), "ERR003") << text;
  EXPECT_EQ(platform::host("PR"), "0");
  for (const char* text : {"N10 X1", "CIRCLE1", "CALL500", "G01 X5", "M3", "X1:500", "M1==2", "HOME1..4"})
    EXPECT_EQ(platform::host(text), "") << text;
  EXPECT_EQ(platform::host("PR"), "8");
}

TEST_F(Statement, AnErrorStoresNothingOfTheLine) {
  EXPECT_EQ(platform::host("X1 Y2 GOTO3"), "ERR003");
  EXPECT_EQ(platform::host("X1 Y34359738369"), "ERR003");  // beyond 2^35
  EXPECT_EQ(platform::host("TM8388608"), "ERR003");
  EXPECT_EQ(platform::host("DWELL-1"), "ERR003");
  EXPECT_EQ(platform::host("F-1"), "ERR003");
  EXPECT_EQ(platform::host("P1==2"), "ERR003");  // M only
  EXPECT_EQ(platform::host("HOME33"), "ERR003");
  EXPECT_EQ(platform::host("N262144"), "ERR003");
  EXPECT_EQ(platform::host("READ (X)"), "ERR003");
  EXPECT_EQ(platform::host("SEND\"A"), "ERR003");
  EXPECT_EQ(rotary_buffers[0].used, 0u);
  EXPECT_EQ(platform::host("PR"), "0");
}

// Each number of a statement at both ends of its range, and one beyond; what is listed is what was entered.
TEST_F(Statement, NumbersHaveTheEndsOfTheirRanges) {
  ASSERT_EQ(platform::host("CLOSE"), "");
  const auto accepted = [](const std::string& text) {
    const std::string buffer = text.rfind("ADR", 0) == 0 ? "PLC 1" : "PROG 1";
    EXPECT_EQ(platform::host("OPEN " + buffer + " CLEAR"), "");
    const std::string reply = platform::host(text);
    EXPECT_EQ(platform::host("CLOSE"), "");
    const std::string listed = platform::host("LIST " + buffer);
    EXPECT_EQ(listed, reply.empty() ? text + "|RET" : "ERR003") << text << ": nothing is stored of what is refused";
    return reply.empty();
  };
  const struct {
    const char *before, *after;
    long first, last;
  } ranges[] = {
      {"TM", "", 0, 8388607},   {"N", "", 0, 262143},       {"O", "", 0, 262143},       {"HM", "", 1, 32},
      {"DISPLC", "", 0, 31},    {"ENAPLC", "", 0, 31},      {"ADR#", "", 1, 32},        {"ADR&", "", 1, 16},
      {"ADR#P", "", 0, 8191},   {"ADR&P", "", 0, 8191},     {"LOCK", ",P5", 0, 7},      {"LOCK3,P", "", 0, 8191},
      {"DISP", "\"A\"", 0, 79}, {"DISP3,", ".2,P1", 1, 16}, {"DISP3,12.", ",P1", 0, 9}, {"DISP", ",8.3,P1", 0, 79}};
  for (const auto& range : ranges)
    for (const long number : {range.first - 1, range.first, range.last, range.last + 1}) {
      const std::string text = range.before + std::to_string(number) + range.after;
      EXPECT_EQ(accepted(text), number >= range.first && number <= range.last) << text;
    }
  for (int c = ' '; c < 0x7F; ++c) {
    if (c == '"' || (c >= 'a' && c <= 'z')) continue;  // lower case is taken for upper case
    EXPECT_EQ(accepted(std::string("CMD^") + static_cast<char>(c)), c >= '@' && c <= '_') << static_cast<char>(c);
    if (c != ' ') {
      EXPECT_EQ(accepted(std::string("DISP3,12.") + static_cast<char>(c) + ",P1"), c >= '0' && c <= '9')
          << static_cast<char>(c);
      EXPECT_EQ(accepted(std::string("READ(") + static_cast<char>(c) + ")"),
                c >= 'A' && c <= 'Z' && c != 'N' && c != 'O')
          << static_cast<char>(c);
    }
  }
  for (const char* rate : {"F", "TA", "TS", "DWE", "DLY", "PVT"}) {
    EXPECT_FALSE(accepted(std::string(rate) + "-1")) << rate;
    EXPECT_TRUE(accepted(std::string(rate) + "0")) << rate;
  }
}

TEST_F(Statement, OnLineCommandsStillActWhileABufferIsOpen) {
  EXPECT_EQ(platform::host("X1"), "");
  EXPECT_EQ(platform::host("PR"), "1");
  EXPECT_EQ(platform::host("I17"), "10");
  EXPECT_EQ(platform::host("P1=5"), "");  // stored
  EXPECT_EQ(platform::host("P1"), "0");
  EXPECT_EQ(platform::host("PR"), "2");
  EXPECT_EQ(platform::host("B5"), "");  // an axis move, not the program pointer
  EXPECT_EQ(platform::host("PR"), "3");
}

TEST_F(Statement, ProgramOnlyTextNeedsAnOpenBuffer) {
  ASSERT_EQ(platform::host("CLOSE"), "");
  for (const char* text : {"X1000", "DWELL100", "DELAY100", "A10", "LINEAR", "F100", "IF(P1=1)", "RAPID", "SPLINE1",
                           "SEND\"A\"", "CMD\"A\""})
    EXPECT_EQ(platform::host(text), "ERR005") << text;
  for (const char* text : {"UUU", "AZ", "RX", "DELETE AY"}) EXPECT_EQ(platform::host(text), "ERR003") << text;
}

TEST_F(Statement, ChangingTheAddressInsideALineEndsIt) {
  ASSERT_EQ(platform::host("CLOSE"), "");
  ASSERT_EQ(platform::host("DELETE ROT"), "");
  ASSERT_EQ(platform::host("&2DEF ROT 10 &1DEF ROT 10"), "");
  ASSERT_EQ(platform::host("OPEN ROT"), "");
  EXPECT_EQ(platform::host("&1X1 &2Y2 Z3"), "");
  EXPECT_EQ(platform::host("&1PR &2PR"), "1|1");
  EXPECT_EQ(rotary_buffers[0].used, 1u);
  EXPECT_EQ(rotary_buffers[1].used, 2u);
}

}  // namespace
