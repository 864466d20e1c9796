// Framing of replies by I3, I4 and I6, and the host link on a scripted controller. Exchanges from firmware:6.2,
// firmware:6.3, firmware:13.
#include <gtest/gtest.h>

#include "testbench/host/host_link.h"
#include "testbench/unit/app/fake_machine.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

ReplyParser parsed(Framing framing, const std::string& bytes) {
  ReplyParser parser(framing);
  for (const char c : bytes) {
    EXPECT_FALSE(parser.complete()) << "complete too early in " << bytes;
    parser.take(static_cast<std::uint8_t>(c));
  }
  return parser;
}

TEST(ReplyParser, DataUpToTheAcknowledge) {
  const auto p = parsed({2, 0, 1}, "25\r50\r75\r\x06");
  EXPECT_TRUE(p.complete());
  EXPECT_EQ(p.reply().lines, (Lines{"25", "50", "75"}));
  EXPECT_FALSE(p.reply().error);
}

TEST(ReplyParser, LineFeedsOfI3Equal3AreNoData) {
  const auto p = parsed({3, 0, 1}, "\n25\r\n50\r\x06");
  EXPECT_TRUE(p.complete());
  EXPECT_EQ(p.reply().lines, (Lines{"25", "50"}));
}

TEST(ReplyParser, ErrorWithNumberEndsAtItsCr) {
  const auto p = parsed({2, 0, 1},
                        "\x07"
                        "ERR003\r");
  EXPECT_TRUE(p.complete());
  EXPECT_TRUE(p.reply().error);
  EXPECT_EQ(p.reply().lines, (Lines{"ERR003"}));
}

TEST(ReplyParser, ErrorFormsOfI6) {
  EXPECT_TRUE(parsed({2, 0, 0}, "\x07").complete());
  EXPECT_EQ(parsed({2, 0, 0}, "\x07").reply().lines, (Lines{"ERR"}));
  const auto p = parsed({3, 0, 3},
                        "\x07\r\n"
                        "ERR005\r");
  EXPECT_TRUE(p.complete());
  EXPECT_EQ(p.reply().lines, (Lines{"ERR005"}));
}

TEST(ReplyParser, DataBeforeTheErrorIsKept) {
  EXPECT_EQ(parsed({2, 0, 1},
                   "7007\r\x07"
                   "ERR003\r")
                .reply()
                .lines,
            (Lines{"7007", "ERR003"}));
}

TEST(ReplyParser, QuietEndsI3Equal0And1Only) {
  auto none = parsed({0, 0, 1}, "");
  EXPECT_TRUE(none.quiet());
  auto data = parsed({0, 0, 1}, "25\r");
  EXPECT_TRUE(data.quiet());
  EXPECT_EQ(data.reply().lines, (Lines{"25"}));
  auto open = parsed({1, 0, 1}, "\n25\r");
  EXPECT_FALSE(open.quiet()) << "the last LF is missing";
  open.take('\n');
  EXPECT_TRUE(open.quiet());
  auto silent = parsed({2, 0, 1}, "25\r");
  EXPECT_FALSE(silent.quiet());
}

TEST(ReplyParser, ChecksumsMayLookLikeAnything) {
  const auto p = parsed({2, 1, 1}, std::string("25\r\x07\x06\x0D", 6));  // line checksum BELL, command checksum CR
  EXPECT_TRUE(p.complete());
  EXPECT_FALSE(p.reply().error);
  EXPECT_EQ(p.reply().lines, (Lines{"25"}));
}

TEST(ReplyParser, TaggedLinesAreUnsolicited) {
  const auto p = parsed({2, 0, 1},
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

TEST_F(HostLinkTest, FollowsAssignmentsToI3) {
  link.command("I3=1 I4=0", ns_to_ticks(20'000'000));
  for (const std::string acknowledge : {"\n", "\x06", ""}) {  // by the old setting, by ACK, by the new one
    fake.controller = [&](const std::string& line) -> std::string {
      return line == "P1" ? "25\r" : line == "I3=0" ? acknowledge : "\n";
    };
    EXPECT_TRUE(link.command("I3=0").complete);
    EXPECT_EQ(link.framing().i3, 0u);
    EXPECT_EQ(link.command("P1").lines, (Lines{"25"}));
    link.command("I3=1");
  }
  EXPECT_TRUE(link.command("I13=2 P3=0").complete);
  EXPECT_EQ(link.framing().i3, 1u) << "I13 is not I3";
}
TEST_F(HostLinkTest, ReducesWhatIsAssignedToI3AsTheControllerDoes) {
  const auto i3_after = [&](const std::string& assignment) {
    link.command("I3=2", ns_to_ticks(20'000'000));
    fake.controller = [](const std::string&) -> std::string { return "\x06"; };
    EXPECT_TRUE(link.command(assignment).complete) << assignment;
    return link.framing().i3;
  };
  EXPECT_EQ(i3_after("I3=5"), 1u);
  EXPECT_EQ(i3_after("I3=$13"), 3u);
  EXPECT_EQ(i3_after("I3=*"), 1u) << "factory default";
  EXPECT_EQ(i3_after("I3=16"), 0u);
}

TEST_F(HostLinkTest, ChecksumThatBeginsWithItsLineIsNoText) {
  link.command("I3=2 I4=0", ns_to_ticks(20'000'000));
  fake.controller = [](const std::string& line) -> std::string { return line == "I4=1" ? "\x06X" : "7\r\x44\x06\x7F"; };
  EXPECT_TRUE(link.command("I4=1").complete);
  EXPECT_EQ(link.command("P1").lines, (Lines{"7"}));
  EXPECT_TRUE(link.take_unsolicited().empty());
}

TEST_F(HostLinkTest, TextBetweenRepliesIsUnsolicited) {
  link.bus();
  for (const char c : std::string("ALARM\r")) fake.to_host.push_back(static_cast<std::uint8_t>(c));
  link.poll();
  EXPECT_EQ(link.take_unsolicited(), (Lines{"ALARM"}));
  EXPECT_TRUE(link.take_unsolicited().empty());
}

}  // namespace
}  // namespace brick
