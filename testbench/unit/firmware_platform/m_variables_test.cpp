// M-variables, firmware:1.8: every form of definition, read, reported and used, and definition words that a user wrote.
#include <gtest/gtest.h>

#include <iomanip>
#include <map>
#include <random>
#include <sstream>
#include <string>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/variables/m_variables.h"
}

namespace brick {
namespace {

std::uint32_t x(std::uint32_t address) { return *hal_x(address) & 0xFFFFFFu; }
std::uint32_t y(std::uint32_t address) { return *hal_y(address) & 0xFFFFFFu; }

std::string hex(std::uint32_t value) {
  std::ostringstream text;
  text << '$' << std::uppercase << std::hex << value;
  return text.str();
}

TEST(MDefinitions, AreReportedAsRealBricksReportThem) {
  BRICK_COVERS("I9-1");
  Controller c;
  // What is typed, and what is reported for it.
  const std::pair<const char*, const char*> texts[] = {
      {"X:$078200,8", "X:$78200,8"},
      {"X:$078200,8,1", "X:$78200,8"},
      {"Y$78C02,8,1,U", "Y:$78C02,8"},
      {"X:$78001,24", "X:$78001,24"},
      {"X:$078001,0,24", "X:$78001,24"},
      {"X:$78001", "X:$78001,24"},
      {"X:$78001,24,S", "X:$78001,24,S"},
      {"X:$078001,0,24,S", "X:$78001,24,S"},
      {"X:$78002,8,16,S", "X:$78002,8,16,S"},
      {"Y:$0000C0,4,8", "Y:$C0,4,8"},
      {"Y:192,4,8,U", "Y:$C0,4,8"},
      {"Y:$C0,4,1,S", "Y:$C0,4,1,S"},
      {"Y:$C0,4,8,D", "Y:$C0,4,8,D"},
      {"Y:$C0,0,24,C", "Y:$C0,24,C"},
      {"D:$000088", "D:$88"},
      {"L:$D7", "L:$D7"},
      {"DP:$060401", "DP:$60401"},
      {"F:$0607FF", "F:$607FF"},
      {"F$60010", "F:$60010"},
      {"TWB:3,4,4,U", "TWB:3,4,4"},
      {"TWB:4,0,16,S", "TWB:4,0,16,S"},
      {"TWB:255,7,32", "TWB:255,7,32"},
      {"TWD:4,0,8.3,U", "TWD:4,0,8.3"},
      {"TWD:0,4,12.8,S", "TWD:0,4,12.8,S"},
      {"TWD:0,0,1", "TWD:0,0,1"},
      {"TWR:254,7", "TWR:254,7"},
      {"TWS:17", "TWS:17"},
      {"*", "*"},
  };
  for (const auto& [typed, reported] : texts) {
    EXPECT_EQ(c.line(std::string("M8191->") + typed), "") << typed;
    for (const char* style : {"I9=0", "I9=2"}) {
      c.line(style);
      EXPECT_EQ(c.line("M8191->"), reported) << typed;
    }
    for (const char* style : {"I9=1", "I9=3"}) {
      c.line(style);
      const std::string statement = c.line("M8191->");
      EXPECT_EQ(statement, std::string("M8191->") + reported) << typed;
      EXPECT_EQ(c.line("M8191->*" + std::string(" ") + statement), "") << "a statement that can be sent back";
      EXPECT_EQ(c.line("M8191->"), statement);
    }
  }
}

TEST(MDefinitions, WhatIsNoneIsAnErrorAndChangesNothing) {
  Controller c;
  c.line("M5->Y:$10F0,3,4");
  for (const char* text :
       {"X",           "X:",         "X:$1000000",  "X:-1",        "X:$0,",        "X:$0,25",   "X:$0,23,4",
        "X:$0,0,25",   "X:$0,24,8",  "X:$0,24,24",  "X:$0,24,1,S", "X:$0,24,24,S", "X:$0,0,0",  "X:$0,0,6,D",
        "X:$0,0,8,Q",  "X:$0,0,8,",  "X:$0,1.5",    "Y:",          "D:",           "L",         "DP",
        "F:",          "F:$1000000", "TWB:256,0,1", "TWB:0,8,1",   "TWB:0,0,33",   "TWB:0,0,0", "TWB:0,0",
        "TWB:0,0,1,D", "TWD:0,1,3",  "TWD:0,0,13",  "TWD:0,0,0",   "TWD:0,0,1.9",  "TWD:0,0",   "TWR:1,0",
        "TWR:0,8",     "TWR:0",      "TWS:256",     "TWS"})
    EXPECT_EQ(c.line(std::string("M5->") + text), "ERR003") << text;
  EXPECT_EQ(c.line("M5->"), "Y:$10F0,3,4");
}

TEST(MDefinitions, OfARangeAreTheSame) {
  Controller c;
  EXPECT_EQ(c.line("M10..12->X:$10F0,4,4"), "");
  EXPECT_EQ(c.line("M9..13->"), "*|X:$10F0,4,4|X:$10F0,4,4|X:$10F0,4,4|*");
  EXPECT_EQ(c.line("M0..8191->*"), "");
  EXPECT_EQ(c.line("M9..13->"), "*|*|*|*|*");
}

// `WX$4001,$700000` and the like: any word a user writes there is a definition or counts as `*`.
TEST(MDefinitions, WordsThatAUserWroteAreSafe) {
  Controller c;
  EXPECT_EQ(c.line("M1->X:$4001 M1=$B00000 M1->"), "*");
  EXPECT_EQ(c.line("M1->X:$10F0,4,4 WX$4001,$F00000 M1-> M1"), "*|4336") << "Y:$4001 holds $10F0";
  EXPECT_EQ(c.line("M1=7 M1 RX$4001"), "7|0");
  std::mt19937 random(random_seed(20));
  unsigned pointers = 0;
  std::map<std::string, unsigned> multiplexed;  // by the name of the form
  for (unsigned i = 0; i < 20000; ++i) {
    std::uint32_t word = random() & 0xFFFFFFu, address = 0x10F0u + (random() & 0xFu);
    if (i % 2 == 1) {  // TWB, TWD, TWR and TWS reach 0 to 255
      word = (7u + random() % 4u) << 20 | (word & 0xFFFFFu);
      address = random() & 0xFFu;
    }
    c.line("WX$4001," + hex(word) + " WY$4001," + hex(address));
    const std::string text = c.line("M1->");
    ASSERT_LE(text.size(), 20u) << text;
    const std::string value = c.line("M1");
    ASSERT_EQ(value.find("ERR"), std::string::npos) << hex(word);
    ASSERT_EQ(c.line("M1=-3"), "");
    if (text == "*") continue;
    ++pointers;
    if (text[0] == 'T') {
      ++multiplexed[text.substr(0, 3)];
      ASSERT_EQ(value + c.line("M1"), "00") << text;
    }
    ASSERT_EQ(c.line("M2->" + text + " M2->"), text) << hex(word);
  }
  EXPECT_GT(pointers, 2000u);
  for (const char* form : {"TWB", "TWD", "TWR", "TWS"}) EXPECT_GT(multiplexed[form], 5u) << form;
}

TEST(MVariables, PartsOfAWordLeaveTheRestAlone) {
  Controller c;
  for (unsigned width = 1; width <= 24; ++width)
    for (unsigned lsb = 0; lsb + width <= 24; ++lsb) {
      const std::string part = std::to_string(lsb) + "," + std::to_string(width);
      const std::uint32_t mask = ((1u << width) - 1u) << lsb;
      c.line("M1->X:$10F0," + part + " M2->X:$10F0," + part + ",S WX$10F0,$A5C3F0");
      const std::uint32_t bits = (0xA5C3F0u & mask) >> lsb;
      const std::int32_t value =
          (bits >> (width - 1)) != 0 ? static_cast<std::int32_t>(bits) - (1 << width) : static_cast<std::int32_t>(bits);
      ASSERT_EQ(c.line("M1 M2"), std::to_string(bits) + "|" + std::to_string(value)) << part;
      c.line("M1=0");
      ASSERT_EQ(x(0x10F0), 0xA5C3F0u & ~mask) << part;
      c.line("M2=-1");
      ASSERT_EQ(x(0x10F0), 0xA5C3F0u | mask) << part;
    }
}

TEST(MVariables, DigitsAreBinaryCodedDecimal) {
  Controller c;
  c.line("M1->Y:$10F0,24,D M2->Y:$10F0,8,8,D M3->Y:$10F0,24,C M4->Y:$10F0,0,4,C WY$10F0,$123456");
  EXPECT_EQ(c.line("M1 M2"), "123456|34");
  c.line("M2=12");
  EXPECT_EQ(y(0x10F0), 0x121256u);
  c.line("M1=987654");
  EXPECT_EQ(y(0x10F0), 0x987654u);
  c.line("M1=1000007 WX$10F0,0");  // as many digits as there are
  EXPECT_EQ(y(0x10F0), 0x000007u);
  const std::pair<const char*, const char*> beyond_32_bits[] = {
      {"5000000123", "123"},
      {"4294967296", "967296"},
      {"-4294967296", "967296"},
      {"34359738367", "738367"},
      {"4294967295*32767", "355264"}};  // 140733193355265 in 35 bits
  for (const auto& [value, digits] : beyond_32_bits) {
    c.line("M1=" + std::string(value));
    EXPECT_EQ(c.line("M1"), digits) << value;
  }
  c.line("M3=123456");
  EXPECT_EQ(y(0x10F0), 0xEDCBA9u);
  EXPECT_EQ(c.line("M3 M4"), "123456|6");
}

TEST(MVariables, LongWordsOfBothHalves) {
  Controller c;
  c.line("M1->D:$10F0 M2->L:$10F1 M3->DP:$60010 M4->F:$60011");
  c.line("M1=-16777217 M2=-1 M3=-2 M4=-0.1");
  EXPECT_EQ(x(0x10F0), 0xFFFFFEu);  // -2 * 2^24 + $FFFFFF
  EXPECT_EQ(y(0x10F0), 0xFFFFFFu);
  EXPECT_EQ(x(0x10F1), 0x800000u);  // firmware:1.2/5
  EXPECT_EQ(y(0x10F1), 0x0007FFu);
  EXPECT_EQ(x(0x60010), 0xFFFFu);
  EXPECT_EQ(y(0x60010), 0xFFFEu);
  EXPECT_EQ(x(0x60011), 0xBDCCu);  // IEEE 754: -0.1 is $BDCCCCCD
  EXPECT_EQ(y(0x60011), 0xCCCDu);
  EXPECT_EQ(c.line("M1..3"), "-16777217|-1|-2");
  EXPECT_NEAR(m_variable_read(4), -0.1, 1e-8);
  c.line("WX$60011,$3FC0 WY$60011,0");
  EXPECT_EQ(c.line("M4"), "1.5");
  c.line("WX$60011,$7F80");
  EXPECT_EQ(c.line("M4"), "140737488355328");
  c.line("WX$60011,$FF80");
  EXPECT_EQ(c.line("M4"), "-140737488355328");
  c.line("WX$60011,$7FC0");
  EXPECT_EQ(c.line("M4 P(M4) M(M4)"), "0|0|0");
}

TEST(MVariables, OfTheMultiplexerReadZeroAndTakeNothing) {
  Controller c;
  c.line("WX$0,5 M1->TWB:0,0,32 M2->TWD:0,0,8.3 M3->TWR:0,0 M4->TWS:1 M1..4=-7");
  EXPECT_EQ(c.line("M1..4"), "0|0|0|0");
  EXPECT_EQ(c.line("M1..4->"), "TWB:0,0,32|TWD:0,0,8.3|TWR:0,0|TWS:1");
  EXPECT_EQ(x(0), 5u);
}

TEST(MVariables, StarsAreVariablesOfTheirOwn) {
  Controller c;
  c.line("M0..2=8388607 M3=-8388608 M4=8388608");
  EXPECT_EQ(c.line("M0..4"), "8388607|8388607|8388607|-8388608|-8388608");
  EXPECT_EQ(c.line("M0->"), "*");
}

TEST(MVariables, ReachTheChips) {
  Controller c;
  c.line("M1->X:$78001,24,S M2->Y:$78002,8,16,S M3->X:$78005,14 M4->X:$78105,14 M3=1 M2=-2");
  *hal_x(0x78001) = 0xFFFFFE;
  (void)hal_x(0);
  EXPECT_EQ(c.line("M1..4"), "-2|-2|1|0");
  EXPECT_EQ(y(0x78002), 0xFFFE00u);
}

}  // namespace
}  // namespace brick
