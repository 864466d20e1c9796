// The communications processor on a machine of pins with a scripted controller behind its host port: requests, who is
// answered what, and what happens when the controller is slow, silent or talks of itself (ethernet:3 to ethernet:7).
#include <gtest/gtest.h>

#include "testbench/host/communications_processor.h"
#include "testbench/unit/app/fake_machine.h"

namespace brick {
namespace {

using Packet = EthernetPacket;
using Bytes = std::string;
using Replies = std::vector<std::pair<unsigned, Bytes>>;

constexpr Tick kMs = ns_to_ticks(1'000'000);

class CommunicationsProcessorTest : public ::testing::Test {
 protected:
  CommunicationsProcessorTest() {
    fake().control = [](char c) {
      return c == 0x18 ? Bytes("\x18") : c == 0x02 || c == 0x07 ? Bytes("000000000800\r\x06") : "";
    };
    fake().controller = [this](const Bytes& line) { return controller(line); };
    make({});
  }

  void make(const CommunicationsProcessor::Options& options) {
    processor_ = std::make_unique<CommunicationsProcessor>(bus_, options);
    processor_->on_reply = [this](CommunicationsProcessor::Client client, const Bytes& reply) {
      replies_.emplace_back(static_cast<unsigned>(client), reply);
    };
    ASSERT_TRUE(processor_->start(100 * kMs));
    lines_.clear();
  }

  Bytes controller(const Bytes& line) {
    lines_.push_back(line);
    if (line == "I63=0") fake().control = nullptr;
    if (line == "silent") return "";
    if (line == "bad")
      return "\x07"
             "ERR003\r";
    if (line == "long") return Bytes(3000, 'x') + "\r\x06";
    if (line.empty() || line[0] == '=') return "\x06";
    return line + "\r\x06";
  }

  static FakeMachine& fake() { return FakeMachine::last(); }

  static Packet packet(unsigned request, const Bytes& data = "", unsigned value = 0, unsigned index = 0,
                       unsigned type = 0x40, unsigned length = 0) {
    return {static_cast<std::uint8_t>(type),
            static_cast<std::uint8_t>(request),
            static_cast<std::uint16_t>(value),
            static_cast<std::uint16_t>(index),
            static_cast<std::uint16_t>(data.empty() ? length : data.size()),
            data};
  }

  void request(unsigned client, const Packet& one) { processor_->request(client, one); }
  void run(Tick time = kMs) { processor_->run_until(bus_.now() + time); }

  Replies take() { return std::exchange(replies_, {}); }

  // Of client 1, within `longest`.
  Bytes ask(const Packet& one, Tick longest = 20'000 * kMs) {
    request(1, one);
    for (const Tick end = bus_.now() + longest; replies_.empty() && bus_.now() < end;) run();
    const Replies found = take();
    EXPECT_EQ(found.size(), 1u);
    return found.empty() ? "nothing" : found[0].second;
  }
  Bytes response(const Bytes& line) { return ask(packet(Packet::kGetResponse, line)); }
  Bytes fetch() { return ask(packet(Packet::kGetBuffer, "", 0, 0, 0xC0)); }
  Bytes ready() { return ask(packet(Packet::kReadReady, "", 0, 0, 0xC0, 2)); }

  Machine machine_{sc_core::sc_gen_unique_name("machine"), MachineConfig{}};
  HostBus bus_{machine_};
  std::unique_ptr<CommunicationsProcessor> processor_;
  Replies replies_;
  std::vector<Bytes> lines_;
};

const Bytes kNul(1, '\0');
using Lines = std::vector<Bytes>;

TEST_F(CommunicationsProcessorTest, GetResponseSendsALineAndGivesItsAnswer) {
  EXPECT_EQ(response("ver"), "ver\r\x06");
  EXPECT_EQ(response("bad"),
            "\x07"
            "ERR003\r");
  EXPECT_EQ(response(""), "\x06");
  EXPECT_EQ(response(Bytes("I10\r\n \0\n", 8)), "I10\r\x06") << "what clients put behind it";
  EXPECT_EQ(lines_, (Lines{"ver", "bad", "", "I10"}));
}

TEST_F(CommunicationsProcessorTest, LinesInOnePacketAreAnsweredTogether) {
  EXPECT_EQ(response("a\rb\rbad\r=c\r"),
            "a\r\x06"
            "b\r\x06\x07"
            "ERR003\r\x06");
  EXPECT_EQ(lines_, (Lines{"a", "b", "bad", "=c"}));
}

// ethernet:4/13
TEST_F(CommunicationsProcessorTest, ControlCharactersInsideALine) {
  std::string seen;
  fake().control = [&](char c) {
    seen.push_back(c);
    return c == 0x10 ? Bytes("0 0\r\x06") : Bytes();
  };
  EXPECT_EQ(response("\x01\n"), "\x06") << "^A and an empty line";
  EXPECT_EQ(response("\x0B"), "\x06");
  EXPECT_EQ(seen, "\x01\x0B");
  EXPECT_EQ(response("=1\x10"
                     "2"),
            "0 0\r\x06");
  EXPECT_EQ(fetch(), "\x06");
  EXPECT_EQ(response("junk\x18ver"), "ver\r\x06");
  EXPECT_EQ(lines_, (Lines{"", "", "=12", "ver"}));
}

TEST_F(CommunicationsProcessorTest, SendLineIsConfirmedAndItsAnswerWaits) {
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
  EXPECT_EQ(ask(packet(Packet::kSendLine, "VER")), "@");
  run(10 * kMs);
  EXPECT_EQ(ready(), Bytes("\1\0", 2));
  EXPECT_EQ(fetch(), "VER\r\x06");
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
  EXPECT_EQ(ask(packet(Packet::kSendLine, "a")), "@");
  EXPECT_EQ(ask(packet(Packet::kSendLine, "=b")), "@");
  EXPECT_EQ(ask(packet(Packet::kGetLine, "", 0, 0, 0xC0)), "a\r");
  EXPECT_EQ(ask(packet(Packet::kGetLine, "", 0, 0, 0xC0)), "\x06");
  EXPECT_EQ(fetch(), "\x06");
}

// ethernet:4/11
TEST_F(CommunicationsProcessorTest, GetResponseDropsWhatWasNotFetched) {
  EXPECT_EQ(ask(packet(Packet::kSendLine, "old")), "@");
  EXPECT_EQ(response("new"), "new\r\x06");
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
}

// ethernet:4/5
TEST_F(CommunicationsProcessorTest, LongAnswersInPiecesOf1400) {
  EXPECT_EQ(response("long"), Bytes(1400, 'x'));
  EXPECT_EQ(fetch(), Bytes(1400, 'x'));
  EXPECT_EQ(fetch(), Bytes(200, 'x') + "\r\x06");
}

// ethernet:4/8
TEST_F(CommunicationsProcessorTest, NothingIsNul) {
  const Tick begin = bus_.now();
  EXPECT_EQ(fetch(), kNul);
  EXPECT_GE(bus_.now() - begin, 500 * kMs);
  EXPECT_LE(bus_.now() - begin, 502 * kMs);
  EXPECT_EQ(response("silent"), kNul);
  EXPECT_EQ(response("ver"), "ver\r\x06");
}

// ethernet:4/15: what comes after half a second is nobody's.
TEST_F(CommunicationsProcessorTest, AnAnswerThatComesTooLateIsClearedAway) {
  fake().thinking = 800 * kMs;
  EXPECT_EQ(response("late"), kNul);
  fake().control = [](char c) {
    if (c == 0x18) fake().later.clear();
    return c == 0x18 ? Bytes("\x18") : "";
  };
  fake().thinking = 0;
  EXPECT_EQ(response("ver"), "ver\r\x06");
  run(1000 * kMs);
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
}

// ethernet:4/10
TEST_F(CommunicationsProcessorTest, SaveIsWaitedForUnlessTheInterfaceDoesNot) {
  fake().thinking = 5000 * kMs;
  EXPECT_EQ(response("=1 save"), "\x06");
  make({32768, true});
  const Tick begin = bus_.now();
  EXPECT_EQ(response("=1 SAVE"), kNul);
  EXPECT_LE(bus_.now() - begin, kMs);
  fake().thinking = 0;
  request(2, packet(Packet::kGetResponse, "=2"));
  run(4900 * kMs);
  EXPECT_EQ(take(), Replies{}) << "the controller is still busy";
  run(200 * kMs);
  EXPECT_EQ(take(), (Replies{{2, "\x06"}}));
  EXPECT_EQ(fetch(), "\x06") << "what SAVE was answered";
}

TEST_F(CommunicationsProcessorTest, AnErrorWithoutANumberEndsBySilence) {
  fake().controller = [](const Bytes&) { return "\x07"; };
  const Tick begin = bus_.now();
  EXPECT_EQ(response("UUU"), "\x07");
  EXPECT_LE(bus_.now() - begin, 10 * kMs);
}

// ethernet:4/3: the controller's checksums, the one behind a lone acknowledge too, which comes when nobody waits.
TEST_F(CommunicationsProcessorTest, ChecksumsReachNobody) {
  bool sums = false;
  fake().controller = [&](const Bytes& line) {
    sums = sums || line == "I4=1";
    unsigned text = '5' + '\r', command = 0;
    for (const unsigned char c : line) command += c;
    const Bytes behind = sums ? Bytes(1, static_cast<char>(command)) : "";
    if (line.find('=') != Bytes::npos) return "\x06" + behind;
    return "5\r" + (sums ? Bytes(1, static_cast<char>(text)) : "") + "\x06" + behind;
  };
  for (const char* line : {"P1=5", "I4=1", "P1=5", "P1=6", "I4=1", "P1=7"}) EXPECT_EQ(response(line), "\x06") << line;
  EXPECT_EQ(response("P1"), "5\r\x06");
  run(100 * kMs);
  EXPECT_EQ(ready(), Bytes("\0\0", 2));
}

// ------------------------------------------------------------------------------------------------------------ several

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

// ethernet:6/5
TEST_F(CommunicationsProcessorTest, WhatStopsThingsWaitsForNobody) {
  std::string seen;
  fake().control = [&](char c) {
    seen.push_back(c);
    return Bytes();
  };
  fake().thinking = 400 * kMs;
  request(1, packet(Packet::kGetResponse, "slow"));
  run(10 * kMs);
  request(2, packet(Packet::kSendControl, "", 0x12));  // ^R in its turn
  request(3, packet(Packet::kSendControl, "", 0x01));
  request(4, packet(Packet::kControlResponse, "", 0x0B, 0, 0xC0));
  run(10 * kMs);
  EXPECT_EQ(seen, "\x01\x0B");
  EXPECT_EQ(take(), (Replies{{3, "@"}, {4, "\x06"}}));
  run(500 * kMs);
  EXPECT_EQ(seen, "\x01\x0B\x12");
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
  request(1, packet(Packet::kSendLine, "#1J+"));
  run(kMs / 100);
  request(1, packet(Packet::kSendControl, "", 0x01));
  run(10 * kMs);
  EXPECT_EQ(order, "#1J+\x01");
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

// ------------------------------------------------------------------------------------------------------- WRITEBUFFER

// ethernet:5
TEST_F(CommunicationsProcessorTest, WriteBufferStopsAtTheFirstLineThatIsRefused) {
  const auto write = [this](const Bytes& lines) { return ask(packet(Packet::kWriteBuffer, lines)); };
  EXPECT_EQ(write(Bytes("=1\0=2\0=3\0", 9)), Bytes(4, '\0'));
  EXPECT_EQ(write(Bytes("=1\0=2", 5)), Bytes(4, '\0')) << "without the last NUL";
  lines_.clear();
  const Bytes refused("\x02\0\x03\x80", 4);
  EXPECT_EQ(write(Bytes("=1\0bad\0=3\0", 10)), refused);
  EXPECT_EQ(lines_, (Lines{"=1", "bad"}));
  EXPECT_EQ(ask(packet(Packet::kWriteError)), refused);
  EXPECT_EQ(write(Bytes("=1\0silent\0=3", 11)), Bytes("\x02\0\0\x80", 4));
  EXPECT_EQ(write("value"), Bytes(4, '\0'));
  EXPECT_EQ(ready(), Bytes("\0\0", 2)) << "answers are dropped";
}

// ------------------------------------------------------------------------------------------------- memory and the rest

// ethernet:7
TEST_F(CommunicationsProcessorTest, MemoryAtAnyOffset) {
  EXPECT_EQ(ask(packet(Packet::kSetMemory, "abcdef", 0x1141, 0, 0xC0)), "\xC0");
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0x1140, 0, 0xC0, 8)), Bytes("\0abcdef\0", 8));
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0x1142, 0, 0xC0, 3)), "bcd");
  EXPECT_EQ(ask(packet(Packet::kSetMemory, "xyz", 0xFFFE, 0)), "@");
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0xFFFD, 0, 0xC0, 5)), Bytes("\0xy\0\0", 5)) << "the end of 64 KiB";
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0, 0, 0xC0, 65535)).size(), 1400u);
  make({8192, false});
  EXPECT_EQ(ask(packet(Packet::kSetMemory, "xyz", 0x3FFF, 0)), "@");
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0x3FFE, 0, 0xC0, 4)), Bytes("\0x\0\0", 4)) << "the end of 16 KiB";
}

TEST_F(CommunicationsProcessorTest, BitsOfThirtyTwo) {
  const unsigned at = 0x200;
  const auto item = [this] { return ask(packet(Packet::kGetMemory, "", at, 0, 0xC0, 4)); };
  EXPECT_EQ(ask(packet(Packet::kSetBit, Bytes("\x01\0\0\x80", 4), at, 1, 0xC0)), "\xC0");
  EXPECT_EQ(item(), Bytes("\x01\0\0\x80", 4));
  EXPECT_EQ(ask(packet(Packet::kSetBit, Bytes("\xFE\xFF\xFF\xFF", 4), at, 0)), "@");
  EXPECT_EQ(item(), Bytes("\0\0\0\x80", 4));
  EXPECT_EQ(ask(packet(Packet::kSetBits, Bytes("\x0F\0\x10\0\x01\0\0\x80", 8), at)), "@");
  EXPECT_EQ(item(), Bytes("\x0E\0\x10\0", 4));
  EXPECT_EQ(ask(packet(Packet::kSetBits, "abc", at)), "@") << "too short: nothing";
  EXPECT_EQ(item(), Bytes("\x0E\0\x10\0", 4));
}

// The controller may write the rest of the item meanwhile.
TEST_F(CommunicationsProcessorTest, BytesInWhichNothingChangesAreNotWritten) {
  fake().changes.clear();
  EXPECT_EQ(ask(packet(Packet::kSetBit, Bytes("\x01\0\0\0", 4), 0x200, 1)), "@");
  int writes = 0;
  for (const auto& change : fake().changes) writes += !change.after.isa_memw_n && change.before.isa_memw_n ? 1 : 0;
  EXPECT_EQ(writes, 1);
}

TEST_F(CommunicationsProcessorTest, PortsAreTheSixteenBytes) {
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x0A, 0x55)), "@");
  EXPECT_EQ(fake().io[0x0A], 0x55);
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x0A, 0, 0xC0)), "\x55");
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x10, 0x55)), "@");
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x10, 0, 0xC0)), kNul);
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0, 0)), "@") << "all requests off";
  EXPECT_EQ(response("ver"), "ver\r\x06");
}

TEST_F(CommunicationsProcessorTest, AddressAndIdentity) {
  Bytes kept;
  processor_->on_address = [&](const Bytes& address) { kept = address; };
  const Bytes factory("\xC0\x06\x5E\x05", 4), other("\x0A\x01\x02\x03", 4);
  EXPECT_EQ(ask(packet(Packet::kAddress, "", 0, 0, 0xC0)), factory) << "192.6.94.5";
  EXPECT_EQ(ask(packet(Packet::kAddress, "abc")), factory) << "no address";
  EXPECT_EQ(ask(packet(Packet::kAddress, other)), other);
  EXPECT_EQ(kept, other);
  EXPECT_EQ(ask(packet(Packet::kAddress, "", 0, 0, 0xC0)), other);
  const std::size_t sizes[] = {6, 16, 16, 8};
  for (unsigned n = 0; n < 4; ++n)
    EXPECT_EQ(ask(packet(Packet::kHardwareAddress + n, "", 0, 0, 0xC0)).size(), sizes[n]);
  EXPECT_EQ(ask(packet(Packet::kDownloadFirmware, "anything", 1)), "@");
}

// ------------------------------------------------------------------------------------------------------------- unasked

// ethernet:4/14
TEST_F(CommunicationsProcessorTest, TextsOfProgramsGoToTheClientThatHasTalkedLast) {
  EXPECT_EQ(response("=1"), "\x06");
  const Bytes text = "HELLO\r";
  fake().to_host.insert(fake().to_host.end(), text.begin(), text.end());
  run(10 * kMs);
  EXPECT_EQ(ready(), Bytes("\1\0", 2));
  EXPECT_EQ(fetch(), "HELLO\r");
  request(2, packet(Packet::kReadReady));
  run();
  EXPECT_EQ(take(), (Replies{{2, Bytes(2, '\0')}}));
}

// Clients that ask for nothing cost no bus cycle.
TEST_F(CommunicationsProcessorTest, NothingMovesOnTheBusWhileNobodyAsks) {
  EXPECT_EQ(response("ver"), "ver\r\x06");
  run(10 * kMs);
  fake().changes.clear();
  run(1000 * kMs);
  EXPECT_EQ(fake().changes.size(), 0u);
}

TEST_F(CommunicationsProcessorTest, AControllerThatNeverAnswersIsFound) {
  fake().control = nullptr;
  CommunicationsProcessor other(bus_, {});
  EXPECT_FALSE(other.start(100 * kMs));
}

TEST_F(CommunicationsProcessorTest, AFirmwareThatStartsLateIsWaitedFor) {
  int asked = 0;
  fake().control = [&](char) { return ++asked < 5 ? Bytes() : Bytes("000000000800\r\x06"); };
  CommunicationsProcessor other(bus_, {});
  EXPECT_TRUE(other.start(500 * kMs));
  EXPECT_TRUE(fake().to_host.empty()) << "and its answer is read";
}

}  // namespace
}  // namespace brick
