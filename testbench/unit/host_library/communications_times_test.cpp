// How long the communications processor waits, for each thing that may not come (ethernet:4/7 to ethernet:4/10,
// ethernet:4/15, ethernet:4/16, ethernet:6/1): not less than the rule says, and little more.
#include "testbench/unit/host_library/communications_fixture.h"

namespace brick {
namespace {

class CommunicationsTimes : public CommunicationsProcessorTest {
 protected:
  CommunicationsTimes() { step_ = kMs / 4; }

  static constexpr char kAskMark = 0x0E;

  // The bus needs some of it, and the fixture looks every quarter of a millisecond.
  static constexpr Tick kSlack = 3 * kMs;

  void expect_to_take(Tick least, const std::function<Bytes()>& work, const Bytes& reply) {
    const Tick begin = bus_.now();
    EXPECT_EQ(work(), reply);
    EXPECT_GE(bus_.now() - begin, least);
    EXPECT_LE(bus_.now() - begin, least + kSlack);
  }

  // ^N is answered by a NUL, lines by `answers`.
  void answer_marks(const std::function<Bytes(const Bytes&)>& answers) {
    fake().control = [this](char c) {
      marks_ += c == kAskMark ? 1 : 0;
      return c == 0x18 ? Bytes("\x18") : c == kAskMark ? Bytes(1, '\0') : Bytes();
    };
    fake().controller = answers;
  }

  static Bytes without_acknowledge(const Bytes& line) {
    if (line == "bad")
      return "\x07"
             "ERR003\r";
    return line[0] == '=' ? "" : line + "\r";
  }

  int marks_ = 0;
};

// ------------------------------------------------------------------------------------------------------ no answer

// ethernet:4/8
TEST_F(CommunicationsTimes, ALineIsWaitedForHalfASecond) {
  fake().thinking = 490 * kMs;
  expect_to_take(
      490 * kMs, [this] { return response("ver"); }, "ver\r\x06");
  fake().thinking = 0;
  expect_to_take(
      500 * kMs, [this] { return response("silent"); }, kNul);
}

// Each character begins the wait anew.
TEST_F(CommunicationsTimes, AnAnswerThatGoesOnIsWaitedForHalfASecondFromItsLastCharacter) {
  fake().controller = [this](const Bytes&) {
    for (const int at : {400, 800, 1200}) fake().later.emplace_back(bus_.now() + at * kMs, "x");
    return Bytes();
  };
  expect_to_take(
      1700 * kMs, [this] { return response("slow"); }, "xxx");
}

// ethernet:4/8
TEST_F(CommunicationsTimes, FetchesWaitHalfASecondWhenThereIsNothing) {
  expect_to_take(
      500 * kMs, [this] { return fetch(); }, kNul);
  expect_to_take(
      500 * kMs, [this] { return ask(packet(Packet::kGetLine, "", 0, 0, 0xC0)); }, kNul);
  EXPECT_EQ(ask(packet(Packet::kSendLine, "silent")), "@");
  expect_to_take(
      500 * kMs, [this] { return fetch(); }, kNul);
}

// Each from when it is its turn, not from when it came.
TEST_F(CommunicationsTimes, FetchesThatComeTogetherWaitOneAfterTheOther) {
  for (int i = 0; i < 2; ++i) request(1, packet(Packet::kGetBuffer, "", 0, 0, 0xC0));
  run(499 * kMs);
  EXPECT_EQ(take(), Replies{});
  run(3 * kMs);
  EXPECT_EQ(take(), (Replies{{1, kNul}}));
  run(496 * kMs);
  EXPECT_EQ(take(), Replies{});
  run(6 * kMs);
  EXPECT_EQ(take(), (Replies{{1, kNul}}));
  EXPECT_FALSE(processor_->busy());
}

// Of the client's time: a hundredth of a second of the controller's when that is fifty times as slow.
TEST_F(CommunicationsTimes, FetchesOfASlowControllerWaitForHalfASecondOfTheClient) {
  const auto nothing = [this] { return fetch(); };
  processor_->set_speed(0.02);
  expect_to_take(10 * kMs, nothing, kNul);
  processor_->set_speed(0.2);
  expect_to_take(100 * kMs, nothing, kNul);
  processor_->set_speed(0.0001);
  expect_to_take(5 * kMs, nothing, kNul);
  expect_to_take(
      500 * kMs, [this] { return response("silent"); }, kNul);
  processor_->set_speed(1);
  expect_to_take(500 * kMs, nothing, kNul);
}

// ethernet:4/8, ethernet:4/10: wherever in the line, but not in a text.
TEST_F(CommunicationsTimes, ASaveIsWaitedForTenSeconds) {
  for (const char* line : {"=SAVE", "=1 save P1", "=1Save"}) {
    fake().thinking = 9900 * kMs;
    expect_to_take(
        9900 * kMs, [&] { return response(line); }, "\x06");
    fake().thinking = 10'500 * kMs;
    expect_to_take(
        10'000 * kMs, [&] { return response(line); }, kNul);
    run(2000 * kMs);
    fake().to_host.clear();
  }
  for (const char* line : {"=1 CMD\"SAVE\"", "=1 ; SAVE", "=1 SA"}) {
    fake().thinking = 700 * kMs;
    expect_to_take(
        500 * kMs, [&] { return response(line); }, kNul);
    run(1000 * kMs);
    fake().to_host.clear();
  }
}

// What is answered while the bus has no time for the port is not given up before somebody has looked.
TEST_F(CommunicationsTimes, AnAnswerThatStandsReadyIsTakenHoweverLate) {
  request(1, packet(Packet::kGetResponse, "ver"));
  for (Tick end = bus_.now() + 10 * kMs; lines_.empty() && bus_.now() < end;) processor_->run_until(bus_.now() + 10);
  ASSERT_EQ(lines_, Lines{"ver"});
  ASSERT_FALSE(fake().to_host.empty());
  bus_.wait(600 * kMs);  // of somebody else's
  run(5 * kMs);
  EXPECT_EQ(take(), (Replies{{1, "ver\r\x06"}}));
}

// To the tick, from the cycle of the last character, ^N left out: what the rule says and not a clock more.
TEST_F(CommunicationsTimes, EachWaitIsExact) {
  constexpr TimeFs kCycle = 120 * kFsPerNs, kRise = 60 * kFsPerNs, kLeft = 40 * kFsPerNs;  // of a typical host
  Tick replied = 0, quiet_since = 0;
  processor_->on_reply = [&](CommunicationsProcessor::Client, const Bytes& reply) {
    replied = bus_.now();
    replies_.emplace_back(1, reply);
    for (const auto& [seen, before, after] : fake().changes) {
      const bool is_read = !before.isa_ior_n && after.isa_ior_n, is_write = !before.isa_iow_n && after.isa_iow_n;
      if (after.isa_sa != 0x217 || !(is_read || (is_write && (before.isa_sd & 0xFF) != kAskMark))) continue;
      const TimeFs rise = (tick_to_fs(seen) - kRise) / kCycle * kCycle + kRise;
      quiet_since = fs_to_tick(rise + kLeft) - 1;
    }
  };
  const auto expect_wait = [&](std::int64_t ms, const Packet& one) {
    fake().changes.clear();
    ask(one);
    EXPECT_EQ(replied - quiet_since, ns_to_ticks(ms * 1'000'000)) << ms;
  };
  const auto line = [](const Bytes& text) { return packet(Packet::kGetResponse, text); };
  fake().control = [](char c) { return Bytes(c == kAskMark ? 1 : 0, '\0'); };  // no echo of ^X
  fake().controller = [](const Bytes& text) { return text == "bell" ? "\x07" : text == "none" ? "" : "x"; };
  expect_wait(5, line("bell"));
  for (const auto& [value, wait] : {std::pair(0u, 10), std::pair(1u, 1), std::pair(50u, 50), std::pair(500u, 500),
                                    std::pair(501u, 500), std::pair(0xFFFFu, 500)})
    expect_wait(wait, packet(Packet::kFlush, "", value));
  expect_wait(10, packet(Packet::kControlResponse, "", 0x18, 0, 0xC0));
  expect_wait(1, line("none"));  // behind the answer to ^N
  fake().control = nullptr;
  expect_wait(500, line("none"));
  expect_wait(10'000, line("none SAVE"));
  fake().changes.clear();
  run(kMs);
  const Tick begin = bus_.now();
  ask(packet(Packet::kGetBuffer, "", 0, 0, 0xC0));
  EXPECT_EQ(replied - begin, ns_to_ticks(500'000'000));
}

// However many requests wait that need no time of the controller: between two of them it has half a millisecond.
TEST_F(CommunicationsTimes, AnswersGoOnBetweenRequestsThatNeedNoTime) {
  fake().thinking = 2 * kMs;
  std::vector<std::pair<unsigned, Tick>> replied;
  processor_->on_reply = [&](CommunicationsProcessor::Client client, const Bytes&) {
    replied.emplace_back(static_cast<unsigned>(client), bus_.now());
  };
  request(1, packet(Packet::kGetResponse, "ver"));
  run();  // it has been sent
  ASSERT_EQ(lines_, Lines{"ver"});
  for (int i = 0; i < 10; ++i) request(2, packet(Packet::kReadReady, "", 0, 0, 0xC0, 2));
  run(5 * kMs);
  ASSERT_EQ(replied.size(), 11u);
  EXPECT_EQ(replied[1].second - replied[0].second, ns_to_ticks(500'000));
  EXPECT_LT(std::find_if(replied.begin(), replied.end(), [](const auto& reply) { return reply.first == 1; }),
            replied.begin() + 5)
      << "of a line that has its answer meanwhile";
}

// ------------------------------------------------------------------------------------------------- no end of an answer

// ethernet:4/7
TEST_F(CommunicationsTimes, ABellAndALineFeedEndByFiveMillisecondsOfSilence) {
  for (const char* answer : {"\x07", "\n"}) {
    fake().controller = [&](const Bytes&) { return answer; };
    expect_to_take(
        5 * kMs, [this] { return response("UUU"); }, answer);
  }
}

// ethernet:4/9: to a fetch, what a program has said so far.
TEST_F(CommunicationsTimes, ATextWithoutAnEndIsGivenAfterFiveMilliseconds) {
  EXPECT_EQ(response("=1"), "\x06");
  run(10 * kMs);
  fake().to_host.push_back('x');
  expect_to_take(
      5 * kMs, [this] { return fetch(); }, "x");
}

// 30 s: a program that sends for ever, whose client does not hold the others for longer.
TEST_F(CommunicationsTimes, AnAnswerWithoutAnEndIsGivenUpAfterHalfAMinute) {
  fake().controller = [&](const Bytes& line) {
    lines_.push_back(line);
    if (line == "ver") return Bytes("ver\r\x06");
    for (int i = 1; i <= 400; ++i) fake().later.emplace_back(bus_.now() + i * 100 * kMs, "A");
    return Bytes();
  };
  request(1, packet(Packet::kSendLine, "P1=1"));
  run(100 * kMs);
  request(2, packet(Packet::kGetResponse, "ver"));
  run(29'890 * kMs);
  EXPECT_EQ(lines_, Lines{"P1=1"});
  run(60 * kMs);
  EXPECT_EQ(lines_, (Lines{"P1=1", "ver"}));
}

// ethernet:4/15: the echo of ^X is waited for 10 ms before the next line.
TEST_F(CommunicationsTimes, WhatWasGivenUpIsClearedAwayForTenMilliseconds) {
  EXPECT_EQ(response("silent"), kNul);
  expect_to_take(
      0, [this] { return response("ver"); }, "ver\r\x06");
  EXPECT_EQ(response("I63=0"), "I63=0\r\x06") << "no echo from now on";
  EXPECT_EQ(response("silent"), kNul);
  expect_to_take(
      10 * kMs, [this] { return response("ver"); }, "ver\r\x06");
  expect_to_take(
      0, [this] { return response("ver"); }, "ver\r\x06");
}

// -------------------------------------------------------------------------------------------------- no acknowledge

// ethernet:4/16: I3 = 0.
TEST_F(CommunicationsTimes, ALineThatNothingAcknowledgesEndsWhenItHasBeenCarriedOut) {
  answer_marks(without_acknowledge);
  expect_to_take(
      5 * kMs, [this] { return response("=1"); }, kNul);
  for (int i = 0; i < 3; ++i) {
    expect_to_take(
        kMs, [this] { return response("=2"); }, kNul);
    expect_to_take(
        kMs, [this] { return response("ver"); }, "ver\r");
  }
  expect_to_take(
      3 * kMs, [this] { return response("a\r=b\rc"); }, "a\rc\r");
  expect_to_take(
      0, [this] { return response("bad"); },
      "\x07"
      "ERR003\r");
  expect_to_take(
      2 * kMs, [this] { return ask(packet(Packet::kWriteBuffer, Bytes("=1\0=2", 5))); }, Bytes(4, '\0'));
  expect_to_take(
      kMs, [this] { return ask(packet(Packet::kWriteBuffer, Bytes("=1\0bad\0=3", 9))); }, Bytes("\x02\0\x03\x80", 4));
  run(100 * kMs);
  EXPECT_EQ(ready(), Bytes("\0\0", 2)) << "a mark reaches nobody";
}

// The lines of the others wait no longer than it takes.
TEST_F(CommunicationsTimes, ALineThatNothingAcknowledgesDoesNotHoldTheOthers) {
  answer_marks(without_acknowledge);
  for (unsigned client = 1; client <= 10; ++client) request(client, packet(Packet::kGetResponse, "=1"));
  run(30 * kMs);
  EXPECT_EQ(take().size(), 10u);
}

// However long it takes: the mark comes behind.
TEST_F(CommunicationsTimes, AMarkOvertakesNoAnswer) {
  answer_marks(without_acknowledge);
  EXPECT_EQ(response("=1"), kNul);
  fake().thinking = 300 * kMs;
  expect_to_take(
      301 * kMs, [this] { return response("ver"); }, "ver\r");
}

// It is asked for once, and where an answer ends by its form, nobody waits for it: no client sees it, and the next line
// is answered its own.
TEST_F(CommunicationsTimes, AMarkBehindAnAnswerWithAnEndIsDropped) {
  answer_marks([](const Bytes& line) { return line + "\r\x06"; });
  fake().thinking = 20 * kMs;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(response("ver"), "ver\r\x06");
    EXPECT_EQ(response("cid"), "cid\r\x06");
  }
  run(100 * kMs);
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
  EXPECT_EQ(marks_, 6);
  fake().thinking = 0;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(response("ver"), "ver\r\x06");
  EXPECT_EQ(marks_, 6) << "nothing is asked that is answered at once";
  fake().thinking = 4 * kMs;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(response("ver"), "ver\r\x06");
  EXPECT_EQ(marks_, 6) << "nor within 5 ms";
}

// After I3 = 0 has ended a line that takes long is waited for as ever.
TEST_F(CommunicationsTimes, OnceAcknowledgesComeAgainTheyAreWaitedFor) {
  answer_marks(without_acknowledge);
  EXPECT_EQ(response("=1"), kNul);
  fake().controller = [](const Bytes& line) { return line + "\r\x06"; };
  fake().thinking = 2 * kMs;
  EXPECT_EQ(response("ver"), "ver\r\x06");
  const int before = marks_;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(response("ver"), "ver\r\x06");
  EXPECT_EQ(marks_, before);
}

// I4 = 1: a checksum that is NUL ends nothing, because more follows.
TEST_F(CommunicationsTimes, AChecksumOfNulIsNoMark) {
  const Bytes line("\xF3\r", 2), other = "5\r";  // F3 + 0D = 100
  answer_marks([&](const Bytes&) { return line + Bytes(1, '\0') + other + static_cast<char>('5' + '\r'); });
  EXPECT_EQ(response("P1 P2"), line + other);
  fake().thinking = 20 * kMs;  // the mark has been asked for when the checksum comes
  for (int i = 0; i < 2; ++i) EXPECT_EQ(response("P1 P2"), line + other);
  fake().thinking = 0;
  fake().controller = [&](const Bytes&) {  // what follows the checksum comes half a millisecond later
    fake().later.emplace_back(bus_.now() + 20 * kMs, line + Bytes(1, '\0'));
    fake().later.emplace_back(bus_.now() + 20 * kMs + kMs / 2, other + static_cast<char>('5' + '\r'));
    return Bytes();
  };
  EXPECT_EQ(response("P1 P2"), line + other);
}

}  // namespace
}  // namespace brick
