// Every bit of the registers of servo-ic:2 shows what it does, and its check notices when it is stuck at 0 or at 1:
// the proof that no bit is checked in name only. Both engines, each alone. The timers are in timer_bits_test.cpp.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "testbench/unit/covers.h"
#include "testbench/unit/register_bits/bits_rig.h"

namespace brick {
namespace {

BitTable full_table() {
  BitTable table;
  add_channel_rows(table);
  add_output_rows(table);
  add_global_rows(table);
  return table;
}

std::string where(const BitRow& row) {
  return row.name + ", " + (row.x ? "X:+" : "Y:+") + std::to_string(row.offset) + " bit " + std::to_string(row.bit);
}

// Word by word: bits that can be read, bits whose written value matters. Bits 5..0 of OUT A and B are stored and
// nothing else, bit 23 of the PWM word does not exist; the read-back rows have them.
TEST(RegisterBitTable, HoldsEveryBitOfEveryWord) {
  struct Word {
    bool x;
    unsigned offset;
    bool global;
    std::uint32_t read, written;
  };
  const Word words[] = {{false, 0, false, 0xFFFFFF, 0x000FFF},  {false, 1, false, 0xFFFFFF, 0x000FFF},
                        {false, 2, false, 0xFFFFFF, 0xFFFFC0},  {false, 3, false, 0xFFFFFF, 0xFFFFC0},
                        {false, 4, false, 0xFFFFFF, 0xFFFFFF},  {false, 5, false, 0xFFFFFF, 0},
                        {false, 6, false, 0xFFFFFF, 0},         {false, 7, false, 0xFFFFFF, 0xFFFFFF},
                        {true, 0, false, 0xFFFFFF, 0x000080},   {true, 1, false, 0xFFFFFF, 0},
                        {true, 2, false, 0xFFFFFF, 0},          {true, 3, false, 0xFFFFFF, 0},
                        {true, 5, false, 0xFFFFFF, 0xFFFFFF},   {true, 6, false, 0xFFFFFF, 0xFFFFFF},
                        {true, 7, false, 0xFFFFFF, 0xFFFFFF},   {true, 0x04, true, 0xFFFFFF, 0xFF3FFF},
                        {true, 0x0C, true, 0xFFFFFF, 0xFFFFFF}, {true, 0x14, true, 0xFFFFFF, 0xFFFFFF},
                        {true, 0x1C, true, 0xFFFFFF, 0x7FFFFF}};
  std::map<std::tuple<bool, unsigned, bool, Side>, std::uint32_t> bits;
  for (const BitRow& row : full_table()) bits[{row.x, row.offset, row.global, row.side}] |= 1u << row.bit;
  for (const Word& w : words) {
    EXPECT_EQ((bits[{w.x, w.offset, w.global, Side::kRead}]), w.read) << (w.x ? "X:+" : "Y:+") << w.offset;
    EXPECT_EQ((bits[{w.x, w.offset, w.global, Side::kWritten}]), w.written) << (w.x ? "X:+" : "Y:+") << w.offset;
  }
}

class RegisterBits : public ::testing::TestWithParam<BitsEngine> {};

TEST_P(RegisterBits, EachBitDoesWhatTheMapSays) {
  BRICK_COVERS("CARD-1 CARD-2");
  BitsRig rig(GetParam());
  for (const BitRow& row : full_table())
    for (unsigned ch = 1; ch <= (row.global ? 1u : 4u); ++ch)
      EXPECT_TRUE(row.check(rig, ch)) << where(row) << ", channel " << ch;
}

TEST_P(RegisterBits, EachStuckBitIsFound) {
  BitsRig rig(GetParam());
  int found = 0;
  for (const BitRow& row : full_table()) {
    const unsigned ch = 1 + row.bit % 4;
    for (bool level : {false, true}) {
      if (row.always_0 && !level) continue;  // what is always 0 may be stuck there
      rig.stuck = StuckBit{row.side, row.x, row.addr(ch), row.bit, level};
      const bool unnoticed = row.check(rig, ch);
      EXPECT_FALSE(unnoticed) << where(row) << ", channel " << ch << ", stuck at " << level;
      found += !unnoticed;
    }
    rig.stuck.reset();
    EXPECT_TRUE(row.check(rig, ch)) << where(row) << ", channel " << ch << ", sound again";
  }
  EXPECT_GT(found, 1500);
}

INSTANTIATE_TEST_SUITE_P(Engines, RegisterBits, ::testing::Values(BitsEngine::kRtl, BitsEngine::kModel),
                         [](const auto& engine) { return engine.param == BitsEngine::kRtl ? "Rtl" : "Model"; });

}  // namespace
}  // namespace brick
