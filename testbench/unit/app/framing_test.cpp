// What a script may do to the dialogue, and the host link that follows it: every change of I3, I4 and I6, restarts in
// the middle, replies without an end.
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
        const auto found = framing_answer(before + framed({i3, i4}, "", {"000000000800"}), before.size());
        ASSERT_TRUE(found) << i3 << i4;
        EXPECT_EQ(found->begin, before.size());
        EXPECT_TRUE(found->framing == (Framing{i3, i4})) << i3 << i4;
      }
  EXPECT_FALSE(framing_answer("25\r\x06", 0));
  EXPECT_FALSE(framing_answer("00000000080\r\x06", 0)) << "eleven digits";
  EXPECT_FALSE(framing_answer("00000000080\r\x06", 40));
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

TEST_F(FramingTest, EndsWhereTheControllerIsNeverQuiet) {
  FakeMachine& fake = FakeMachine::last();
  fake.never_quiet = true;
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
