// SEND, COMMAND and DISPLAY of programs (firmware:6.7, firmware:7.2), as bytes at the port.
#include <algorithm>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/run/display.h"
}

namespace {

using platform::background;
using platform::host;
using platform::sent;
using Lines = std::vector<std::string>;

// A host that does not read: what it would have read waits in the port.
void nobody_reads() {}

// A host that reads `a_millisecond` characters in each, from the `reads_from`th on that a reply has waited, and sends a
// line in the fifth.
struct SlowHost {
  unsigned reads_from, a_millisecond, waits, waits_of_line;
  std::string got;
};
SlowHost slow_host{};

void host_is_slow() {
  std::uint8_t c = 0;
  if (++slow_host.waits == 5)
    for (const char* sent = "P5=7\r"; *sent != '\0'; ++sent) host_port_character(static_cast<std::uint8_t>(*sent));
  if (p_variable_read(5) == 0.0 && slow_host.waits > 5) ++slow_host.waits_of_line;
  if (slow_host.waits < slow_host.reads_from) return;
  for (unsigned i = 0; i < slow_host.a_millisecond && host_port_next_output(&c); ++i)
    slow_host.got += static_cast<char>(c);
}

class ProgramTexts : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I3=2 I6=1 I5=2"), "");
  }
  void TearDown() override { fake_hal_on_wait(nullptr); }

  static void load(int number, const Lines& lines) {
    ASSERT_EQ(host("OPEN PLC " + std::to_string(number) + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
  }
  // PLC 1 executes the statements once; what the host reads meanwhile.
  static std::string once(Lines lines) {
    lines.push_back("DISABLE PLC 1");
    load(1, lines);
    EXPECT_EQ(host("ENABLE PLC 1"), "");
    background(2 + static_cast<unsigned>(lines.size()));
    return sent();
  }
};

TEST_F(ProgramTexts, SentTextIsALineWithoutHandshake) {
  EXPECT_EQ(once({"SEND\"Hello, host;\"", "SENDP\"2\"", "SEND\"\""}), "Hello, host;\r2\r\r");
  EXPECT_EQ(once({"SENDS\"serial\"", "SENDR\"DPRAM\"", "SENDA\"auxiliary\"", "P1=7"}), "")
      << "ports that are not there";
  EXPECT_EQ(host("P1"), "7");
}

TEST_F(ProgramTexts, FormOfTheLineFollowsI3I4I62AndI64) {
  ASSERT_EQ(host("I3=3"), "");
  EXPECT_EQ(once({"SEND\"A\""}), "\nA\r");
  ASSERT_EQ(host("I3=2 I64=1"), "");
  EXPECT_EQ(once({"SEND\"A\""}),
            "\x02"
            "A\r");
  ASSERT_EQ(host("I62=1"), "");
  EXPECT_EQ(once({"SEND\"A\""}),
            "\x02"
            "A\r")
      << "a marked line has its end";
  ASSERT_EQ(host("I64=0"), "");
  EXPECT_EQ(once({"SEND\"A\"", "SEND\"B\"", "SEND^M"}), "AB\r");
  ASSERT_EQ(host("I62=0 I4=1"), "");
  EXPECT_EQ(once({"SEND\"AB\""}), std::string("AB\r") + static_cast<char>('A' + 'B' + '\r'));
}

// firmware:6.7/1: the tag is of what programs send; the host's own answers and errors have none.
TEST_F(ProgramTexts, TheHostsOwnAnswersHaveNoTag) {
  const auto bytes = [](const std::string& line) {
    for (const char c : line + "\r") host_port_character(static_cast<std::uint8_t>(c));
    background(2);
    return sent();
  };
  ASSERT_EQ(bytes("I64=1"), "\x06");
  for (const char* before : {"P1=1", "SEND\"A\"", "CMDP\"P1\"", "CMDP\"UUU\"", "CMD\"P1\"", "SENDR\"A\""}) {
    once({before});
    EXPECT_EQ(bytes("P1=5 P1"), "5\r\x06") << before;
    EXPECT_EQ(bytes("UUU"), "\aERR003\r") << before;
  }
}

TEST_F(ProgramTexts, LetterSendsItsControlCharacterAlone) {
  ASSERT_EQ(host("I64=1"), "");
  EXPECT_EQ(once({"SEND^G", "SEND^A", "SEND^@"}), std::string("\x07\x01\x00", 3));
}

TEST_F(ProgramTexts, LongestTextArrives) {
  std::string text;
  for (int i = 0; i < 248; ++i) text += static_cast<char>('#' + i % 90);
  EXPECT_EQ(once({"SEND\"" + text + "\""}), text + "\r");
}

TEST_F(ProgramTexts, CommandsAreExecutedWithoutAReply) {
  EXPECT_EQ(once({"CMD\"p1=3 P2=P1*2\"", "COMMAND\"P1\"", "CMDS\"P1\"", "CMDA\"P1\"", "CMDR\"P1\""}), "");
  EXPECT_EQ(host("P1 P2"), "3|6");
}

TEST_F(ProgramTexts, ReplyComesWhereTheStatementNamesThePort) {
  ASSERT_EQ(host("P1=3 P2=4"), "");
  EXPECT_EQ(once({"CMDP\"P1P2\""}), "3\r4\r") << "no handshake";
  EXPECT_EQ(once({"CMDP\"size\""}), host("SIZE") + "\r") << "each letter is made a capital";
  ASSERT_EQ(host("I64=1"), "");
  EXPECT_EQ(once({"CMDP\"P1P2\""}),
            "\x02"
            "3\r\x02"
            "4\r");
  ASSERT_EQ(host("I64=0 I3=3"), "");
  EXPECT_EQ(once({"CMDP\"P1\""}), "\n3\r");
}

TEST_F(ProgramTexts, ErrorsOfCommandsAreReportedByI6) {
  const Lines bad = {"CMD\"UUU\""};
  EXPECT_EQ(once(bad), "\aERR003\r");
  ASSERT_EQ(host("I3=3"), "");
  EXPECT_EQ(once(bad), "\a\nERR003\r");
  ASSERT_EQ(host("I3=2 I6=0"), "");
  EXPECT_EQ(once(bad), "\a");
  ASSERT_EQ(host("I6=2"), "");
  EXPECT_EQ(once(bad), "");
  ASSERT_EQ(host("I6=3"), "");
  EXPECT_EQ(once(bad), "\a\rERR003\r");
  EXPECT_EQ(once({"CMDP\"X5\"", "CMDS\"UUU\""}), "\a\rERR005\r");
  const char* const tagged[] = {"\x02\r",
                                "\x02"
                                "ERR003\r",
                                "",
                                "\x02"
                                "ERR003\r"};
  for (int i6 = 0; i6 < 4; ++i6) {
    ASSERT_EQ(host("I64=1 I6=" + std::to_string(i6)), "");
    EXPECT_EQ(once(bad), tagged[i6]) << i6;
  }
}

// It would be raised to capitals, and the listing of the PLC would tell it.
TEST_F(ProgramTexts, APasswordIsSetByTheHostOnly) {
  ASSERT_EQ(host("PASSWORD=ABC"), "");
  EXPECT_EQ(once({"CMD\"PASSWORD=xyz\"", "CMD\"PASSWORD=\"", "CMD\"P1=7 PASSWORD=ABC P1=8\""}),
            "\aERR003\r\aERR003\r\aERR003\r");
  EXPECT_EQ(host("P1"), "7") << "nothing behind it is executed";
  const char* text;
  ASSERT_EQ(program_password(&text), 3u);
  EXPECT_EQ(std::string(text, 3), "ABC");
}

TEST_F(ProgramTexts, WithI62ACommandIsExecutedAtItsReturn) {
  ASSERT_EQ(host("I62=1"), "");
  EXPECT_EQ(once({"CMD\"P1=\"", "CMD\"12\"", "P2=P1", "CMD^M"}), "");
  EXPECT_EQ(host("P1 P2"), "12|0");
}

TEST_F(ProgramTexts, AddressesOfACommandAreThoseOfThePlcAndStayThere) {
  ASSERT_EQ(host("&3 #4"), "");
  EXPECT_EQ(once({"CMD\"Q1=1\"", "ADDRESS#7&2", "CMD\"Q1=2\"", "CMD\"&5Q1=5\"", "CMD\"Q2=2\"", "CMDP\"#\""}), "7\r");
  EXPECT_EQ(q_variable_read(0, 1), 1.0);
  EXPECT_EQ(q_variable_read(1, 1), 2.0);
  EXPECT_EQ(q_variable_read(4, 1), 5.0);
  EXPECT_EQ(q_variable_read(1, 2), 2.0) << "&5 was not modal";
  EXPECT_EQ(host("& #"), "3|4") << "the host's addresses are its own";
}

TEST_F(ProgramTexts, BufferRequestStaysWithTheHostsSystem) {
  load(1, {"CMD\"&1P1=1\"", "CMD\"P2=1\"", "DISABLE PLC 1"});
  for (const char* line : {"&2DEF ROT 100", "&1DEF ROT 100", "I17=1", "OPEN ROT", "&1X1", "&2"})
    ASSERT_EQ(host(line), "") << line;
  ASSERT_EQ(host("CLOSE"), "");
  ASSERT_TRUE(platform::breq()) << "&1 is full, &2 is not";
  platform::clear_edges();
  ASSERT_EQ(host("ENABLE PLC 1"), "");
  for (int pass = 0; pass < 8; ++pass) {
    background(1);
    platform::real_time();
  }
  EXPECT_EQ(host("P1 P2"), "1|1");
  EXPECT_TRUE(platform::edges().empty());
}

TEST_F(ProgramTexts, CommandsOfAProgramDoNotEnterTheHostsBuffer) {
  load(1, {"CMD\"P1=1\"", "CMD\"CLOSE\"", "CMD\"CLEAR\"", "DISABLE PLC 1"});
  ASSERT_EQ(host("ENABLE PLC 1"), "");
  ASSERT_EQ(host("OPEN PROG 5 CLEAR"), "");
  ASSERT_EQ(host("P2=2"), "");
  sent();
  background(8);
  EXPECT_EQ(sent(), "\aERR007\r") << "CLEAR, for whom nothing is open";
  EXPECT_EQ(p_variable_read(1), 1.0) << "executed, not stored";
  ASSERT_EQ(host("P3=3"), "");
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("LIST PROG 5"), "P2=2|P3=3|RET");
}

TEST_F(ProgramTexts, ProgramHasABufferOfItsOwn) {
  load(1, {"CMD\"OPEN PROG 6 CLEAR\"", "CMD\"P4=4\"", "DISABLE PLC 1"});
  ASSERT_EQ(host("ENABLE PLC 1"), "");
  background(8);
  EXPECT_EQ(host("P5=5 P5"), "5") << "the host's line is not stored";
  EXPECT_EQ(host("OPEN PROG 7"), "ERR007");
  EXPECT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("OPEN PROG 7"), "ERR007") << "it is not the host's to close";
  EXPECT_EQ(host("CLOSE ALL"), "");
  EXPECT_EQ(host("LIST PROG 6"), "P4=4|RET");
}

TEST_F(ProgramTexts, ControlCharacterOfACommandActs) {
  fake_interrupts_leave_time();
  ASSERT_EQ(host("I5=3"), "");
  load(2, {"P2=P2+1"});
  ASSERT_EQ(host("ENABLE PLC 2"), "");
  EXPECT_EQ(once({"CMD^D"}), "");
  EXPECT_EQ(plc_enabled(), 0u);
  EXPECT_EQ(once({"CMDP^G"}), "000000000800\r");
}

TEST_F(ProgramTexts, CommandsControlPlcsAndRestart) {
  load(2, {"P2=P2+1"});
  once({"CMD\"ENABLE PLC 2\""});
  EXPECT_EQ(plc_enabled(), 1u << 2);
  ASSERT_EQ(host("SAVE"), "");
  load(3, {"CMD\"P9=1 $$$\"", "CMD\"P8=1\"", "DISABLE PLC 3"});
  ASSERT_EQ(host("&4 ENABLE PLC 3"), "");
  fake_hal_set_look(100);
  background(6);
  fake_hal_set_look(0);
  EXPECT_EQ(plc_enabled(), 1u << 2) << "PLC 1 was saved too, and disables itself";
  EXPECT_EQ(host("LIST PLC 3"), "ERR003");
  EXPECT_EQ(host("P8 &"), "0|1") << "what was queued is gone, as are the host's addresses";
}

// Of both tasks; nothing that a program has asked for before a reset is made behind it.
TEST_F(ProgramTexts, AResetForgetsWhatWaits) {
  for (const char* reset : {"$$$", "$$$***"}) {
    load(1, {"SEND\"old\"", "CMDP\"P1=1\"", "CMD\"P2=2\"", "DISABLE PLC 1"});
    ASSERT_EQ(host("OPEN PROG 1 CLEAR SEND\"older\" CMDP\"P3=3\" CMD\"P4=4\" CLOSE P1..4=0"), "");
    ASSERT_EQ(host("ENABLE PLC 1 B1R"), "");
    background(1);
    platform::real_time();
    for (const text_queue* queue : {send_queues, command_queues})
      for (unsigned task = 0; task < PROGRAM_TASKS; ++task) ASSERT_FALSE(text_queue_is_empty(&queue[task])) << task;
    platform::reset(reset);
    sent();
    background(4);
    EXPECT_EQ(sent(), "");
    EXPECT_EQ(host("P1..4"), "0|0|0|0");
    ASSERT_EQ(host("I3=2 I6=1 I5=2"), "");
  }
}

TEST_F(ProgramTexts, HostThatDoesNotReadHoldsUpNobodyButWhoSends) {
  fake_hal_on_wait(nobody_reads);
  const std::string text(100, 'x');
  load(1, {"SEND\"" + text + "\"", "P1=P1+1"});
  load(2, {"P2=P2+1", "CMD\"P3=P3+1\""});
  ASSERT_EQ(host("ENABLE PLC 1,2"), "");
  background(400);
  const double stuck = p_variable_read(1);
  // The port holds 4096 characters, and keeps room for the longest text; a queue 1024.
  EXPECT_GE(stuck, 35.0 + 9.0);
  EXPECT_LE(stuck, 41.0 + 10.0);
  background(100);
  EXPECT_EQ(p_variable_read(1), stuck) << "it stays at its SEND";
  EXPECT_EQ(p_variable_read(2), 250.0) << "the other one goes on";
  plc_disable(1u << 1);
  std::string all = sent();
  background(20);
  all += sent();
  EXPECT_EQ(all.size(), static_cast<std::size_t>(stuck) * 101) << "nothing is lost";
  fake_hal_on_wait(nullptr);
}

// firmware:6.7/9: nothing waits for a host. An error that the port has no room for is lost.
TEST_F(ProgramTexts, AnErrorOfACommandWaitsForNoHost) {
  static unsigned waits;
  waits = 0;
  fake_hal_on_wait([] { ++waits; });
  for (const char* statement : {"CMD\"UUU\"", "CMDS\"UUU\""}) {
    load(1, {statement, "P1=P1+1"});
    ASSERT_EQ(host("P1=0 ENABLE PLC 1"), "");
    host_port_open_output();
    while (host_port_room() != 0) host_port_send('x');
    background(20);
    EXPECT_EQ(waits, 0u) << statement;
    EXPECT_EQ(p_variable_read(1), 20.0) << statement << ": a scan a pass";
    plc_disable(1u << 1);
    EXPECT_EQ(sent(), std::string(4096, 'x')) << statement;
    background(2);
    sent();
  }
}

// 8192 values: the port holds 4096 characters of them, and the rest waits for half a second.
TEST_F(ProgramTexts, HostThatDoesNotReadALongReplyHoldsUpNoProgram) {
  fake_hal_on_wait(nobody_reads);
  load(1, {"CMDP\"P0..8191\"", "DISABLE PLC 1"});
  load(2, {"P2=P2+1"});
  ASSERT_EQ(host("ENABLE PLC 1,2"), "");
  background(6);
  EXPECT_GE(p_variable_read(2), 500.0) << "a scan a millisecond at least";
  EXPECT_EQ(sent().size(), 4096u);
}

// What it sends is not kept waiting by what a program has asked for, and its own reply is not lost.
TEST_F(ProgramTexts, HostThatDoesNotReadALongReplyIsServedSoon) {
  load(1, {"CMDP\"P0..8191\"", "DISABLE PLC 1"});
  slow_host = {60, 4096, 0, 0, {}};
  fake_hal_on_wait(host_is_slow);
  ASSERT_EQ(host("P5=0 ENABLE PLC 1"), "");
  background(6);
  EXPECT_EQ(p_variable_read(5), 7.0);
  EXPECT_LE(slow_host.waits_of_line, 21u);
  slow_host.got += sent();
  EXPECT_EQ(slow_host.got.size(), 4096u + 1u);
  EXPECT_EQ(slow_host.got.back(), '\x06');
}

TEST_F(ProgramTexts, HostThatDoesNotReadFastLosesNothing) {
  load(1, {"CMDP\"P0..8191\"", "DISABLE PLC 1"});
  for (const unsigned reads_from : {1u, 18u}) {
    slow_host = {reads_from, 100, 0, 0, {}};
    fake_hal_on_wait(host_is_slow);
    ASSERT_EQ(host("P5=0 ENABLE PLC 1"), "");
    background(6);
    slow_host.got += sent();
    EXPECT_EQ(std::count(slow_host.got.begin(), slow_host.got.end(), '\r'), 8192);
    EXPECT_EQ(slow_host.got.back(), '\x06') << "of its line, behind the reply";
  }
}

TEST_F(ProgramTexts, ControlXDropsWhatWaits) {
  ASSERT_EQ(host("I63=0"), "");
  load(1, {"SEND\"" + std::string(200, 'x') + "\""});
  ASSERT_EQ(host("ENABLE PLC 1"), "");
  background(100);
  plc_disable(1u << 1);
  ASSERT_EQ(host_port_room(), 4096u - 18 * 201u) << "room for a reply is left";
  ASSERT_FALSE(text_queue_is_empty(&send_queues[PROGRAM_BACKGROUND]));
  host_port_character(0x18);
  background(5);
  EXPECT_EQ(sent(), "");
  plc_enable(1u << 1);
  background(2);
  EXPECT_EQ(sent(), std::string(200, 'x') + '\r') << "later texts come";
}

TEST_F(ProgramTexts, DisplayIsKeptInMemory) {
  const auto shown = [] {
    std::string text;
    for (unsigned i = 0; i < 80; ++i) text += static_cast<char>(*hal_y(0x1080 + i));
    return text;
  };
  EXPECT_EQ(*hal_x(0x24), 0x1080u);
  EXPECT_EQ(shown(), std::string(80, ' '));
  EXPECT_EQ(once({"P1=0-12.345", "DISPLAY\"Speed\"", "DISP 10\"rpm\"", "DISP 20,8.2,P1", "DISP 30,4,1234",
                  "DISP 35,3,1234", "DISP 40,6.3,0.0004", "DISP 76\"beyond\""}),
            "");
  const std::string text = shown();
  EXPECT_EQ(text.substr(0, 16), "Speed     rpm   ");
  EXPECT_EQ(text.substr(20, 8), "  -12.35");
  EXPECT_EQ(text.substr(30, 4), "1234");
  EXPECT_EQ(text.substr(35, 3), "***");
  EXPECT_EQ(text.substr(40, 6), " 0.000");
  EXPECT_EQ(text.substr(76), "beyo");
  EXPECT_EQ(*hal_y(0x1080 + 80), 0u);
}

// Right-aligned, rounded to its decimals, stars where it is too wide; no sign of what is shown as 0.
TEST_F(ProgramTexts, NumbersAreShownInTheirFields) {
  const struct {
    const char *field, *value, *shown;
  } cases[] = {{"1.0", "5", "5"},
               {"1.0", "10", "*"},
               {"1.0", "0-5", "*"},
               {"2.0", "0-5", "-5"},
               {"3.2", "0.5", "***"},
               {"4.2", "0.5", "0.50"},
               {"5.2", "0-0.5", "-0.50"},
               {"4.1", "0-0.04", " 0.0"},
               {"4.1", "0-0.06", "-0.1"},
               {"5.1", "99.96", "100.0"},
               {"4.1", "99.96", "****"},
               {"6.0", "1234.4", "  1234"},
               {"6.0", "1234.6", "  1235"},
               {"16.9", "1/8", "     0.125000000"},
               {"16.0", "10000000*10000000", " 100000000000000"},
               {"16.1", "10000000*10000000", "****************"},
               {"16.2", "10000000*10000000", "****************"},
               {"16.9", "10000000*10000000", "****************"},
               {"16.9", "987654+1/8", "987654.125000000"},
               {"16.8", "1234567.5", "1234567.50000000"},
               {"16.0", "1000000*1000000000", "1000000000000000"},
               {"16.0", "100000000*1000000000", "****************"},
               {"16.9", "0-123456", "****************"}};
  for (const auto& c : cases) {
    const std::string width(c.shown);
    EXPECT_EQ(once({"DISP 0\"" + std::string(40, '#') + "\"", std::string("DISP 10,") + c.field + "," + c.value}), "");
    std::string text;
    for (unsigned i = 0; i < 40; ++i) text += static_cast<char>(*hal_y(0x1080 + i));
    EXPECT_EQ(text, std::string(10, '#') + c.shown + std::string(30 - width.size(), '#')) << c.field << " " << c.value;
  }
}

// What a damaged word asks for beyond 16 characters or nine decimals is as much as there is.
TEST_F(ProgramTexts, FieldsHaveTheirEnds) {
  for (unsigned i = 0; i < 80; ++i) *hal_y(0x1080 + i) = '#';
  display_value(20, 255, 255, 0.125);
  display_value(40, 17, 10, 0.125);
  std::string text;
  for (unsigned i = 20; i < 60; ++i) text += static_cast<char>(*hal_y(0x1080 + i));
  EXPECT_EQ(text, "     0.125000000####     0.125000000####");
}

TEST_F(ProgramTexts, TheDisplayEndsWithItsLastColumn) {
  *hal_y(0x1080 + 80) = 0x55;
  EXPECT_EQ(once({"DISP 78,4.0,1234", "DISP 79\"AB\""}), "");
  EXPECT_EQ(*hal_y(0x1080 + 78), static_cast<std::uint32_t>('1'));
  EXPECT_EQ(*hal_y(0x1080 + 79), static_cast<std::uint32_t>('A'));
  EXPECT_EQ(*hal_y(0x1080 + 80), 0x55u);
}

// firmware:6.7/9: 1024 bytes, five of them for what a text comes with. Filled and emptied in turns, over its end.
TEST(TextQueue, TakesWhatItHasRoomForAndGivesItInOrder) {
  static text_queue queue;
  std::vector<program_text> waiting;
  unsigned bytes = 0, refused = 0, exact = 0;
  queue.head = queue.tail = 0xFFFFFF00u;  // both run over the end of their numbers
  for (unsigned i = 0; i < 4000; ++i) {
    program_text t{};
    t.port = static_cast<std::uint8_t>(i % 5);
    t.cs = static_cast<std::uint8_t>(i % 16);
    t.motor = static_cast<std::uint8_t>(i % 32);
    t.control = static_cast<std::uint8_t>(i % 2);
    const unsigned room = 1024 - bytes;
    t.length = static_cast<std::uint8_t>(i % 7 == 0 && room >= 6 && room <= 260 ? room - 5 : i * 37 % 256);
    for (unsigned n = 0; n < t.length; ++n) t.text[n] = static_cast<char>(i + n);
    const bool fits = room >= 5u + t.length;
    ASSERT_EQ(text_queue_push(&queue, &t), fits) << i;
    if (fits) waiting.push_back(t), bytes += 5u + t.length;
    refused += fits ? 0u : 1u;
    exact += bytes == 1024 ? 1u : 0u;
    ASSERT_EQ(text_queue_is_empty(&queue), waiting.empty());
    for (unsigned n = fits ? i % 2 : 3; n > 0 && !waiting.empty(); --n) {
      program_text got{};
      ASSERT_EQ(text_queue_next_port(&queue), waiting.front().port);
      ASSERT_TRUE(text_queue_pop(&queue, &got));
      const program_text& sent = waiting.front();
      ASSERT_EQ(std::string(got.text, got.length), std::string(sent.text, sent.length)) << i;
      ASSERT_TRUE(got.port == sent.port && got.cs == sent.cs && got.motor == sent.motor && got.control == sent.control);
      bytes -= 5u + sent.length;
      waiting.erase(waiting.begin());
    }
  }
  EXPECT_GT(refused, 100u);
  EXPECT_GT(exact, 10u) << "full to the last byte";
  program_text rest;
  text_queue_empty(&queue);
  EXPECT_TRUE(text_queue_is_empty(&queue));
  EXPECT_FALSE(text_queue_pop(&queue, &rest));
}

TEST_F(ProgramTexts, LocksHoldNobody) {
  EXPECT_EQ(once({"LOCK 1", "LOCK 1", "P1=1", "UNLOCK 1"}), "");
  EXPECT_EQ(host("P1"), "1");
}

}  // namespace
