// Words as users reach them: which there are, at both ends of each area, and which may be read where they stand.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/variables/phase_period.h"
#include "firmware/variables/words.h"
}

namespace brick {
namespace {

// First and last of each area (firmware:1.10); of latches those of the board are words, in X only.
TEST(Words, AreThereFromTheFirstToTheLastOfEachArea) {
  Controller c;
  struct Edge {
    std::uint32_t address;
    bool x, y;
  };
  const std::vector<Edge> edges = {
      {0x000000, true, true},   {0x03FFFF, true, true},   {0x040000, false, false}, {0x05FFFF, false, false},
      {0x060000, true, true},   {0x063FFF, true, true},   {0x064000, false, false}, {0x070000, false, false},
      {0x07000F, false, false}, {0x070010, true, false},  {0x0700FF, true, false},  {0x070100, false, false},
      {0x077FFF, false, false}, {0x078000, true, true},   {0x07BFFF, true, true},   {0x07C000, false, false},
      {0xFFFF8C, false, false}, {0xFFFFFF, false, false},
  };
  for (const Edge& e : edges) {
    EXPECT_EQ(word_exists(true, e.address), e.x) << std::hex << e.address;
    EXPECT_EQ(word_exists(false, e.address), e.y) << std::hex << e.address;
  }
  for (const auto& [words, end] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 0x60000}, {8192, 0x61000}, {32768, 0x64000}}) {
    fake_hal_set_strap(HAL_STRAP_DPRAM_WORDS, words);
    for (const bool x : {false, true}) {
      EXPECT_EQ(word_exists(x, 0x60000), words != 0) << words;
      EXPECT_FALSE(word_exists(x, end)) << words;
      if (words != 0) { EXPECT_TRUE(word_exists(x, end - 1)) << words; }
    }
  }
}

// Gathering reads plain ones where they stand. The conversion table is made from I8000 on when it is read.
TEST(Words, OfMainMemoryThatNobodyMakesArePlain) {
  Controller c;
  for (const std::uint32_t address : {0x10F0u, 0x4000u, 0xA000u, 0x3FFFFu}) EXPECT_TRUE(word_is_plain(address));
  for (const std::uint32_t address : {0x3501u, 0x40000u, 0x60000u, 0x78000u, 0xFFFFFFu})
    EXPECT_FALSE(word_is_plain(address)) << std::hex << address;
}

// In X, in one piece with Y as alone; nothing else is there.
TEST(Words, PhasePeriodIsReadInEveryForm) {
  Controller c;
  const std::uint32_t half = 13057 * 8 / 12 / 2;  // $1100
  std::uint32_t x = 0, y = 0;
  word_read_long(0xFFFF8C, &x, &y);
  EXPECT_EQ(x, half);
  EXPECT_EQ(y, 0u);
  EXPECT_EQ(word_read(true, 0xFFFF8C), half);
  EXPECT_EQ(word_read(false, 0xFFFF8C), 0u);
  EXPECT_EQ(c.line("RHL$FFFF8C M1->D:$FFFF8C M1"), "001100000000|" + std::to_string(half * 16777216ull));
  word_read_long(0xFFFF8B, &x, &y);
  EXPECT_EQ(x | y, 0u);
}

// What is written elsewhere is not kept, and who reads or writes lets the servo task on.
TEST(Words, AreReadAndWrittenWholeAndInPart) {
  Controller c;
  for (const std::uint32_t address : {0x10F0u, 0x3FFFFu, 0x60000u, 0x63FFFu}) {
    word_write_long(address, 0x1ABCDEF, 0x1123456);
    std::uint32_t x = 0, y = 0;
    word_read_long(address, &x, &y);
    EXPECT_EQ(x, 0xABCDEFu) << std::hex << address;
    EXPECT_EQ(y, 0x123456u) << std::hex << address;
    word_write(true, address, 0x1000001);
    word_write_part(false, address, 0xFF00, 0x123400FF);
    EXPECT_EQ(word_read(true, address), 1u);
    EXPECT_EQ(word_read(false, address), 0x120056u);
    EXPECT_FALSE(fake_hal_masked());
  }
  for (const std::uint32_t address : {0x40000u, 0x5FFFFu, 0x64000u, 0x77FFFu, 0x7C000u}) {
    word_write_long(address, 1, 1);
    EXPECT_EQ(word_read(true, address) | word_read(false, address), 0u) << std::hex << address;
  }
}

// Half the CPU cycles of (2 I7m00 + 3)(I7m01 + 1) periods. With no IC that drives, of the one that I19 names, and
// without that one of the factory value.
TEST(Words, PhasePeriodWithoutASourceIsThatOfI19) {
  Controller c;
  const auto cycles = [](unsigned max_phase, unsigned divider) { return (2 * max_phase + 3) * (divider + 1) * 8 / 12; };
  c.line("I7000=3000 I7001=1 I7100=1000 I7101=4 I7007=3");
  EXPECT_EQ(phase_period(), cycles(3000, 1)) << "I19 = 7007";
  c.line("I19=7107");
  EXPECT_EQ(phase_period(), cycles(1000, 4));
  c.line("I19=6807");
  EXPECT_EQ(phase_period(), cycles(6527, 0)) << "it is not there";
  c.line("I7107=1");
  EXPECT_EQ(phase_period(), cycles(6527, 0)) << "half of the clocks is none";
  c.line("I7107=0");
  EXPECT_EQ(phase_period(), cycles(1000, 4));
  Controller none(0);
  EXPECT_EQ(phase_period(), cycles(6527, 0));
}

}  // namespace
}  // namespace brick
