// What a script may do to the dialogue, and the host link that follows it: every change of I3, I4 and I6, restarts in
// the middle, replies without an end.
#include <algorithm>

#include <gtest/gtest.h>

#include "testbench/host/host_link.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/host_library/dialogue_controller.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

constexpr const char* kMotorWords = DialogueController::kMotorWords;

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

// A text is looked at with its checksum: one that comes later is none of the next.
TEST_F(FramingTest, ATextIsOneWithTheChecksumBehindIt) {
  reply("I4=1");
  std::deque<std::uint8_t>& port = FakeMachine::last().to_host;
  for (const std::string text : {"TEXT", "NEXT"}) {
    const std::string line = controller.data(text);
    ASSERT_GE(line.back(), ' ') << "seen if it is taken for text";
    port.insert(port.end(), line.begin(), line.end() - 1);
    link.poll();
    EXPECT_EQ(link.take_unsolicited(), Lines{});
    port.push_back(static_cast<std::uint8_t>(line.back()));
    link.poll();
    EXPECT_EQ(link.take_unsolicited(), Lines{text});
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
    for (const unsigned i4 : {1u, 1u, 0u, 0u}) {
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

// What `?`, `??` and `???` are answered with, and then a pause: only the answer to ^B ends the reply.
TEST_F(FramingTest, APauseBehindStatusDigitsIsNoEnd) {
  FakeMachine& fake = FakeMachine::last();
  fake.thinking = ns_to_ticks(50'000'000);
  for (const unsigned i3 : {0u, 1u, 2u, 3u, 0u})
    for (const std::string digits : {"A80020020000000000", "000000000800"}) {
      SCOPED_TRACE("I3=" + std::to_string(i3));
      const std::string change = "I3=" + std::to_string(i3);
      for (const std::string& line : Lines{change + " P1", "P1"}) {
        controller.before_line = [&] {
          const std::string first = controller.data(digits);
          fake.to_host.insert(fake.to_host.end(), first.begin(), first.end());
        };
        EXPECT_EQ(reply(line), (Lines{digits, "25"})) << line;
        controller.before_line = nullptr;
        EXPECT_EQ(reply("P2"), (Lines{"50"})) << line;
      }
      EXPECT_EQ(link.take_unsolicited(), Lines{});
    }
}

// A control character is answered in the background, behind whatever PLCs run there.
TEST_F(FramingTest, ControlCharactersAreAnsweredLate) {
  FakeMachine& fake = FakeMachine::last();
  const auto answer = fake.control;
  fake.control = [&](char c) {
    const Tick now = bus.now(), before = fake.later.empty() ? now : std::max(now, fake.later.back().first);
    fake.later.emplace_back(before + ns_to_ticks(12'000'000), answer(c));
    return std::string();
  };
  for (const unsigned i3 : {0u, 1u, 2u, 3u}) {
    EXPECT_EQ(reply("I3=" + std::to_string(i3)), Lines{});
    EXPECT_EQ(link.control(0x07).lines, (Lines{"0123456789AB"})) << i3;
    EXPECT_EQ(link.control(0x02).lines, (Lines{kMotorWords})) << i3;
    EXPECT_EQ(link.control(0x01).lines, Lines{}) << i3;
    EXPECT_EQ(reply("P1"), (Lines{"25"})) << i3;
  }
  EXPECT_EQ(link.take_unsolicited(), Lines{});
}

// The checksum of ^B is the tag's code, and so is that of a line whose characters add up to $202.
TEST_F(FramingTest, QuestionsAmongChecksumsAreAnsweredHoweverOftenTheyAreAsked) {
  FakeMachine::last().thinking = ns_to_ticks(250'000'000);
  for (const unsigned i3 : {2u, 3u, 1u, 0u}) {
    EXPECT_EQ(reply("P1 I4=1 I3=" + std::to_string(i3)), (Lines{"25"}));
    EXPECT_EQ(reply("P2 I4=1"), (Lines{"50"}));
  }
  EXPECT_EQ(reply("I3=2"), Lines{});
  ASSERT_EQ(checksum("I4=1 RRS"), 0x02);
  EXPECT_EQ(reply("I4=1 RRS"), Lines{});
}

// A second question is asked a moment before the line is worked off, and answered in the next background pass.
TEST_F(FramingTest, AnswersToAllQuestionsAreWaitedFor) {
  FakeMachine& fake = FakeMachine::last();
  EXPECT_EQ(reply("I3=0"), Lines{});
  const auto answer = fake.control;
  int asked = 0;
  fake.control = [&](char c) {
    const Tick begin = fake.later.empty() ? bus.now() : fake.later.back().first;
    fake.later.emplace_back(begin + ns_to_ticks(++asked == 1 ? 1'500'000 : 20'000'000), answer(c));
    return std::string();
  };
  fake.thinking = ns_to_ticks(99'000'000);
  EXPECT_EQ(reply("P5=1"), Lines{});
  EXPECT_EQ(asked, 2);
  fake.control = answer;
  fake.thinking = 0;
  EXPECT_EQ(reply("P2"), (Lines{"50"}));
  EXPECT_EQ(link.take_unsolicited(), Lines{});
}

// Each control character may be answered by itself; the answer of the line comes behind.
TEST_F(FramingTest, ControlCharactersInALineDoNotShiftTheReplies) {
  EXPECT_EQ(reply("P1\x07"), (Lines{"0123456789AB", "25"}));
  EXPECT_EQ(reply("P2"), (Lines{"50"}));
  FakeMachine::last().thinking = ns_to_ticks(40'000'000);
  EXPECT_EQ(reply("P1\x02"), (Lines{kMotorWords, "25"})) << "the host's own question";
  EXPECT_EQ(reply("P2\x07"), (Lines{"0123456789AB", "50"}));
  EXPECT_EQ(reply("\x02\x02P1 I3=0"), (Lines{kMotorWords, kMotorWords, "25"}));
  EXPECT_EQ(reply("\x02P1 I3=2"), (Lines{kMotorWords, "25"}));
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

TEST_F(SendingTest, KeepsDataThatLookLikeTheAnswer) {
  send("TEXT");
  for (const unsigned i3 : {2u, 0u, 1u, 3u, 0u, 2u})
    EXPECT_EQ(data("P6 P1 I3=" + std::to_string(i3) + " P6"), (Lines{kMotorWords, "25", kMotorWords})) << i3;
  fake.thinking = ns_to_ticks(130'000'000);
  EXPECT_EQ(data("I3=0 P6 UUU"), (Lines{kMotorWords, "ERR003"}));
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
  send(kMotorWords);
  EXPECT_EQ(data("P1 I3=3"), (Lines{"25"}));
  EXPECT_EQ(data("P1 I3=2"), (Lines{"25"}));
  const Reply reply = link.command("P1 I3=0");
  EXPECT_FALSE(reply.complete);
  EXPECT_EQ(std::count(reply.lines.begin(), reply.lines.end(), "25"), 1) << "the reply is not lost";
  EXPECT_NE(reply.doubt.find("a program sends lines of eight words"), std::string::npos) << reply.doubt;
  fake.sends = [this] { return controller.data(std::string("\x02") + kMotorWords); };
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

// Where other lines have checksums the errors of programs have none: nothing is taken from the text behind one.
TEST_F(FramingTest, TextsBehindErrorsOfProgramsAreWhole) {
  EXPECT_EQ(reply("I4=1"), Lines{});
  FakeMachine& fake = FakeMachine::last();
  for (const std::string& text : {std::string("\x02"
                                              "ERR003\r"),
                                  controller.data("\x02"
                                                  "AB"),
                                  std::string("\x02\r"),
                                  controller.data("\x02"
                                                  "ERR"),
                                  controller.data("CD")})
    fake.to_host.insert(fake.to_host.end(), text.begin(), text.end());
  link.poll();
  EXPECT_EQ(link.take_unsolicited(), (Lines{"ERR003", "AB", "", "ERR", "CD"}));
  EXPECT_EQ(reply("P1"), (Lines{"25"}));
}

// Behind the acknowledge of a line without data, and in front of what a program sends then.
TEST_F(FramingTest, ALateChecksumIsNoText) {
  controller.before_line = [&] { controller.i4 = 1; };
  EXPECT_EQ(reply("X"), Lines{});
  controller.before_line = nullptr;
  const std::string text = controller.data("TEXT");
  FakeMachine& fake = FakeMachine::last();
  fake.to_host.insert(fake.to_host.end(), text.begin(), text.end());
  link.poll();
  EXPECT_EQ(link.take_unsolicited(), Lines{"TEXT"});
  EXPECT_EQ(reply("P1"), (Lines{"25"}));
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
  EXPECT_EQ(reply("I3=1"), Lines{});
  EXPECT_EQ(reply("I4=1 P1 $$$"), (Lines{"25"})) << "a checksum on the way, none before and behind";
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
