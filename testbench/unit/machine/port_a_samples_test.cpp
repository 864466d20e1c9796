// What the CPU takes from a bus that moves: bits of D that change between the sample of row 104 and /RD high, a bus
// that nobody drives, and /TA that changes inside rows 118 and 119. At I52 = 7, ticks of 8.477 ns and TC of 12.716 ns.
#include <gmock/gmock.h>

#include <set>

#include "testbench/unit/covers.h"
#include "testbench/unit/machine/port_a_rig.h"

namespace brick {
namespace {

BoardOutputs shows(std::uint32_t data, bool driven = true, bool busy = false) {
  BoardOutputs o;
  o.set(pin::kPaData, data);
  o.set(pin::kPaDataOe, driven);
  o.set(pin::kPaTaN, busy);
  return o;
}

std::uint32_t read(std::function<BoardOutputs(Tick)> board, std::uint64_t seed, PortACycle* cycle = nullptr,
                   unsigned ws = 7) {
  PortARig rig(std::move(board));
  rig.port_a.seed(seed);
  rig.write('X', 0xFFFFFB, ws << 5 | 3 << 10);
  rig.cycle = 31;  // behind the write to BCR; /RD rises at tick 46.5 + 7.75 x 1.5, an edge an eighth before it
  const std::uint32_t data = rig.read('X', 0x078000);
  if (cycle != nullptr) *cycle = *rig.last;
  return data;
}
Tick edge_before(TimeFs time) { return fs_to_tick_floor(time); }

TEST(PortASamples, BitsThatMoveAfterTheSampleAreRandomBySeed) {
  BRICK_COVERS("CARD-5");
  PortACycle c;
  read([](Tick) { return shows(0); }, 1, &c);
  const Tick in_time = edge_before(c.data_time), late = in_time + 1;
  ASSERT_LT(tick_to_fs(late), c.strobe_high) << "an edge inside the window";
  const auto moves_at = [](Tick when) { return [when](Tick t) { return shows(t < when ? 0x111111 : 0x112211); }; };
  std::set<std::uint32_t> words;
  for (std::uint64_t seed = 1; seed <= 64; ++seed) {
    EXPECT_EQ(read(moves_at(in_time), seed, &c), 0x112211u) << "in time";
    const std::uint32_t word = read(moves_at(late), seed, &c);
    EXPECT_EQ(word, read(moves_at(late), seed)) << "the same seed, the same word";
    EXPECT_EQ(word & ~0x003300u, 0x110011u) << "bits that stood";
    words.insert(word);
  }
  EXPECT_GT(words.size(), 8u) << "of sixteen";
}

TEST(PortASamples, ABusThatNobodyDrivesGivesAnything) {
  BRICK_COVERS("CARD-5");
  PortACycle c;
  std::set<std::uint32_t> words;
  for (std::uint64_t seed = 1; seed <= 32; ++seed) words.insert(read([](Tick) { return shows(5, false); }, seed, &c));
  EXPECT_GT(words.size(), 30u);
  const Tick gone = edge_before(c.strobe_high);
  words.clear();
  for (std::uint64_t seed = 1; seed <= 32; ++seed)
    words.insert(read([gone](Tick t) { return shows(5, t < gone); }, seed, &c));
  EXPECT_GT(words.size(), 30u) << "let go just before /RD rises";
  const Tick after = fs_to_tick(c.strobe_high);
  EXPECT_EQ(read([after](Tick t) { return shows(5, t < after); }, 1), 5u) << "no hold is needed";
}

// /TA falls between the sample, TC / 4 + 2 ns before /RD would rise, and that rise.
TEST(PortASamples, TaThatMovesInItsWindowIsSeenOrNotBySeed) {
  BRICK_COVERS("CARD-5");
  const auto ready_at = [](Tick when) { return [when](Tick t) { return shows(7, true, t < when); }; };
  PortACycle c;
  read(ready_at(0), 1, &c);
  ASSERT_EQ(c.stretched, 0u);
  const Tick in_time = edge_before(c.ta_time), inside = edge_before(c.strobe_high);
  ASSERT_GT(inside, in_time);
  unsigned seen = 0;
  for (std::uint64_t seed = 1; seed <= 64; ++seed) {
    read(ready_at(in_time), seed, &c);
    EXPECT_EQ(c.stretched, 0u) << "in time";
    read(ready_at(inside), seed, &c);
    EXPECT_LE(c.stretched, 1u);
    seen += c.stretched == 0;
    read(ready_at(inside + 1), seed, &c);
    EXPECT_EQ(c.stretched, 1u) << "after the window of one sample and before that of the next";
  }
  EXPECT_GT(seen, 16u);
  EXPECT_LT(seen, 48u);
}

// The board lets go of D as /RD comes to it, and that is at the CPU before a word of the edge before, which has its 10
// ns on the way (docs/port_a.md, Skew).
TEST(PortASamples, TheEndOfDIsAsLateAsItsStrobeAndNoLater) {
  BRICK_COVERS("CARD-5");
  struct Watch final : PortAWatch {
    void cpu_moved(TimeFs, const PortALevels&) override {}
    void board_moved(TimeFs time, const BoardOutputs& board) override { moves.emplace_back(time, board); }
    void bus_reset() override {}
    std::vector<std::pair<TimeFs, BoardOutputs>> moves;
  };
  for (const TimeFs pad : {TimeFs{0}, PinSkew::kMost / 2, PinSkew::kMost}) {
    unsigned overtaken = 0;
    for (Tick before = -3; before < 4; ++before) {
      SCOPED_TRACE(::testing::Message() << fs_to_ns(pad) << " ns, word " << before << " edges before");
      Watch watch;
      PortARig* board = nullptr;
      Tick moves = kNever;
      PortARig rig([&](Tick t) { return shows(t < moves ? 1 : 2, board != nullptr && !board->pins.pa_rd_n); });
      board = &rig;
      PinSkew skew;
      skew.set(kRdLine, pad);
      rig.port_a.set_skew(skew);
      rig.read('X', 0x078000);
      const TimeFs low = rig.last->strobe_high - rig.last->strobe_low;
      rig.on_pins = [&](Tick now, const BoardInputs&, const BoardInputs& after) {
        if (!after.pa_rd_n) moves = std::min(moves, now + fs_to_tick_floor(low) - before);
      };
      rig.port_a.set_watch(&watch);
      rig.read('X', 0x078000);
      const TimeFs off = rig.last->strobe_high + pad;
      bool driven = false;
      for (const auto& [time, shown] : watch.moves) {
        const bool drives = shown.get(pin::kPaDataOe) != 0;
        EXPECT_TRUE(drives ? time < off : !driven || time == off);
        overtaken += time > off;
        driven = drives;
      }
      EXPECT_FALSE(driven);
    }
    EXPECT_GT(overtaken, 0u);
  }
}

TEST(PortASamples, ForcedWaitStatesWinOverTheProgram) {
  PortARig rig;
  rig.port_a.force_wait_states(9 << 5);
  rig.write('X', 0xFFFFFB, 3 << 5);
  EXPECT_EQ(rig.read('X', 0xFFFFFB), 3u << 5) << "the program reads what it wrote";
  rig.read('X', 0x078000);
  EXPECT_EQ(rig.last->wait_states, 9u);
}

// Not before the program has set up its bus: by another clock, or by other wait states of a device.
TEST(PortASamples, ForcedWaitStatesActAfterTheSetUp) {
  const auto wait_states = [](std::uint32_t i52, std::uint32_t bcr) {
    PortARig rig;
    rig.port_a.force_wait_states(9 << 5);
    rig.write('X', 0xFFFFFB, 0x1FFFFF);
    rig.write('X', 0xFFFFFD, i52);
    rig.write('X', 0xFFFFFB, bcr);
    rig.read('X', 0x078000);
    return rig.last->wait_states;
  };
  EXPECT_EQ(wait_states(7, 0x1FFFFF), 31u) << "as after a reset";
  EXPECT_EQ(wait_states(7, 0x1FFFE1), 31u) << "another number for main memory alone";
  EXPECT_EQ(wait_states(31, 0x1FFFE5), 9u);
  EXPECT_EQ(wait_states(0, 0x1FFFFF), 9u);
  EXPECT_EQ(wait_states(7, 0x1FFFDF), 9u);
  EXPECT_EQ(wait_states(7, 0x1FFBFF), 9u);
  EXPECT_EQ(wait_states(7, 0x1EFFFF), 9u);
}

}  // namespace
}  // namespace brick
