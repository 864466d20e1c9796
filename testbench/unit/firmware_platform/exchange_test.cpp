// Golden exchanges of firmware:13 and the protocol rules of firmware:6, byte for byte.
#include <gtest/gtest.h>

#include <cmath>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_platform/framing.h"

#define error_t firmware_error_t  // the C library has a type of this name
extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/run/run_control.h"
}

namespace brick {
namespace {

using namespace std::string_literals;

TEST(HostExchange, AnswersWithDataThenAcknowledge) {
  Controller c;
  EXPECT_EQ(c.send("I3\r"), "2\r\x06");
  c.send("P1=25 P2=50 P3=75\r");
  EXPECT_EQ(c.send("P1..3\r"), "25\r50\r75\r\x06");
}

TEST(HostExchange, ReportsUnknownCommandAndMissingBuffer) {
  Controller c;
  EXPECT_EQ(c.send("UUU\r"),
            "\x07"
            "ERR003\r");
  EXPECT_EQ(c.send("X1000\r"),
            "\x07"
            "ERR005\r");
}

// A sign behind `%` makes the whole command wrong: no report goes before the error.
TEST(HostExchange, TimeBaseWithASignIsAnErrorAndNoReport) {
  Controller c;
  EXPECT_EQ(c.send("%\r"), "100\r\x06");
  for (const char* line : {"%-1\r", "%+1\r", "% -1\r", "%-\r", "%-0\r"}) {
    EXPECT_EQ(c.send(line),
              "\x07"
              "ERR003\r")
        << line;
  }
  EXPECT_EQ(c.send("%\r"), "100\r\x06");
}

TEST(HostExchange, ReducesI3ModuloItsRange) {
  Controller c;
  EXPECT_EQ(c.send("I3=5\r"), "\x06");
  EXPECT_EQ(c.send("I3\r"), "\n1\r\n");
}

TEST(HostExchange, ClientsFirstLineWorksFromPowerOnSettings) {
  Controller c(0x3, false);
  EXPECT_EQ(c.send("i6=1 i3=2 ver\r"), "1.947\r\x06");
}

TEST(HostExchange, ReportsI16InLongForm) {
  BRICK_COVERS("I9-1");
  Controller c;
  c.send("I9=3\r");
  EXPECT_EQ(c.send("I16\r"), "I16=5\r\x06");
}

TEST(HostExchange, FlagModeIsHexadecimalAndTakesExpressions) {
  BRICK_COVERS("I9-2");
  Controller c;
  EXPECT_EQ(c.send("I124\r"), "$1\r\x06");
  EXPECT_EQ(c.send("I124=I124|$20000\r"), "\x06");
  EXPECT_EQ(c.send("I124\r"), "$20001\r\x06");
  c.send("I9=0\r");
  EXPECT_EQ(c.send("I124\r"), "131073\r\x06");
}

TEST(HostExchange, MacroBasesOfAbsentIcsAreZero) {
  Controller c;
  EXPECT_EQ(c.send("i20 i21 i22 i23\r"), "$0\r$0\r$0\r$0\r\x06");
}

TEST(HostExchange, IdentifiesItself) {
  fake_interrupts_leave_time();
  Controller c;
  EXPECT_EQ(c.send("cid\r"), "603382\r\x06");
  EXPECT_EQ(c.send("TYPE\r"), "TURBO2, X4\r\x06");
  EXPECT_EQ(c.send("VERSION\r"), "1.947\r\x06");
  EXPECT_EQ(c.send("VID\r"), "1\r\x06");
  EXPECT_EQ(c.send("???\r"), "000000000800\r\x06");
}

TEST(HostExchange, IdentifiesTheBoardAndTheFirmware) {
  Controller c;
  EXPECT_EQ(c.line("CPU DATE EAVER"), "DSP56321|07/01/2014|1947001");
  EXPECT_EQ(c.line("SID IDNUMBER"), "0000000934F6|00000000000934F6");  // 603382 = $934F6
  static_assert(FAKE_IMAGE_WORDS == 1000, "1 + 2 + ... + 1000 = 500500 = $7A314");
  EXPECT_EQ(c.line("CHECKSUM CHKS"), "7A314|7A314");
  fake_hal_set_strap(HAL_STRAP_CARD, 602404);
  EXPECT_EQ(c.line("CID"), "602404");
}

// Jan. 1, 2000, was a Saturday, and a year has 365 days, every fourth 366.
TEST(HostExchange, TellsDateAndTime) {
  Controller c;
  EXPECT_EQ(c.line("TODAY TIME"), "SAT 01/01/2000|00:00:00");
  fake_hal_pass(78643000);
  EXPECT_EQ(c.line("TIME"), "00:00:01");
  EXPECT_EQ(c.line("TIME=17:45:24 TODAY=02/29/2028"), "");
  EXPECT_EQ(c.line("TODAY TIME"), "TUE 02/29/2028|17:45:24");
  EXPECT_EQ(c.line("TIME=08:30 TIME"), "08:30:00");
  for (int second = 0; second < 200; ++second) fake_hal_pass(78643000);
  EXPECT_EQ(c.line("TIME"), "08:33:20") << "15.7 thousand million cycles, more than 2^33";
  const char* const nights[][2] = {{"12/31/2099", "FRI 01/01/2100"}, {"02/28/2027", "MON 03/01/2027"},
                                   {"02/28/2028", "TUE 02/29/2028"}, {"12/31/2003", "THU 01/01/2004"},
                                   {"12/31/2004", "SAT 01/01/2005"}, {"04/30/2026", "FRI 05/01/2026"}};
  for (const auto& [before, after] : nights) {
    EXPECT_EQ(c.line(std::string("TODAY=") + before + " TIME=23:59:59"), "") << before;
    fake_hal_pass(78643000);
    EXPECT_EQ(c.line("TODAY TIME"), std::string(after) + "|00:00:00");
  }
  c.line("TODAY=05/06/2007 TIME=01:02:03");
  for (const char* text : {"TODAY=02/29/2027", "TODAY=13/01/2027", "TODAY=00/01/2027", "TODAY=01/00/2027",
                           "TODAY=01/32/2027", "TODAY=01/01/1999", "TODAY=01/01/2100", "TODAY=01/01", "TODAY=",
                           "TIME=24:00", "TIME=12:60", "TIME=12:00:60", "TIME=12", "TIME=", "TIME=-1:00", "TIME=1:1:"})
    EXPECT_EQ(c.line(text), "ERR003") << text;
  EXPECT_EQ(c.line("TODAY TIME"), "SUN 05/06/2007|01:02:03");
  c.line("$$$");
  EXPECT_EQ(c.line("TODAY"), "SAT 01/01/2000");
}

TEST(HostExchange, EnableIsTakenUnlessTheClocksAreMissing) {
  Controller c;
  EXPECT_EQ(c.send("&1E\r"), "\x06");
  EXPECT_EQ(c.line("E5"), "ERR003");
  fake_hal_stop_clocks(true);
  for (int i = 0; i < 20000; ++i) (void)hal_cycles();
  EXPECT_EQ(c.line("E"), "ERR018");
  fake_hal_stop_clocks(false);
}

TEST(HostExchange, ClockSourceIsDecimalInEveryReportMode) {
  BRICK_COVERS("I19-1");
  Controller c;
  EXPECT_EQ(c.send("I19\r"), "7007\r\x06");
  c.send("I9=3\r");
  EXPECT_EQ(c.send("I19\r"), "I19=7007\r\x06");
}

TEST(HostExchange, LockBitMakesAssignmentsSilentlyIneffective) {
  Controller c;
  EXPECT_EQ(c.line("I100"), "1");
  EXPECT_EQ(c.send("I41=1\r"), "\x06");
  EXPECT_EQ(c.send("I100=0\r"), "\x06");
  EXPECT_EQ(c.line("I100"), "1");
}

TEST(HostExchange, EachFramingStyle) {
  Controller c;
  c.send("P1=7\r");
  c.send("I3=0\r");
  EXPECT_EQ(c.send("P1\r"), "7\r");
  EXPECT_EQ(c.send("P2=1\r"), "");
  c.send("I3=1\r");
  EXPECT_EQ(c.send("P1 P1\r"), "\n7\r\n7\r\n");
  EXPECT_EQ(c.send("UUU\r"), "\x07\nERR003\r");
  c.send("I3=3\r");
  EXPECT_EQ(c.send("P1\r"), "\n7\r\x06");
}

TEST(HostExchange, EachErrorStyle) {
  Controller c;
  c.send("I6=0\r");
  EXPECT_EQ(c.send("UUU\r"), "\x07");
  c.send("I6=2\r");
  EXPECT_EQ(c.send("UUU\r"), "\x07");
  c.send("I6=3\r");
  EXPECT_EQ(c.send("UUU\r"), "\x07\rERR003\r");
}

TEST(HostExchange, ErrorDropsTheRestOfTheLineAndKeepsWhatWentBefore) {
  Controller c;
  EXPECT_EQ(c.send("P1=5 P1 UUU P1=6\r"),
            "5\r\x07"
            "ERR003\r");
  EXPECT_EQ(c.line("P1"), "5");
}

TEST(HostExchange, ChecksumsCountEveryByteOfALineInEachFraming) {
  Controller c;
  for_each_framing([&c](Framing framing, const std::string& set_up, const std::string& command,
                        const std::vector<std::string>& data) {
    c.send(set_up);
    EXPECT_EQ(c.send(command + "\r"), framed(framing, command, data)) << set_up << command;
  });
}

TEST(HostExchange, ControlNAnswersTheChecksumSoFar) {
  Controller c;
  EXPECT_EQ(c.send("J+\x0E"), "\x75");  // before its CR: 0x4A + 0x2B = 117
  EXPECT_EQ(c.send("\x18"), "\x18");
  EXPECT_EQ(c.send("j+\x0E"), "\x95") << "behind ^X too, of the bytes that were sent";
}

TEST(HostExchange, ControlIRepeatsTheLastLineAlone) {
  Controller c;
  EXPECT_EQ(c.send("P1=P1+1\r"), "\x06");
  EXPECT_EQ(c.send("P2=7\t"), "\x06") << "what was begun is forgotten";
  EXPECT_EQ(c.line("P1 P2"), "2|0");
}

TEST(HostExchange, ControlXEmptiesTheLineAndIsEchoed) {
  Controller c;
  EXPECT_EQ(c.send("P1=\x18"), "\x18");
  EXPECT_EQ(c.send("P2=3\r"), "\x06");
  c.send("I63=0\r");
  EXPECT_EQ(c.send("P1=\x18"), "");
}

unsigned waits;

TEST(HostExchange, HostThatDoesNotReadIsGivenUpAfterHalfASecond) {
  Controller c;
  waits = 0;
  fake_hal_set_look(0);  // no time but that of the waits
  fake_hal_on_wait([] {
    std::uint8_t unread = 0;
    if (++waits > 1000)  // so that a failure does not take minutes
      while (host_port_next_output(&unread)) {}
  });
  const std::string reply = c.send("P0..8191\r");
  fake_hal_on_wait(nullptr);
  EXPECT_GE(waits, 500u) << "of a millisecond each";
  EXPECT_LE(waits, 502u) << "once, not for every character";
  EXPECT_EQ(reply.substr(0, 4), "0\r0\r") << "what was queued stays";
  EXPECT_LT(reply.size(), 8192u * 2u);
  EXPECT_EQ(c.send("VER\r"), "1.947\r\x06");
}

TEST(HostExchange, ControlXEndsALongReply) {
  Controller c;
  waits = 0;
  fake_hal_on_wait([] {
    if (++waits == 3) host_port_character(0x18);
  });
  EXPECT_EQ(c.send("P0..8191\r"), "\x18") << "queue emptied, rest dropped, no acknowledge";
  fake_hal_on_wait(nullptr);
  EXPECT_EQ(waits, 3u);
  EXPECT_EQ(c.send("VER\r"), "1.947\r\x06");
}

TEST(HostExchange, BackspaceTakesTheLastCharacter) {
  Controller c;
  c.send(
      "P1=12\x08"
      "3\r");
  EXPECT_EQ(c.line("P1"), "13");
  EXPECT_EQ(c.send("p1=4 \"\x08p1\r"), "4\r\x06") << "a quote that is taken back quotes nothing";
}

TEST(HostExchange, ControlCharactersActInsideALine) {
  fake_interrupts_leave_time();
  Controller c;
  EXPECT_EQ(c.send("P1=\x07"
                   "4\r"),
            "000000000800\r\x06\x06");
  EXPECT_EQ(c.line("P1"), "4");
}

TEST(HostExchange, ControlAStopsCoordinateSystemsBeyondI68Too) {
  Controller c;
  EXPECT_EQ(c.line("&9 DEF ROT 20"), "");
  EXPECT_EQ(c.line("B0 R"), "");
  EXPECT_EQ(c.line("??").substr(5, 1), "1");  // program running
  c.line("I68=3");
  EXPECT_EQ(c.send("\x01"), "");
  EXPECT_EQ(c.line("??").substr(5, 1), "0");
}

// Characters as the port's interrupt takes them, while the background is at something else.
void put(const std::string& characters) {
  for (const char c : characters) fake_host_input(static_cast<std::uint8_t>(c));
  while (fake_host_input_waits() &&
         (fake_task_take(FAKE_HOST) || (host_port_held != 0 && fake_task_take(FAKE_PHASE)))) {}
}

// 256 lines are 2048 characters: a queue is full (host-bus:8.7/2).
std::string full_queue() {
  std::string lines;
  for (int i = 0; i < 256; ++i) lines += "P1=P1+1\r";
  return lines;
}

// Two characters wait in the port when it comes: three servo interrupts are 1.3 ms, of which the first takes both.
TEST(HostExchange, FullQueueLetsControlAActSoon) {
  Controller c;
  ASSERT_EQ(c.line("&1 DEF ROT 20"), "");
  ASSERT_EQ(c.line("B0 R"), "");
  put(full_queue() + "P2");
  EXPECT_TRUE(fake_host_input_waits());
  c.servo(1);
  put("");
  EXPECT_FALSE(fake_host_input_waits()) << "the port is free again";
  fake_host_input(0x01);
  c.servo(1);
  put("");
  EXPECT_TRUE(fake_task_take(FAKE_REAL_TIME)) << "it was asked for";
  EXPECT_FALSE(run_is_running(0)) << "before the background has done anything";
  put("=P2+1\r");
  while (fake_host_input_waits()) {
    c.send("");
    put("");
  }
  c.send("");
  EXPECT_EQ(c.line("P1"), "256") << "nothing is lost";
  EXPECT_EQ(c.line("P2"), "1");
}

TEST(HostExchange, FullQueueTakesTwoCharactersAServoInterruptInOrder) {
  Controller c;
  std::string more;
  for (int i = 0; i < 400; ++i) more += "P2=P2*3%1000003+" + std::to_string(i) + "\r";
  put(full_queue() + more);
  std::uint32_t taken = host_port_received_count - host_port_taken_count;
  EXPECT_EQ(taken, 2048u);
  for (; taken + 2 <= 8192; taken += 2) {
    ASSERT_EQ(host_port_received_count - host_port_taken_count, taken);
    c.servo(1);
    put("");
  }
  c.servo(3);
  put("");
  EXPECT_EQ(host_port_received_count - host_port_taken_count, 8192u) << "the reserve is full, too";
  while (fake_host_input_waits() || host_port_waiting()) {
    c.send("");
    put("");
  }
  double expected = 0.0;
  for (int i = 0; i < 400; ++i) expected = std::fmod(expected * 3.0, 1000003.0) + i;
  EXPECT_EQ(c.line("P1"), "256");
  EXPECT_EQ(std::stod(c.line("P2")), expected);
}

TEST(HostExchange, FullQueueIsEmptiedByControlX) {
  Controller c;
  put(full_queue() + "\x18");
  c.servo(1);
  put("");
  EXPECT_EQ(c.send(""), "\x18");
  put("P2=3\r");
  EXPECT_EQ(c.send(""), "\x06");
  EXPECT_EQ(c.line("P1"), "0");
  EXPECT_EQ(c.line("P2"), "3");
}

TEST(HostExchange, LineFeedsAndCommentsAreIgnored) {
  Controller c;
  EXPECT_EQ(c.send("P1=8\r\n"), "\x06");
  EXPECT_EQ(c.line("P1 ; what is P1=9"), "8");
}

TEST(HostExchange, LinesEndAt255Characters) {
  Controller c;
  const std::string fits = "P1=" + std::string(251, '0') + "5";
  ASSERT_EQ(fits.size(), 255u);
  EXPECT_EQ(c.send(fits + "\r"), "\x06");
  EXPECT_EQ(c.line("P1"), "5");
  EXPECT_EQ(c.send("P1=" + std::string(252, '0') + "6\r"),
            "\x07"
            "ERR003\r");
  EXPECT_EQ(c.line("P1"), "5");
}

TEST(HostExchange, EightBitCharactersAreIllegal) {
  Controller c;
  EXPECT_EQ(c.send("P1=\xC4\r"),
            "\x07"
            "ERR004\r");
  EXPECT_EQ(c.send("P1=\x80\r"),
            "\x07"
            "ERR004\r");
  EXPECT_EQ(c.line("P1=" + std::string(253, '0') + "\xC4"), "ERR004") << "also behind the 255th";
  EXPECT_EQ(c.send("\x7F\r"),  // seven bits, and no command
            "\x07"
            "ERR003\r");
}

TEST(HostExchange, BareConstantGoesToP0) {
  Controller c;
  EXPECT_EQ(c.send("342\r"), "\x06");
  EXPECT_EQ(c.line("P0"), "342");
  c.send("$FF\r");
  EXPECT_EQ(c.line("P0"), "255");
  c.send("-2.5\r");
  EXPECT_EQ(c.line("P0"), "-2.5");
}

TEST(HostExchange, AddressesAreModalAndReported) {
  Controller c;
  EXPECT_EQ(c.line("& #"), "1|1");
  EXPECT_EQ(c.send("&16#32\r"), "\x06");
  EXPECT_EQ(c.line("&"), "16");
  EXPECT_EQ(c.line("#"), "32");
  EXPECT_EQ(c.line("&17"), "ERR003");
  EXPECT_EQ(c.line("#33"), "ERR003");
  c.line("I68=1");  // on one line `1 &3` would be an expression
  EXPECT_EQ(c.line("&3"), "ERR003");
}

TEST(HostExchange, SingleLetterCommandsMustStandAlone) {
  Controller c;
  EXPECT_EQ(c.line("A10"), "ERR005");    // an axis move, not an abort
  EXPECT_EQ(c.line("RAPID"), "ERR005");  // not `R`
  EXPECT_EQ(c.line("#2P"), "0");
}

TEST(HostExchange, CoordinateSystemStatusAtPowerOn) {
  Controller c;
  // Word 1: X, Y, Z feedrate axes, radius vector incremental. Word 2: in position.
  EXPECT_EQ(c.line("&1??").substr(0, 6), "A80020");
}

}  // namespace
}  // namespace brick
