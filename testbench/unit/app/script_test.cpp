// Host scripts: what is read, and that every error says file and line, what, and what was expected.
#include "app/script.h"
#include "app/hand_encoder.h"
#include "app/line_reader.h"
#include "app/place.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/time_text.h"
#include "systemc/core/usage_error.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = ScriptLine::Kind;

std::vector<ScriptLine> read(const std::string& text) {
  std::istringstream in(text);
  return read_script(in, "job.txt");
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const UsageError& e) { return e.what(); }
  return "no error";
}

TEST(Script, ReadsEveryKindOfLine) {
  const auto s = read(
      "VERSION\n\n  &2DEFINE ROTARY 50  \r\n^A^X\n@wait 2.5us\n@until host.breq=1 50ms\n@signal clock.phase\n@pic\n"
      "@pic MSK=02 ELR=00\n@pic clear\n@dpram 0x1050 6\n@dpram 4176 = 12 FFFF\n@jumper E3 on\n@input "
      "servo_ic0.ch1.hmfl=1\n@encoder 2 "
      "-50\n@encoder 1 7 100\n@reset\n@power\n"
      "@expect 1|2 3\n@expect\n@time\n");
  std::vector<Kind> kinds;
  kinds.reserve(s.size());
  for (const auto& line : s) kinds.push_back(line.kind);
  EXPECT_EQ(kinds,
            (std::vector<Kind>{Kind::kCommand,    Kind::kCommand, Kind::kControl,  Kind::kWait,     Kind::kUntil,
                               Kind::kSignal,     Kind::kPicRead, Kind::kPicWrite, Kind::kPicClear, Kind::kDpramRead,
                               Kind::kDpramWrite, Kind::kJumper,  Kind::kInput,    Kind::kEncoder,  Kind::kEncoder,
                               Kind::kReset,      Kind::kPower,   Kind::kExpect,   Kind::kExpect,   Kind::kTime}));
  EXPECT_EQ(s[1].text, "&2DEFINE ROTARY 50");
  EXPECT_EQ(s[1].place, "job.txt:3");
  EXPECT_EQ(s[2].value, std::string("\x01\x18"));
  EXPECT_EQ(s[3].time, 2'500'000'000);
  EXPECT_EQ(s[4].name, "host.breq");
  EXPECT_EQ(s[4].value, "1");
  EXPECT_EQ(s[7].mask, 2);
  EXPECT_EQ(s[7].edge_level, 0);
  EXPECT_EQ(s[9].offset, 0x1050u);
  EXPECT_EQ(s[9].count, 6u);
  EXPECT_EQ(s[10].offset, 0x1050u);
  EXPECT_EQ(s[10].words, (std::vector<std::uint16_t>{0x12, 0xFFFF}));
  EXPECT_EQ(s[12].name, "servo_ic0.ch1.hmfl");
  EXPECT_TRUE(s[12].on);
  EXPECT_EQ(s[13].motor, 2u);
  EXPECT_EQ(s[13].counts, -50);
  EXPECT_EQ(s[14].counts, 7);
  EXPECT_EQ(s[14].rate, 100);
  EXPECT_EQ(s[17].value, "1|2 3");
  EXPECT_EQ(s[18].value, "");
}

// Values as @signal prints them: of a counter that has gone down, of a bus.
// As much as there is, and nothing of what is not named.
TEST(Script, TakesTheLastWordTheFastestTurnAndOneRegister) {
  const auto s = read("@dpram 65534 1\n@dpram 0 32768\n@encoder 1 5 9830400\n@pic ELR=1\n@pic MSK=2\n");
  ASSERT_EQ(s.size(), 5u);
  EXPECT_EQ(s[0].count, 1u);
  EXPECT_EQ(s[1].count, 32768u);
  EXPECT_EQ(s[2].rate, 9'830'400);
  EXPECT_EQ(s[3].mask, -1);
  EXPECT_EQ(s[3].edge_level, 1);
  EXPECT_EQ(s[4].mask, 2);
  EXPECT_EQ(s[4].edge_level, -1);
}

TEST(LineReader, EndsAtACommentWhereThereAreSome) {
  LineReader with("a # b", '#'), without("a # b");
  EXPECT_EQ(with.word("a"), "a");
  EXPECT_TRUE(with.at_end());
  for (const char* word : {"a", "#", "b"}) EXPECT_EQ(without.word("a word"), word);
  EXPECT_TRUE(without.at_end());
  EXPECT_EQ(LineReader("x9").name("a name"), "x9");
  EXPECT_THROW(LineReader("9x").name("a name"), UsageError);
  EXPECT_THROW(LineReader("").name("a name"), UsageError);
}

TEST(LineReader, KnowsATimeBeforeItIsRead) {
  for (const char* time : {"10ms", "10 ms", "2.5us 7", "0 s"}) EXPECT_TRUE(LineReader(time).time_follows()) << time;
  for (const char* other : {"", "10", "10 7 ms", "ms", "x1ms", "10 m"})
    EXPECT_FALSE(LineReader(other).time_follows()) << other;
}

TEST(Place, IsAHostAndAPort) {
  const auto port_of = [](const char* text) { return parse_place("--listen", text, "localhost:1025").port; };
  EXPECT_EQ(port_of("h:65535"), "65535");
  EXPECT_EQ(port_of("h:00080"), "00080");
  for (const char* bad : {"h", "h:", ":1", "h:65536", "h:000080", "h:-1", "h:1x"})
    EXPECT_THROW(port_of(bad), UsageError) << bad;
}

TEST(Script, WaitsForEveryKindOfValue) {
  const auto s = read("@until ch1.count=-37 5ms\n@until bus.addr=$78004 5ms\n@until cpu.symbol=main 2.5 us\n");
  EXPECT_EQ(s[0].value, "-37");
  EXPECT_EQ(s[0].time, 5'000'000'000'000);
  EXPECT_EQ(s[1].value, "$78004");
  EXPECT_EQ(s[2].value, "main");
  EXPECT_EQ(s[2].time, 2'500'000'000);
}

TEST(Script, ErrorsSayWhereWhatAndWhatWasExpected) {
  for (const char* bad : {"@wait",
                          "@wait 10",
                          "@wait ten ms",
                          "@until breq 5ms",
                          "@until breq=1",
                          "@until breq=1 5",
                          "@until count=- 5ms",
                          "@signal",
                          "@pic MSK=100",
                          "@pic FOO=1",
                          "@pic clear MSK=1",
                          "@dpram 1 2",
                          "@dpram 65536 1",
                          "@dpram 65534 2",
                          "@dpram 0",
                          "@dpram 0 = 10000",
                          "@dpram 0 =",
                          "@jumper E4 on",
                          "@jumper E3 perhaps",
                          "@reset now",
                          "@frob",
                          "@input USER1",
                          "@input USER1=2",
                          "@input =1",
                          "@encoder 1",
                          "@encoder 0 100",
                          "@encoder 1 0",
                          "@encoder 1 -0",
                          "@encoder 1 5 0",
                          "@encoder 1 x",
                          "@encoder 1 5 9830401",
                          "@encoder 1 4294967295 1",
                          "@encoder 1 5 6 7",
                          "@jpan FPD=x"})
    EXPECT_THAT(error_of(std::string("VERSION\n") + bad), AllOf(HasSubstr("job.txt:2: @"), HasSubstr("expected")))
        << bad;
}

TEST(Script, ErrorsInAtLinesSayWhoIncludedTheFile) {
  const std::string folder = ::testing::TempDir() + "brick_script_included/";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "bad.pmc") << "I16\n@frob\n";
  EXPECT_EQ(error_of("#include \"" + folder + "bad.pmc\"").find(folder + "bad.pmc:2: @frob: `@frob` is not known"), 0u);
  EXPECT_THAT(error_of("#include \"" + folder + "bad.pmc\""), ::testing::EndsWith(" (included at job.txt:1)"));
  std::filesystem::remove_all(folder);
  EXPECT_LT(error_of("@frob" + std::string(1 << 16, 'X')).size(), 300u);
  EXPECT_THAT(error_of("@wait \x1B[2J"), HasSubstr("`<1B>`"));
}

// Quadrature by hand: the levels of A and B after each edge, and the tick of each, by the rule of the data sheet.
TEST(HandEncoder, TurnsAAndBAtTheRateThatWasAskedFor) {
  MotorInputPins pins;
  pins[3].pins[1] = 0;
  HandEncoder up(3, 1, 5, 1'000'000, 1000);
  const std::vector<unsigned> expected{2, 3, 1, 0, 2};  // {B, A} with B in bit 1: B leads
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Tick due = 1000 + static_cast<Tick>(i + 1) * 1179648 / 10000;  // 117.9648 ticks each
    ASSERT_EQ(up.next_event(), due);
    EXPECT_FALSE(up.step(due - 1, pins));
    EXPECT_TRUE(up.step(due, pins));
    EXPECT_EQ(pins[3].pins[1], expected[i]) << "edge " << i + 1;
  }
  EXPECT_EQ(up.next_event(), kNever);
  HandEncoder down(3, 1, -3, 1'000'000, 0);
  for (const unsigned level : {0u, 1u, 3u}) {
    down.step(down.next_event(), pins);
    EXPECT_EQ(pins[3].pins[1], level);
  }
}

TEST(HandEncoder, MotorsAreTheChannelsOfTheFittedIcsInOrder) {
  constexpr std::uint32_t kIcs2And3 = 0xC;
  EXPECT_EQ(motor_place(kIcs2And3, 1)->ic, 2u);
  EXPECT_EQ(motor_place(kIcs2And3, 8)->ic, 3u);
  EXPECT_EQ(motor_place(kIcs2And3, 8)->channel, 3u);
  EXPECT_FALSE(motor_place(kIcs2And3, 9));
  EXPECT_FALSE(motor_place(1u << 18, 1)) << "a MACRO IC alone";
}

TEST(TimeText, IsExact) {
  EXPECT_EQ(parse_time("1ns"), 1'000'000);
  EXPECT_EQ(parse_time("0.5ns"), 500'000);
  EXPECT_EQ(parse_time("10ms"), 10'000'000'000'000);
  EXPECT_EQ(parse_time("1.25s"), 1'250'000'000'000'000);
  EXPECT_EQ(parse_time("1000000000s"), 1'000'000'000 * TimeFs{1'000'000'000'000'000}) << "31 years, the longest";
  for (const char* bad : {"", "ms", "10", "10 ms", "-1ms", "1.2.3ms", "10m", "1e3s", "1000000001s"})
    EXPECT_THROW(parse_time(bad), UsageError) << bad;
}

}  // namespace
}  // namespace brick
