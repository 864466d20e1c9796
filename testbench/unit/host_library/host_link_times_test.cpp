// How long the host link waits for each thing that may not come, and what it does when it does not (host-bus:3.1,
// host-bus:8, firmware:6): not less than it says, and little more.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "testbench/host/host_link.h"
#include "testbench/unit/host_library/dialogue_controller.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

class HostLinkTimes : public ::testing::Test {
 protected:
  static constexpr Tick kLinkMs = ns_to_ticks(1'000'000);

  HostLinkTimes() {
    fake.records = false;
    EXPECT_TRUE(link.connect(HostLink::kBootTime));
  }

  // `most`: beside the wait itself what is asked behind it, and a pause of polling.
  template <class Work>
  void expect_to_take(std::int64_t least, std::int64_t most, const Work& work) {
    const Tick begin = bus.now();
    work();
    EXPECT_GE(bus.now() - begin, ns_to_ticks(least * 1'000'000));
    EXPECT_LE(bus.now() - begin, ns_to_ticks(most * 1'000'000));
  }
  void trip_in(Tick ms) {
    BoardOutputs pins = machine.outputs();
    pins.set(pin::kWdo, 1);
    fake.planned.emplace_back(bus.now() + ms * kLinkMs, pins);
  }

  Machine machine{sc_core::sc_gen_unique_name("machine"), {}};
  FakeMachine& fake = FakeMachine::last();
  HostBus bus{machine};
  HostLink link{bus};
  DialogueController controller{fake};
};

// From one character to the next.
TEST_F(HostLinkTimes, AReplyMayTakeLongerThanThePauseBetweenItsCharacters) {
  const auto say = [this](Tick ms, const std::string& text) {
    fake.later.emplace_back(bus.now() + ms * kLinkMs, text);
  };
  fake.controller = [&](const std::string&) {
    say(40, "2");
    say(80, "5");
    say(120, "\r\x06");
    return std::string();
  };
  expect_to_take(120, 122, [&] { EXPECT_EQ(link.command("P1", 50 * kLinkMs).lines, Lines{"25"}); });
  fake.controller = [&](const std::string&) {
    say(40, "2");
    say(200, "5\r\x06");
    return std::string();
  };
  expect_to_take(90, 115, [&] { EXPECT_FALSE(link.command("P1", 50 * kLinkMs).complete); });
}

TEST_F(HostLinkTimes, AnAnswerIsWaitedForASecond) {
  fake.thinking = 990 * kLinkMs;
  EXPECT_EQ(link.command("P1").lines, Lines{"25"});
  fake.thinking = 1030 * kLinkMs;
  expect_to_take(1000, 1025, [&] { EXPECT_FALSE(link.command("P1").complete); });
}

// Unless it is told otherwise.
TEST_F(HostLinkTimes, ASaveIsWaitedForTenSeconds) {
  fake.thinking = 9900 * kLinkMs;
  EXPECT_EQ(link.command("P1 SAVE").lines, Lines{"25"});
  expect_to_take(50, 75, [&] { EXPECT_FALSE(link.command("P1 SAVE", 50 * kLinkMs).complete); });
}

// The port takes no character: a line, a character of control.
TEST_F(HostLinkTimes, APortThatTakesNothingIsWaitedForUntilTheTimeOut) {
  fake.takes = false;
  expect_to_take(20, 22, [&] { EXPECT_FALSE(link.send("P1", 20 * kLinkMs)); });
  expect_to_take(20, 22, [&] { EXPECT_FALSE(link.command("P1", 20 * kLinkMs).complete); });
  expect_to_take(1000, 1002, [&] {
    const Reply reply = link.control(0x07);
    EXPECT_FALSE(reply.complete);
    EXPECT_TRUE(reply.lines.empty());
  });
  EXPECT_EQ(fake.line, "");
  fake.takes = true;
  EXPECT_EQ(link.command("P1").lines, Lines{"25"});
}

// What comes meanwhile is read, so that the controller can go on.
TEST_F(HostLinkTimes, AnAnswerNeverWaitsBehindACharacterToBeSent) {
  fake.takes = false;
  for (int i = 0; i < 20; ++i) fake.later.emplace_back(bus.now() + i * kLinkMs, "TEXT\r");
  EXPECT_FALSE(link.send("P1", 30 * kLinkMs));
  EXPECT_TRUE(fake.to_host.empty());
  fake.takes = true;
  EXPECT_EQ(link.command("P1").lines, Lines{"25"});
  EXPECT_EQ(link.take_unsolicited(), Lines(20, "TEXT"));
}

TEST_F(HostLinkTimes, ConnectingEndsWithItsTime) {
  fake.controller = nullptr;
  fake.control = nullptr;
  expect_to_take(30, 32, [&] { EXPECT_FALSE(link.connect(30 * kLinkMs)); });
  fake.takes = false;
  expect_to_take(30, 32, [&] { EXPECT_FALSE(link.connect(30 * kLinkMs)); });
}

// A controller that starts late, whose first lines are lost.
TEST_F(HostLinkTimes, ConnectingWaitsForAFirmwareThatStarts) {
  const auto answer = fake.controller;
  int lines = 0;
  fake.controller = [&](const std::string& line) { return ++lines < 3 ? std::string() : answer(line); };
  EXPECT_TRUE(link.connect(3000 * kLinkMs));
  EXPECT_TRUE(link.framing() == (Framing{2, 0}));
  EXPECT_EQ(link.command("P1").lines, Lines{"25"});
}

// What answers the first line, in whatever form, is over when nothing has come for 2 ms.
TEST_F(HostLinkTimes, ConnectingWaitsUntilTheFirstAnswerIsOver) {
  int begun = 0;
  fake.controller = [&](const std::string& line) {
    if (line == "I3") return std::string("2\r\x06");
    ++begun;
    fake.later.emplace_back(bus.now(), "\nTE");
    fake.later.emplace_back(bus.now() + 3 * kLinkMs / 2, "XT\r\x06");
    return std::string();
  };
  EXPECT_TRUE(link.connect(100 * kLinkMs));
  EXPECT_EQ(begun, 1);
}

// Whoever does not take I3=2 is asked again, not believed.
TEST_F(HostLinkTimes, ConnectingLooksWhetherI3IsTwo) {
  for (const char* answer : {"1\r\x06", "\x06", "22\r\x06", "2\r",
                             "\x07"
                             "ERR003\r"}) {
    fake.controller = [&](const std::string& line) { return std::string(line == "I3" ? answer : "\x06"); };
    EXPECT_FALSE(link.connect(100 * kLinkMs)) << answer;
  }
  for (const char* answer : {"2\r\x06", "I3=2\r\x06", "TEXT\r2\r\x06"}) {
    fake.controller = [&](const std::string& line) { return std::string(line == "I3" ? answer : "\x06"); };
    EXPECT_TRUE(link.connect(100 * kLinkMs)) << answer;
    EXPECT_EQ(link.take_unsolicited(), Lines{}) << "what came before is nobody's";
  }
}

// Nobody will answer until a reset: no wait goes on, of whatever kind.
TEST_F(HostLinkTimes, ATrippedWatchdogEndsEachWait) {
  fake.controller = [](const std::string&) { return std::string(); };
  fake.control = [](char) { return std::string(); };
  trip_in(2);
  expect_to_take(2, 4, [&] { EXPECT_FALSE(link.command("P1").complete); });
  expect_to_take(0, 2, [&] { EXPECT_FALSE(link.command("I3=1").complete); });
  expect_to_take(0, 2, [&] { EXPECT_FALSE(link.command("P1 SAVE").complete); });
  expect_to_take(0, 5, [&] { link.control(0x07); });
  expect_to_take(0, 5, [&] { EXPECT_FALSE(link.connect(1000 * kLinkMs)); });
  fake.takes = false;
  expect_to_take(0, 2, [&] { EXPECT_FALSE(link.send("P1")); });
}

// I3 = 1 and 0 end by 5 ms of silence, and I6 = 0: what follows sooner belongs to it.
TEST_F(HostLinkTimes, SilenceOfFiveMillisecondsEndsAnErrorWithoutANumber) {
  fake.controller = [&](const std::string&) {
    fake.later.emplace_back(bus.now(), "\x07");
    fake.later.emplace_back(bus.now() + 4 * kLinkMs, "\r");
    fake.later.emplace_back(bus.now() + 8 * kLinkMs, "ERR");
    fake.later.emplace_back(bus.now() + 12 * kLinkMs, "005\r");
    return std::string();
  };
  EXPECT_EQ(link.command("UUU").lines, Lines{"ERR005"});
  fake.controller = [](const std::string&) { return std::string("\x07"); };
  expect_to_take(5, 7, [&] { EXPECT_EQ(link.command("UUU").lines, Lines{"ERR"}); });
}

}  // namespace
}  // namespace brick
