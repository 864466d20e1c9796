// Several clients of the communications processor, and requests that come while an answer is under way (ethernet:1,
// ethernet:6).
#include "testbench/unit/host_library/communications_fixture.h"

namespace brick {
namespace {

// ethernet:1/5
TEST_F(CommunicationsProcessorTest, EachClientIsAnsweredItsOwn) {
  fake().thinking = 3 * kMs;
  for (unsigned client = 1; client <= 20; ++client)
    request(client, packet(Packet::kGetResponse, std::to_string(client)));
  run(200 * kMs);
  const Replies found = take();
  ASSERT_EQ(found.size(), 20u);
  for (const auto& [client, reply] : found) EXPECT_EQ(reply, std::to_string(client) + "\r\x06");
}

// How a job ended is told although others wait to begin theirs. Whoever comes next may have a number before or behind.
TEST_F(CommunicationsProcessorTest, EachClientIsToldHowItsOwnJobEnded) {
  const Bytes refused("\x02\0\x03\x80", 4), report = "000000000800\r";
  for (const unsigned other : {1u, 3u}) {
    request(2, packet(Packet::kWriteBuffer, Bytes("=1\0bad", 6)));
    request(2, packet(Packet::kControlResponse, "", 0x02, 0, 0xC0));
    for (int i = 0; i < 3; ++i) request(other, packet(Packet::kGetResponse, "=1"));
    run(200 * kMs);
    Lines found;
    for (const auto& [client, reply] : take())
      if (client == 2) found.push_back(reply);
    EXPECT_EQ(found, (Lines{refused, report})) << "beside client " << other;
  }
}

TEST_F(CommunicationsProcessorTest, OneThatFloodsDoesNotStarveTheOthers) {
  for (int i = 0; i < 100; ++i) request(1, packet(Packet::kGetResponse, "flood"));
  request(2, packet(Packet::kGetResponse, "two"));
  request(3, packet(Packet::kReadReady));
  run(200 * kMs);
  const Replies found = take();
  ASSERT_EQ(found.size(), 102u);
  for (unsigned client : {2u, 3u}) {
    const auto at = std::find_if(found.begin(), found.end(), [&](const auto& r) { return r.first == client; });
    EXPECT_LE(at - found.begin(), 3) << "client " << client;
  }
}

TEST_F(CommunicationsProcessorTest, OthersMemoryAndQueriesDoNotWaitForALine) {
  fake().thinking = 400 * kMs;
  request(1, packet(Packet::kGetResponse, "slow"));
  run(10 * kMs);
  request(2, packet(Packet::kGetMemory, "", 0x1140, 0, 0xC0, 4));
  request(2, packet(Packet::kReadReady));
  run(10 * kMs);
  EXPECT_EQ(take(), (Replies{{2, Bytes(4, '\0')}, {2, Bytes(2, '\0')}}));
  run(400 * kMs);
  EXPECT_EQ(take(), (Replies{{1, "slow\r\x06"}}));
}

TEST_F(CommunicationsProcessorTest, OneThatWaitsIsNotOvertakenByWhoComesLater) {
  fake().thinking = 20 * kMs;
  request(1, packet(Packet::kSendLine, "=a"));
  run(5 * kMs);
  ASSERT_EQ(take(), (Replies{{1, "@"}}));
  request(2, packet(Packet::kGetResponse, "=b"));
  run(5 * kMs);
  request(3, packet(Packet::kGetResponse, "=c"));
  run(100 * kMs);
  EXPECT_EQ(lines_, (Lines{"=a", "=b", "=c"}));
}

// Memory takes time of the bus: 16 requests of 64 clients take longer than an answer may pause.
TEST_F(CommunicationsProcessorTest, RequestsForMemoryWithoutAnEndDoNotStarveLines) {
  const auto ask_for_memory = [&](unsigned client) {
    request(client, packet(Packet::kGetMemory, "", 0, 0, 0xC0, 1400));
  };
  Lines answers;
  unsigned floods = 0;
  processor_->on_reply = [&](CommunicationsProcessor::Client client, const Bytes& reply) {
    if (client == 1) answers.push_back(reply);
    if (client == 1 || ++floods > 20'000) return;
    ask_for_memory(static_cast<unsigned>(client));  // and again
  };
  for (unsigned client = 2; client < 66; ++client)
    for (int i = 0; i < 16; ++i) ask_for_memory(client);
  request(1, packet(Packet::kGetResponse, "ver"));
  request(1, packet(Packet::kGetResponse, "bad"));
  for (int i = 0; i < 1000 && answers.size() < 2; ++i) run();
  EXPECT_EQ(answers, (Lines{"ver\r\x06",
                            "\x07"
                            "ERR003\r"}));
  EXPECT_LT(floods, 20'000u);
}

// What a client that has gone was to be told is nobody else's.
TEST_F(CommunicationsProcessorTest, AClientThatGoesLeavesNothingBehind) {
  fake().thinking = 100 * kMs;
  request(1, packet(Packet::kGetResponse, "gone"));
  request(1, packet(Packet::kGetResponse, "never sent"));
  run(10 * kMs);
  processor_->close(1);
  request(2, packet(Packet::kGetResponse, "here"));
  run(300 * kMs);
  EXPECT_EQ(take(), (Replies{{2, "here\r\x06"}}));
  EXPECT_EQ(lines_, (Lines{"gone", "here"}));
  EXPECT_FALSE(processor_->busy());
}

// I3 = 0, and a program that never stops sending: nobody knows where an answer ends, and its client has gone.
TEST_F(CommunicationsProcessorTest, AnAnswerWithoutAnEndIsGivenUp) {
  fake().controller = [&](const Bytes& line) {
    lines_.push_back(line);
    for (int i = 1; i <= 400; ++i) fake().later.emplace_back(bus_.now() + i * 100 * kMs, "A");
    return Bytes();
  };
  request(1, packet(Packet::kSendLine, "P1=1"));
  run(1000 * kMs);
  processor_->close(1);
  request(2, packet(Packet::kGetResponse, "ver"));
  run(28'000 * kMs);
  EXPECT_EQ(lines_, (Lines{"P1=1"}));
  run(2000 * kMs);
  EXPECT_EQ(lines_, (Lines{"P1=1", "ver"}));
}

// -------------------------------------------------------------------------------------------------- flush and control

// ethernet:6/1
TEST_F(CommunicationsProcessorTest, FlushWaitsForTheEcho) {
  EXPECT_EQ(ask(packet(Packet::kSendLine, "old")), "@");
  const Tick begin = bus_.now();
  EXPECT_EQ(ask(packet(Packet::kFlush)), "@");
  EXPECT_LE(bus_.now() - begin, 2 * kMs);
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
  EXPECT_EQ(response("I63=0"), "I63=0\r\x06") << "no echo from now on";
  for (const auto& [value, wait] : {std::pair(0u, 10), std::pair(50u, 50), std::pair(0xF401u, 500)}) {
    const Tick from = bus_.now();
    EXPECT_EQ(ask(packet(Packet::kFlush, "", value)), "@");
    EXPECT_GE(bus_.now() - from, wait * kMs);
    EXPECT_LE(bus_.now() - from, (wait + 2) * kMs);
  }
}

// Another client has talked last.
TEST_F(CommunicationsProcessorTest, FlushOfAnotherClientWaitsAsWell) {
  EXPECT_EQ(response("I63=0"), "I63=0\r\x06") << "no echo from now on";
  request(2, packet(Packet::kFlush, "", 50));
  run(49 * kMs);
  EXPECT_EQ(take(), Replies{});
  run(3 * kMs);
  EXPECT_EQ(take(), (Replies{{2, "@"}}));
}

// ^X as a control character is a flush whose answer is that of any other character.
TEST_F(CommunicationsProcessorTest, ClearingByItsCharacterWaitsForTheEcho) {
  const auto clear = [this] { return ask(packet(Packet::kControlResponse, "", 0x18, 0, 0xC0)); };
  Tick begin = bus_.now();
  EXPECT_EQ(clear(), "\x06");
  EXPECT_LE(bus_.now() - begin, 2 * kMs);
  EXPECT_EQ(response("I63=0"), "I63=0\r\x06") << "no echo from now on";
  begin = bus_.now();
  EXPECT_EQ(clear(), "\x06");
  EXPECT_GE(bus_.now() - begin, 10 * kMs);
  EXPECT_LE(bus_.now() - begin, 12 * kMs);
}

// ethernet:6/2
TEST_F(CommunicationsProcessorTest, FlushEndsTheClientsOwnAnswerAndNoOthers) {
  fake().thinking = 100 * kMs;
  request(1, packet(Packet::kGetResponse, "mine"));
  request(2, packet(Packet::kGetResponse, "yours"));
  run(10 * kMs);
  request(2, packet(Packet::kFlush));
  request(3, packet(Packet::kFlush));
  run(50 * kMs);
  EXPECT_EQ(take(), Replies{});
  run(400 * kMs);
  EXPECT_EQ(take().front(), (std::pair<unsigned, Bytes>{1, "mine\r\x06"}));
  request(1, packet(Packet::kGetResponse, "again"));
  run(10 * kMs);
  take();
  request(1, packet(Packet::kFlush));
  run(20 * kMs);
  EXPECT_EQ(take(), (Replies{{1, kNul}, {1, "@"}}));
}

// The client's answer is one that was not under way yet when the flush came; what is no flush waits for it.
TEST_F(CommunicationsProcessorTest, FlushEndsWhatBeginsBeforeIt) {
  fake().control = [](char c) {
    if (c == 0x18) fake().later.clear();
    return Bytes(c == 0x18 ? 1 : 0, c);
  };
  fake().thinking = 100 * kMs;
  request(2, packet(Packet::kGetResponse, "slow"));
  run(10 * kMs);
  request(1, packet(Packet::kSendLine, "old"));
  request(1, packet(Packet::kFlush));
  run(120 * kMs);
  EXPECT_EQ(take(), (Replies{{2, "slow\r\x06"}, {1, "@"}, {1, "@"}}));
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
  request(1, packet(Packet::kSendLine, "a"));
  request(1, packet(Packet::kSendLine, "b"));
  run(300 * kMs);
  EXPECT_EQ(take(), (Replies{{1, "@"}, {1, "@"}}));
  EXPECT_EQ(fetch(), "a\r\x06");
  EXPECT_EQ(fetch(), "b\r\x06");
}

// ethernet:6/5
TEST_F(CommunicationsProcessorTest, WhatStopsThingsWaitsForNobody) {
  std::string seen;
  fake().control = [&](char c) {
    if (c != 0x0E) seen.push_back(c);  // ^N asks whether the line has been read
    return Bytes();
  };
  fake().thinking = 400 * kMs;
  request(1, packet(Packet::kGetResponse, "slow"));
  run(10 * kMs);
  request(2, packet(Packet::kSendControl, "", 0x12));  // ^R in its turn
  request(3, packet(Packet::kSendControl, "", 0x01));
  request(4, packet(Packet::kControlResponse, "", 0x0B, 0, 0xC0));
  for (const unsigned c : {0x04u, 0x0Fu, 0x11u}) request(5, packet(Packet::kSendControl, "", c));
  run(10 * kMs);
  EXPECT_EQ(seen, "\x01\x0B\x04\x0F\x11");
  EXPECT_EQ(take(), (Replies{{3, "@"}, {4, "\x06"}, {5, "@"}, {5, "@"}, {5, "@"}}));
  run(500 * kMs);
  EXPECT_EQ(seen, "\x01\x0B\x04\x0F\x11\x12");
}

TEST_F(CommunicationsProcessorTest, AStopDoesNotComeBeforeTheLineOfTheSameClient) {
  std::string order;
  fake().control = [&](char c) {
    order.push_back(c);
    return Bytes();
  };
  fake().controller = [&](const Bytes& line) {
    order += line;
    return "\x06";
  };
  const Bytes line = "#1J+" + Bytes(200, ' ') + "P1=1";
  request(1, packet(Packet::kGetResponse, line));
  run(kMs / 100);
  EXPECT_EQ(order, "") << "it is still on its way";
  request(1, packet(Packet::kSendControl, "", 0x01));
  run(10 * kMs);
  EXPECT_EQ(order, line + "\x01");
}

// ethernet:6/5: in the text of whatever request, too. The answers of the lines come in their turn.
TEST_F(CommunicationsProcessorTest, WhatStopsThingsInTheTextOfARequestWaitsForNobody) {
  std::string seen;
  fake().control = [&](char c) {
    if (c != 0x0E) seen.push_back(c);
    return Bytes();
  };
  fake().thinking = 400 * kMs;
  request(1, packet(Packet::kGetResponse, "slow"));
  run(10 * kMs);
  request(2, packet(Packet::kGetResponse, "\x01\n"));
  request(3, packet(Packet::kSendLine, "\x0B"));
  request(4, packet(Packet::kWriteBuffer, Bytes("\x04=1\0=2\x0F", 7)));
  request(5, packet(Packet::kSendLine, "=3\x11\x18=4"));
  request(6, packet(Packet::kSendLine, "=5\x12"));  // ^R in its turn
  run(10 * kMs);
  EXPECT_EQ(seen, "\x01\x0B\x04\x0F\x11");
  EXPECT_EQ(take(), Replies{});
  EXPECT_EQ(lines_, Lines{"slow"});
  run(3000 * kMs);
  EXPECT_EQ(seen, "\x01\x0B\x04\x0F\x11\x0F\x12") << "what follows a line in its packet comes there as well";
  Replies replies = take();
  std::sort(replies.begin(), replies.end());
  EXPECT_EQ(replies, (Replies{{1, "slow\r\x06"}, {2, "\x06"}, {3, "@"}, {4, Bytes(4, '\0')}, {5, "@"}, {6, "@"}}));
  EXPECT_EQ(lines_, (Lines{"slow", "", "", "=1", "=2", "=4", "=5"}));
}

// A client that does not wait for its replies: no line that it has sent before a stop moves anything behind it.
TEST_F(CommunicationsProcessorTest, AStopBehindLinesOfTheSameClientThatWaitComesBehindThemAsWell) {
  const std::pair<Packet, Bytes> stops[] = {{packet(Packet::kSendControl, "", 0x01), "@"},
                                            {packet(Packet::kControlResponse, "", 0x01, 0, 0xC0), "\x06"},
                                            {packet(Packet::kGetResponse, "\x01\n"), "\x06"}};
  std::string order;
  fake().control = [&](char c) {
    if (c == 0x01) order += "^A ";
    return Bytes();
  };
  fake().controller = [&](const Bytes& line) {
    if (!line.empty()) order += line + ' ';
    return "\x06";
  };
  for (const auto& [stop, reply] : stops) {
    for (const bool together : {false, true}) {  // the lines: in a packet for each, or the first under way in one
      order.clear();
      fake().thinking = 100 * kMs;
      request(together ? 1 : 2, packet(Packet::kGetResponse, together ? "slow\rJ+" : "slow"));
      run(10 * kMs);
      if (!together) request(1, packet(Packet::kGetResponse, "J+"));
      request(1, stop);
      run(1000 * kMs);
      EXPECT_EQ(order, "slow ^A J+ ^A ");
      EXPECT_EQ(take().back(), (std::pair<unsigned, Bytes>{1, reply}));
      order.clear();
      request(2, packet(Packet::kGetResponse, "slow"));
      run(10 * kMs);
      for (int i = 0; i < 2; ++i) {
        request(1, stop);
        run(10 * kMs);
      }
      run(1000 * kMs);
      EXPECT_EQ(order, "slow ^A ^A ") << "asked for twice";
      take();
    }
  }
}

// ethernet:6/3, ethernet:6/4
TEST_F(CommunicationsProcessorTest, ControlCharactersAndTheirAnswers) {
  const auto ask_control = [this](unsigned value) { return ask(packet(Packet::kControlResponse, "", value, 0, 0xC0)); };
  EXPECT_EQ(ask_control(0x07), "000000000800\r");
  EXPECT_EQ(ask_control(0x0700), "000000000800\r") << "in the high byte";
  EXPECT_EQ(ask_control(0x12), "\x06");
  EXPECT_EQ(ask_control('A'), "\x06") << "not sent";
  EXPECT_EQ(ask(packet(Packet::kSendControl, "", 0x07)), "@");
  EXPECT_EQ(fetch(), "000000000800\r\x06");
  EXPECT_EQ(response("ver"), "ver\r\x06");
}

}  // namespace
}  // namespace brick
