// Compare with hardware 1/T to the SCLK period: up and down, A and B with fractions of their own, over many cells, and
// what is no motion and so must not turn EQU (servo-ic:5.7, servo-ic:5.10/9, servo-ic:5.10/11). Where the position is
// comes from the rule's formula; when a count was, from channel 2, which compares channel 1's counter without 1/T and
// turns its EQU at each count.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

constexpr std::uint32_t kCounterMask = 0xFFFFFF, kFineWord = kX4 | kFine;

struct Place {
  int cell;
  unsigned fraction;
};
std::int64_t position(const Place& p) { return std::int64_t{p.cell} * 4096 + p.fraction; }

// What the two compares do while the position moves one way, as the SCLK edges find it.
class Compares {
 public:
  Compares(bool up, Place a, Place b, int increment) : up_(up), a_(a), b_(b), step_(up ? increment : -increment) {}
  // True when EQU turns: a compare is left when the position found is beyond it and the one before was not.
  bool find(std::int64_t found) {
    const bool of_a = left(a_, found), of_b = left(b_, found);
    last_ = found;
    if (of_a) b_.cell += step_;
    if (of_b) a_.cell += step_;
    turns += of_a != of_b;
    return of_a != of_b;
  }
  void start(std::int64_t found) { last_ = found; }
  int turns = 0;

 private:
  bool left(const Place& p, std::int64_t found) const {
    return up_ ? last_ <= position(p) && position(p) < found : found < position(p) && position(p) <= last_;
  }
  bool up_;
  Place a_, b_;
  int step_;
  std::int64_t last_ = 0;
};

class ChannelFineCompareTest : public ChannelTest {
 protected:
  // Channel 1 at cell 0 with 1/T, channel 2 turns its EQU with each of its counts: pulses of one count every two.
  void start(bool up) {
    control(1, kFineWord | kCounterReset);
    control(2, kFromChannel1);
    rig_.write(2, words::kCompareA, 0);
    rig_.write(2, words::kCompareB, up ? kCounterMask : 1);
    rig_.write(2, words::kCompareIncrement, 2);
    control(1, kFineWord);
  }
  // Channel 1 with 1/T, in which it comes to rest; channel 2 compares its position.
  void to_the_end_of_cell_4(bool up) {
    control(1, kFineWord | kCounterReset);
    control(2, kFineWord | kFromChannel1);
    control(1, kFineWord);
    steps(1, 4, up, 20 * kSclk);
    rig_.ticks(100 * kSclk);
  }
  void place(unsigned channel, const Place& a, const Place& b, int increment) {
    rig_.write(channel, words::kCompareA, static_cast<std::uint32_t>(a.cell) & kCounterMask);
    rig_.write(channel, words::kTimer2, a.fraction);
    rig_.write(channel, words::kCompareB, static_cast<std::uint32_t>(b.cell) & kCounterMask);
    rig_.write(channel, words::kTimer1, b.fraction);
    rig_.write(channel, words::kCompareIncrement, static_cast<std::uint32_t>(increment));
    EXPECT_EQ(fine2::kCompareA.get(rig_.peek(channel, words::kTimer2)), a.fraction);
    EXPECT_EQ(fine1::kCompareB.get(rig_.peek(channel, words::kTimer1)), b.fraction);
  }

  // A count every `t1` SCLK periods. The first two have no T1 of that length behind them.
  void run(bool up, int cells, int t1, const Place& a, const Place& b, int increment) {
    constexpr int kFirst = 3;
    const std::string what = (up ? "up, T1 " : "down, T1 ") + std::to_string(t1) + ", fractions " +
                             std::to_string(a.fraction) + " " + std::to_string(b.fraction);
    start(up);
    place(1, a, b, increment);
    Compares compares(up, a, b, increment);
    const Tick count_period = t1 * kSclk;
    bool level{equ(1)}, seen{equ(2)};
    int counts = 0;
    Tick count = 0;
    for (int i = 0; i < cells; ++i) {
      step(1, up, 0);
      for (Tick t = 0; t < count_period; ++t) {
        rig_.tick();
        const bool counted = bool{equ(2)} != seen;
        if (counted && ++counts > kFirst) { ASSERT_EQ(rig_.now() - count, count_period) << what; }
        // An edge of SCLK finds the position before it: `since` periods after a count.
        const bool edge = counted || (counts > 0 && (rig_.now() - count) % kSclk == 0);
        if (edge && counts >= kFirst) {
          const int since = static_cast<int>((rig_.now() - count) / kSclk) - 1, cell = counted ? counts - 1 : counts;
          const auto e = static_cast<unsigned>(std::min(4095, 4096 * since / t1));
          const std::int64_t found = position({up ? cell : -cell, up ? e : 4095 - e});
          if (counts == kFirst && counted)
            compares.start(found);
          else if (compares.find(found))
            level = !level;
        }
        if (counted) {
          seen = !seen;
          count = rig_.now();
        }
        ASSERT_EQ(bool{equ(1)}, level) << what << ", " << counts << " counts and " << (rig_.now() - count) / kSclk
                                       << " SCLK periods";
      }
    }
    EXPECT_GE(compares.turns, 2 * ((cells - 8) / increment)) << what;
  }
};

// Fractions that are reached when e is exact, 26 reference edges after a count or later (servo-ic:5.7/3), and the last
// of a cell, which the next count leaves. The pulses begin in one cell and end in the same or the next but one.
TEST_F(ChannelFineCompareTest, EachCompareIsLeftAtTheSclkEdgeThatFindsThePositionBeyondIt) {
  constexpr int kIncrement = 8, kCells = 20;
  struct Row {
    unsigned begins, ends;  // 1/4096 count on the way through the cell
    int width;
  };
  for (const int t1 : {64, 101})
    for (const Row& row : {Row{600, 1024, 0}, Row{1024, 3333, 0}, Row{2047, 4095, 0}, Row{4095, 700, 2},
                           Row{3000, 1500, 2}, Row{2048, 2048, 2}})
      for (const bool up : {true, false}) {
        const auto fraction = [up](unsigned f) { return up ? f : 4095 - f; };
        const int way = up ? 1 : -1;
        run(up, kCells, t1, {5 * way, fraction(row.begins)}, {(5 + row.width - kIncrement) * way, fraction(row.ends)},
            kIncrement);
        if (HasFatalFailure()) return;
      }
}

// Channel 2 stands at its own position and looks at channel 1's instead, and back: a compare lies between the two, or
// on one of them, be they a count apart, as far as a position may move, or farther. Nothing has moved, so nothing is
// left.
TEST_F(ChannelFineCompareTest, AChangeOfTheSourceLeavesNothing) {
  for (const auto& [up, apart] : {std::pair{true, 1}, {false, 1}, {true, 20}, {false, 20}}) {
    const int way = up ? 1 : -1;
    control(1, kFineWord | kCounterReset);
    control(2, kFineWord | kCounterReset);
    control(1, kFineWord);
    control(2, kFineWord);
    steps(1, 4 + apart, up);
    steps(2, 4, up);
    rig_.ticks(40 * kSclk);  // until both fractions have reached their end
    for (const int cell : {4, 5, 10, 24})
      for (const bool of_a : {true, false}) {
        const Place between{cell * way, 2000}, far{100 * way, 0};
        const Place &a = of_a ? between : far, &b = of_a ? far : between;
        place(2, a, b, 5);
        for (int change = 0; change < 4; ++change) {
          const bool before{equ(2)};
          control(2, kFineWord | (change % 2 == 0 ? kFromChannel1 : 0));
          for (Tick t = 0; t < 8 * kSclk; ++t) {
            rig_.tick();
            ASSERT_EQ(bool{equ(2)}, before) << "cell " << cell << ", change " << change;
          }
          EXPECT_EQ(rig_.peek(2, words::kCompareA), static_cast<std::uint32_t>(a.cell) & kCounterMask);
          EXPECT_EQ(rig_.peek(2, words::kCompareB), static_cast<std::uint32_t>(b.cell) & kCounterMask);
        }
      }
  }
}

// A source without 1/T is at the beginning of its cell (servo-ic:5.7/2), whichever way it came in: 5 and a fraction is
// left with the count from 5 to 6 upwards, with that from 6 to 5 downwards, and 5 itself with that to 4.
TEST_F(ChannelFineCompareTest, ASourceWithoutHardware1TIsAtTheBeginningOfItsCell) {
  control(1, kX4 | kCounterReset);
  control(2, kFineWord | kFromChannel1);
  control(1, kX4);
  steps(1, 3, true);
  for (const unsigned fraction : {0u, 1u, 2048u, 4095u}) {
    for (const bool up : {true, false}) {  // 3 to 8 and back
      place(2, {5, fraction}, {100, 0}, 0);
      for (int i = 0; i < 5; ++i) {
        const bool before{equ(2)};
        step(1, up);
        const int to = up ? 4 + i : 7 - i;
        EXPECT_EQ(bool{equ(2)} != before, to == (up ? 6 : fraction == 0 ? 4 : 5)) << fraction << ", to " << to;
      }
    }
  }
}

// And the first motion after the change is seen, from where the new source stands.
TEST_F(ChannelFineCompareTest, TheNewSourceIsFollowedFromWhereItStands) {
  control(1, kFineWord | kCounterReset);
  control(2, kFineWord | kCounterReset);
  control(1, kFineWord);
  control(2, kFineWord);
  steps(1, 24, true);
  rig_.ticks(40 * kSclk);
  place(2, {24, 4095}, {10, 0}, 3);
  const bool before{equ(2)};
  control(2, kFineWord | kFromChannel1);
  rig_.ticks(2 * kSclk);
  step(1, true);
  EXPECT_NE(bool{equ(2)}, before) << "24 to 25";
  EXPECT_EQ(rig_.peek(2, words::kCompareB), 13u);
}

// The counter has moved on since 1/T was last on; then it is held at 0. Neither is a motion that the compare between
// the two places sees.
TEST_F(ChannelFineCompareTest, TurningHardware1TOnOrHoldingTheCounterLeavesNothing) {
  for (const bool up : {true, false}) {
    const int way = up ? 1 : -1;
    for (const int cell : {9, 12, 15}) {
      control(1, kX4 | kCounterReset);
      control(1, kFineWord);
      steps(1, 12, up);
      place(1, {100 * way, 2000}, {101 * way, 0}, 0);
      control(1, kX4);
      steps(1, 6, up);
      rig_.write(1, words::kCompareA, static_cast<std::uint32_t>(cell * way) & kCounterMask);
      const bool before{equ(1)};
      for (const std::uint32_t word :
           {kFineWord, kX4, kFineWord, kFineWord | kCounterReset, kFineWord, kFineWord | kCounterReset, kX4}) {
        control(1, word);
        rig_.ticks(8 * kSclk);
        EXPECT_EQ(bool{equ(1)}, before) << "control " << std::hex << word << std::dec << ", cell " << cell * way;
      }
    }
  }
}

// In MLDT mode e is 0 (servo-ic:5.7/5): from the far end of its cell the position goes back over the compare in its
// middle, be it the channel's own or channel 1's, and nothing has moved.
TEST_F(ChannelFineCompareTest, ChangingToMldtAndBackLeavesNothing) {
  for (const unsigned channel : {1u, 2u})
    for (const bool up : {true, false}) {
      const int way = up ? 1 : -1;
      to_the_end_of_cell_4(up);
      place(channel, {4 * way, 2048}, {100 * way, 0}, 5);
      const bool before{equ(channel)};
      for (const std::uint32_t word : {decode_mode(regs::decode::kMldt) | kPfm | kFine, kFineWord}) {
        control(1, word);
        rig_.ticks(20 * kSclk);
        EXPECT_EQ(bool{equ(channel)}, before) << "channel " << channel << (up ? ", up" : ", down");
        EXPECT_EQ(rig_.read(channel, words::kCompareB), static_cast<std::uint32_t>(100 * way) & kCounterMask);
      }
      steps(1, 1, up, 20 * kSclk);
      EXPECT_NE(bool{equ(channel)}, before) << "behind it motion counts";
    }
}

// The same when it is over within an SCLK period: a write an edge of clk_ref, at any edge of the period. The position
// comes from 4, held at 0 across the compare in cell 2, else across that in the middle of its cell.
TEST_F(ChannelFineCompareTest, WhatIsOverWithinAnSclkPeriodLeavesNothing) {
  constexpr unsigned kEdges = 8;  // of an SCLK period
  constexpr Tick kSlow = kEdges * kTicksPerRef;
  constexpr std::uint32_t kReset = kFineWord | kCounterReset, kMldt = decode_mode(regs::decode::kMldt) | kPfm | kFine;
  struct Write {
    unsigned channel;
    std::uint32_t word;
  };
  struct Row {
    const char* what;
    unsigned channel;      // that compares
    std::uint32_t source;  // of channel 2
    int cell;
    std::vector<Write> writes;
  };
  const Row rows[] = {
      {"reset", 1, kFromChannel1, 2, {{1, kReset}, {1, kFineWord}}},
      {"MLDT", 1, kFromChannel1, 4, {{1, kMldt}, {1, kFineWord}}},
      {"1/T off", 1, kFromChannel1, 4, {{1, kX4}, {1, kFineWord}}},
      {"reset of the source", 2, kFromChannel1, 2, {{1, kReset}, {1, kFineWord}}},
      {"MLDT of the source", 2, kFromChannel1, 4, {{1, kMldt}, {1, kFineWord}}},
      {"1/T of the source off", 2, kFromChannel1, 4, {{1, kX4}, {1, kFineWord}}},
      {"reset and away", 2, 0, 2, {{2, kReset | kFromChannel1}, {2, kFineWord}}},
      {"MLDT and away", 2, 0, 4, {{2, kMldt | kFromChannel1}, {2, kFineWord}}},
      {"away, reset",
       2,
       kFromChannel1,
       2,
       {{2, kFineWord}, {1, kReset}, {1, kFineWord}, {2, kFineWord | kFromChannel1}}},
      {"away, MLDT", 2, kFromChannel1, 4, {{2, kFineWord}, {1, kMldt}, {1, kFineWord}, {2, kFineWord | kFromChannel1}}},
      {"away, 1/T off",
       2,
       kFromChannel1,
       4,
       {{2, kFineWord}, {1, kX4}, {2, kFineWord | kFromChannel1}, {1, kFineWord}}},
  };
  rig_.write(ic_words::kClockControl, ic_words::clock_control::kSclkDivider.set(kServoEachPhase, 3));
  for (const Row& row : rows)
    for (const bool up : {true, false})
      for (unsigned start = 0; start < kEdges; ++start) {
        const std::string what = row.what + std::string(up ? ", up, " : ", down, ") + std::to_string(start);
        const int way = up ? 1 : -1;
        const unsigned moves = row.source == 0 ? 2 : 1;
        control(1, kReset);
        control(2, kReset);
        control(1, kFineWord);
        control(2, kFineWord | row.source);
        steps(moves, 4, up, 20 * kSlow);
        rig_.ticks(50 * kSlow);
        place(row.channel, {row.cell * way, 2048}, {100 * way, 0}, 5);
        const bool before{equ(row.channel)};
        while (rig_.now() % kSlow != 0) rig_.tick();
        rig_.ticks(start * kTicksPerRef);
        for (const Write& w : row.writes) control(w.channel, w.word);
        rig_.ticks(20 * kSlow);
        EXPECT_EQ(bool{equ(row.channel)}, before) << what;
        EXPECT_EQ(rig_.peek(row.channel, words::kCompareB), static_cast<std::uint32_t>(100 * way) & kCounterMask)
            << what;
        steps(moves, row.cell == 2 ? 3 : 1, up, 20 * kSlow);
        EXPECT_NE(bool{equ(row.channel)}, before) << what << ": behind it motion counts";
      }
}

// 1/T of channel 1 comes and goes while channel 2 compares its position: from the far end of the cell over the compare
// in its middle.
TEST_F(ChannelFineCompareTest, TurningHardware1TOfTheSourceLeavesNothing) {
  for (const bool up : {true, false}) {
    const int way = up ? 1 : -1;
    to_the_end_of_cell_4(up);
    place(2, {4 * way, 2048}, {100 * way, 0}, 5);
    const bool before{equ(2)};
    for (const std::uint32_t word : {kX4, kFineWord, kX4, kFineWord}) {
      control(1, word);
      rig_.ticks(20 * kSclk);
      EXPECT_EQ(bool{equ(2)}, before) << (up ? "up" : "down") << (word == kFineWord ? ", on" : ", off");
    }
    steps(1, 1, up, 20 * kSclk);
    EXPECT_NE(bool{equ(2)}, before) << "behind it motion counts";
  }
}

// Pulses that begin at 0, where the counter was held: the first count up leaves it.
TEST_F(ChannelFineCompareTest, ACompareAtZeroIsLeftBehindACounterReset) {
  control(1, kFineWord | kCounterReset);
  control(1, kFineWord);
  steps(1, 4, true, 20 * kSclk);
  rig_.ticks(100 * kSclk);
  control(1, kFineWord | kCounterReset);
  place(1, {0, 0}, {100, 0}, 5);
  control(1, kFineWord);
  rig_.ticks(8 * kSclk);
  const bool before{equ(1)};
  step(1, true);
  EXPECT_NE(bool{equ(1)}, before);
  EXPECT_EQ(rig_.peek(1, words::kCompareB), 105u);
}

// A count from 4 to 5 on one SCLK edge, which the next finds beyond {4, 4095}, and a write of X:+5 at any edge of
// clk_ref about it. What comes before the count, or when it has been found, takes nothing away; what comes between
// does.
TEST_F(ChannelFineCompareTest, AWriteTakesAwayTheCountThatIsNotFoundYetAndNoOther) {
  constexpr int kEdges = kSclk / kTicksPerRef;
  struct Row {
    const char* what;
    unsigned channel;  // that compares channel 1's position
    std::uint32_t before;
    std::vector<std::pair<unsigned, std::uint32_t>> writes;
    int lost;
  };
  const Row rows[] = {
      {"1/T on", 1, kX4, {{1, kFineWord}}, 0},  // without it the count itself turns EQU
      {"1/T of the source on", 2, kX4, {{1, kFineWord}}, kEdges},
      {"1/T of the source off", 2, kFineWord, {{1, kX4}}, kEdges},
      // one more: channel 2 has no count of its own
      {"away and back", 2, kFineWord, {{2, kFineWord}, {2, kFineWord | kFromChannel1}}, kEdges + 1},
      {"1/T off and on", 2, kFineWord, {{2, kX4 | kFromChannel1}, {2, kFineWord | kFromChannel1}}, kEdges},
      {"AENA",
       2,
       kFineWord,
       {{2, kFineWord | kFromChannel1 | field::kAena.mask()}, {1, kFineWord | field::kAena.mask()}},
       0},
  };
  for (const Row& row : rows) {
    int lost = 0;
    for (int n = 0; n < 10 * kEdges; ++n) {
      control(1, kFineWord | kCounterReset);
      control(2, kFineWord | kFromChannel1);
      control(1, kFineWord);
      steps(1, 4, true, 20 * kSclk);
      place(row.channel, {4, 4095}, {100, 0}, 5);
      control(1, row.before);
      rig_.ticks(20 * kSclk);
      while (rig_.now() % kSclk != 0) rig_.tick();
      const bool before{equ(row.channel)};
      step(1, true, n * kTicksPerRef);
      for (const auto& [channel, word] : row.writes) control(channel, word);
      rig_.ticks(20 * kSclk);
      lost += bool{equ(row.channel)} == before;
    }
    EXPECT_EQ(lost, row.lost) << row.what;
  }
}

// Channel 2 compares its own position, so that nothing of channel 1 takes its count away, at any edge about it.
TEST_F(ChannelFineCompareTest, WhatChannel1DoesIsNothingToAPositionOfOnesOwn) {
  constexpr int kEdges = kSclk / kTicksPerRef;
  for (const std::uint32_t word : {kX4, kFineWord | kCounterReset, decode_mode(regs::decode::kMldt) | kPfm | kFine}) {
    for (int n = 2 * kEdges; n < 5 * kEdges; ++n) {
      control(1, kFineWord);
      control(2, kFineWord | kCounterReset);
      control(2, kFineWord);
      steps(2, 4, true, 20 * kSclk);
      place(2, {4, 4095}, {100, 0}, 5);
      while (rig_.now() % kSclk != 0) rig_.tick();
      const bool before{equ(2)};
      step(2, true, n * kTicksPerRef);
      control(1, word);
      rig_.ticks(8 * kSclk);
      EXPECT_NE(bool{equ(2)}, before) << n << " edges, control of channel 1 " << std::hex << word;
    }
  }
}

}  // namespace
}  // namespace brick
