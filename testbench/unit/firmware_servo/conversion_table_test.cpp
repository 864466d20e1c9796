// The encoder conversion table against motion:2: its check vectors, and every method worked out from its row.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/motion/conversion_table.h"
}

namespace brick {
namespace {

constexpr std::uint32_t kTable = 0x3501, kChannel = 0x78000, kFree = 0x10F0;
constexpr std::uint32_t kDown = 1, kTurned = 0x800000, kCaptured = 0x800;

class ConversionTable : public ::testing::Test {
 protected:
  void table(const std::string& lines) {
    c_.line("I8000..8191=0");
    std::string text;
    std::size_t begin = 0;
    for (int number = 8000; begin < lines.size(); ++number) {
      const std::size_t end = std::min(lines.find(' ', begin), lines.size());
      text += "I" + std::to_string(number) + "=$" + lines.substr(begin, end - begin) + " ";
      begin = end + 1;
    }
    EXPECT_EQ(c_.line(text), "");
  }
  static std::uint32_t result(std::uint32_t line) { return *hal_x(kTable + line) & HAL_WORD_MASK; }
  static std::int32_t signed_result(std::uint32_t line) { return hal_signed(result(line)); }
  static void x(std::uint32_t address, std::int64_t value) {
    *hal_x(address) = static_cast<std::uint32_t>(value) & HAL_WORD_MASK;
  }
  static void y(std::uint32_t address, std::int64_t value) {
    *hal_y(address) = static_cast<std::uint32_t>(value) & HAL_WORD_MASK;
  }
  static void channel(std::int64_t counts, bool down, std::uint32_t between, std::uint32_t since) {
    x(kChannel + 2, counts * 2 + (down ? kDown : 0));
    y(kChannel, between);
    y(kChannel + 1, since);
  }
  static std::int32_t once(std::uint32_t line) {
    conversion_table_servo();
    return signed_result(line);
  }

  Controller c_;
};

TEST_F(ConversionTable, DefaultsFollowTheChannels) {
  EXPECT_EQ(c_.line("I8000 I8007 I8008 I103 I104 I803"), "$78000|$78118|$0|$3501|$3501|$3508");
  x(0x78118 + 2, 2 * 5);
  conversion_table_servo();
  EXPECT_EQ(signed_result(7), 5 * 32);
}

// Counter*32 and the part of a count that time tells, on the way that the counter moves.
TEST_F(ConversionTable, SoftwareTime) {
  table("078000");
  channel(100, false, 640, 0);
  EXPECT_EQ(once(0), 3200);
  channel(100, false, 640, 320);
  EXPECT_EQ(once(0), 3216);
  channel(100, false, 640, 639);
  EXPECT_EQ(once(0), 3231);
  channel(100, false, 640, 640);
  EXPECT_EQ(once(0), 3231) << "below 1";
  channel(100, false, 640, 641);
  EXPECT_EQ(once(0), 3200) << "slower than before: nothing is known";
  channel(100, true, 640, 320);
  EXPECT_EQ(once(0), 3184);
  channel(-1, true, 640, 320);
  EXPECT_EQ(once(0), -48);
  channel(100, true, 640 | kTurned, 320);
  EXPECT_EQ(once(0), 3200) << "turned round";
  channel(100, false, kTurned, 0x400000);
  EXPECT_EQ(once(0), 3200) << "at once";
  channel(100, false, 0, 0);
  EXPECT_EQ(once(0), 3200);
  channel(100, false, 0x7FFFFF, 0x400000);
  EXPECT_EQ(once(0), 3216);
}

TEST_F(ConversionTable, CountersWithAndWithoutTheFractionOfTheIC) {
  table("C78000 CF8000 878000");
  channel(-7, true, 0, 0);
  y(kChannel + 1, 0xABC000);
  x(kChannel, 0x5FFFFF);
  conversion_table_servo();
  EXPECT_EQ(signed_result(0), -7 * 32);
  EXPECT_EQ(signed_result(1), -7 * 32 + (0xABC >> 7));
  EXPECT_EQ(signed_result(2), -7 * 32 + (0x5FFFFF >> 19));
}

TEST_F(ConversionTable, AnalogWordsHaveTheirLowestBitIn5) {
  table("178005 1F8005");
  y(kChannel + 5, 0x8000FF);
  conversion_table_servo();
  EXPECT_EQ(signed_result(0), -32768 * 32);
  EXPECT_EQ(signed_result(1), 32768 * 32);
  y(kChannel + 5, 0x000100);
  conversion_table_servo();
  EXPECT_EQ(signed_result(0), 32);
  EXPECT_EQ(signed_result(1), 32);
}

// Bias of 5 converter bits: 1280.
TEST_F(ConversionTable, IntegratedAnalogWords) {
  c_.line("I8000=$578005 I8001=1280 I8002=$5F8005 I8003=1280 I8004=0");
  y(kChannel + 5, 7 << 8);
  EXPECT_EQ(once(1), 2 * 32);
  EXPECT_EQ(signed_result(3), 2 * 32);
  EXPECT_EQ(once(1), 4 * 32);
  y(kChannel + 5, 1 << 8);
  EXPECT_EQ(once(1), 0);
  EXPECT_EQ(signed_result(3), 4 * 32) << "not below 0 after the bias";
}

// The bias has 1/256 of a converter bit: (7 - 5 - 1/256) bits of 32, eight times, less 2^-3 at most.
TEST_F(ConversionTable, IntegratedAnalogWordsLoseNothing) {
  c_.line("I8000=$578005 I8001=1281 I8002=$5F8005 I8003=1281 I8004=0");
  y(kChannel + 5, 7 << 8);
  for (int n = 1; n <= 16; ++n) {
    EXPECT_EQ(once(1), 511 * n / 8) << n;
    EXPECT_EQ(signed_result(3), 511 * n / 8) << n;
  }
  c_.line("I8001=$FFFB00 I8003=$FFFB00");  // -5 bits; a new line begins at 0
  y(kChannel + 5, -(7 << 8));
  EXPECT_EQ(once(1), (-7 + 5) * 32);
  EXPECT_EQ(signed_result(3), (65536 - 7 + 5) * 32);
}

TEST_F(ConversionTable, ParallelWordsRollOver) {
  table("2010F0 00C004 2810F0 00C004 6010F0 00C014");  // 12 bits from bit 4; from bit 20 on into X
  y(kFree, 0xFFF0);
  x(kFree, 0x0000FF);
  conversion_table_servo();
  EXPECT_EQ(signed_result(1), 0xFFF * 32);
  EXPECT_EQ(signed_result(3), 0xFFF);
  EXPECT_EQ(signed_result(5), 0xFF0 * 32);
  y(kFree, 0xF0002F);
  conversion_table_servo();
  EXPECT_EQ(signed_result(1), (0xFFF + 3) * 32) << "2 is 3 behind 4095";
  EXPECT_EQ(signed_result(3), 0xFFF + 3);
  EXPECT_EQ(signed_result(5), 0xFFF * 32);
}

// The next word is the upper half for $2 and $3.
TEST_F(ConversionTable, ParallelWordsReachIntoTheNextAddress) {
  table("2810F0 018010");
  y(kFree, 0xAB0000);
  y(kFree + 1, 0x00CDEF);
  EXPECT_EQ(once(1), hal_signed(0xCDEFAB));
  table("2810F0 018000");
  EXPECT_EQ(once(1), hal_signed(0xAB0000)) << "24 bits from 0";
  y(kFree + 1, 0xCDEF01);
  table("2810F0 00C00D");
  EXPECT_EQ(once(1), 0xAB0000 >> 13 | 0x800) << "the last of 12 bits is the first of the next word";
  table("2810F0 002017");
  EXPECT_EQ(once(1), 3) << "the last bit and the first of the next word";
  table("2810F0 00801C");
  EXPECT_EQ(once(1), 0xF0) << "8 bits from bit 4 of the next word";
  x(kFree, 0x654321);
  table("6810F0 00C01C 7810F0 00C01C FFFFFF");
  EXPECT_EQ(once(1), 0x432);
  EXPECT_EQ(signed_result(4), 0x432) << "of X, for $7 too";
  table("2810F0 001080");
  EXPECT_EQ(once(1), 0) << "bits that are not there";
  table("2810F0 018000");
  EXPECT_NE(once(1), 0);
  table("2810F0 019000");
  EXPECT_EQ(once(1), 0) << "25 bits are more than a result has";
}

// Rules 4 and 5: 1 to $18 bits from bit $2F at most; other numbers are no bits.
TEST_F(ConversionTable, ParallelWordsHaveBitsThatAreThere) {
  const struct {
    const char* line;
    std::int32_t result;
  } cases[] = {{"001000", 1}, {"018000", 0xFFFFFF}, {"00102F", 1}, {"000000", 0}, {"019000", 0},
               {"100000", 0}, {"101000", 0},        {"001030", 0}, {"001100", 0}, {"FFF000", 0}};
  for (const auto& c : cases)
    for (const char* method : {"2810F0 ", "6810F0 "}) {
      table(std::string(method) + c.line);
      for (const std::uint32_t address : {kFree, kFree + 1}) {
        x(address, 0xFFFFFF);
        y(address, 0xFFFFFF);
      }
      conversion_table_servo();
      EXPECT_EQ(static_cast<std::int32_t>(result(1)), c.result) << method << c.line;
    }
}

TEST_F(ConversionTable, ALimitedStepCatchesUp) {
  table("3810F0 010000 00000A 7810F0 010000 00000A");
  conversion_table_servo();
  y(kFree, 25);
  EXPECT_EQ(once(2), 10);
  EXPECT_EQ(signed_result(5), 10);
  EXPECT_EQ(once(2), 20);
  EXPECT_EQ(once(2), 25);
  y(kFree, 0xFFF0);  // 16 back and 25: 41 down
  EXPECT_EQ(once(2), 15);
  for (int i = 0; i < 4; ++i) conversion_table_servo();
  EXPECT_EQ(signed_result(2), -16);
}

// A change has no sign: $FFFFFF is more than any source can move.
TEST_F(ConversionTable, TheMostChangeIsAMagnitude) {
  table("3810F0 018000 FFFFFF D010F0 FFFFFF 400000");
  conversion_table_servo();
  EXPECT_EQ(once(2), 0);
  EXPECT_EQ(signed_result(5), 0);
  y(kFree, 5000000);
  x(kFree, 5000000);
  EXPECT_EQ(once(2), 5000000);
  EXPECT_EQ(signed_result(5), 2500000);
  EXPECT_EQ(once(2), 5000000);
  EXPECT_EQ(signed_result(5), 3750000);
}

// Tf = 0: K = 2^23, the result is the source.
TEST_F(ConversionTable, AFilterWithoutATimeFollowsAtOnce) {
  table("D010F0 7FFFFF 800000");
  conversion_table_servo();
  for (const int value : {100, -100, 8000000}) {
    x(kFree, value);
    EXPECT_EQ(once(2), value);
  }
}

// What the motor follows counts down as it counts up.
TEST_F(ConversionTable, AFilterLimitsStepsBothWays) {
  table("D010F0 000064 7FFFFF");
  conversion_table_servo();
  x(kFree, 350);
  for (const int value : {100, 200, 300, 350, 350}) EXPECT_NEAR(once(2), value, 1);
  x(kFree, 0);
  for (const int value : {250, 150, 50, 0, 0}) EXPECT_NEAR(once(2), value, 1);
}

// Largest gains and steps, for long: it goes round, and nothing overflows (sanitizers).
TEST_F(ConversionTable, ATrackingFilterIsBounded) {
  table("D810F0 FFFFFF FFFFFF 000000 FFFFFF");
  for (int n = 0; n < 2000; ++n) {
    x(kFree, n % 3 * 8388607);
    conversion_table_servo();
  }
  table("D810F0 7FFFFF 100000 000000 7FFFFF");
  conversion_table_servo();
  x(kFree, 8388607);
  for (int n = 0; n < 2000; ++n) conversion_table_servo();
}

// RTIF 256: SF = 2^17/256 = 512, so 256 ct/ms of 1/32 ct, a ms in a servo interrupt, are 2^23.
TEST_F(ConversionTable, TimeBase) {
  table("4010F0 000200");
  x(kFree, 1000);
  EXPECT_EQ(once(1), 0);
  EXPECT_EQ(signed_result(0), 1000);
  x(kFree, 1000 + 256 * 32 / 4);
  EXPECT_EQ(once(1), (1 << 23) / 4);
  x(kFree, 1000);
  EXPECT_EQ(once(1), -(1 << 23) / 4);
}

// RTIF 32: SF = 4096. At 100 ct/ms and 2.25 kHz it is 3.1 times what 2^23 holds of it: the end, not a turn (TU348).
TEST_F(ConversionTable, ATimeBaseThatIsTooFastIsAtItsEnd) {
  table("4010F0 001000");
  std::int64_t at = 0;
  x(kFree, at);
  once(1);
  for (const int counts : {31, 32, 44, 100, -31, -32, -44, -100}) {
    x(kFree, at += counts * 32);
    const std::int64_t rate = std::int64_t{2} * 4096 * counts * 32, most = (1 << 23) - 1;
    EXPECT_EQ(once(1), std::clamp(rate, -most, most)) << counts;
  }
  table("AF8000 000400");
  channel(0, false, 0, 0);
  once(1);
  channel(15, false, 0, 0);
  EXPECT_EQ(once(1), 512 * 1024 * 15);
  channel(15 + 17, false, 0, 0);
  EXPECT_EQ(once(1), (1 << 23) - 1);
}

TEST_F(ConversionTable, TriggeredTimeBase) {
  table("978000 000004");
  c_.line("I8000=$9F8000 I8001=16");
  channel(50, false, 0, 0);
  EXPECT_EQ(once(1), 0);
  c_.line("I8000=$BF8000");
  x(kChannel, 0);
  x(kChannel + 3, 60);
  channel(70, false, 0, 0);
  EXPECT_EQ(once(1), 0) << "waits for the capture";
  x(kChannel, kCaptured);
  EXPECT_EQ(once(1), 512 * 16 * (70 - 60)) << "from the captured position";
  EXPECT_EQ(signed_result(0), 70 * 256);
  channel(72, false, 640, 320);
  EXPECT_EQ(once(1), 512 * 16 * 2 + 256 * 16);
  c_.line("");
  EXPECT_EQ(c_.line("I8000"), "$AF8000") << "within a background pass";
  x(kChannel, 0);
  channel(73, false, 640, 320);
  EXPECT_EQ(once(1), 512 * 16) << "goes on when its line has changed";
  c_.line("I8000=$9F8000");
  EXPECT_EQ(once(1), 0);
  channel(-90, false, 0, 0);
  c_.line("I8000=$AF8000");
  EXPECT_EQ(once(1), 0) << "told to run: from where the counter is";
  channel(-95, false, 0, 0);
  EXPECT_EQ(once(1), -512 * 16 * 5);
  EXPECT_EQ(signed_result(0), -95 * 256);
  c_.line("I8000=$BF8000");
  EXPECT_EQ(once(1), 0) << "armed anew";
}

// Rule 17: without its trigger it begins where the counter is as well, of that source or of another.
TEST_F(ConversionTable, AnArmedTimeBaseThatIsToldToRun) {
  for (const std::uint32_t source : {0u, 1u, 8u}) {
    table("BF8000 000010");
    x(kChannel, 0);
    x(kChannel + 1, 0);
    x(kChannel + 8, 0);
    EXPECT_EQ(once(1), 0);
    x(kChannel + source + 2, 2 * 100);
    c_.line("I8000=$AF800" + std::to_string(source));
    EXPECT_EQ(once(1), 0) << source;
    x(kChannel + source + 2, 2 * 105);
    EXPECT_EQ(once(1), 512 * 16 * 5) << source;
  }
}

// motion:2.1/2: one that is taken away and put back is new, each time: it begins at its source.
TEST_F(ConversionTable, AnEntryThatComesBackIsNew) {
  table("C78000 D010F0 000001 000001");
  for (std::int64_t place = 1000; place < 9000; place += 1000) {
    x(kFree, place);
    c_.line("I8001=$D010F0");
    EXPECT_EQ(once(3), place);
    x(kFree, place + 500);
    EXPECT_LT(once(3), place + 500) << "slowly";
    c_.line("I8001=0");
    conversion_table_servo();
  }
}

// Entries behind one that waits for its trigger are worked out, and each of several shows that it has had it.
TEST_F(ConversionTable, SeveralTriggeredTimeBases) {
  table("BF8000 000010 BF8008 000020 2810F0 018000");
  x(kChannel, 0);
  x(kChannel + 8, 0);
  y(kFree, 4711);
  EXPECT_EQ(once(5), 4711);
  x(kChannel, kCaptured);
  x(kChannel + 8, kCaptured);
  conversion_table_servo();
  for (int n = 0; n < 3; ++n) c_.line("");
  EXPECT_EQ(c_.line("I8000 I8002"), "$AF8000|$AF8008");
}

// Tf = 7: K = 2^23/8 = 1048576.
TEST_F(ConversionTable, ExponentialFilter) {
  c_.line("I8000=$D010F0 I8001=4000 I8002=1048576 I8003=0");
  conversion_table_servo();
  x(kFree, 1000);
  double out = 0;
  for (int i = 0; i < 100; ++i) {
    out += (1000 - out) / 8;
    EXPECT_NEAR(once(2), out - 0.5, 0.52) << i;
  }
  EXPECT_GE(signed_result(2), 999);
  x(kFree, 9000);  // in steps of 4000
  double in = 1000;
  for (int i = 0; i < 30; ++i) {
    in = std::min(in + 4000, 9000.0);
    out += (in - out) / 8;
    EXPECT_NEAR(once(2), out - 0.5, 0.52) << i;
  }
}

// motion:2.2/18: what a step is rounded by is kept, and kept once. In 1/256 of the result a step of 1 with K = 3/4 is
// at 192, 240, 252, 255, 255 and 3/4, 256 and 1/2 less what the last one has left.
TEST_F(ConversionTable, AFilterKeepsWhatItRoundsOnce) {
  c_.line("I8000=$D010F0 I8001=4000 I8002=6291456 I8003=0");
  conversion_table_servo();
  x(kFree, 1);
  for (const int expected : {0, 0, 0, 0, 0, 1, 1}) EXPECT_EQ(once(2), expected);
  x(kFree, 0);
  for (int i = 0; i < 5; ++i) conversion_table_servo();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(once(2), 0);
}

// Tf = 1000: nothing is lost on the way, however slow it is.
TEST_F(ConversionTable, ASlowFilterArrives) {
  c_.line("I8000=$D010F0 I8001=8388607 I8002=8380 I8003=0");
  conversion_table_servo();
  x(kFree, 100);
  for (int i = 0; i < 20000; ++i) conversion_table_servo();
  EXPECT_GE(signed_result(2), 99);
  x(kFree, -100);
  for (int i = 0; i < 20000; ++i) conversion_table_servo();
  EXPECT_LE(signed_result(2), -99);
}

TEST_F(ConversionTable, TrackingFilter) {
  c_.line("I8000=$D810F0 I8001=100000 I8002=2097152 I8003=0 I8004=262144 I8005=0");
  conversion_table_servo();
  double out = 0, integral = 0;
  for (int i = 1; i < 200; ++i) {
    x(kFree, 50 * i);
    const double error = 50 * i - out;
    integral += error / 32;
    out += error / 4 + integral;
    EXPECT_NEAR(once(4), out - 0.5, 0.6) << i;
  }
  EXPECT_NEAR(out, 50 * 200, 1) << "at constant speed it is where the source will be next";
}

// $E00100 = L0+L1; $E20100 = L0-L1; $E50013 = -L19 (here -L1: $E50001).
TEST_F(ConversionTable, SumsAndDifferences) {
  table("2810F0 018000 2810F1 018000 E00301 E20301 E50003 E80301 E50013");
  y(kFree, 100);
  y(kFree + 1, 7);
  conversion_table_servo();
  EXPECT_EQ(signed_result(4), 107);
  EXPECT_EQ(signed_result(5), 93);
  EXPECT_EQ(signed_result(6), -7);
  EXPECT_EQ(signed_result(7), 107);
  conversion_table_servo();
  EXPECT_EQ(signed_result(7), 214) << "integrated";
  y(kFree, 0x7FFFFF - 7);
  conversion_table_servo();
  EXPECT_EQ(signed_result(7), hal_signed(214 + 0x7FFFFF)) << "the sum wraps as its word does";
  x(kTable + 19, 55);
  conversion_table_servo();
  EXPECT_EQ(signed_result(8), -55);
  table("E4C8C8");  // line 200
  x(kTable + 200, 55);
  EXPECT_EQ(once(0), 0) << "there is no such line";
}

// The table goes on behind each entry as its method says, and ends at a first line of 0.
TEST_F(ConversionTable, EntriesHaveTheirLines) {
  struct {
    const char* lines;
    unsigned length;
  } const entries[] = {{"078000", 1},
                       {"178005", 1},
                       {"2010F0 018000", 2},
                       {"3010F0 018000 000001", 3},
                       {"4010F0 000001", 2},
                       {"578005 000000", 2},
                       {"6010F0 018000", 2},
                       {"7010F0 018000 000001", 3},
                       {"878000", 1},
                       {"9F8000 000001", 2},
                       {"AF8000 000001", 2},
                       {"BF8000 000001", 2},
                       {"C78000", 1},
                       {"D010F0 000001 000001", 3},
                       {"D810F0 000001 000001 000000 000001", 5},
                       {"E00000", 1},
                       {"F78000 000000 000000", 3},
                       {"F78000 100000 000000 000000 000000", 5},
                       {"F78000 200000", 2},
                       {"F78000 300000 000000", 3},
                       {"F78000 400000 000000 000000", 4}};
  for (const auto& entry : entries) {
    table(std::string(entry.lines) + " 2810F4 018000");
    x(kTable + entry.length + 1, 1);
    y(kFree + 4, 4711);
    EXPECT_EQ(once(entry.length + 1), 4711) << entry.lines;
    table(std::string(entry.lines) + " 000000 2810F4 018000");
    x(kTable + entry.length + 2, 1);
    EXPECT_EQ(once(entry.length + 2), 1) << entry.lines;
  }
}

TEST_F(ConversionTable, ExtendedMethodsStayZeroAndAreKnown) {
  table("F78000 000000 000000");
  x(kTable + 2, 5);
  EXPECT_EQ(once(2), 0);
  EXPECT_TRUE(conversion_table_is_not_built(kTable + 2));
  EXPECT_FALSE(conversion_table_is_not_built(kTable));
  table("F78000 000000 000000 C78000");
  EXPECT_FALSE(conversion_table_is_not_built(kTable + 3)) << "a method that is built";
}

TEST_F(ConversionTable, AnEntryThatIsCutOffIsNone) {
  c_.line("I8000..8190=$C78000 I8191=$278000");
  channel(3, false, 0, 0);
  x(kTable + 191, 9);
  x(kTable + 192, 9);
  conversion_table_servo();
  EXPECT_EQ(signed_result(190), 96);
  EXPECT_EQ(signed_result(191), 9);
  EXPECT_EQ(signed_result(192), 9) << "what is behind the table";
  c_.line("I8190=$2810F0 I8191=$018000");
  y(kFree, 7);
  EXPECT_EQ(once(191), 7) << "the last line is the table's";
}

TEST_F(ConversionTable, EachOf192LinesMayBeAnEntry) {
  c_.line("I8000..8191=$C78000");
  channel(3, false, 0, 0);
  conversion_table_servo();
  for (std::uint32_t line = 0; line < 192; ++line) EXPECT_EQ(signed_result(line), 96) << line;
}

TEST_F(ConversionTable, OtherLinesDoNotDisturbAnEntry) {
  table("2810F0 018000 D010F0 7FFFFF 100000 4010F0 000001");
  y(kFree, 5);
  x(kFree, 100000);
  conversion_table_servo();
  y(kFree, 6);
  x(kFree, 200000);
  conversion_table_servo();
  const std::int32_t filtered = signed_result(4);
  c_.line("I8007=$E00101");
  conversion_table_servo();
  EXPECT_EQ(signed_result(1), 6);
  EXPECT_NEAR(signed_result(4), filtered + (200000 - filtered) / 8, 1) << "its gain is 1/8";
  EXPECT_EQ(signed_result(6), 0);
  EXPECT_EQ(signed_result(7), 12);
}

}  // namespace
}  // namespace brick
