// The ASCII port in the dual-ported RAM (host-bus:6.6, host-bus:8.5) beside the host port.
#include <random>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/dpram_host.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/host/dpram_ascii.h"
#include "firmware/host/dpram_responses.h"
#include "firmware/host/program_texts.h"
#include "firmware/variables/pq_variables.h"
#include "rtl/regs/brick_regs.h"
}

namespace {

using platform::background;
using platform::DpramHost;
using platform::host;
using platform::sent;
using Lines = std::vector<std::string>;

class DpramAscii : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I3=2 I6=1 I5=2 I58=1"), "");
    background(1);
  }
  // A line as the host port brings it; what comes back on that port.
  static std::string by_port(const std::string& line) {
    for (const char c : line + "\r") host_port_character(static_cast<std::uint8_t>(c));
    background(2);
    return sent();
  }
  // PLC 1 executes the statements once.
  static void once(Lines lines) {
    lines.emplace_back("DISABLE PLC 1");
    ASSERT_EQ(host("OPEN PLC 1 CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE ENABLE PLC 1"), "");
    background(3 + static_cast<unsigned>(lines.size()));
  }
  // What the buffer shows from now on, released line by line: code and text.
  Lines released() {
    Lines lines;
    while (const auto response = ram_host.take(3)) {
      char code[8];
      std::snprintf(code, sizeof code, "%04X ", response->code);
      lines.push_back(code + response->text);
      EXPECT_EQ(response->count, response->text.size() + 1);
    }
    return lines;
  }
  static std::vector<bool> compare_output_edges() {
    const fake_write* log = nullptr;
    const unsigned count = fake_hal_writes(&log);
    std::vector<bool> levels;
    for (unsigned i = 0; i < count; ++i)
      if (log[i].x && log[i].address == SERVO_IC_0_BASE + SERVO_CHANNEL_X_CONTROL &&
          (log[i].value & SERVO_CHANNEL_CONTROL_EQU_WRITE_MASK) != 0)
        levels.push_back((log[i].value & SERVO_CHANNEL_CONTROL_EQU_STATE_MASK) != 0);
    return levels;
  }

  platform::NativeDpram ram;
  DpramHost ram_host{ram};
};

TEST_F(DpramAscii, AnswersWithLinesThenAcknowledges) {
  ASSERT_TRUE(ram_host.send("P1=25 P2=50 P1..2"));
  EXPECT_EQ(released(), (Lines{"000D 25", "000D 50", "0006 "}));
  ASSERT_TRUE(ram_host.send("P3=1"));
  EXPECT_EQ(released(), (Lines{"0006 "}));
  ASSERT_TRUE(ram_host.send(""));
  EXPECT_EQ(released(), (Lines{"0006 "}));
}

TEST_F(DpramAscii, AnErrorIsItsNumberInDecimalDigitsBehindTheLinesBeforeIt) {
  ASSERT_TRUE(ram_host.send("P1=7 P1 UUU P1=8"));
  EXPECT_EQ(released(), (Lines{"000D 7", "8003 "}));
  ASSERT_TRUE(ram_host.send("X1000"));
  EXPECT_EQ(released(), (Lines{"8005 "}));
  ASSERT_TRUE(ram_host.send("&1R"));
  EXPECT_EQ(released(), (Lines{"8015 "})) << "no program";
  EXPECT_EQ(host("P1"), "7");
}

// I3, I4 and I6 are of the other port.
TEST_F(DpramAscii, NoFramingAndNoChecksums) {
  ASSERT_EQ(host("I3=3 I4=1 I6=0 I64=1 P1=5"), "");
  ASSERT_TRUE(ram_host.send("P1"));
  EXPECT_EQ(released(), (Lines{"000D 5", "0006 "}));
  ASSERT_TRUE(ram_host.send("UUU"));
  EXPECT_EQ(released(), (Lines{"8003 "}));
}

TEST_F(DpramAscii, LinesOfUpTo255CharactersComeInPieces) {
  for (const unsigned length : {1U, 2U, 157U, 158U, 159U, 160U, 161U, 254U, 255U}) {
    std::string line = "P1=" + std::to_string(length % 7);
    if (length < line.size()) line = "&";
    line.insert(line.size() > 3 ? 3 : line.size(), std::string(length - line.size(), ' '));
    ASSERT_EQ(line.size(), length);
    ASSERT_EQ(host("P1=-1"), "");
    EXPECT_EQ(ram_host.ask(line), length < 4 ? (length == 1 ? "1" : "1") : "") << length;
    if (length >= 4) { EXPECT_EQ(host("P1"), std::to_string(length % 7)) << length; }
  }
  EXPECT_EQ(ram_host.ask("P1=9" + std::string(252, ' ')), "ERR003") << "256 characters";
  EXPECT_EQ(host("P1"), "3") << "255 % 7";
  EXPECT_EQ(ram_host.ask("P1=9" + std::string(2000, ' ')), "ERR003");
  EXPECT_EQ(ram_host.ask("P1=4"), "");
}

// 32 Q-variables of 12 digits with a blank between them: 415 characters. 1 is a half times 2^1.
TEST_F(DpramAscii, AnAnswerOfMoreThan255CharactersComesInPieces) {
  std::string text = "400000000800";
  for (unsigned i = 1; i < 32; ++i) text += " 400000000800";
  ASSERT_EQ(text.size(), 415u);
  ASSERT_TRUE(ram_host.send("&1Q0..31=1 RHL$8000,32"));
  EXPECT_EQ(released(), (Lines{"000D " + text.substr(0, 255), "000D " + text.substr(255), "0006 "}));
}

TEST_F(DpramAscii, QuotesKeepTheirCaseAndCharactersThatAreNoneAreRefused) {
  EXPECT_EQ(ram_host.ask("p1=4 p1\r\n"), "4") << "CR and LF are not of the line";
  EXPECT_EQ(ram_host.ask("P1=\x01 5"), "ERR004");
  EXPECT_EQ(ram_host.ask("P1=\xC4"), "ERR004");
  EXPECT_EQ(ram_host.ask("PASSWORD=aB c"), "");
  const char* kept = nullptr;
  const std::uint32_t length = program_password(&kept);
  EXPECT_EQ(std::string(kept, length), "aB c");
}

TEST_F(DpramAscii, AddressesAreOfEachPort) {
  EXPECT_EQ(ram_host.ask("&3#7##2"), "");
  EXPECT_EQ(by_port("&#"), "1\r1\r\x06");
  EXPECT_EQ(by_port("&2"), "\x06");
  EXPECT_EQ(ram_host.ask("&#"), "3|7");
  EXPECT_EQ(by_port("&"), "2\r\x06");
}

// BREQ is that of the last `&n`, from whichever port (host-bus:5.3).
TEST_F(DpramAscii, TheLastAddressSelectsBreq) {
  EXPECT_EQ(ram_host.ask("&2DEF ROT 50"), "");
  EXPECT_EQ(ram_host.ask("OPEN ROT"), "");
  EXPECT_TRUE(platform::breq()) << "C.S. 2, by the RAM";
  EXPECT_EQ(by_port("&1"), "\x06");
  EXPECT_FALSE(platform::breq()) << "C.S. 1, which has no buffer, by the port";
  EXPECT_EQ(ram_host.ask("&"), "2");
  EXPECT_FALSE(platform::breq()) << "a question selects nothing";
  EXPECT_EQ(ram_host.ask("&2"), "");
  EXPECT_TRUE(platform::breq());
}

TEST_F(DpramAscii, TheOpenBufferIsThatOfThePortThatHasOpenedIt) {
  EXPECT_EQ(ram_host.ask("OPEN PROG 5 CLEAR"), "");
  EXPECT_EQ(ram_host.ask("X10"), "");
  EXPECT_EQ(by_port("X20"), "\aERR005\r");
  EXPECT_EQ(by_port("CLOSE"), "\x06") << "of another port";
  EXPECT_EQ(ram_host.ask("X30"), "");
  EXPECT_EQ(ram_host.ask("CLOSE"), "");
  EXPECT_EQ(host("LIST PROG 5"), "X10|X30|RET");
}

// A port that is off can close nothing any more: others may (host-bus:6.6/8).
TEST_F(DpramAscii, TheBufferOfAPortThatIsOffIsClosedByAnyCloseAndTakesNoText) {
  for (const char* off : {"I58=0", "I24=0"}) {
    EXPECT_EQ(ram_host.ask("OPEN PROG 5 CLEAR"), "");
    EXPECT_EQ(ram_host.ask("X10"), "");
    EXPECT_EQ(by_port("CLOSE OPEN PROG 6"), "\aERR007\r") << "while the port is on it is its own";
    EXPECT_EQ(by_port(off), "\x06");
    EXPECT_EQ(by_port("X20"), "\aERR005\r") << off;
    EXPECT_EQ(by_port("CLOSE"), "\x06") << off;
    EXPECT_EQ(by_port("OPEN PROG 6 CLEAR CLOSE"), "\x06") << off;
    EXPECT_EQ(host("LIST PROG 5"), "X10|RET") << off;
    ASSERT_EQ(host("I58=1 I24=*"), "");
    background(1);
  }
  EXPECT_EQ(ram_host.ask("OPEN PROG 5 CLEAR"), "");
  EXPECT_EQ(by_port("I58=0 CLOSE OPEN PROG 6 CLOSE"), "\x06") << "at once, in one line";
}

// A line that the host port is in the middle of is not disturbed, compiled ahead or not.
TEST_F(DpramAscii, ALineOfTheHostPortUnderWayIsKept) {
  ASSERT_EQ(by_port("&1DEF ROT 100"), "\x06");
  ASSERT_EQ(by_port("OPEN ROT"), "\x06");
  for (const char c : std::string("X10 Y2")) host_port_character(static_cast<std::uint8_t>(c));
  background(1);
  ASSERT_TRUE(ram_host.send("P1=1 P1"));
  Lines answer;
  for (int i = 0; i < 3; ++i) {  // a pass waits for the end of a line that is on its way, 2 ms at most
    fake_hal_pass(3 * hal_cycles_per_ms());
    background(1);
    const auto response = ram_host.look();
    if (!response) continue;
    answer.push_back(response->text);
    ram.write(DPRAM_RESPONSE_CONTROL, 0);
  }
  EXPECT_EQ(answer, (Lines{"1", ""}));
  EXPECT_EQ(by_port("0"), "\x06");
  EXPECT_EQ(host("LIST ROT"), "X10Y20");
}

TEST_F(DpramAscii, ControlCharactersActAndAreCleared) {
  ASSERT_TRUE(ram_host.control(0x10));
  EXPECT_EQ(released(), (Lines{"000D 0 0 0 0 0 0 0 0", "0006 "}));
  once({"P1=P1+1", "ENABLE PLC 1"});
  ASSERT_TRUE(ram_host.control(0x04));
  EXPECT_EQ(released(), (Lines{})) << "^D answers nothing";
  EXPECT_EQ(ram_host.ask("P1=6 P1"), "6");
  ASSERT_TRUE(ram_host.control(0x19));
  EXPECT_EQ(released(), (Lines{"000D P1=6 P1", "0006 "})) << "^Y";
  ASSERT_EQ(host("WX$20,$414243 WY$20,$444546 I5001=$800020 I5002=$20 I5050=3"), "");
  ASSERT_TRUE(ram_host.control(0x05));
  EXPECT_EQ(released(), (Lines{"000D ABCDEFDEF", "0006 "})) << "^E";
}

// host-bus:6.6/3, firmware:5.9/25: what was executed, or refused, as far as a line goes.
TEST_F(DpramAscii, ControlYReportsTheLineAsItCame) {
  const auto last = [this] {
    EXPECT_TRUE(ram_host.control(0x19));
    return released();
  };
  EXPECT_EQ(last(), (Lines{"000D ", "0006 "})) << "there was none";
  EXPECT_EQ(ram_host.ask("p1=5 ;Ab\r\n"), "");
  EXPECT_EQ(last(), (Lines{"000D p1=5 ;Ab", "0006 "}));
  EXPECT_EQ(ram_host.ask("P1"), "5");
  EXPECT_EQ(last(), (Lines{"000D P1", "0006 "})) << "nothing of the longer one";
  EXPECT_EQ(ram_host.ask("P1=\xC4"), "ERR004");
  EXPECT_EQ(last(), (Lines{"000D P1=\xC4", "0006 "}));
  for (const unsigned length : {254U, 255U, 256U, 2000U}) {
    const std::string line = "P1=" + std::to_string(length % 10) + std::string(length - 5, ' ') + "~";
    EXPECT_EQ(ram_host.ask(line), "ERR003") << length;
    EXPECT_EQ(last(), (Lines{"000D " + line.substr(0, 255), "0006 "})) << length;
  }
  EXPECT_EQ(ram_host.ask("P1"), "5") << "255 characters";
}

TEST_F(DpramAscii, ControlXForgetsWhatWaits) {
  ASSERT_TRUE(ram_host.send("P1..5"));
  background(3);
  ASSERT_TRUE(ram_host.control(0x18));
  EXPECT_EQ(released(), (Lines{"000D 0"})) << "the line that stood there is the host's";
  EXPECT_EQ(ram_host.ask("P1=3 P1"), "3");
}

TEST_F(DpramAscii, ControlXForgetsThePieceThatHasCome) {
  const std::string piece = "P1=7" + std::string(155, ' ');
  ASSERT_EQ(piece.size(), 159u);
  for (std::uint32_t i = 0; i < 160; i += 2)
    ram.write(DPRAM_COMMAND_TEXT + i, static_cast<std::uint16_t>(piece[i] | (i < 158 ? piece[i + 1] : ' ') << 8));
  ram.write(DPRAM_COMMAND_CONTROL, 1);
  background(2);
  ASSERT_EQ(ram.read(DPRAM_COMMAND_CONTROL), 0u) << "taken, and the rest is waited for";
  ASSERT_TRUE(ram_host.control(0x18));
  EXPECT_EQ(ram_host.ask("P2=3 P1..2"), "0|3");
}

TEST_F(DpramAscii, TextsGoWhereTheyAreSent) {
  once({"SENDR\"ram\"", "SENDP\"port\"", "SENDS\"serial\"", "SENDA\"auxiliary\""});
  EXPECT_EQ(sent(), "port\r");
  EXPECT_EQ(released(), (Lines{"020D ram"}));
}

TEST_F(DpramAscii, TheActivePortIsTheLastThatHasBroughtACommand) {
  once({"SEND\"1\""});
  EXPECT_EQ(sent(), "1\r") << "host port, from the start";
  EXPECT_EQ(ram_host.ask("P1=1"), "");
  once({"SEND\"2\""});
  EXPECT_EQ(sent(), "");
  EXPECT_EQ(released(), (Lines{"020D 2"}));
  EXPECT_EQ(by_port("P1=1"), "\x06");
  once({"SEND\"3\""});
  EXPECT_EQ(sent(), "3\r");
  ASSERT_TRUE(ram_host.control(0x1A));
  once({"SEND\"4\""});
  EXPECT_EQ(sent(), "") << "the serial port, which is not there";
  EXPECT_EQ(released(), (Lines{}));
  EXPECT_EQ(by_port("\x1A"), "\x06") << "the line that ends behind it makes the port active again";
  once({"SEND\"5\""});
  EXPECT_EQ(sent(), "5\r");
}

// host-bus:8.5/2. The program sends when P1 says so, which no host has written.
TEST_F(DpramAscii, AfterControlZTextsAreDroppedUntilACommandComes) {
  ASSERT_EQ(host("OPEN PLC 1 CLEAR"), "");
  for (const char* line : {"IF(P1=1)", "SEND\"text\"", "P1=0", "ENDIF"}) ASSERT_EQ(host(line), "") << line;
  ASSERT_EQ(host("CLOSE ENABLE PLC 1"), "");
  const auto text = [] {
    p_variable_write(1, 1.0);
    for (int i = 0; i < 4; ++i) {  // behind a character the background waits 2 ms for the rest of its line
      fake_hal_pass(3 * hal_cycles_per_ms());
      background(1);
    }
    EXPECT_EQ(p_variable_read(1), 0.0);
    return sent();
  };
  EXPECT_EQ(text(), "text\r");
  for (const bool by_ram : {false, true}) {
    if (by_ram)
      ASSERT_TRUE(ram_host.control(0x1A));
    else
      host_port_character(0x1A);
    background(2);
    EXPECT_EQ(text(), "");
    EXPECT_EQ(released(), (Lines{}));
    EXPECT_EQ(by_port("P2=1"), "\x06");
    EXPECT_EQ(text(), "text\r");
  }
  EXPECT_EQ(ram_host.ask("P2=1"), "");
  EXPECT_EQ(text(), "");
  EXPECT_EQ(released(), (Lines{"020D text"}));
  program_texts_initialize();
  EXPECT_EQ(text(), "text\r") << "after a start";
}

TEST_F(DpramAscii, CommandsOfProgramsAnswerWhereTheyName) {
  ASSERT_EQ(host("P1=3 P2=4"), "");
  once({"CMDR\"P1P2\"", "CMDP\"P2\"", "CMD\"P1\"", "CMDR\"UUU\""});
  EXPECT_EQ(sent(), "4\r");
  EXPECT_EQ(released(), (Lines{"010D 3", "010D 4", "010D ERR003"}));
  EXPECT_EQ(ram_host.ask("P1"), "3");
  once({"CMD\"UUU\""});
  EXPECT_EQ(sent(), "");
  EXPECT_EQ(released(), (Lines{"010D ERR003"})) << "the active port";
}

// 8,192 answers are more than the other port's queue holds.
TEST_F(DpramAscii, ALongAnswerArrivesWhole) {
  ASSERT_TRUE(ram_host.send("P0..8191"));
  background(2);
  EXPECT_EQ(by_port("P1=5 P1"), "5\r\x06") << "not held up";
  const brick::Reply reply = ram_host.finish(DpramHost::kPasses);
  EXPECT_TRUE(reply.complete);
  EXPECT_EQ(reply.lines.size(), 8192U);
}

TEST_F(DpramAscii, AnAnswerThatNoQueueHoldsIsCutAndEndsWithAnError) {
  std::string line;
  for (int i = 0; i < 20; ++i) line += "M0..8191->";
  ASSERT_TRUE(ram_host.send(line));
  const brick::Reply reply = ram_host.finish(DpramHost::kPasses);
  EXPECT_TRUE(reply.complete);
  ASSERT_GT(reply.lines.size(), 8192U);
  EXPECT_EQ(reply.lines.back(), "ERR006");
  EXPECT_EQ(ram_host.ask("P1=5 P1"), "5");
}

// host-bus:6.6/9: 256 KiB are 1016 lines of 255 characters with three bytes each before them, 13 bytes for one of 10,
// and three for the end.
TEST_F(DpramAscii, AnAnswerIsCutWhereTheQueueIsFull) {
  static_assert(1016 * (3 + 255) + (3 + 10) + 3 == 256 * 1024);
  const auto letter = [](unsigned line) { return static_cast<char>('A' + line % 26); };
  for (const unsigned last : {10u, 11u, 255u}) {
    const auto put = [](char c, unsigned count) {
      for (unsigned i = 0; i < count; ++i) dpram_responses_put(DPRAM_RESPONSE_LINE, static_cast<std::uint8_t>(c));
      dpram_responses_end(DPRAM_RESPONSE_LINE);
    };
    for (unsigned line = 0; line < 1016; ++line) put(letter(line), 255);
    put('z', last);
    dpram_responses_end(DPRAM_RESPONSE_ACKNOWLEDGE);
    Lines expected;
    for (unsigned line = 0; line < 1016; ++line) expected.push_back("000D " + std::string(255, letter(line)));
    if (last == 10) expected.push_back("000D " + std::string(10, 'z'));
    expected.emplace_back(last == 10 ? "0006 " : "8006 ");
    EXPECT_EQ(released(), expected) << last;
    EXPECT_EQ(ram_host.ask("P1=5 P1"), "5");
  }
}

// A host that never reads: its next command waits, nobody else.
TEST_F(DpramAscii, AHostThatDoesNotReadHoldsUpItselfOnly) {
  ASSERT_TRUE(ram_host.send("P0..999"));
  background(2);
  ASSERT_TRUE(ram_host.send("P1=77"));
  for (int i = 0; i < 20; ++i) EXPECT_EQ(by_port("P2=P2+1"), "\x06");
  EXPECT_EQ(host("P1 P2"), "0|20");
  once({"SENDR\"for the ram\"", "SENDP\"for the port\""});
  EXPECT_EQ(sent(), "") << "the port's text stands behind the other";
  fake_hal_pass(500 * hal_cycles_per_ms() - hal_cycles_per_ms() / 4);
  background(3);
  EXPECT_EQ(sent(), "") << "not yet half a second";
  fake_hal_pass(hal_cycles_per_ms() / 2);
  background(3);
  EXPECT_EQ(sent(), "for the port\r") << "half a second: the other is dropped";
  const brick::Reply reply = ram_host.finish(DpramHost::kPasses);
  EXPECT_EQ(reply.lines.size(), 1000U);
  EXPECT_TRUE(ram_host.finish(DpramHost::kPasses).complete);
  EXPECT_EQ(host("P1"), "77");
  EXPECT_EQ(ram_host.take_unsolicited(), Lines{});
}

// host-bus:6.6/9: a line of one digit is four bytes of the queue, the end three; the first line stands in the buffer.
TEST_F(DpramAscii, TheNextCommandWaitsWhile2048BytesAreUnread) {
  static_assert(511 * 4 + 3 < 2048 && 512 * 4 + 3 >= 2048);
  for (const unsigned lines : {512u, 513u}) {
    ASSERT_EQ(host("P1=0"), "");
    ASSERT_TRUE(ram_host.send("P1001.." + std::to_string(1000 + lines)));
    background(2);
    ASSERT_TRUE(ram_host.send("P1=1"));
    background(2);
    EXPECT_EQ(host("P1"), lines == 512 ? "1" : "0") << lines;
    EXPECT_EQ(ram_host.finish(DpramHost::kPasses).lines.size(), lines);
    EXPECT_TRUE(ram_host.finish(DpramHost::kPasses).complete);
    EXPECT_EQ(host("P1"), "1");
  }
}

// One rise a line, which falls when the host has released it.
TEST_F(DpramAscii, I56RaisesEqu1ForEachLine) {
  ASSERT_EQ(host("I56=1"), "");
  fake_hal_clear_writes();
  ASSERT_TRUE(ram_host.send("P1"));
  background(2);
  EXPECT_EQ(compare_output_edges(), (std::vector<bool>{true}));
  background(5);
  EXPECT_EQ(compare_output_edges(), (std::vector<bool>{true})) << "high until released";
  EXPECT_EQ(released(), (Lines{"000D 0", "0006 "}));
  EXPECT_EQ(compare_output_edges(), (std::vector<bool>{true, false, true, false}));
  ASSERT_EQ(host("I56=0"), "");
  EXPECT_EQ(ram_host.ask("P1"), "0");
  EXPECT_EQ(compare_output_edges().size(), 4U);
}

TEST_F(DpramAscii, AnUltraliteAndAUmacRaiseCtrl0AndLeaveCtrl1) {
  for (const unsigned product : {HAL_PRODUCT_ULTRALITE, HAL_PRODUCT_UMAC}) {
    fake_hal_set_strap(HAL_STRAP_PRODUCT, product);
    ASSERT_EQ(host("I56=1 M1->X:$70012,0,2 M1=2"), "");
    fake_hal_clear_writes();
    ASSERT_TRUE(ram_host.send("P1"));
    background(2);
    EXPECT_EQ(host("M1"), "3") << product;
    EXPECT_EQ(released(), (Lines{"000D 0", "0006 "}));
    EXPECT_EQ(host("M1"), "2") << product;
    EXPECT_FALSE(fake_hal_masked()) << product;
    EXPECT_TRUE(compare_output_edges().empty()) << product;
  }
}

TEST_F(DpramAscii, IsOffUntilI58AndThenBeginsClean) {
  ASSERT_EQ(host("I58=0"), "");
  background(1);
  ram.write(DPRAM_COMMAND_CONTROL, 1);
  ram.write(DPRAM_COMMAND_TEXT, 'P' | '1' << 8);
  ram.write(DPRAM_COMMAND_TEXT + 2, '=' | '1' << 8);
  ram.write(DPRAM_COMMAND_TEXT + 4, 0);
  ram.write(DPRAM_CONTROL_CHARACTER, 0x10);
  ram.write(DPRAM_RESPONSE_CONTROL, 0x1234);
  background(5);
  EXPECT_EQ(ram.read(DPRAM_COMMAND_CONTROL), 1U);
  EXPECT_EQ(ram.read(DPRAM_CONTROL_CHARACTER), 0x10U);
  EXPECT_EQ(ram.read(DPRAM_RESPONSE_CONTROL), 0x1234U);
  once({"SENDR\"nobody\""});
  ASSERT_EQ(host("I58=1"), "");
  background(1);
  EXPECT_EQ(ram.read(DPRAM_COMMAND_CONTROL), 0U);
  EXPECT_EQ(ram.read(DPRAM_CONTROL_CHARACTER), 0U);
  EXPECT_EQ(ram.read(DPRAM_RESPONSE_CONTROL), 0U);
  EXPECT_EQ(host("P1"), "0");
  EXPECT_EQ(released(), (Lines{}));
  ASSERT_EQ(host("I24=0"), "");
  background(1);
  EXPECT_FALSE(dpram_ascii_is_on()) << "no RAM is named";
}

TEST_F(DpramAscii, ARestartThroughThePortIsAcknowledgedIfItIsOnAfterIt) {
  ASSERT_EQ(host("SAVE"), "");
  fake_hal_set_look(100);
  EXPECT_EQ(ram_host.ask("P1=1 $$$"), "");
  EXPECT_EQ(ram_host.ask("I58 P1"), "1|0");
  ASSERT_TRUE(ram_host.send("$$$***"));
  background(5);
  EXPECT_FALSE(dpram_ascii_is_on());
  EXPECT_EQ(host("I58=1"), "");
  EXPECT_EQ(released(), (Lines{})) << "of what was before";
}

// Such a reply waits for nobody, and takes longer than the watchdog allows a background pass.
TEST_F(DpramAscii, PlcsAndTheWatchdogGoOnInALongReply) {
  ASSERT_EQ(host("OPEN PLC 1 CLEAR"), "");
  ASSERT_EQ(host("P200=P200+1"), "");
  ASSERT_EQ(host("CLOSE P200=0 ENABLE PLC 1"), "");
  fake_hal_set_look(hal_cycles_per_ms());
  ASSERT_TRUE(ram_host.send("P200=0 P0..99"));
  background(1);
  EXPECT_GT(p_variable_read(200), 10) << "through the RAM";
  fake_hal_set_look(0);
  while (ram_host.take(3)) {}
  fake_hal_set_look(hal_cycles_per_ms());
  for (const char c : std::string("P200=0 P0..99\r")) host_port_character(static_cast<std::uint8_t>(c));
  background(1);
  fake_hal_set_look(0);
  EXPECT_GT(p_variable_read(200), 10) << "by the port";
}

// Whatever the host writes wherever: nothing traps, the port works afterwards.
TEST_F(DpramAscii, AnyWordsAreSurvived) {
  std::mt19937 random(brick::random_seed(7));
  for (int i = 0; i < 3000; ++i) {
    const std::uint32_t offset = DPRAM_COMMAND_CONTROL + 2 * (random() % ((DPRAM_OPEN - DPRAM_COMMAND_CONTROL) / 2));
    ram.write(offset, static_cast<std::uint16_t>(random()));
    ram.write(DPRAM_COMMAND_CONTROL, random() % 2);
    if (random() % 3 == 0) ram.write(DPRAM_RESPONSE_CONTROL, 0);
    background(1);
  }
  ASSERT_TRUE(ram_host.control(0x18));
  while (ram_host.take(3)) {}
  platform::reset("$$$***");
  ASSERT_EQ(host("I58=1"), "");
  background(1);
  EXPECT_EQ(ram_host.ask("P1=4 P1"), "4");
}

TEST_F(DpramAscii, AHostWaitsForAnAnswerNoLongerThanItSays) {
  const brick::Tick begin = ram.now();
  const brick::Reply reply = ram_host.finish(9);
  EXPECT_FALSE(reply.complete || reply.error);
  EXPECT_TRUE(reply.lines.empty());
  EXPECT_EQ(ram.now() - begin, 9);
}

}  // namespace
