// What a script may do to the dialogue, and the host link that follows it: every change of I3, I4 and I6, restarts in
// the middle, replies without an end.
#include <algorithm>

#include <gtest/gtest.h>

#include "testbench/host/framing_probe.h"
#include "testbench/host/host_link.h"
#include "testbench/unit/app/dialogue_controller.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

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

// Every setting answers ^G in its own form; what came before it is not taken for a part of it.
TEST(FramingProbe, ReadsEverySettingOffAnAnswer) {
  for (unsigned i3 = 0; i3 <= 3; ++i3)
    for (unsigned i4 = 0; i4 <= 1; ++i4)
      for (const std::string before : {"", "25\r", "\n25\r", "\x06", "0123456789AB\r\x06"}) {
        const std::string answer = framed({i3, i4}, "", {"000000000800"});
        const auto found = framing_answers(before + answer, before.size());
        ASSERT_EQ(found.size(), 1u) << i3 << i4;
        EXPECT_EQ(found[0].begin, before.size());
        EXPECT_EQ(found[0].end, before.size() + answer.size()) << i3 << i4;
        EXPECT_TRUE(found[0].framing == (Framing{i3, i4})) << i3 << i4;
      }
  EXPECT_TRUE(framing_answers("25\r\x06", 0).empty());
  EXPECT_TRUE(framing_answers("00000000080\r\x06", 0).empty()) << "eleven digits";
  EXPECT_TRUE(framing_answers("00000000080\r\x06", 40).empty());
}

// What follows an answer shows what it is where its own bytes do not: the sum of 000000000800 and its CR is `U`.
TEST(FramingProbe, ReadsAnAnswerAmongTexts) {
  const std::string digits = "000000000800\r", lf = "\n" + digits;
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

class FramingTest : public ::testing::Test {
 protected:
  FramingTest() {
    FakeMachine::last().records = false;
    EXPECT_TRUE(link.connect(HostLink::kBootTime));
  }

  Lines reply(const std::string& line) {
    const Reply reply = link.command(line);
    EXPECT_TRUE(reply.complete) << line;
    EXPECT_EQ(reply.bad_checksum, "") << line;
    return reply.lines;
  }

  Machine machine{"machine", {}};
  HostBus bus{machine};
  HostLink link{bus};
  DialogueController controller{FakeMachine::last()};
};

// From every setting of I3 and I4 to every other with all of I6, acknowledged by the old one or by the new one.
TEST_F(FramingTest, FollowsEveryChangeOfI3I4AndI6) {
  for (unsigned pair = 0; pair < 64; ++pair) {
    const unsigned from = pair / 8, to = pair % 8;
    SCOPED_TRACE(std::to_string(from) + " to " + std::to_string(to));
    controller.acknowledges_by_the_old = (from + to) % 2 == 0;
    controller.i3 = 2;
    controller.i4 = 0;
    ASSERT_TRUE(link.connect(HostLink::kBootTime));
    for (const unsigned n : {from, to}) {
      const std::string set = "I3=" + std::to_string(n & 3) + " I4=" + std::to_string(n >> 2);
      EXPECT_EQ(reply("P1 " + set + " I6=" + std::to_string(pair / 2 % 4)), (Lines{"25"}));
      EXPECT_TRUE(link.framing() == (Framing{n & 3, n >> 2}));
    }
    EXPECT_EQ(reply("P1 P2"), (Lines{"25", "50"}));
    EXPECT_EQ(reply("X"), Lines{});
    EXPECT_EQ(reply("P1 UUU"), (Lines{"25", pair / 2 % 2 == 1 ? "ERR003" : "ERR"}));
    EXPECT_EQ(reply("P2"), (Lines{"50"}));
  }
}

// Data lines before and behind the change have different forms.
TEST_F(FramingTest, DataOnBothSidesOfAChange) {
  EXPECT_EQ(reply("P1 I3=3 P2 I4=1 P1"), (Lines{"25", "50", "25"}));
  EXPECT_EQ(reply("P1 I3=0 I4=0 P2"), (Lines{"25", "50"}));
  EXPECT_EQ(reply("P1 I3=1 UUU"), (Lines{"25", "ERR003"}));
  EXPECT_EQ(link.framing().i3, 1u) << "what stands before an error has been done";
}

TEST_F(FramingTest, FindsOutWhenAProgramChangesI3) {
  for (const unsigned i3 : {0u, 2u, 1u, 3u, 0u}) {
    controller.before_line = [&] { controller.i3 = i3; };
    EXPECT_EQ(reply("P1"), (Lines{"25"})) << i3;
    EXPECT_EQ(reply("P2"), (Lines{"50"})) << i3;
  }
}

// 22221 CR and its checksum, $06: an acknowledge, where no checksum is expected. 3 CR adds up to $40.
TEST_F(FramingTest, FindsOutWhenAProgramChangesI4) {
  for (const unsigned i3 : {2u, 3u, 1u, 2u, 0u})
    for (const unsigned i4 : {1u, 0u, 1u, 1u, 0u, 0u}) {
      SCOPED_TRACE("I3=" + std::to_string(i3) + " I4=" + std::to_string(i4));
      controller.before_line = [&] { controller.i3 = i3; };
      EXPECT_EQ(reply("P1"), (Lines{"25"}));
      for (const char* line : {"P1", "P1 P2", "P4 P1", "P3=1 P3", "P5=1", "X", "P1 UUU"}) {
        controller.i4 = 1 - i4;
        controller.before_line = [&] { controller.i4 = i4; };
        const std::string first(line);
        EXPECT_EQ(reply(line), first == "P1"        ? (Lines{"25"})
                               : first == "P1 P2"   ? (Lines{"25", "50"})
                               : first == "P4 P1"   ? (Lines{"22221", "25"})
                               : first == "P3=1 P3" ? (Lines{"3"})
                               : first == "P1 UUU"  ? (Lines{"25", "ERR003"})
                                                    : Lines{})
            << line;
        controller.before_line = nullptr;
        EXPECT_EQ(reply("P2"), (Lines{"50"})) << "behind " << line;
        EXPECT_EQ(link.take_unsolicited(), Lines{}) << line;
      }
    }
}

// Quiet is no end of a reply that nothing ends, nor of one that a restart may end.
TEST_F(FramingTest, WaitsForTheErrorOfASlowLine) {
  FakeMachine& fake = FakeMachine::last();
  for (const Tick thinking : {0, 6, 40, 130}) {
    SCOPED_TRACE(std::to_string(thinking) + " ms");
    fake.thinking = ns_to_ticks(thinking * 1'000'000);
    EXPECT_EQ(reply("I3=0"), Lines{});
    EXPECT_EQ(reply("P1 UUU"), (Lines{"25", "ERR003"}));
    EXPECT_EQ(reply("P5=1"), Lines{});
    EXPECT_EQ(reply("P2"), (Lines{"50"}));
    EXPECT_EQ(reply("I3=2"), Lines{});
    const int restarts = controller.restarts;
    EXPECT_EQ(reply("P1 UUU $$$"), (Lines{"25", "ERR003"}));
    EXPECT_EQ(controller.restarts, restarts);
    EXPECT_EQ(reply("P1 $$$"), (Lines{"25"}));
    EXPECT_EQ(controller.restarts, restarts + 1);
    EXPECT_EQ(reply("P2"), (Lines{"50"}));
    EXPECT_EQ(link.take_unsolicited(), Lines{});
  }
}

// Each control character may be answered by itself; the answer of the line comes behind.
TEST_F(FramingTest, ControlCharactersInALineDoNotShiftTheReplies) {
  EXPECT_EQ(reply("P1\x07"), (Lines{"0123456789AB", "25"}));
  EXPECT_EQ(reply("P2"), (Lines{"50"}));
  EXPECT_EQ(reply("\x07UUU\x07"), (Lines{"0123456789AB", "0123456789AB", "ERR003"}));
  EXPECT_EQ(reply("P2"), (Lines{"50"}));
  EXPECT_EQ(link.take_unsolicited(), Lines{});
}

// The same while a program sends for ever; its texts stand among the data, whole.
class SendingTest : public FramingTest {
 protected:
  static constexpr Tick kOften = ns_to_ticks(1'000'000);

  void send(const std::string& text) {
    fake.sends = [this, text] { return controller.data(text); };
    fake.sends_every = kOften;
    sent = text;
  }
  Lines data(const std::string& line) {
    Lines lines = reply(line);
    lines.erase(std::remove(lines.begin(), lines.end(), sent), lines.end());
    return lines;
  }

  FakeMachine& fake = FakeMachine::last();
  std::string sent;
};

TEST_F(SendingTest, FollowsEveryChangeOfI3I4AndI6) {
  send("TEXT");
  for (unsigned pair = 0; pair < 64; ++pair) {
    const unsigned from = pair / 8, to = pair % 8;
    SCOPED_TRACE(std::to_string(from) + " to " + std::to_string(to));
    controller.acknowledges_by_the_old = false;
    EXPECT_EQ(data("I3=2 I4=0"), Lines{});
    controller.acknowledges_by_the_old = (from + to) % 2 == 0;
    for (const unsigned n : {from, to}) {
      const std::string set = "I3=" + std::to_string(n & 3) + " I4=" + std::to_string(n >> 2);
      EXPECT_EQ(data("P1 " + set + " I6=" + std::to_string(pair / 2 % 4)), (Lines{"25"}));
      EXPECT_TRUE(link.framing() == (Framing{n & 3, n >> 2}));
    }
    EXPECT_EQ(data("P1 P2"), (Lines{"25", "50"}));
    EXPECT_EQ(data("P1 UUU"), (Lines{"25", pair / 2 % 2 == 1 ? "ERR003" : "ERR"}));
    EXPECT_EQ(data("P2"), (Lines{"50"}));
  }
}

TEST_F(SendingTest, AnErrorTakesNothingFromATextWithoutChecksums) {
  send("TEXT");
  EXPECT_EQ(data("P1 UUU I3=0"), (Lines{"25", "ERR003"}));
  EXPECT_EQ(data("I4=1"), Lines{});
  EXPECT_EQ(data("I4=0 P1 UUU"), (Lines{"25", "ERR003"}));
}

// 123456789012 is data in the form of the answer.
TEST_F(SendingTest, KeepsDataThatLookLikeTheAnswer) {
  send("TEXT");
  for (const unsigned i3 : {2u, 0u, 1u, 3u, 0u, 2u})
    EXPECT_EQ(data("P6 P1 I3=" + std::to_string(i3) + " P6"), (Lines{"123456789012", "25", "123456789012"})) << i3;
  fake.thinking = ns_to_ticks(130'000'000);
  EXPECT_EQ(data("I3=0 P6 UUU"), (Lines{"123456789012", "ERR003"}));
}

TEST_F(SendingTest, FindsOutWhenAProgramChangesI3AndI4) {
  send("TEXT");
  for (const unsigned n : {0u, 2u, 6u, 1u, 5u, 3u, 4u, 7u, 0u}) {
    controller.before_line = [&] { controller.i3 = n & 3, controller.i4 = n >> 2; };
    EXPECT_EQ(data("P1"), (Lines{"25"})) << n;
    EXPECT_EQ(data("P2"), (Lines{"50"})) << n;
  }
}

// An acknowledge is none of a text; without one nobody can tell.
TEST_F(SendingTest, SaysWhatCannotBeTold) {
  send("123456789012");
  EXPECT_EQ(data("P1 I3=3"), (Lines{"25"}));
  EXPECT_EQ(data("P1 I3=2"), (Lines{"25"}));
  const Reply reply = link.command("P1 I3=0");
  EXPECT_FALSE(reply.complete);
  EXPECT_EQ(std::count(reply.lines.begin(), reply.lines.end(), "25"), 1) << "the reply is not lost";
  EXPECT_NE(reply.doubt.find("a program sends lines of 12 hexadecimal digits"), std::string::npos) << reply.doubt;
  fake.sends = [this] {
    return controller.data(
        "\x02"
        "123456789012");
  };
  EXPECT_EQ(data("P1 I3=1"), (Lines{"25"})) << "tagged (I64)";
  EXPECT_EQ(data("P1 I3=0"), (Lines{"25"}));
}

TEST_F(SendingTest, RestartsAndConnects) {
  send("TEXT");
  EXPECT_EQ(data("P1 $$$"), (Lines{"25"}));
  EXPECT_TRUE(link.framing() == (Framing{2, 0}));
  EXPECT_EQ(data("P1"), (Lines{"25"}));
  fake.sends_every = 0;  // as fast as it is read
  EXPECT_TRUE(link.connect(HostLink::kBootTime));
  EXPECT_EQ(data("P1"), (Lines{"25"}));
}

TEST_F(SendingTest, ControlCharactersHaveAnEnd) {
  send("TEXT");
  EXPECT_LT(link.control(0x01).raw.size(), 1000u);
  EXPECT_EQ(data("P1"), (Lines{"25"}));
}

// Every text comes once, whole and in order, however many are asked for the end of a reply.
TEST_F(SendingTest, NoTextIsLostOrTorn) {
  int sent_so_far = 0, next = 0;
  fake.sends = [&] { return controller.data("TEXT" + std::to_string(sent_so_far++)); };
  fake.sends_every = kOften;
  const auto expect_texts = [&](const Lines& lines) {
    for (const std::string& line : lines) {
      if (line == "25" || line.rfind("ERR", 0) == 0) continue;
      EXPECT_EQ(line, "TEXT" + std::to_string(next++));
    }
  };
  for (const char* line : {"P1", "I3=3", "P1 UUU", "I3=0", "P1", "P1 UUU", "I3=1", "P1", "I4=1 I6=0", "P1", "P1 UUU",
                           "I3=2", "P1", "P1 UUU", "P1"}) {
    SCOPED_TRACE(line);
    link.poll();
    const Lines before = link.take_unsolicited(), lines = reply(line), tagged = link.take_unsolicited();
    expect_texts(before);
    expect_texts(tagged);
    expect_texts(lines);
  }
  EXPECT_GT(next, 300);
}

TEST_F(FramingTest, EndsWhereTheControllerIsNeverQuiet) {
  FakeMachine& fake = FakeMachine::last();
  fake.sends = [] { return "X"; };
  link.poll();
  EXPECT_LT(link.control(0x10).raw.size(), HostLink::kLongestReply + 2);
  EXPECT_EQ(link.take_unsolicited(), Lines{}) << "there is no end of the line";
}

TEST_F(FramingTest, ConnectsAgainAfterARestartAnywhereInALine) {
  for (const char* line : {"$$$", "$$$***", "P1 $$$ P2", "I3=0 $$$", "I4=1 $$$***"}) {
    const int restarts = controller.restarts;
    EXPECT_EQ(reply(line), line[0] == 'P' ? (Lines{"25"}) : Lines{}) << line;
    EXPECT_EQ(controller.restarts, restarts + 1);
    EXPECT_TRUE(link.framing() == (Framing{2, 0})) << line;
    EXPECT_EQ(reply("P1"), (Lines{"25"})) << line;
  }
  controller.i3 = 2;
  EXPECT_EQ(reply("UUU $$$"), (Lines{"ERR003"})) << "never reached";
  EXPECT_EQ(reply("P1"), (Lines{"25"}));
}

TEST_F(FramingTest, GivesUpOnAReplyWithoutEnd) {
  FakeMachine& fake = FakeMachine::last();
  fake.controller = [](const std::string&) { return std::string(HostLink::kLongestReply + 100, 'X'); };
  const Reply reply = link.command("LIST");
  EXPECT_FALSE(reply.complete);
  EXPECT_EQ(reply.raw.size(), HostLink::kLongestReply);
}

}  // namespace
}  // namespace brick
