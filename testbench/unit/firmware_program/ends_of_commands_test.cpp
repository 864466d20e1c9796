// On-line commands at the ends of what they take: sizes that 32 bits do not hold, letters with a bracket behind them,
// modes without axes (firmware:4.3, firmware:6.4, firmware:7.1).
#include "testbench/unit/firmware_program/motion_program.h"

namespace {

using namespace motion_program;

class EndsOfCommands : public MotionProgram {};

// 2^32 words and a few more: modulo 2^32 they would fit.
TEST_F(EndsOfCommands, ABufferOfMoreWordsThanThereCanBeHasNoRoom) {
  const struct {
    const char* name;
    std::uint64_t each;
    const char* rest;
  } kinds[] = {{"TBUF", 12, ""}, {"CCBUF", 10, ""}, {"LOOK", 6, ",0"}};
  for (const auto& kind : kinds) {
    const std::uint64_t count = (std::uint64_t{1} << 32) / kind.each + 1;  // at most `each` words beyond 2^32
    EXPECT_EQ(host("DEF " + std::string(kind.name) + std::to_string(count) + kind.rest), "ERR006") << kind.name;
    EXPECT_EQ(host("DEF " + std::string(kind.name) + "2147483647" + kind.rest), "ERR006") << kind.name;
    EXPECT_EQ(host("SIZE"), "26624");
  }
  EXPECT_EQ(host("DEF LOOK 1,2147483647"), "ERR006") << "6 + 2 (2^31 - 1) = 2^32 + 4";
  const std::pair<const char*, int> fit[] = {{"TBUF 2218", 12 * 2218}, {"CCBUF 2662", 10 * 2662}};
  for (const auto& [text, words] : fit) {
    EXPECT_EQ(host(std::string("DEF ") + text), "") << text;
    EXPECT_EQ(host("SIZE"), std::to_string(26624 - words));
    ASSERT_EQ(host("DELETE ALL"), "");
  }
  EXPECT_EQ(host("DEF TBUF 2219"), "ERR006") << "26628 words";
  EXPECT_EQ(host("DEF CCBUF 2663"), "ERR006");
}

// A(..) and R9 are statements of a program, RQ is nothing: none of them stops or starts anything.
TEST_F(EndsOfCommands, ALetterWithSomethingBehindItIsNoCommand) {
  store(1, {"WHILE(P1=0) WAIT", "X5"});
  const struct {
    const char* error;
    Lines texts;
  } kinds[] = {{"ERR005", {"A(5)", "R(5)", "S(5)", "A(P1)", "A5", "R9", "S1", "A.5", "B(1)"}},
               {"ERR003",
                {"H(5)",
                 "H0",
                 "AA",
                 "HZ",
                 "RQ",
                 "SA",
                 "QUIT",
                 "E(1)",
                 "E5",
                 "ABR(5)",
                 "ABR (5)",
                 "ABR(P1)",
                 "ABRA",
                 "ABRZ",
                 "ABR X5",
                 "ABR-X",
                 "ABR-",
                 "ABR+",
                 "ABR=2",
                 "ABR.",
                 "ABR,2",
                 "ABR$",
                 "ABR32768",
                 "ABR-5",
                 "ABR P1=5",
                 "ABR99999999999",
                 "ABR 99999999999",
                 "ABR-99999999999",
                 "BX",
                 "B",
                 "B-",
                 "B+X"}}};
  for (const auto& kind : kinds)
    for (const std::string& text : kind.texts) {
      ASSERT_EQ(host("B1R"), "");
      platform::servo_ticks(9);
      const std::string status = host("??");
      EXPECT_EQ(host(text), kind.error) << text;
      EXPECT_TRUE(run_is_running(0)) << text;
      platform::servo_ticks(9);
      EXPECT_EQ(host("??"), status) << text;
      EXPECT_EQ(coordinate_systems[0].increment_target, platform::kDefaultI10) << text;
      ASSERT_EQ(host("A"), "");
      platform::servo_ticks(9);
      EXPECT_FALSE(run_is_running(0));
      EXPECT_EQ(host(text), kind.error) << text;
      EXPECT_FALSE(run_is_running(0)) << text;
    }
}

// firmware:1.1/4, firmware:4.3/7: a number that is too large is no axis.
TEST_F(EndsOfCommands, BOfANumberThatIsTooLargeIsADataError) {
  for (const char* text : {"B99999999999", "B32768", "B-1"}) EXPECT_EQ(host(text), "ERR003") << text;
}

// servo-ic:7.2/4: at the end of the line, whatever the background has to do before it comes to them.
TEST_F(EndsOfCommands, ClockDirectionsActAtTheEndOfTheirLine) {
  const auto inputs = [] { return *hal_x(0x078004) >> 12 & 3; };
  ASSERT_EQ(inputs(), 0u);
  ASSERT_EQ(host("I7007=3"), "");
  EXPECT_EQ(inputs(), 3u);
  ASSERT_EQ(host("I7007=0"), "");
  EXPECT_EQ(inputs(), 0u);
}

// firmware:7.1/7. One by F then goes by time of its longest axis (firmware:7.5/3).
TEST_F(EndsOfCommands, WithoutFeedrateAxesThereAreNone) {
  coordinate_system& s = coordinate_systems[0];
  ASSERT_EQ(s.feedrate_axes, static_cast<std::uint32_t>(AXIS_XYZ));
  const auto bit_of = [](unsigned axis) { return 1u << axis; };
  EXPECT_EQ(host("FRAX(A,X)"), "");
  EXPECT_EQ(s.feedrate_axes, bit_of(AXIS_A) | bit_of(AXIS_X));
  EXPECT_EQ(host("NOFRAX"), "");
  EXPECT_EQ(s.feedrate_axes, 0u);
  EXPECT_EQ(host("FRAX"), "");
  EXPECT_EQ(s.feedrate_axes, static_cast<std::uint32_t>(AXIS_XYZ));
  EXPECT_EQ(host("&2NOFRAX"), "");
  EXPECT_EQ(s.feedrate_axes, static_cast<std::uint32_t>(AXIS_XYZ)) << "of the addressed system";
  EXPECT_EQ(coordinate_systems[1].feedrate_axes, 0u);
}

}  // namespace
