// Requests of one client of the communications processor, and what happens when the controller is slow, silent or talks
// of itself (ethernet:3 to ethernet:7).
#include "testbench/unit/host_library/communications_fixture.h"

namespace brick {
namespace {

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
  std::string seen, before;
  fake().control = [&](char c) {
    seen.push_back(c);
    if (c == 0x12) before = fake().line;
    return c == 0x10 ? Bytes("0 0\r\x06") : Bytes();
  };
  EXPECT_EQ(response("\x01\n"), "\x06") << "^A and an empty line";
  EXPECT_EQ(response("\x0B"), "\x06");
  EXPECT_EQ(seen, "\x01\x0B");
  EXPECT_EQ(response("=1\x12"
                     "2"),
            "\x06");
  EXPECT_EQ(before, "=1") << "what has no answer goes where it stands";
  EXPECT_EQ(response("=1\x10"
                     "2"),
            "0 0\r\x06");
  EXPECT_EQ(fetch(), "\x06");
  EXPECT_EQ(response("junk\x18ver"), "ver\r\x06");
  EXPECT_EQ(lines_, (Lines{"", "", "=12", "=12", "ver"}));
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

// The rest of a late answer stands in front of the echo.
TEST_F(CommunicationsProcessorTest, WhatComesBeforeTheEchoIsClearedAwayToo) {
  fake().thinking = 800 * kMs;
  EXPECT_EQ(response("late"), kNul);
  fake().thinking = 0;
  fake().control = [](char c) {
    if (c == 0x18) fake().later.clear();
    return c == 0x18 ? Bytes("te\r\x06\x18") : "";
  };
  EXPECT_EQ(response("ver"), "ver\r\x06");
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

// firmware:5.9/5: three bytes a word, any of them may be an acknowledge, CR or NUL, and an acknowledge. By itself or in
// another's line, the next line is answered with its own.
TEST_F(CommunicationsProcessorTest, GatherSourcesAreBinaryAndTheirOwn) {
  const Bytes words("\x06\r\0\x05\x07\xff", 6);
  for (const Bytes& sources : {words, Bytes()}) {
    fake().control = [&](char c) { return c == 0x05 ? sources + "\x06" : c == 0x18 ? Bytes("\x18") : Bytes(); };
    EXPECT_EQ(ask(packet(Packet::kSendControl, "", 0x05)), "\x40");
    Bytes fetched;
    while (fetched.size() <= sources.size()) fetched += fetch();
    EXPECT_EQ(fetched, sources + "\x06") << "in pieces, which end at what may be an acknowledge";
    EXPECT_EQ(ask(packet(Packet::kControlResponse, "", 0x05, 0, 0xC0)), "\x06");
    EXPECT_EQ(response("P1"), "P1\r\x06");
    request(2, packet(Packet::kSendLine, "\xe0\x05"));
    run();
    EXPECT_EQ(take(), (Replies{{2, "\x40"}}));
    EXPECT_EQ(response("P2"), "P2\r\x06");
  }
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
  for (const bool pauses : {false, true}) {
    make({});
    sums = false;
    for (const char* line : {"P1=5", "I4=1", "P1=5", "P1=6", "I4=1", "P1=7"}) {
      EXPECT_EQ(response(line), "\x06") << line;
      if (!pauses) continue;
      run(10 * kMs);
      EXPECT_EQ(ready(), Bytes("\0\0", 2)) << line;
    }
    EXPECT_EQ(response("P1"), "5\r\x06");
    run(100 * kMs);
    EXPECT_EQ(ready(), Bytes("\0\0", 2));
  }
}

// A line that turns checksums on has one behind its acknowledge. An empty line has been sent by then.
TEST_F(CommunicationsProcessorTest, AChecksumBehindTheNextLineIsNoneOfItsAnswer) {
  fake().controller = [this](const Bytes& line) {
    if (line.empty()) return Bytes("\x06\0", 2);
    fake().later.emplace_back(bus_.now(), "\x06");
    fake().later.emplace_back(bus_.now() + kMs / 10, "\x04");
    return Bytes();
  };
  const Bytes line = "=sumr";
  ASSERT_EQ(command_checksum(line), 0x04);
  request(1, packet(Packet::kGetResponse, line));
  request(2, packet(Packet::kGetResponse, ""));
  run(20 * kMs);
  EXPECT_EQ(take(), (Replies{{1, "\x06"}, {2, "\x06"}}));
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

// NUL alone ends a line there; what may end one elsewhere is a blank.
TEST_F(CommunicationsProcessorTest, WriteBufferKeepsItsLinesWhole) {
  EXPECT_EQ(ask(packet(Packet::kWriteBuffer, Bytes("=1\r2\0=3\r\0=4 \r\n\0 ", 16))), Bytes(4, '\0'));
  EXPECT_EQ(lines_, (Lines{"=1 2", "=3 ", "=4"}));
}

// Line number in two bytes, low one first; error number; 80. Lines that cost one byte and their NUL: 700 fit.
TEST_F(CommunicationsProcessorTest, WriteBufferTellsEachFieldOfItsAnswer) {
  Bytes error = "001";
  fake().controller = [&](const Bytes& line) {
    if (line == "silent") return Bytes();
    return line == "bad" ? "\x07"
                           "ERR" +
                               error + "\r"
                         : Bytes("\x06");
  };
  const auto write_behind = [this](std::size_t good, const Bytes& last) {
    Bytes lines;
    for (std::size_t n = 0; n < good; ++n) lines += Bytes("=\0", 2);
    return ask(packet(Packet::kWriteBuffer, lines + last));
  };
  const std::pair<std::size_t, Bytes> numbers[] = {{0, Bytes("\x01\0", 2)},     {1, Bytes("\x02\0", 2)},
                                                   {254, Bytes("\xFF\0", 2)},   {255, Bytes("\0\x01", 2)},
                                                   {256, Bytes("\x01\x01", 2)}, {700, Bytes("\xBD\x02", 2)}};
  for (const auto& [good, number] : numbers) {
    EXPECT_EQ(write_behind(good, "bad"), number + Bytes("\x01\x80", 2)) << good;
    EXPECT_EQ(ask(packet(Packet::kWriteError)), number + Bytes("\x01\x80", 2)) << good;
    EXPECT_EQ(write_behind(good, "silent"), number + Bytes("\0\x80", 2)) << good;
  }
  for (const auto& [text, code] : {std::pair("003", '\x03'), std::pair("018", '\x12'), std::pair("255", '\xFF')}) {
    error = text;
    EXPECT_EQ(write_behind(2, "bad"), Bytes("\x03\0", 2) + code + '\x80') << text;
  }
  EXPECT_EQ(write_behind(700, "="), Bytes(4, '\0'));
  EXPECT_EQ(ask(packet(Packet::kWriteError)), Bytes(4, '\0')) << "of the last one";
}

// ethernet:6/3: reports are ^B ^C ^F ^G ^P ^V; each other character is sent as well, and only acknowledged.
TEST_F(CommunicationsProcessorTest, ControlResponseGivesTheAnswerOfEachReport) {
  Bytes seen;
  const Bytes reports = "\x02\x03\x06\x07\x10\x16", answered = "\x05\x09\x0E\x19";
  const auto answer = [](char c) { return "answer " + std::to_string(int{c}) + "\r"; };
  fake().control = [&](char c) {
    seen.push_back(c);
    if (c == 0x18) return Bytes("\x18");
    return (reports + answered).find(c) != Bytes::npos ? answer(c) + "\x06" : Bytes();
  };
  for (char c = 1; c < 0x20; ++c) {
    if (c == '\r') continue;  // ends a line
    for (const unsigned place : {0u, 8u}) {
      seen.clear();
      const Bytes reply = ask(packet(Packet::kControlResponse, "", static_cast<unsigned>(c) << place, 0, 0xC0));
      EXPECT_EQ(reply, reports.find(c) != Bytes::npos ? answer(c) : "\x06") << int{c};
      run(10 * kMs);
      EXPECT_EQ(seen, Bytes(1, c)) << int{c};
      EXPECT_EQ(ready(), Bytes("\0\0", 2)) << "nothing is left of " << int{c};
    }
  }
}

// 1400 bytes, as of any reply; what stands around its lines is no text.
TEST_F(CommunicationsProcessorTest, AReportIsAsLongAsAReplyMayBe) {
  Bytes text;
  fake().control = [&](char c) { return c == 0x10 ? text + "\r\x06" : Bytes(); };
  for (const std::size_t length : {1u, 1398u, 1399u, 1400u, 1401u, 3000u}) {
    text = "\n" + Bytes(length, 'x');
    const Bytes reply = ask(packet(Packet::kControlResponse, "", 0x10, 0, 0xC0));
    EXPECT_EQ(reply, (Bytes(length, 'x') + "\r").substr(0, 1400)) << length;
    EXPECT_EQ(ready(), Bytes("\0\0", 2));
  }
  text.clear();
  EXPECT_EQ(ask(packet(Packet::kControlResponse, "", 0x10, 0, 0xC0)), "\r");
  fake().control = [](char c) { return c == 0x10 ? "0 0" : c == 0x18 ? "\x18" : ""; };
  EXPECT_EQ(ask(packet(Packet::kControlResponse, "", 0x10, 0, 0xC0)), "0 0\r") << "whatever it ends with";
  fake().control = nullptr;
  EXPECT_EQ(ask(packet(Packet::kControlResponse, "", 0x10, 0, 0xC0)), kNul) << "no answer at all";
}

// Nobody waits for silence, which takes 5 ms.
TEST_F(CommunicationsProcessorTest, ReportsEndWithTheirAcknowledge) {
  for (const unsigned c : {0x02u, 0x07u}) {
    const Tick begin = bus_.now();
    EXPECT_EQ(ask(packet(Packet::kControlResponse, "", c, 0, 0xC0)), "000000000800\r");
    EXPECT_LE(bus_.now() - begin, 2 * kMs);
  }
}

// ------------------------------------------------------------------------------------------------- memory and the rest

// ethernet:7
TEST_F(CommunicationsProcessorTest, MemoryAtAnyOffset) {
  EXPECT_EQ(ask(packet(Packet::kSetMemory, "abcdef", 0x1141, 0, 0xC0)), "\xC0");
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0x1140, 0, 0xC0, 8)), Bytes("\0abcdef\0", 8));
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0x1142, 0, 0xC0, 3)), "bcd");
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0x1141, 0, 0xC0, 3)), "abc");
  EXPECT_EQ(ask(packet(Packet::kSetMemory, "xyz", 0xFFFE, 0)), "@");
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0xFFFD, 0, 0xC0, 5)), Bytes("\0xy\0\0", 5)) << "the end of 64 KiB";
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0, 0, 0xC0, 65535)).size(), 1400u);
  make({8192, false});
  EXPECT_EQ(ask(packet(Packet::kSetMemory, "xyz", 0x3FFF, 0)), "@");
  EXPECT_EQ(ask(packet(Packet::kGetMemory, "", 0x3FFE, 0, 0xC0, 4)), Bytes("\0x\0\0", 4)) << "the end of 16 KiB";
  for (const unsigned beyond : {0x4000u, 0x10000u}) EXPECT_EQ(fake().memory[beyond], 0) << "lost, " << beyond;
}

// Whoever reads it on the other side finds no word half written: a, bc, de, f.
TEST_F(CommunicationsProcessorTest, WordsAreWrittenInOneCycle) {
  fake().changes.clear();
  EXPECT_EQ(ask(packet(Packet::kSetMemory, "abcdef", 0x1141, 0)), "@");
  EXPECT_EQ(memory_writes(), 4);
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
  EXPECT_EQ(memory_writes(), 1);
}

TEST_F(CommunicationsProcessorTest, PortsAreTheSixteenBytes) {
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x0A, 0x55)), "@");
  EXPECT_EQ(fake().io[0x0A], 0x55);
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x0A, 0, 0xC0)), "\x55");
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x10, 0x55)), "@");
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0x10, 0, 0xC0)), kNul);
  EXPECT_EQ(ask(packet(Packet::kPort, "", 0, 0)), "@") << "all requests off";
  EXPECT_EQ(fake().io[0] & 1, 1) << "RREQ is on again at once: programs send unasked";
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
  request(2, packet(Packet::kGetResponse, "=2"));
  run(10 * kMs);
  EXPECT_EQ(take(), (Replies{{2, "\x06"}}));
  fake().to_host.insert(fake().to_host.end(), text.begin(), text.end());
  run(10 * kMs);
  EXPECT_EQ(ready(), Bytes("\0\0", 2)) << "client 2 has talked last";
  request(2, packet(Packet::kGetBuffer));
  run(10 * kMs);
  EXPECT_EQ(take(), (Replies{{2, "HELLO\r"}}));
}

// Nobody will answer until the next start.
TEST_F(CommunicationsProcessorTest, ATrippedWatchdogIsSeenAtOnce) {
  EXPECT_EQ(response("ver"), "ver\r\x06");
  fake().thinking = 400 * kMs;
  request(1, packet(Packet::kGetResponse, "slow"));
  run(10 * kMs);
  BoardOutputs tripped = machine_.outputs();
  tripped.set(pin::kWdo, 1);
  fake().planned.emplace_back(bus_.now() + 100, tripped);
  run();
  run();
  EXPECT_EQ(take(), (Replies{{1, kNul}}));
  const Tick begin = bus_.now();
  EXPECT_EQ(response("ver"), kNul);
  EXPECT_EQ(ask(packet(Packet::kFlush)), "@");
  EXPECT_LE(bus_.now() - begin, 3 * kMs);
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

// Asked each 20 ms, until a watchdog trips.
TEST_F(CommunicationsProcessorTest, AStartEndsWithItsTime) {
  int asked = 0;
  fake().control = [&](char c) {
    asked += c == 0x07 ? 1 : 0;
    return Bytes();
  };
  CommunicationsProcessor other(bus_, {});
  Tick begin = bus_.now();
  EXPECT_FALSE(other.start(90 * kMs));
  EXPECT_GE(bus_.now() - begin, 90 * kMs);
  EXPECT_LE(bus_.now() - begin, 101 * kMs);
  EXPECT_EQ(asked, 5);
  EXPECT_FALSE(other.busy());
  BoardOutputs tripped = machine_.outputs();
  tripped.set(pin::kWdo, 1);
  fake().planned.emplace_back(bus_.now() + kMs, tripped);
  begin = bus_.now();
  EXPECT_FALSE(other.start(500 * kMs));
  EXPECT_LE(bus_.now() - begin, 21 * kMs);
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
