// The image itself: start-up time, cost of an idle second, tasks, and survival without clocks.
#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/framing.h"
#include "testbench/unit/firmware_platform/image_board.h"

namespace brick {
namespace {

class Image : public ::testing::Test {
 protected:
  void SetUp() override { board.fill_memory(0x5A5A5A); }  // memory holds anything at power-on
  ImageBoard board{firmware_image(), 0x3};
};

TEST_F(Image, FirstReplyComesWithin20Milliseconds) {
  BRICK_COVERS("CARD-3");
  EXPECT_EQ(board.send("I6=1 I3=2 VER\r"), "1.947\r\x06");
  EXPECT_LT(board.now_ms(), 20.0);
  RecordProperty("first_reply_us", static_cast<int>(board.now_ms() * 1000));
}

// The hardware watchdog allows 25 ms from reset to the first servo edge, and 25 ms between strobes (docs/watchdog.md).
TEST_F(Image, StartUpStaysWithinTheHardwareWatchdog) {
  BRICK_COVERS("WDT-2");
  board.send("I6=1 I3=2\r");
  EXPECT_GT(board.clocks_started_ms(), 0.0);
  EXPECT_LT(board.clocks_started_ms(), 15.0);
  EXPECT_LT(board.longest_strobe_gap_ms(), 15.0);
  board.send("I100..3299=1\r", 2000.0);  // as much to restore as there can be
  board.send("P0..8191=1.5\r", 2000.0);
  board.send("I19=7007 I5=3 SAVE\r", 2000.0);
  board.reset();
  board.send("I6=1 I3=2\r");
  EXPECT_GT(board.clocks_started_ms(), 0.0);
  EXPECT_LT(board.clocks_started_ms(), 15.0);
  EXPECT_LT(board.longest_strobe_gap_ms(), 15.0);
}

TEST_F(Image, ChecksumsCountEveryByteOfALineInEachFraming) {
  const auto exchange = [this](const std::string& characters) {
    std::string reply = board.send(characters, 5.0), more;
    while (!(more = board.send("", 2.0)).empty()) reply += more;  // send() ends at an ACK, which a checksum follows
    return reply;
  };
  board.run_ms(20.0);  // it is up by then
  for_each_framing([&exchange](Framing framing, const std::string& set_up, const std::string& command,
                               const std::vector<std::string>& data) {
    exchange(set_up);
    EXPECT_EQ(exchange(command + "\r"), framed(framing, command, data)) << set_up << command;
  });
}

// Each of the 2258.7 servo interrupts works out the eight entries of the default conversion table, from three words of
// a channel each (motion:2.2, method $0): 45 instructions an entry beside the 2,200,000 of all else.
TEST_F(Image, IdleSecondCostsLessThan3000000Instructions) {
  board.send("I6=1 I3=2\r");
  board.send("CHECKSUM\r");  // else the background would add the image up in this second
  const std::uint64_t instructions = board.instructions(), accesses = board.device_accesses();
  board.run_ms(1000.0);
  EXPECT_LT(board.instructions() - instructions, 3'000'000u);
  // Beside the table nothing but a watchdog strobe and a look at the header of a binary buffer goes to a device in each
  // real-time interrupt, of which there are 2258.7 / 3 a second.
  EXPECT_NEAR(static_cast<double>(board.device_accesses() - accesses), 2 * 752.9 + 8 * 3 * 2258.7, 6.0 + 8 * 3);
  RecordProperty("instructions", static_cast<int>(board.instructions() - instructions));
}

TEST_F(Image, ServoCounterAndTimersFollowTheServoClock) {
  board.send("I6=1 I3=2 I5111=2000\r");
  const std::uint32_t before = board.word(true, 0);
  board.run_ms(100.0);
  EXPECT_NEAR(board.word(true, 0) - before, 225.9, 1.0);  // 2.2587 kHz
  const std::string timer = board.send("I5111\r");
  EXPECT_NEAR(std::stoi(timer), 2000 - 226, 3);
}

TEST_F(Image, DateAndTimeFollowTheCpuClockAndTheImageHasAChecksum) {
  board.send("I6=1 I3=2\r");
  EXPECT_EQ(board.send("TODAY TIME\r"), "SAT 01/01/2000\r00:00:00\r\x06");
  board.send("TODAY=12/31/2027 TIME=23:59:58\r");
  board.run_ms(2100.0);
  EXPECT_EQ(board.send("TODAY TIME\r"), "SAT 01/01/2028\r00:00:00\r\x06");
  // Code and constants, as the file has them: the sum of their words, 24 bits (firmware:6.2).
  const ElfFile image(firmware_image());
  const std::uint32_t begin = image.symbol("__code_start").value(), end = image.symbol("__code_end").value();
  std::uint32_t sum = 0, words = 0;
  for (const auto& segment : image.segments())
    for (std::uint32_t at = 0; at + 4 <= segment.data.size(); at += 4) {
      std::uint32_t word;
      std::memcpy(&word, &segment.data[at], 4);
      if (segment.address + at < begin || segment.address + at >= end) continue;
      sum += word;
      ++words;
    }
  EXPECT_EQ(4 * words, end - begin);
  EXPECT_GT(words, 10000u) << "more than 40 KB of code";
  std::ostringstream text;
  text << std::hex << std::uppercase << (sum & 0xFFFFFFu);
  const double asked = board.now_ms();
  EXPECT_EQ(board.send("CHECKSUM\r"), text.str() + "\r\x06");
  EXPECT_LT(board.now_ms() - asked, 0.3) << "four cycles a word, all at once, would be 1.5 ms";
  board.reset();
  board.send("I6=1 I3=2\r");
  EXPECT_EQ(board.send("CHECKSUM\r"), text.str() + "\r\x06") << "before the background had time";
}

TEST_F(Image, BackgroundReloadsTheWatchdogCounter) {
  board.send("I6=1 I3=2 I40=100\r");
  board.run_ms(100.0);
  EXPECT_GT(board.word(false, 0x25), 95u);  // Y:$25
  EXPECT_LE(board.word(false, 0x25), 100u);
}

TEST_F(Image, RareRealTimeInterruptsDoNotStarveTheHardwareWatchdog) {
  board.send("I6=1 I3=2 I8=255\r");  // 256 servo cycles are 113 ms, the hardware allows 25
  board.run_ms(400.0);
  EXPECT_LT(board.longest_strobe_gap_ms(), 15.0);
  EXPECT_EQ(board.send("???\r"), "000000000800\r\x06");
}

TEST_F(Image, WatchdogReloadOfOneServoCycleIsKeptUp) {
  board.send("I6=1 I3=2 I40=1\r");
  board.run_ms(100.0);
  EXPECT_LT(board.longest_strobe_gap_ms(), 15.0);
  EXPECT_LE(board.word(true, 0x25), 1u) << "X:$25, lowest value: not below zero";
}

// An edge latched during start-up must not be served so late that the next one finds its task still at work.
TEST_F(Image, NoAlignmentOfTheClocksToTheStartUpIsAServoError) {
  for (Cycle ahead = 0; ahead < 4 * ImageBoard::kPhaseCycles; ahead += 120) {
    board.reset(ahead);
    board.run_ms(14.0);
    ASSERT_EQ(board.word(true, 6) & 1u << 20, 0u) << ahead;  // X:$6, first global status word
  }
}

// All motors commutated every other phase interrupt of 9 kHz: dear, but every other task keeps its rate.
TEST_F(Image, AllMotorsCommutatedLeaveTimeForTheOtherTasks) {
  board.send("I6=1 I3=2 I7=1\r");
  for (int motor = 1; motor <= 32; ++motor) {
    const std::string first = "I" + std::to_string(motor) + "0";
    board.send(first + "0=1 " + first + "1=1 " + first.substr(0, first.size() - 1) + "71=3\r");
  }
  const std::uint32_t before = board.word(true, 0);
  board.run_ms(100.0);
  EXPECT_NEAR(board.word(true, 0) - before, 225.9, 1.0);
  EXPECT_LT(board.longest_strobe_gap_ms(), 15.0);
  const std::uint32_t duration = board.word(true, 0x37);  // X:$37, half cycles
  EXPECT_GT(duration, 32u * 10u);
  EXPECT_LT(duration, 8705u / 2u * 3u / 4u) << "three quarters of a phase period, every other";
  RecordProperty("half_cycles", static_cast<int>(duration));
  EXPECT_EQ(board.send("I101..3201=0 ???\r", 1000.0), "000000000800\r\x06");
}

TEST_F(Image, LongReportsArriveComplete) {
  board.send("I6=1 I3=2\r");
  const std::string reply = board.send("I0..8191\r", 4000.0);
  EXPECT_EQ(std::count(reply.begin(), reply.end(), '\r'), 8192);
  EXPECT_EQ(reply.back(), '\x06');
  EXPECT_EQ(board.send("???\r"), "000000000800\r\x06");
}

TEST_F(Image, CommandsAreAnsweredWithoutAnyClock) {
  BRICK_COVERS("I19-2");
  board.set_clocks(false);
  EXPECT_EQ(board.send("I6=1 I3=2 VER\r"), "1.947\r\x06");
  EXPECT_EQ(board.send("???\r"), "000008000800\r\x06");
  // The servo task runs from the cycle counter, so that timers and the watchdog go on.
  const std::uint32_t before = board.word(true, 0);
  const std::uint64_t strobes = board.strobes();
  board.run_ms(100.0);
  EXPECT_NEAR(board.word(true, 0) - before, 225.9, 3.0);
  EXPECT_NEAR(static_cast<double>(board.strobes() - strobes), 75.3, 2.0);
}

TEST_F(Image, LosingTheClocksAtRunTimeIsNoticed) {
  BRICK_COVERS("I19-2");
  board.send("I6=1 I3=2\r");
  EXPECT_EQ(board.send("???\r"), "000000000800\r\x06");
  board.send("I7007=3\r");
  board.set_clocks(false);
  board.run_ms(3.0);
  EXPECT_EQ(board.send("???\r"), "000008000800\r\x06");
  board.send("I7007=0\r");
  board.set_clocks(true);
  board.run_ms(3.0);
  EXPECT_EQ(board.send("???\r"), "000000000800\r\x06");
}

TEST_F(Image, PointerIntoNothingDoesNotStopTheController) {
  board.send("I6=1 I3=2 M1->X:$050000,0,24\r");
  EXPECT_EQ(board.send("M1=5\r"), "\x06");
  EXPECT_EQ(board.send("M1\r").back(), '\x06');
  EXPECT_EQ(board.send("VER\r"), "1.947\r\x06");
}

TEST_F(Image, SavedValuesSurviveTheResetLine) {
  board.send("I6=1 I3=2 I17=25 P3=4.5\r");
  EXPECT_EQ(board.send("SAVE\r", 1000.0), "\x06");
  board.reset();
  board.fill_memory(0x123456);
  EXPECT_EQ(board.send("I17 P3\r", 1000.0).substr(0, 9), "25\r4.5\r\x06");
}

}  // namespace
}  // namespace brick
