// The ring of a rotary buffer: wrap, full, PR, order of consumption, commands around it.
#include <deque>
#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

namespace {

using platform::host;

class Rotary : public FirmwareTest {
 protected:
  static void define(unsigned words) {
    ASSERT_EQ(host("DEF ROT " + std::to_string(words)), "");
    ASSERT_EQ(host("B0 OPEN ROT"), "");
  }
};

TEST_F(Rotary, FullRingRefusesTheLineAndKeepsTheRest) {
  define(5);
  EXPECT_EQ(host("X1 Y1"), "");
  EXPECT_EQ(host("X2 Y2"), "");
  EXPECT_EQ(host("X3 Y3"), "ERR006");
  EXPECT_EQ(host("PR"), "2");
  EXPECT_EQ(host("X3"), "");
  EXPECT_EQ(host("X4"), "ERR006");
  EXPECT_EQ(host("PR"), "3");
  EXPECT_EQ(rotary_buffers[0].used, 5u);
}

// firmware:1.10/9
TEST_F(Rotary, FillStandsInTheMemory) {
  ASSERT_EQ(host("&2 DEF ROT 20 B0"), "");
  ASSERT_EQ(host("OPEN ROT"), "");
  ASSERT_EQ(host("X1 Y1 F5"), "");
  ASSERT_EQ(host("DWELL10"), "");
  EXPECT_EQ(host("RX$213E"), "2");
  EXPECT_EQ(host("RY$213E"), "4");
  ASSERT_TRUE(rotary_consume(1, 3));
  EXPECT_EQ(host("RX$213E"), "1");
  EXPECT_EQ(host("RY$213E"), "1");
  ASSERT_EQ(host("CLEAR"), "");
  EXPECT_EQ(host("RX$213E"), "0");
  EXPECT_EQ(host("RY$213E"), "0");
  EXPECT_EQ(host("RX$203E"), "0") << "another system";
}

TEST_F(Rotary, RandomTrafficComesOutInOrderAndComplete) {
  define(17);
  std::mt19937 random(brick::random_seed(11));
  std::deque<std::vector<word48_t>> model;  // lines as they should be in the ring
  unsigned used = 0, stored = 0, refused = 0;
  for (int step = 0; step < 20000; ++step) {
    if (random() % 2 == 0) {
      std::vector<word48_t> line(1 + random() % 6);
      for (auto& word : line)
        word = (random() & 0x7FFFFFu) | (static_cast<word48_t>(random() & 0x3FFFFFu) << 24);  // no line mark
      const error_t error = rotary_store(0, line.data(), static_cast<std::uint32_t>(line.size()));
      if (used + line.size() > 17) {
        ASSERT_EQ(error, ERR_NO_ROOM);
        ++refused;
        continue;
      }
      ASSERT_EQ(error, ERR_NONE);
      used += static_cast<unsigned>(line.size());
      ++stored;
      model.push_back(line);
    } else if (!model.empty()) {
      const auto line = model.front();
      model.pop_front();
      for (std::size_t i = 0; i < line.size(); ++i) {
        word48_t word = 0;
        ASSERT_TRUE(rotary_peek(0, 0, &word));
        ASSERT_EQ(word, i == 0 ? line[i] | WORD_START_OF_LINE : line[i]);
        ASSERT_EQ(rotary_consume(0, 1), i + 1 == line.size()) << "end of line";
        --used;
      }
    }
    ASSERT_EQ(rotary_buffers[0].lines, model.size());
    ASSERT_EQ(rotary_buffers[0].used, used);
  }
  EXPECT_GT(stored, 3000u);
  EXPECT_GT(refused, 500u);
}

TEST_F(Rotary, CalculatedWordsAreFreeAgain) {
  define(2);
  ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("X2"), "");
  ASSERT_EQ(host("X3"), "ERR006");
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  EXPECT_EQ(host("PR"), "1");
  EXPECT_EQ(host("X3"), "");
  EXPECT_EQ(host("PR"), "2");
}

TEST_F(Rotary, LineForACoordinateSystemWithoutBufferIsError6) {
  define(20);
  EXPECT_EQ(host("&2X1"), "ERR006");
  EXPECT_EQ(host("&1X1"), "");
}

TEST_F(Rotary, OpenRules) {
  EXPECT_EQ(host("OPEN ROT"), "ERR003") << "none is defined";
  ASSERT_EQ(host("DEF ROT 20"), "");
  EXPECT_EQ(host("OPEN ROTARY"), "");
  EXPECT_EQ(host("OPEN ROT"), "ERR007");
  EXPECT_EQ(host("OPEN BIN ROT"), "ERR007");
  EXPECT_EQ(host("DEL ROT"), "ERR003") << "open";
  EXPECT_EQ(host("DELETE ALL TEMPS"), "ERR003") << "open";
  EXPECT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("CLEAR"), "ERR007");
  EXPECT_EQ(host("DEL ROT"), "");
  EXPECT_EQ(host("DEL ROT"), "");
  EXPECT_EQ(host("OPEN PLCC 3"), "ERR003");
}

// firmware:4.2: not while something lies below it. Nothing of it is lost then.
TEST_F(Rotary, ARefusedDeletionChangesNothing) {
  define(20);
  ASSERT_EQ(host("P1=5"), "");
  ASSERT_EQ(host("CLOSE DEF GAT 10"), "");
  EXPECT_EQ(host("DEL ROT"), "ERR003");
  EXPECT_TRUE(platform::breq());
  EXPECT_EQ(host("PR LIST ROT"), "1|P1=5");
  ASSERT_EQ(host("DEL GAT R"), "");
  platform::real_time();
  EXPECT_EQ(host("PR P1"), "0|5");
}

// A host may write into the ring: lines are those that were counted, however many begin there now.
TEST_F(Rotary, PrDoesNotGoBelowNoLines) {
  define(10);
  ASSERT_EQ(host("P1=1 P2=2 P3=3 P4=4"), "");
  ASSERT_EQ(rotary_buffers[0].lines, 1u);
  for (std::uint32_t i = 0; i < 4; ++i)
    user_memory_write(rotary_buffers[0].base + i, rotary_word(0, i) | WORD_START_OF_LINE);
  for (const std::uint32_t left : {3u, 2u, 1u, 0u}) {
    EXPECT_TRUE(rotary_consume(0, 1));
    EXPECT_EQ(rotary_buffers[0].used, left);
    EXPECT_EQ(host("PR"), "0") << left;
  }
}

TEST_F(Rotary, RunningBuffersAreProtected) {
  define(20);
  ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("R"), "");
  EXPECT_EQ(host("CLEAR"), "ERR001");
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("DEL ROT"), "ERR003");
  EXPECT_EQ(host("DEF ROT 30"), "ERR001");
  EXPECT_EQ(host("DEF LOOK 10,10"), "ERR001");
  EXPECT_EQ(host("DELETE ALL TEMPS"), "ERR001");
  EXPECT_EQ(host("&2DELETE ALL TEMPS &1"), "ERR001") << "whoever runs";
  EXPECT_EQ(host("&1B0"), "ERR001");
  EXPECT_EQ(host("OPEN ROT"), "") << "may be opened while it runs";
}

TEST_F(Rotary, ClearEmptiesTheAddressedOneOnly) {
  ASSERT_EQ(host("&2DEF ROT 20 &1DEF ROT 20 OPEN ROT"), "");
  ASSERT_EQ(host("&1X1"), "");
  ASSERT_EQ(host("&2X1"), "");
  EXPECT_EQ(host("&2CLEAR"), "");
  EXPECT_EQ(host("&1PR &2PR"), "1|0");
}

TEST_F(Rotary, CloseDoesNotAffectExecution) {
  define(20);
  ASSERT_EQ(host("TM10 TA5 TS0 X1"), "");
  ASSERT_EQ(host("X2"), "");
  ASSERT_EQ(host("R CLOSE"), "");
  platform::servo_ticks(200);  // 88 ms
  EXPECT_EQ(coordinate_systems[0].position[AXIS_X], 2.0);
  EXPECT_EQ(host("PR"), "0");
  EXPECT_TRUE(run_is_running(0)) << "waits for lines";
}

TEST_F(Rotary, BinaryOpenTakesNoText) {
  ASSERT_EQ(host("DEF ROT 20"), "");
  ASSERT_EQ(host("OPEN BINARY ROTARY"), "");
  EXPECT_EQ(host("X10"), "ERR005");
  EXPECT_EQ(host("???"),
            "000000100800");  // binary rotary open (bit 20), fixed buffer full (bit 11); bits 18, 19 stay 0
  EXPECT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("???"), "000000000800");
  ASSERT_EQ(host("OPEN ROT"), "");
  EXPECT_EQ(host("???"), "0000000C0800");  // motion buffer (19), ASCII rotary (18)
}

TEST_F(Rotary, MemoryHoldsTheLine) {
  ASSERT_EQ(host("&2DEF ROT 10 &1DEF ROT 10 OPEN ROT"), "");
  ASSERT_EQ(host("&1X1000"), "");
  // &1 lies below &2: first word at $010800 - 20. X1000 as in host-bus:7.7 with the start-of-line bit.
  EXPECT_EQ(*hal_x(0x107EC), 0x800000u | (1u << 19) | (6u << 6) | 10u);
  EXPECT_EQ(*hal_y(0x107EC), 0x7D0000u);
}

}  // namespace
