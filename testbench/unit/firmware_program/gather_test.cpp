// Data gathering (firmware:4.3, host-bus:6.8): sources, packing, period, modes of I5000, commands and their errors. The
// servo counter X:$0 says at which interrupt a sample was taken.
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_program/dpram_host.h"

namespace {

using platform::host;
using platform::host_lines;
using platform::servo_ticks;
using Lines = std::vector<std::string>;

class Gather : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I3=2 I6=1 I9=0"), "");
  }
  static unsigned long count() { return std::stoul(host("RX$0")); }
  static std::string hex(unsigned long word) {
    char text[16];
    std::snprintf(text, sizeof text, "%06lX", word);
    return text;
  }
  static bool gathers() { return (std::stoul(host("???").substr(0, 6), nullptr, 16) >> 19 & 1) != 0; }
  std::uint32_t pointer() { return ram.read(DPRAM_GATHER_POINTER); }
  std::uint32_t item(unsigned place) { return dpram_read_item(DPRAM_OPEN + 4 * place); }

  platform::NativeDpram ram;
};

TEST_F(Gather, WordsFillXAndYInTurnInAscendingOrderOfTheSources) {
  ASSERT_EQ(host("WX$20,$123456 WY$20,$ABCDEF WY$22,$777"), "");
  ASSERT_EQ(host("I5001=$400000 I5003=$20 I5025=$400020 I5048=$800020 I5049=1"), "");
  ASSERT_EQ(host("I5050=$5 I5051=$800001 DEF GAT 100"), "");
  const unsigned long before = count();
  ASSERT_EQ(host("GATHER"), "");
  EXPECT_TRUE(gathers());
  servo_ticks(2);
  ASSERT_EQ(host("ENDGATHER"), "");
  EXPECT_FALSE(gathers());
  servo_ticks(2);
  // 24, 24 | 24 | 48 bits: three long words a sample.
  EXPECT_EQ(host_lines("LIST GATHER"), (Lines{hex(before + 1) + "ABCDEF", "123456000000", "123456ABCDEF",
                                              hex(before + 2) + "ABCDEF", "123456000000", "123456ABCDEF"}));
  EXPECT_EQ(host_lines("LIST GAT,3,1"), (Lines{hex(before + 2) + "ABCDEF"}));
  EXPECT_EQ(host("RHX$3120"), "1079C") << "$10800 - 100";
  EXPECT_EQ(host("RHY$3120"), "107A2");
}

// The period is from sample to sample, not to the one that an ended gathering would have taken.
TEST_F(Gather, GoesOnWithTheNextInterrupt) {
  ASSERT_EQ(host("I5001=$400000 I5050=1 I5049=10 DEF GAT 50"), "");
  const unsigned long before = count();
  ASSERT_EQ(host("GAT"), "");
  servo_ticks(3);
  ASSERT_EQ(host("END GATHER GAT"), "") << "firmware:4.3/10";
  servo_ticks(1);
  ASSERT_EQ(host("ENDG"), "");
  EXPECT_EQ(host_lines("LIST GATHER"), (Lines{hex(before + 1) + "000000", hex(before + 4) + "000000"}));
}

TEST_F(Gather, EachPeriodIsThatManyServoInterrupts) {
  for (const unsigned period : {1U, 2U, 10U}) {
    ASSERT_EQ(host("DEL GAT I5001=$400000 I5050=1 I5049=" + std::to_string(period) + " DEF GAT 50"), "");
    const unsigned long before = count();
    ASSERT_EQ(host("GAT"), "");
    servo_ticks(4 * period);
    ASSERT_EQ(host("ENDG"), "");
    Lines samples;
    for (unsigned i = 0; i < 4; ++i) samples.push_back(hex(before + 1 + i * period) + "000000");
    EXPECT_EQ(host_lines("LIST GATHER"), samples);
  }
}

TEST_F(Gather, APeriodOf0IsOneSampleForEachCommand) {
  ASSERT_EQ(host("I5001=$400000 I5050=1 I5049=0 DEF GAT 50"), "");
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(host("GATHER"), "");
    servo_ticks(5);
    EXPECT_FALSE(gathers());
  }
  EXPECT_EQ(host_lines("LIST GATHER").size(), 3U);
}

TEST_F(Gather, StopsAtTheEndOfTheBufferAndNotBehindIt) {
  ASSERT_EQ(host("DEF UBUF 10"), "");
  ASSERT_EQ(host("WX$107F6,$555555 I5001=$800000 I5002=$800000 I5050=3 I5049=1 DEF GAT 5"), "");
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(20);
  EXPECT_FALSE(gathers());
  EXPECT_EQ(host_lines("LIST GATHER").size(), 4U) << "two samples of two: a third does not fit";
  EXPECT_EQ(host("RHX$107F6"), "555555");
  ASSERT_EQ(host("ENDGATHER"), "");
  EXPECT_EQ(host("GATHER"), "ERR003") << "full";
  ASSERT_EQ(host("DEF GAT"), "") << "again from the beginning";
  EXPECT_EQ(host("LIST GATHER"), "ERR003");
  EXPECT_EQ(host("GATHER"), "");
  servo_ticks(1);
  EXPECT_EQ(host_lines("LIST GATHER").size(), 2U);
}

// Half a long word at its end is a whole one: three words of 24 bits take two.
TEST_F(Gather, ASampleThatEndsWithHalfAWordDoesNotGoBehindTheBuffer) {
  ASSERT_EQ(host("DEF UBUF 10"), "");
  ASSERT_EQ(host("WX$107F6,$555555 I5001=$400000 I5002=$400000 I5003=$400000 I5050=7 I5049=1 DEF GAT 5"), "");
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(20);
  EXPECT_FALSE(gathers());
  EXPECT_EQ(host_lines("LIST GATHER").size(), 4U);
  EXPECT_EQ(host("RHX$107F6"), "555555");
}

// 48 bits begin a long word of their own: 24, 48 take two, and 24 more a third.
TEST_F(Gather, ALongSourceTakesAWholeWordBetweenShortOnes) {
  ASSERT_EQ(host("DEF UBUF 10"), "");
  for (const char* size : {"4", "5"})
    for (const auto& [mask, lines] : {std::pair{"3", 4U}, std::pair{"7", 3U}}) {
      ASSERT_EQ(host("DEL GAT WX$107F6,$555555 I5001=$400000 I5002=$800020 I5003=$400000 I5049=1"), "");
      ASSERT_EQ(host(std::string("I5050=") + mask + " DEF GAT " + size + " GATHER"), "");
      servo_ticks(20);
      EXPECT_FALSE(gathers());
      EXPECT_EQ(host_lines("LIST GATHER").size(), lines) << mask << " in " << size;
      EXPECT_EQ(host("RHX$107F6"), "555555");
    }
}

// host-bus:6.8/5: DEFINE GATHER begins anew, and the pointers show it before anything is gathered.
TEST_F(Gather, PointersAreThoseOfABufferThatBeginsAnew) {
  for (const char* set_up : {"I5000=0", "I5000=2"}) {
    const bool in_ram = set_up[6] == '2';
    const std::string first = in_ram ? "60450" : "1079C";  // $10800 - 100
    ASSERT_EQ(host(std::string("DEL GAT I5001=$400000 I5050=1 I5049=1 ") + set_up), "");
    ram.write(DPRAM_GATHER_POINTER, 0x5555);
    ASSERT_EQ(host("DEF GAT 100"), "");
    EXPECT_EQ(host("RHX$3120 RHY$3120"), first + "|" + first) << set_up;
    EXPECT_EQ(pointer(), in_ram ? 0U : 0x5555U) << set_up;
    ASSERT_EQ(host("GATHER"), "");
    servo_ticks(10);
    ASSERT_EQ(host("ENDG"), "");
    EXPECT_NE(host("RHY$3120"), first);
    ASSERT_EQ(host("DEF GAT"), "");
    EXPECT_EQ(host("RHX$3120 RHY$3120"), first + "|" + first) << set_up;
    EXPECT_EQ(pointer(), in_ram ? 0U : 0x5555U) << set_up;
  }
}

// host-bus:6.2: what is not used is the user's. Its size is taken back of a buffer in the RAM alone.
TEST_F(Gather, TheSizeInTheRamIsThatOfABufferThere) {
  ASSERT_EQ(host("I5000=2 DEF GAT 7"), "");
  EXPECT_EQ(ram.read(DPRAM_GATHER_SIZE), 7);
  ASSERT_EQ(host("DEL GAT"), "");
  EXPECT_EQ(ram.read(DPRAM_GATHER_SIZE), 0);
  ram.write(DPRAM_GATHER_SIZE, 0x5A5A);
  ASSERT_EQ(host("DEL GAT"), "") << "nothing is defined";
  EXPECT_EQ(ram.read(DPRAM_GATHER_SIZE), 0x5A5A);
  for (const char* line : {"I5000=0 DEF GAT 7", "DEF GAT", "DEL GAT", "DEF GAT 7", "DELETE ALL"}) {
    ASSERT_EQ(host(line), "") << line;
    EXPECT_EQ(ram.read(DPRAM_GATHER_SIZE), 0x5A5A) << line;
  }
}

TEST_F(Gather, I5000Of1Wraps) {
  ASSERT_EQ(host("I5000=1 I5001=$400000 I5050=1 I5049=1 DEF GAT 4"), "");
  const unsigned long before = count();
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(6);
  EXPECT_TRUE(gathers());
  const auto at = [before](unsigned n) { return hex(before + n) + "000000"; };
  EXPECT_EQ(host_lines("LIST GATHER"), (Lines{at(5), at(6), at(3), at(4)}));
}

// I5052 and on are reserved.
TEST_F(Gather, I5050AndI5051AloneChoose) {
  ASSERT_EQ(host("I5052..5060=1 I5049=1 I5050=0 I5051=0 DEF GAT 20"), "");
  EXPECT_EQ(host("GATHER"), "ERR003");
  host_port_character(0x05);
  platform::background(1);
  EXPECT_EQ(platform::sent(), "\x06") << "^E";
  ASSERT_EQ(host("I5048=$400000 I5051=$800000"), "");
  const unsigned long before = count();
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(1);
  ASSERT_EQ(host("ENDG"), "");
  EXPECT_EQ(host_lines("LIST GATHER"), (Lines{hex(before + 1) + "000000"}));
}

// Items of 32 bits from $060450 on; the pointer is the next one's place.
TEST_F(Gather, IntoTheDualPortedRamUpToItsEnd) {
  ASSERT_EQ(host("WX$20,$FEDCBA WY$20,$123456"), "");
  ASSERT_EQ(host("I5000=2 I5001=$400000 I5002=$800020 I5003=$400020 I5050=$7 I5049=1 DEF GAT 6"), "");
  EXPECT_EQ(ram.read(DPRAM_GATHER_SIZE), 6);
  EXPECT_EQ(pointer(), 0U);
  EXPECT_EQ(host("SIZE"), "26624") << "no user memory";
  const unsigned long before = count();
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(1);
  EXPECT_EQ(pointer(), 4U);
  EXPECT_EQ(item(0), before + 1);
  EXPECT_EQ(item(1), 0x00123456U) << "low half first";
  EXPECT_EQ(item(2), 0xFFFEDCBAU) << "sign-extended";
  EXPECT_EQ(item(3), 0xFFFEDCBAU);
  servo_ticks(5);
  EXPECT_EQ(pointer(), 8U) << "a sample that begins in the buffer is whole";
  EXPECT_EQ(item(4), before + 2);
  EXPECT_FALSE(gathers());
  EXPECT_EQ(host("GATHER"), "ERR003");
  EXPECT_EQ(host("LIST GATHER"), "ERR003") << "the host reads it";
  EXPECT_EQ(host("RHX$3120 RHY$3120"), "60450|60458");
  ASSERT_EQ(host("DELETE GATHER"), "");
  EXPECT_EQ(ram.read(DPRAM_GATHER_SIZE), 0);
}

TEST_F(Gather, I5000Of3WrapsInTheDualPortedRam) {
  ASSERT_EQ(host("I5000=3 I5001=$400000 I5050=1 I5049=1 DEF GAT 4"), "");
  const unsigned long before = count();
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(6);
  EXPECT_EQ(pointer(), 2U);
  for (const unsigned n : {5U, 6U, 3U, 4U}) EXPECT_EQ(item((n - 1) % 4), before + n);
}

// The RAM that is fitted is the limit, whatever is asked for.
TEST_F(Gather, NoSampleGoesBeyondTheRam) {
  ASSERT_EQ(host("I5000=2 I5001=$400000 I5002=$800020 I5050=$3 I5049=1"), "");
  EXPECT_EQ(host("DEF GAT 15281"), "ERR006") << "$63FFF - $060450 + 1 = 15280";
  ASSERT_EQ(host("DEF GAT"), "");
  EXPECT_EQ(ram.read(DPRAM_GATHER_SIZE), 15280);
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(5200);
  EXPECT_EQ(pointer(), 15279U) << "5093 samples of 3; the last item stays free";
  EXPECT_FALSE(gathers());
  // Whatever its words are: of 48 bits two items, 24 bits one.
  ASSERT_EQ(host("I5001=$800020 I5002=$C00020 I5003=$800020 I5050=$7 DEF GAT"), "");
  ASSERT_EQ(host("GATHER"), "");
  servo_ticks(2600);
  EXPECT_EQ(pointer(), 15276U) << "2546 samples of 6";
  EXPECT_FALSE(gathers());
}

TEST_F(Gather, CommandsAndTheirErrors) {
  ASSERT_EQ(host("I5001=$400000 I5050=1 I5049=1"), "");
  EXPECT_EQ(host("GATHER"), "ERR003") << "no buffer";
  EXPECT_EQ(host("DEF GAT 0"), "ERR003");
  ASSERT_EQ(host("DEF GAT 1000"), "");
  EXPECT_EQ(host("&1DEF ROT 20"), "ERR003");
  ASSERT_EQ(host("I5050=0"), "");
  EXPECT_EQ(host("GATHER"), "ERR003") << "no source";
  ASSERT_EQ(host("I5050=1 GATHER GATHER"), "");
  EXPECT_EQ(host("DEF GAT"), "ERR003");
  EXPECT_EQ(host("DELETE GATHER"), "ERR003");
  ASSERT_EQ(host("ENDGATHER ENDGATHER DELETE GATHER"), "");
  EXPECT_EQ(host("GATHER"), "ERR003") << "what was there has gone";
  ASSERT_EQ(host("DEF GAT GATHER"), "");
  ASSERT_EQ(host("DELETE ALL TEMPS"), "") << "ends it";
  EXPECT_FALSE(gathers());
  EXPECT_EQ(host("SIZE"), "26624");
  ASSERT_EQ(host("DEF GAT 50 GATHER"), "");
  platform::reset();
  EXPECT_FALSE(gathers());
  EXPECT_EQ(host("GATHER"), "ERR003");
}

// host-bus:6.8/8: no board brings machine input 2 to the CPU, so nothing could ever begin.
TEST_F(Gather, ThereIsNoTriggerToWaitFor) {
  fake_interrupts_leave_time();
  ASSERT_EQ(host("I5001=$400000 I5050=1 I5049=1 DEF GAT 50"), "");
  for (const char* line : {"GATHER TRIGGER", "GAT TRIG", "GATHERTRIGGER"}) EXPECT_EQ(host(line), "ERR003") << line;
  servo_ticks(5);
  EXPECT_FALSE(gathers());
  EXPECT_EQ(host("??? RHY$3120"), "000000000800|" + host("RHX$3120"));
  EXPECT_EQ(host("GATHER"), "");
  EXPECT_TRUE(gathers());
}

// firmware:5.9/5: three bytes a word of 24 bits, the highest first, X before Y; in the order of the sources, whether
// something is gathered or not, and as I5050 and I5051 are now.
TEST_F(Gather, ControlEReportsTheSourcesInBinary) {
  const auto control_e = [] {
    host_port_character(0x05);
    platform::background(1);
    return platform::sent();
  };
  EXPECT_EQ(control_e(), "\x06") << "none is chosen";
  ASSERT_EQ(host("WX$20,$123456 WY$20,$ABCDEF WX$21,$818283 WY$21,$000D06"), "");
  ASSERT_EQ(host("I5001=$20 I5002=$400020 I5003=$400021 I5025=$800021 I5048=$C00020"), "");
  ASSERT_EQ(host("I5050=$5"), "");
  const std::string y20 = "\xAB\xCD\xEF", x20 = "\x12\x34\x56", x21 = "\x81\x82\x83",
                    y21 = std::string("\0\x0D\x06", 3);
  EXPECT_EQ(control_e(), y20 + x21 + "\x06");
  ASSERT_EQ(host("I5050=$2 I5051=$800001"), "");
  EXPECT_EQ(control_e(), x20 + x21 + y21 + x20 + y20 + "\x06");
  ASSERT_EQ(host("I3=0"), "");
  EXPECT_EQ(control_e(), x20 + x21 + y21 + x20 + y20) << "no handshake";
  ASSERT_EQ(host("I3=2 I5049=1 DEF GAT 50 GATHER I5050=$1 I5051=0"), "");
  servo_ticks(1);
  EXPECT_EQ(control_e(), y20 + "\x06");
  EXPECT_EQ(host_lines("LIST GATHER")[0], "123456000000") << "what is gathered is as it was at GATHER";
}

// What is made when it is read is made for a sample too; what is not there reads 0.
TEST_F(Gather, LiveWordsAndAddressesOfNothing) {
  ASSERT_EQ(host("I5001=$402040 I5002=$7FFFF I5003=$40780F I5050=7 I5049=1 DEF GAT 50 GATHER"), "");
  servo_ticks(1);
  EXPECT_EQ(host("LIST GATHER").substr(0, 12), host("&1??").substr(0, 6) + "000000");
}

// A sample an interrupt, wherever it comes: in order, none lost, both halves of one moment.
TEST_F(Gather, SamplesAreConsecutiveWhateverIsDoneMeanwhile) {
  ASSERT_EQ(host("I5001=$400000 I5002=$800000 I5050=3 I5049=1 DEF GAT 4000 GATHER"), "");
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(host("P1=P1+1"), "");
    ASSERT_EQ(host("&1%"), "100");
    platform::background(1);
    servo_ticks(1);
  }
  ASSERT_EQ(host("ENDGATHER"), "");
  const Lines lines = host_lines("LIST GATHER");
  ASSERT_GE(lines.size(), 60U);
  const unsigned long first = std::stoul(lines[0].substr(0, 6), nullptr, 16);
  for (std::size_t i = 0; i < lines.size(); i += 2) {
    EXPECT_EQ(lines[i], hex(first + i / 2) + "000000") << i;
    EXPECT_EQ(lines[i + 1].substr(0, 6), hex(first + i / 2)) << i;
  }
}

// 48 sources: the most, in both places.
TEST_F(Gather, FortyEightSources) {
  for (int i = 1; i <= 48; ++i) ASSERT_EQ(host("I" + std::to_string(5000 + i) + "=$800000"), "");
  ASSERT_EQ(host("I5050=$FFFFFF I5051=$FFFFFF I5049=1 DEF GAT 96 GATHER"), "");
  servo_ticks(3);
  EXPECT_EQ(host_lines("LIST GATHER").size(), 96U);
  ASSERT_EQ(host("DEL GAT I5000=2 DEF GAT GATHER"), "");
  servo_ticks(2);
  EXPECT_EQ(pointer(), 192U);
}

}  // namespace
