// Words that a host has written over a program with WX and WY: what is no statement is listed as `?`, and whoever meets
// it stops with an error; nothing else happens.
#include <limits>

#include "testbench/unit/firmware_program/motion_program.h"

extern "C" {
#include "firmware/buffers/user_memory.h"
#include "firmware/language/lister.h"
#include "firmware/language/statement_argument.h"
}

namespace damaged_words {
namespace {

using motion_program::MotionProgram;
using platform::host;
using Words = std::vector<word48_t>;

word48_t word(operation op, std::uint32_t group, std::uint32_t number, double value = 0) {
  const instruction in{op, group, number, value};
  return word_encode(&in);
}

constexpr word48_t kIllegal = 8ull << 43 | 1ull << 40;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

const word48_t kNumber = word(OP_PUSH, 0, 0, 7), kMode = word(OP_STATEMENT, 0, WORD_KEY(2, 0, 1000)),
               kList = word(OP_LIST, WORD_KEY(9, 1, 30), 1);

std::string lister_text;

std::string list(const Words& words, bool long_form) {
  lister_text.clear();
  lister_line(words.data(), static_cast<std::uint32_t>(words.size()), long_form, [](char c) { lister_text += c; });
  return lister_text;
}

TEST(DamagedWords, AreListedAsQuestionMarks) {
  const word48_t assignment = word(OP_ASSIGN_POP, VARIABLE_P, 5), indexed = word(OP_ASSIGN_INDEXED, VARIABLE_P, 0),
                 condition = word(OP_CONDITION, CONDITION_IF, 0), apply = word(OP_APPLY, 0, OPERATOR_ADD);
  const auto constant = [&](double value) {
    return Words{word_double_head(value), word_double_tail(value), assignment};
  };
  const struct {
    Words words;
    const char* text;
  } cases[] = {
      {{kIllegal}, "?"},
      {{kMode}, "?"},
      {{kList}, "?"},
      {{apply}, "?"},
      {{kNumber, apply}, "?"},
      {{word(OP_AXIS_POP, 0, AXIS_X)}, "X?"},
      {{word(OP_RATE_POP, 0, RATE_F)}, "F?"},
      {{assignment}, "P5=?"},
      {{indexed}, "P(?)=?"},
      {{kNumber, indexed}, "P(?)=7"},
      {{word(OP_SYNCHRONOUS_INDEXED, SYNCHRONOUS_OR, 0)}, "M(?)|=?"},
      {{condition}, "IF(?)"},
      {{kNumber, condition}, "IF(?)"},
      {{word(OP_LIST, DISPLAY_VALUE, 5 | 8 << DISPLAY_WIDTH_BIT | 3 << DISPLAY_DECIMALS_BIT)}, "DISP5,8.3,?"},
      {{word(OP_TEXT, KEY_SEND, 0x81 << TEXT_CONTROL_BIT)}, "SEND^?"},
      {{word_double_head(0.1)}, "?"},
      {constant(1e18), "P5=?"},
      {constant(kInfinite), "P5=?"},
      {constant(-kInfinite), "P5=-?"},
      {constant(std::numeric_limits<double>::quiet_NaN()), "P5=?"},
  };
  for (const auto& c : cases) {
    EXPECT_EQ(list(c.words, false), c.text);
    Words between = c.words;  // lines and statements about it are listed as ever
    between.insert(between.begin(), word(OP_AXIS, 0, AXIS_Y, 1));
    EXPECT_EQ(list(between, false), std::string("Y1") + c.text);
  }
}

class DamagedPrograms : public MotionProgram {
 protected:
  // The word of P2=2, behind P1=1 in a program or PLC.
  static void damage(fixed_kind kind, const Words& words) {
    const std::uint32_t base = fixed_program_find(kind, 1)->base;
    for (std::uint32_t i = 0; i < words.size(); ++i)
      user_memory_write(base + 1 + i, words[i] | (i == 0 ? WORD_START_OF_LINE : 0));
  }
};

// Of a motion program: an error, and the number of a statement that it does not have.
const Words kStatements[] = {
    {kIllegal},
    {kMode},
    {kList},
    {word(OP_APPLY, 0, OPERATOR_ADD)},
    {word(OP_AXIS_POP, 0, AXIS_X)},
    {word(OP_ASSIGN_POP, VARIABLE_P, 2)},
    {word(OP_ASSIGN_INDEXED, VARIABLE_P, 0)},
    {word(OP_CONDITION, CONDITION_IF, 0)},
    {word(OP_LIST, DISPLAY_VALUE, 0)},
    {word(OP_RATE_POP, 0, RATE_F)},
    {word(OP_STATEMENT_POP, 0, KEY_GOTO)},
    {word(OP_SYNCHRONOUS, SYNCHRONOUS_SET, 1)},
    {word(OP_SYNCHRONOUS_INDEXED, SYNCHRONOUS_SET, 0)},
    {word(OP_PUSH_INDEXED, VARIABLE_P, 0)},
};

TEST_F(DamagedPrograms, AMotionProgramStopsWithAnError) {
  for (const Words& words : kStatements) {
    SCOPED_TRACE(list(words, false));
    platform::power_up();
    run({"P1=P1+1", "P2=2", "P3=3"});
    ASSERT_EQ(host("P1..3"), "1|2|3");
    const std::uint32_t statement = 4;  // P1, 1, +, P1=
    user_memory_write(fixed_program_find(FIXED_PROG, 1)->base + statement, words[0] | WORD_START_OF_LINE);
    ASSERT_EQ(host("P1=0 P2=0 P3=0 B1R"), "");
    ASSERT_TRUE(finish());
    EXPECT_EQ(host("P1..3"), "1|0|0");
    EXPECT_TRUE(error());
    EXPECT_EQ(host("RY$2014"), "1");
  }
}

TEST_F(DamagedPrograms, APlcIsDisabled) {
  for (const Words& words : kStatements) {
    SCOPED_TRACE(list(words, false));
    platform::power_up();
    ASSERT_EQ(host("OPEN PLC 1 CLEAR P1=1 P2=2 P3=3 CLOSE I5=2 ENABLE PLC 1"), "");
    platform::background(2);
    ASSERT_EQ(host("P1..3"), "1|2|3");
    damage(FIXED_PLC, words);
    ASSERT_EQ(host("P1=0 P2=0 P3=0"), "");
    platform::background(2);
    EXPECT_EQ(host("P1..3"), "1|0|0");
    EXPECT_EQ(plc_enabled(), 0u);
  }
}

// There are eight locks; one that is none is no lock of others either.
TEST_F(DamagedPrograms, ALockThatThereIsNotIsNone) {
  for (const unsigned key : {static_cast<unsigned>(KEY_LOCK), static_cast<unsigned>(KEY_UNLOCK)})
    for (const double number : {8.0, 9.0, -1.0, 32.0}) {
      platform::power_up();
      ASSERT_EQ(host("OPEN PROG 1 CLEAR P1=1 P2=2 P3=3 CLOSE LOCK0,P9 LOCK7,P9"), "");
      damage(FIXED_PROG, {word(OP_STATEMENT, 0, key, number)});
      ASSERT_EQ(host("B1R"), "");
      ASSERT_TRUE(finish());
      EXPECT_EQ(host("P1..3 RY$2014 I4904"), "1|0|3|0|$811") << key << " " << number;
    }
}

// No buffer that is read as it is filled can be jumped about in.
TEST_F(DamagedPrograms, ARotaryBufferTakesNoConditions) {
  ASSERT_EQ(host("DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("P1=P2+P3"), "");
  ASSERT_EQ(host("P4=4"), "");
  ASSERT_EQ(host("CLOSE"), "");
  const std::uint32_t add = rotary_buffers[0].base + 2;
  ASSERT_EQ(word_decode(user_memory_read(add)).operation, OP_APPLY);
  user_memory_write(add, word(OP_CONDITION, CONDITION_IF, 0));
  ASSERT_EQ(host("P1=7 P2=1 R"), "") << "a condition that would leave out its line";
  ASSERT_TRUE(finish());
  EXPECT_EQ(host("P1 P4 RY$2014"), "7|0|1");
}

// What has no RETURN any more ends with its last word: a program stops, a PLC begins anew.
TEST_F(DamagedPrograms, EndWithTheirLastWord) {
  for (const auto& [buffer, kind] : {std::pair{"PROG", FIXED_PROG}, {"PLC", FIXED_PLC}}) {
    ASSERT_EQ(host(std::string("OPEN ") + buffer + " 1 CLEAR P1=1 CLOSE"), "");
    ASSERT_EQ(fixed_program_find(kind, 1)->words, 2u);
    damage(kind, {word(OP_ASSIGN, VARIABLE_P, 2, 2)});
  }
  ASSERT_EQ(host("B1R"), "");
  ASSERT_TRUE(finish());
  EXPECT_FALSE(error());
  EXPECT_EQ(host("P1..2"), "1|2");
  for (int turns = 0; turns < 2; ++turns) {
    ASSERT_EQ(host("P1=0 P2=0 I5=2 ENABLE PLC 1"), "");
    platform::background(2);
    EXPECT_EQ(host("P1..2"), "1|2");
    EXPECT_EQ(plc_enabled(), 2u);
  }
}

// The marks of its lines gone, a program is one line, longer than any that a host can give.
TEST_F(DamagedPrograms, ALineLongerThanAHostCanGiveIsExecuted) {
  store(1, std::vector<std::string>(200, "P1=P1+1"));  // 4 words each
  std::uint32_t marks = 0;
  for (std::uint32_t at = 1; at < 800; ++at) {
    marks += (user_memory_read(at) & WORD_START_OF_LINE) != 0 ? 1 : 0;
    user_memory_write(at, user_memory_read(at) & ~WORD_START_OF_LINE);
  }
  ASSERT_GE(marks, 199u);
  ASSERT_EQ(host("P1=0 B1R"), "");
  ASSERT_TRUE(finish());
  EXPECT_EQ(host("P1"), "200");
}

}  // namespace
}  // namespace damaged_words
