// Framing of replies by I3, I4 and I6, and the host link on a scripted controller. Exchanges from firmware:6.2,
// firmware:6.3, firmware:13.
#include <gtest/gtest.h>

#include "testbench/host/host_link.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/framing.h"
#include "testbench/unit/host_library/fake_machine.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

ReplyParser parsed(Framing framing, const std::string& bytes, std::uint8_t command = 0) {
  ReplyParser parser(framing, command);
  for (const char c : bytes) {
    EXPECT_FALSE(parser.complete()) << "complete too early in " << bytes;
    parser.take(static_cast<std::uint8_t>(c));
  }
  return parser;
}

TEST(ReplyParser, DataUpToTheAcknowledge) {
  const auto p = parsed({2, 0}, "25\r50\r75\r\x06");
  EXPECT_TRUE(p.complete());
  EXPECT_EQ(p.reply().lines, (Lines{"25", "50", "75"}));
  EXPECT_FALSE(p.reply().error);
}

// The characters of 100002 and their CR sum up to '0': where checksums cannot be, that is the next value.
TEST(ReplyParser, NoValueIsTakenForAChecksumWhereNoneCanBe) {
  ReplyParser without({2, 0}, 0, ReplyParser::Mixed::kWithoutChecksums),
      with({2, 0}, 0, ReplyParser::Mixed::kWithChecksums);
  for (const char c : std::string("100002\r0\r5\r\x06")) {
    without.take(static_cast<std::uint8_t>(c));
    with.take(static_cast<std::uint8_t>(c));
  }
  EXPECT_EQ(without.reply().lines, (Lines{"100002", "0", "5"}));
  EXPECT_EQ(with.reply().lines, (Lines{"100002", "", "5"})) << "nobody can tell";
}

TEST(ReplyParser, LineFeedsOfI3Equal3AreNoData) {
  const auto p = parsed({3, 0}, "\n25\r\n50\r\x06");
  EXPECT_TRUE(p.complete());
  EXPECT_EQ(p.reply().lines, (Lines{"25", "50"}));
}

TEST(ReplyParser, ErrorWithNumberEndsAtItsCr) {
  const auto p = parsed({2, 0},
                        "\x07"
                        "ERR003\r");
  EXPECT_TRUE(p.complete());
  EXPECT_TRUE(p.reply().error);
  EXPECT_EQ(p.reply().lines, (Lines{"ERR003"}));
}

TEST(ReplyParser, ErrorFormsOfI6) {
  auto bare = parsed({2, 0}, "\x07");
  EXPECT_TRUE(bare.ends_by_quiet());
  EXPECT_TRUE(bare.quiet());
  EXPECT_EQ(bare.reply().lines, (Lines{"ERR"}));
  const auto p = parsed({3, 0},
                        "\x07\r\n"
                        "ERR005\r");
  EXPECT_TRUE(p.complete());
  EXPECT_EQ(p.reply().lines, (Lines{"ERR005"}));
}

TEST(ReplyParser, DataBeforeTheErrorIsKept) {
  EXPECT_EQ(parsed({2, 0},
                   "7007\r\x07"
                   "ERR003\r")
                .reply()
                .lines,
            (Lines{"7007", "ERR003"}));
}

TEST(ReplyParser, QuietEndsI3Equal0And1Only) {
  auto none = parsed({0, 0}, "");
  EXPECT_TRUE(none.quiet());
  auto data = parsed({0, 0}, "25\r");
  EXPECT_TRUE(data.quiet());
  EXPECT_EQ(data.reply().lines, (Lines{"25"}));
  auto open = parsed({1, 0}, "\n25\r");
  EXPECT_FALSE(open.quiet()) << "the last LF is missing";
  open.take('\n');
  EXPECT_TRUE(open.quiet());
  auto silent = parsed({2, 0}, "25\r");
  EXPECT_FALSE(silent.quiet());
}

TEST(ReplyParser, ChecksumsMayLookLikeAnything) {
  // $F9 and CR add up to ACK; the checksum of the command is BELL.
  const auto p = parsed({2, 1}, "\xF9\r\x06\x06\x07", 0x07);
  EXPECT_TRUE(p.complete());
  EXPECT_FALSE(p.reply().error);
  EXPECT_EQ(p.reply().lines, (Lines{"\xF9"}));
  EXPECT_EQ(p.reply().bad_checksum, "");
  auto lf = parsed({1, 1}, "\n\x07", 0x07);  // I3 = 1: the command's checksum behind the LF
  EXPECT_TRUE(lf.quiet());
  EXPECT_FALSE(lf.reply().error);
  EXPECT_EQ(lf.reply().lines, Lines{});
  auto text = parsed({1, 1}, std::string("\n25\r") + checksum("\n25\r") + "\n2", '2');
  EXPECT_TRUE(text.quiet()) << "the same behind data";
  EXPECT_EQ(text.reply().lines, (Lines{"25"}));
}

// J+ is 117 (firmware:6.5/1); 25 CR is $32 + $35 + $0D = $74.
TEST(ReplyParser, WrongChecksumsAreTold) {
  EXPECT_EQ(command_checksum("J\x02+"), 117);
  EXPECT_EQ(parsed({2, 1}, "25\r\x74\x06u", 117).reply().bad_checksum, "");
  EXPECT_EQ(parsed({2, 1}, "25\r\x75\x06u", 117).reply().bad_checksum, "the checksum of `25` is $75, expected $74");
  EXPECT_EQ(parsed({2, 1}, "25\r\x74\x06v", 117).reply().bad_checksum, "the checksum of the line is $76, expected $75");
  auto lf = parsed({1, 1}, "\nv", 117);
  EXPECT_TRUE(lf.quiet());
  EXPECT_EQ(lf.reply().bad_checksum, "the checksum of the line is $76, expected $75");
  EXPECT_EQ(lf.reply().lines, Lines{});
}

// No source says whether an error has a checksum, or of what: ERR003 CR is $45 + 2 * $52 + 2 * $30 + $33 + $0D = $189,
// with BELL $190. A byte that cannot be one belongs to what comes next.
TEST(ReplyParser, ErrorAmongChecksumsEndsWithOrWithoutOne) {
  const auto error = [] {
    return parsed({2, 1},
                  "\x07"
                  "ERR003\r",
                  'u');
  };
  auto without = error(), text = error();
  EXPECT_FALSE(without.complete());
  EXPECT_TRUE(without.quiet());
  EXPECT_EQ(without.reply().lines, (Lines{"ERR003"}));
  for (const int sum : {0x89, 0x90, +'u'}) {  // the last: of the command
    auto with = error();
    EXPECT_TRUE(with.take(static_cast<std::uint8_t>(sum)));
    EXPECT_TRUE(with.complete());
  }
  EXPECT_FALSE(text.take('T'));
  EXPECT_TRUE(text.complete());
  EXPECT_EQ(text.reply().raw.back(), '\r');
}

// 25 CR is $74, LF 25 CR $7E; X CR is $65, LF X CR $6F.
TEST(ReplyParser, TextsOfProgramsBehindAReplyHaveChecksumsOfTheirOwn) {
  auto bell = parsed({0, 1}, "25\r\x74\x07X\r\x65");
  EXPECT_TRUE(bell.quiet());
  EXPECT_EQ(bell.reply().lines, (Lines{"25", "X", "ERR"})) << "no number came";
  EXPECT_EQ(bell.reply().bad_checksum, "");
  auto lf = parsed({1, 1}, "\n25\r\x7E\nu\nX\r\x6F", 'u');
  EXPECT_EQ(lf.reply().lines, (Lines{"25", "X"}));
  EXPECT_EQ(lf.reply().bad_checksum, "");
}

// Of programs too, where they are tagged (I64). $02 ERR003 CR is $18B, $02 X CR $67, 25 CR $74.
TEST(ReplyParser, ErrorsOfProgramsHaveNoChecksum) {
  for (const std::string number : {"ERR003", ""}) {
    auto p = parsed({2, 1}, "\x02" + number + "\r\x02X\r\x67" + "25\r\x74\x06u", 'u');
    EXPECT_TRUE(p.complete());
    EXPECT_EQ(p.reply().bad_checksum, "");
    EXPECT_EQ(p.reply().lines, (Lines{"25"}));
    EXPECT_EQ(p.reply().unsolicited, (Lines{number, "X"}));
  }
  auto summed = parsed({2, 1},
                       "\x02"
                       "ERR003\r\x8B"
                       "25\r\x74\x06u",
                       'u');
  EXPECT_EQ(summed.reply().lines, (Lines{"25"}));
  EXPECT_EQ(summed.reply().bad_checksum, "");
  // With I3 = 1 one without a number begins without LF behind the acknowledge.
  for (const std::string error : {"\x02\r", "\x07"}) {
    auto p = parsed({1, 1}, "\nu" + error, 'u');
    (void)p.quiet();
    EXPECT_EQ(p.reply().bad_checksum, "");
    EXPECT_EQ(p.reply().lines, error == "\x07" ? (Lines{"ERR"}) : Lines{}) << "nobody can tell whose it is";
  }
}

// A control character in the line is answered with a checksum of its own, which may look like BELL or a tag, and the
// line's is not known: backspaces. 25 CR is $74, LF 25 CR $7E.
TEST(ReplyParser, AnswersToControlCharactersInALineHaveChecksums) {
  const auto mixed = [](unsigned i3, unsigned i4, const std::string& bytes) {
    ReplyParser parser({i3, i4}, std::nullopt, ReplyParser::Mixed::kWithChecksums);
    for (const char c : bytes) parser.take(static_cast<std::uint8_t>(c));
    EXPECT_TRUE(parser.quiet());
    EXPECT_EQ(parser.reply().bad_checksum, "");
    EXPECT_EQ(parser.reply().raw, bytes);
    return parser.reply();
  };
  for (const std::string sum : {"\x02", "\x07", "\n", "u", "\x06"}) {
    EXPECT_EQ(mixed(2, 1, "25\r\x74\x06" + sum + "25\r\x74\x06" + sum).lines, (Lines{"25", "25"})) << sum;
    EXPECT_FALSE(mixed(2, 1, "25\r\x74\x06" + sum).error) << "BELL it is not";
    EXPECT_TRUE(mixed(2, 1, "25\r\x74\x06" + sum + "\x07").error);
    EXPECT_EQ(mixed(2, 0, "\x06" + sum).lines, Lines{}) << "from now on";
    const std::string plain = "25\r\x06", summed = "25\r\x74\x06" + sum;
    EXPECT_EQ(mixed(2, 0, plain + summed).lines, (Lines{"25", "25"})) << "from now on, with data";
    if (sum == "\x02" || sum == "\x07" || sum == "\n") continue;  // an acknowledge: a checksum before a text
    EXPECT_EQ(mixed(2, 0, plain + "\x06" + sum).lines, (Lines{"25"})) << "from now on, without data";
  }
  EXPECT_EQ(mixed(1, 1, "\n25\r\x7E\n\x02\x06u").lines, (Lines{"25"})) << "I3 is 0 from now on";
  ReplyParser unnumbered({2, 0}, std::nullopt, ReplyParser::Mixed::kWithoutChecksums);
  for (const char c : std::string("25\r\x06\x07")) unnumbered.take(static_cast<std::uint8_t>(c));
  EXPECT_TRUE(unnumbered.quiet());
  EXPECT_EQ(unnumbered.reply().lines, (Lines{"25", "ERR"}));
  const Reply error = mixed(1, 1, "\n25\r\x7E\n\x07\x07");
  EXPECT_TRUE(error.error);
  EXPECT_EQ(error.lines, (Lines{"25", "ERR"}));
}

// Texts among checksums behind an error: those of programs have one. LF, $02, X, CR is $71.
TEST(ReplyParser, TaggedTextsBehindAnErrorHaveChecksums) {
  ReplyParser parser({3, 1}, 'u', ReplyParser::Mixed::kWithChecksums);
  for (const char c : std::string("\x07\nERR003\r\n\x02X\r\x71\n\x02"
                                  "ERR003\r"))
    parser.take(static_cast<std::uint8_t>(c));
  EXPECT_TRUE(parser.quiet());
  EXPECT_EQ(parser.reply().lines, (Lines{"ERR003"}));
  EXPECT_EQ(parser.reply().unsolicited, (Lines{"X", "ERR003"}));
}

// ^N and ^X: a byte, and no acknowledge.
TEST(ReplyParser, AByteWithoutLfIsNoChecksum) {
  for (const char byte : {'\0', '\x18'}) {
    ReplyParser p({1, 1}, std::nullopt);
    EXPECT_TRUE(p.take(static_cast<std::uint8_t>(byte)));
    (void)p.quiet();
    EXPECT_EQ(p.reply().bad_checksum, "");
  }
  ReplyParser wrong({1, 1}, 'u');
  for (const char c : {'\n', 'v'}) EXPECT_TRUE(wrong.take(static_cast<std::uint8_t>(c)));
  EXPECT_TRUE(wrong.quiet());
  EXPECT_NE(wrong.reply().bad_checksum, "");
}

TEST(ReplyParser, TaggedLinesAreUnsolicited) {
  const auto p = parsed({2, 0},
                        "\x02"
                        "HELLO\r25\r\x06");
  EXPECT_EQ(p.reply().lines, (Lines{"25"}));
  EXPECT_EQ(p.reply().unsolicited, (Lines{"HELLO"}));
}

class HostLinkTest : public ::testing::Test {
 protected:
  Machine machine{"machine", {}};
  HostBus bus{machine};
  HostLink link{bus};
  FakeMachine& fake = FakeMachine::last();
};

TEST_F(HostLinkTest, ConnectSetsTheFramingWhateverItWas) {
  std::vector<std::string> heard;
  fake.controller = [&](const std::string& line) -> std::string {
    heard.push_back(line);
    if (heard.size() == 1) return "\x07";  // characters were lost: the first try fails
    return line == "I3"             ? "2\r\x06"
           : line == "I6=1I3=2I4=0" ? "\n\x55"
                                    : "\x07"
                                      "ERR003\r";
  };
  EXPECT_TRUE(link.connect(ns_to_ticks(200'000'000)));
  EXPECT_EQ(heard.back(), "I3");
  EXPECT_EQ(link.framing().i3, 2u);
  EXPECT_EQ(link.command("X").lines, (Lines{"ERR003"}));
}

TEST_F(HostLinkTest, ConnectGivesUpOnASilentController) { EXPECT_FALSE(link.connect(ns_to_ticks(3'000'000))); }

TEST_F(HostLinkTest, NoReplyIsNotComplete) { EXPECT_FALSE(link.command("VERSION", ns_to_ticks(100'000)).complete); }

TEST_F(HostLinkTest, TextBetweenRepliesIsUnsolicited) {
  link.bus();
  for (const char c : std::string("ALARM\r")) fake.to_host.push_back(static_cast<std::uint8_t>(c));
  link.poll();
  EXPECT_EQ(link.take_unsolicited(), (Lines{"ALARM"}));
  EXPECT_TRUE(link.take_unsolicited().empty());
}

TEST_F(HostLinkTest, TextWithinAReplyIsUnsolicited) {
  fake.controller = [](const std::string&) {
    return std::string(
        "\x02"
        "ALARM\r25\r\x06");
  };
  EXPECT_EQ(link.command("P1").lines, (Lines{"25"}));
  EXPECT_EQ(link.take_unsolicited(), (Lines{"ALARM"}));
  EXPECT_TRUE(link.take_unsolicited().empty());
}

// A text without CR (I62 = 1) is none of the reply, whatever comes next.
TEST_F(HostLinkTest, TextWithoutEndIsNoneOfTheReply) {
  fake.controller = [](const std::string&) { return std::string("25\r\x06"); };
  for (const char c : std::string("ALARM")) fake.to_host.push_back(static_cast<std::uint8_t>(c));
  link.poll();
  EXPECT_EQ(link.command("P1").lines, (Lines{"25"}));
  for (const char c : std::string(" 7\r")) fake.to_host.push_back(static_cast<std::uint8_t>(c));
  link.poll();
  EXPECT_EQ(link.take_unsolicited(), (Lines{"ALARM 7"}));
}

}  // namespace
}  // namespace brick
