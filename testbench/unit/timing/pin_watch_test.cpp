// A read of a gate IC at I52 = 7 with seven wait states, TC = 12.7157 ns, and lines that a made-up board moves: the
// times that rows 104 to 106, 118 and 119 are about. /TA is looked at TC / 4 + 2 ns, 5.2 ns, before /RD may rise.
#include "testbench/checkers/timing_pins.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace brick {
namespace {

constexpr TimeFs kNs = kFsPerNs, kQuarter = 3'178'914, kStart = 1000 * kNs, kLow = kStart + 2 * kQuarter,
                 kHigh = kLow + 29 * kQuarter;

struct Shows {
  TimeFs time;
  std::uint32_t data;
  bool driven = true, busy = false;
};

PinCycle read(const std::vector<Shows>& board, unsigned more_clocks = 0, TimeFs rd_late = 0) {
  PinWatch watch;
  watch.set_pin_delay(rd_late);
  PinCycle cycle;
  watch.on_cycle = [&](const PinCycle& c) { cycle = c; };
  PortALevels levels;
  levels.wait_states = 7;
  const TimeFs high = kHigh + 4 * kQuarter * more_clocks;
  std::size_t shown = 0;
  const auto move = [&](TimeFs time, const std::function<void()>& edit) {
    for (; shown < board.size() && board[shown].time < time; ++shown) {
      BoardOutputs o;
      o.set(pin::kPaData, board[shown].data);
      o.set(pin::kPaDataOe, board[shown].driven);
      o.set(pin::kPaTaN, board[shown].busy);
      watch.board_moved(board[shown].time, o);
    }
    edit();
    watch.cpu_moved(time, levels);
  };
  move(kStart, [&] { levels.addr_oe = true; });
  move(kLow, [&] { levels.rd_n = false; });
  move(high, [&] { levels.rd_n = true; });
  move(high + 5 * kQuarter, [&] { levels.addr_oe = false; });
  return cycle;
}

TEST(PinWatch, DataOfARead) {
  PinCycle c = read({{kLow + 50 * kNs, 5}, {kHigh, 0, false}});
  EXPECT_EQ(c.data_valid, kLow + 50 * kNs);
  EXPECT_EQ(c.data_held, kHigh);
  EXPECT_TRUE(!c.corrupted && !c.data_lost && c.data == 5 && !c.drives_outside);
  c = read({{kLow + 50 * kNs, 5}, {kHigh + 1, 0, false}});
  EXPECT_EQ(c.data_held, kHigh + 1);
  EXPECT_TRUE(c.drives_outside);
  c = read({{kLow + 50 * kNs, 5}, {kHigh - 4 * kNs, 6}});
  EXPECT_TRUE(c.corrupted);
  EXPECT_EQ(c.data_valid, kHigh - 4 * kNs);
  c = read({});
  EXPECT_TRUE(c.corrupted);
  EXPECT_EQ(c.data_valid, kHigh) << "never driven";
  c = read({{kLow + 50 * kNs, 5}, {kHigh - 10 * kNs, 0, false}});
  EXPECT_TRUE(c.corrupted && c.data_lost);
  EXPECT_EQ(c.data_held, kHigh - 10 * kNs);
}

TEST(PinWatch, TheBoardDrivesInsideReadStrobesOnly) {
  EXPECT_FALSE(read({{kLow, 5}, {kHigh, 5, false}}).drives_outside);
  EXPECT_TRUE(read({{kLow - 1, 5}, {kHigh, 5, false}}).drives_outside) << "before /RD falls";
  EXPECT_TRUE(read({{kLow + kNs, 5}}).drives_outside) << "for ever";
  EXPECT_TRUE(read({{kStart - 9 * kNs, 5}, {kStart - 8 * kNs, 5, false}, {kLow, 5}, {kHigh, 5, false}}).drives_outside)
      << "between cycles";
}

// /RD comes to the board 3 ns late: as much later may D end, and no more.
TEST(PinWatch, ALatePinOfTheStrobeIsNoMoreThanThat) {
  EXPECT_FALSE(read({{kLow, 5}, {kHigh + 3 * kNs, 5, false}}, 0, 3 * kNs).drives_outside);
  EXPECT_TRUE(read({{kLow, 5}, {kHigh + 3 * kNs + 1, 5, false}}, 0, 3 * kNs).drives_outside);
}

// host-bus:2.5/7: address, space and select, each alone.
TEST(PinWatch, EachLineOfTheAddressIsSeenToMove) {
  const std::function<void(PortALevels&)> lines[] = {
      [](PortALevels& l) { l.addr ^= 1; }, [](PortALevels& l) { l.x = !l.x; }, [](PortALevels& l) { l.aa ^= 8; }};
  for (const auto& line : lines) {
    PinWatch watch;
    PinCycle cycle;
    watch.on_cycle = [&](const PinCycle& c) { cycle = c; };
    PortALevels levels;
    levels.wait_states = 7;
    const auto move = [&](TimeFs time, const std::function<void(PortALevels&)>& edit) {
      edit(levels);
      watch.cpu_moved(time, levels);
    };
    move(kStart, [](PortALevels& l) { l.addr_oe = true; });
    move(kLow, [](PortALevels& l) { l.rd_n = false; });
    move(kLow + 20 * kNs, line);
    move(kHigh, [](PortALevels& l) { l.rd_n = true; });
    EXPECT_TRUE(cycle.address_moved);
    EXPECT_EQ(cycle.end, kLow + 20 * kNs);
  }
}

TEST(PinWatch, ClocksThatTaAskedFor) {
  const Shows busy{kLow + 5 * kNs, 5, true, true};
  const auto until = [](TimeFs time) { return Shows{time, 5, true, false}; };
  PinCycle c = read({busy, until(kHigh - 6 * kNs)});
  EXPECT_TRUE(c.stretched == 0 && c.asked == 0 && c.ta_seen + c.ta_missed == 0 && !c.ta_high);
  EXPECT_EQ(c.ta_moved, kHigh - 6 * kNs);
  c = read({busy, until(kHigh - 4 * kNs)});
  EXPECT_TRUE(c.stretched == 0 && c.asked == 0 && c.ta_seen == 1 && c.ta_missed == 0);
  c = read({busy, until(kHigh - 4 * kNs)}, 1);
  EXPECT_TRUE(c.stretched == 1 && c.asked == 0 && c.ta_seen == 0 && c.ta_missed == 1);
  c = read({busy, until(kHigh + 1 * kNs)}, 1);
  EXPECT_TRUE(c.stretched == 1 && c.asked == 1 && c.ta_seen + c.ta_missed == 0);
  c = read({busy, until(kHigh + 6 * kNs)});
  EXPECT_TRUE(c.stretched == 0 && c.asked == 1 && c.ta_high) << "the strobe should have been longer";
  EXPECT_EQ(c.ta_held, kHigh + 6 * kNs);
}

}  // namespace
}  // namespace brick
