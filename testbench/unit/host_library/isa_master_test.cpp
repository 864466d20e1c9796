// The cycles of the bus master, point by point (host-bus:3.4): what it drives and when, at which tick it looks at the
// board, how IOCHRDY stretches a command, and which cycles bytes and words of memory take.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "systemc/host/isa_cycles.h"
#include "systemc/host/isa_master.h"

namespace brick {
namespace {

using ::testing::ElementsAre;
using Lines = std::vector<std::string>;

// A board of pins alone. IOCHRDY is low behind the ticks [low, high); SD is the tick's own number, so that what was
// read tells when.
struct ScriptedBoard {
  Tick low = kNever, high = kNever;
  std::function<bool(Tick)> narrow = [](Tick) { return false; };

  BoardOutputs at(Tick tick) const {
    BoardOutputs pins;
    pins.set(pin::kIsaIochrdy, tick < low || tick >= high ? 1 : 0);
    pins.set(pin::kIsaMemcs16N, narrow(tick) ? 1 : 0);
    pins.set(pin::kIsaSdOe, 3);
    pins.set(pin::kIsaSd, static_cast<std::uint32_t>(tick & 0xFFFF));
    return pins;
  }
};

class IsaMasterTest : public ::testing::Test {
 protected:
  static constexpr TimeFs kStart = 120'000 * kFsPerNs;  // on every grid

  // What the pins do, in ns from the start; the board is taken to each point as the master asks.
  Lines play(const IsaCycle& cycle, const isa::HostTimes& times = isa::kTypical, unsigned width = 16) {
    Lines moves;
    IsaPins pins;
    pins.isa_aen = true;  // as of a DMA before
    pins.isa_sd = 0xFFFF;
    Tick now = fs_to_tick(kStart) - 1;
    master.begin(cycle, kStart, times, width);
    for (int points = 0; master.running() && points < 1000; ++points) {
      if (master.drives()) {
        const IsaPins before = pins;
        master.drive(pins);
        if (const std::string what = changes(before, pins); !what.empty()) {
          moves.push_back(fmt::format("{}{}", in_ns(master.time()), what));
          now = std::max(now, fs_to_tick(master.time()) - 1);  // pins that stay are nothing to stop for
        }
        master.driven();
        continue;
      }
      const Tick limit = master.tick();
      EXPECT_FALSE(!master.waits() && master.stands(board.at(now))) << "who waits for nothing stands by the time alone";
      if (!master.waits()) now = std::max(now, limit);
      while (now < limit && !(master.waits() && master.stands(board.at(now)))) ++now;
      last_look = now;
      master.look(now, board.at(now));
      if (master.result().stuck) return moves;
    }
    EXPECT_FALSE(master.running()) << "it has an end";
    return moves;
  }

  static std::int64_t in_ns(TimeFs time) { return static_cast<std::int64_t>((time - kStart) / kFsPerNs); }
  static Tick floor_of(std::int64_t ns) { return fs_to_tick_floor(kStart + ns * kFsPerNs); }

  static std::string changes(const IsaPins& a, const IsaPins& b) {
    std::string text;
    if (a.isa_la != b.isa_la) text += fmt::format(" LA={:02X}", b.isa_la);
    if (a.isa_sa != b.isa_sa) text += fmt::format(" SA={:05X}", b.isa_sa);
    if (a.isa_aen != b.isa_aen) text += fmt::format(" AEN={:d}", b.isa_aen);
    if (a.isa_sbhe_n != b.isa_sbhe_n) text += fmt::format(" SBHE#={:d}", b.isa_sbhe_n);
    if (a.isa_sd != b.isa_sd) text += fmt::format(" SD={:04X}", b.isa_sd);
    if (a.isa_ior_n != b.isa_ior_n) text += fmt::format(" IOR#={:d}", b.isa_ior_n);
    if (a.isa_iow_n != b.isa_iow_n) text += fmt::format(" IOW#={:d}", b.isa_iow_n);
    if (a.isa_memr_n != b.isa_memr_n) text += fmt::format(" MEMR#={:d}", b.isa_memr_n);
    if (a.isa_memw_n != b.isa_memw_n) text += fmt::format(" MEMW#={:d}", b.isa_memw_n);
    return text;
  }

  ScriptedBoard board;
  IsaMaster master;
  Tick last_look = 0;
};

const IsaCycle kReadIo{IsaCommand::kIoRead, 0x217, 0xFFFF, false};
const IsaCycle kWriteIo{IsaCommand::kIoWrite, 0x217, 0xFF41, false};
const IsaCycle kReadWord{IsaCommand::kMemoryRead, 0xFD1050, 0xFFFF, true};
const IsaCycle kWriteWord{IsaCommand::kMemoryWrite, 0xFD1050, 0xBEEF, true};

// Six BCLK of 120 ns, and three of 16 bits: LA of A23 to A17, SA of A19 to A0.
TEST_F(IsaMasterTest, ATypicalHostDrivesEachPinAtItsTime) {
  EXPECT_THAT(play(kReadIo), ElementsAre("0 SA=00217 AEN=0", "120 IOR#=0", "660 IOR#=1"));
  EXPECT_EQ(in_ns(master.free_at()), 840);
  EXPECT_THAT(play(kWriteIo), ElementsAre("0 SA=00217 AEN=0", "60 SD=FF41", "120 IOW#=0", "660 IOW#=1", "700 SD=FFFF"));
  EXPECT_THAT(play(kReadWord),
              ElementsAre("0 LA=7E SA=D1050 AEN=0 SBHE#=0", "120 MEMR#=0", "360 MEMR#=1", "400 SBHE#=1"));
  EXPECT_EQ(in_ns(master.end()), 400);
  EXPECT_EQ(in_ns(master.free_at()), 480);
  EXPECT_THAT(play(kWriteWord), ElementsAre("0 LA=7E SA=D1050 AEN=0 SBHE#=0", "60 SD=BEEF", "120 MEMW#=0",
                                            "360 MEMW#=1", "400 SBHE#=1 SD=FFFF"));
}

// t1 91, t2 530 or 219, t3 and t7 25, t6 22, t11 170 ns, LA 111 and SA 34 before a command of memory: SA 77 behind LA.
TEST_F(IsaMasterTest, AHostAtTheLimitsDrivesEachPinAtItsTime) {
  EXPECT_THAT(play(kWriteIo, isa::kTight),
              ElementsAre("0 SA=00217 AEN=0", "91 IOW#=0", "113 SD=FF41", "621 IOW#=1", "646 SD=FFFF"));
  EXPECT_EQ(in_ns(master.free_at()), 621 + 170 - 91);
  EXPECT_THAT(play(kWriteWord, isa::kTight), ElementsAre("0 LA=7E", "77 SA=D1050 AEN=0 SBHE#=0", "111 MEMW#=0",
                                                         "133 SD=BEEF", "330 MEMW#=1", "355 SBHE#=1 SD=FFFF"));
  EXPECT_THAT(play(kReadWord, isa::kTight),
              ElementsAre("0 LA=7E", "77 SA=D1050 AEN=0 SBHE#=0", "111 MEMR#=0", "330 MEMR#=1", "355 SBHE#=1"));
  EXPECT_EQ(in_ns(master.free_at()), 330 + 170 - 91);
}

// Where MEMCS16# is high 66 ns behind LA, and in a slot of eight bits, where nobody looks at it.
TEST_F(IsaMasterTest, MemoryOfEightBitsTakesALongCycle) {
  const Tick look = floor_of(66);
  const Lines longer{"0 LA=7E SA=D1050 AEN=0 SBHE#=0", "120 MEMR#=0", "660 MEMR#=1", "700 SBHE#=1"};
  board.narrow = [look](Tick tick) { return tick == look; };
  EXPECT_EQ(play(kReadWord), longer);
  EXPECT_TRUE(master.result().narrow);
  EXPECT_EQ(in_ns(master.free_at()), 720);
  board.narrow = [look](Tick tick) { return tick != look; };
  EXPECT_EQ(play(kReadWord).at(2), "360 MEMR#=1");
  EXPECT_FALSE(master.result().narrow);
  EXPECT_EQ(play(kReadWord, isa::kTypical, 8), longer);
  EXPECT_FALSE(master.result().narrow) << "not looked at";
  board.narrow = [](Tick) { return true; };
  EXPECT_EQ(play(kReadIo).back(), "660 IOR#=1") << "nor in a cycle of I/O";
  EXPECT_FALSE(master.result().narrow);
  EXPECT_THAT(play(kWriteWord, isa::kTight),
              ElementsAre("0 LA=7E", "77 SA=D1050 AEN=0 SBHE#=0", "111 MEMW#=0", "133 SD=BEEF",
                          fmt::format("{} MEMW#=1", 111 + 530), fmt::format("{} SBHE#=1 SD=FFFF", 111 + 530 + 25)));
}

// 10 ns before the command ends, at the limits t4: 489 or 173 ns behind its fall. The board is left before the edge
// that sees address and data go.
TEST_F(IsaMasterTest, DataAreLookedAtBeforeTheCommandEnds) {
  const std::tuple<IsaCycle, isa::HostTimes, int, int> cycles[] = {{kReadIo, isa::kTypical, 650, 700},
                                                                   {kReadWord, isa::kTypical, 350, 400},
                                                                   {kReadIo, isa::kTight, 91 + 489, 646},
                                                                   {kReadWord, isa::kTight, 111 + 173, 355}};
  for (const auto& [cycle, times, sample, release] : cycles) {
    play(cycle, times);
    EXPECT_EQ(master.result().data, floor_of(sample) & 0xFFFF) << sample;
    EXPECT_EQ(last_look, fs_to_tick(kStart + release * kFsPerNs) - 1) << sample;
  }
}

// A lane that nobody drives is pulled up.
TEST(IsaMaster, LanesThatNobodyDrivesReadOnes) {
  BoardOutputs pins;
  pins.set(pin::kIsaSd, 0x1234);
  const std::uint16_t expected[] = {0xFFFF, 0xFF34, 0x12FF, 0x1234};
  for (unsigned driven = 0; driven < 4; ++driven) {
    pins.set(pin::kIsaSdOe, driven);
    EXPECT_EQ(IsaMaster::data_bus(pins), expected[driven]) << driven;
  }
}

// IOCHRDY is looked at one BCLK before the command would end, and again with each BCLK: the command ends with the first
// one before which IOCHRDY was high for a BCLK (t9). What moves before or between two looks does not count.
TEST_F(IsaMasterTest, ATypicalHostEndsTheCommandWithTheBclkBehindReady) {
  const int times[] = {100, 130, 300, 530, 535, 540, 545, 550, 650, 655, 665, 670, 700, 780, 890, 900, 910, 2000, 2100};
  for (const int low : times)
    for (const int high : times) {
      if (high <= low) continue;
      board.low = floor_of(low);
      board.high = floor_of(high);
      const auto is_low = [&](int at) { return floor_of(at) >= board.low && floor_of(at) < board.high; };
      int end = 660;
      while (is_low(end - 120)) end += 120;
      EXPECT_EQ(play(kReadIo).back(), fmt::format("{} IOR#=1", end)) << low << ' ' << high;
      EXPECT_EQ(master.result().data, floor_of(end - 10) & 0xFFFF) << "data are looked at 10 ns before";
      EXPECT_EQ(in_ns(master.free_at()), end + 180);
      EXPECT_FALSE(master.result().stuck);
    }
}

// Exactly t9 behind the edge with which IOCHRDY rises; the data of row 4 as long before as in any cycle.
TEST_F(IsaMasterTest, AHostAtTheLimitsEndsTheCommandABclkBehindReady) {
  for (const int high : {300, 495, 505, 600, 1000, 5000}) {
    board.low = floor_of(150);
    board.high = floor_of(high);
    const TimeFs ready = tick_to_fs(board.high) + 120 * kFsPerNs, end = kStart + 621 * kFsPerNs;
    const TimeFs expected = floor_of(621 - 120) >= board.high ? end : ready;
    EXPECT_EQ(play(kReadIo, isa::kTight).back(), fmt::format("{} IOR#=1", in_ns(expected))) << high;
    EXPECT_EQ(master.result().data, fs_to_tick_floor(expected - 41 * kFsPerNs) & 0xFFFF) << high;
  }
}

// t10, 15.6 us: a typical host looks for the last time a BCLK before the first end of the command behind that, 15.66 us
// from the start, a slow one, of which 15.6 us are an end, before the next; one at the limits 15.6 us behind the fall
// of the command.
TEST_F(IsaMasterTest, IochrdyThatStaysLowForT10IsAnError) {
  const struct {
    const isa::HostTimes& times;
    Tick last;
  } hosts[] = {{isa::kTypical, floor_of(15'660 - 120)},
               {isa::kSlow, floor_of(15'600)},
               {isa::kTight, fs_to_tick(kStart + (91 + 15'600) * kFsPerNs)}};
  for (const auto& host : hosts) {
    board.low = floor_of(200);
    board.high = host.last;
    play(kReadIo, host.times);
    EXPECT_FALSE(master.result().stuck);
    EXPECT_FALSE(master.running());
    board.high = host.last + 1;
    play(kReadIo, host.times);
    EXPECT_TRUE(master.result().stuck);
    EXPECT_EQ(last_look, host.last);
    EXPECT_TRUE(master.running()) << "the command is still low";
  }
}

// --------------------------------------------------------------------------------------------------- bytes and words

struct RecordedCycles final : IsaCycles {
  IsaResult cycle(const IsaCycle& c) override {
    static constexpr const char* kNames[] = {"IOR", "IOW", "MEMR", "MEMW"};
    cycles.push_back(fmt::format("{} {:X} {:04X}{}", kNames[static_cast<unsigned>(c.command)], c.address, c.data,
                                 c.sbhe ? " SBHE" : ""));
    const unsigned low = c.address & 0xFF;  // the byte that stands there
    const bool is_narrow = c.memory() && narrow;
    return {static_cast<std::uint16_t>(is_narrow || !c.memory() ? 0xAA00 | low : (low | 1) << 8 | (low & 0xFE)),
            is_narrow, false};
  }
  unsigned width() const override { return slot; }
  bool irq() const override { return false; }
  Lines take() { return std::exchange(cycles, {}); }

  Lines cycles;
  bool narrow = false;
  unsigned slot = 16;
};

TEST(IsaCycles, IoIsBytesOnTheLowLane) {
  RecordedCycles bus;
  EXPECT_EQ(bus.read_io(0x217), 0x17);
  bus.write_io(0x213, 0x42);
  EXPECT_EQ(bus.take(), (Lines{"IOR 217 FFFF", "IOW 213 FF42"}));
}

// A0 low and SBHE# low: both lanes; A0 high and SBHE# low: the upper one alone; A0 low alone: the lower one.
TEST(IsaCycles, AWordOfMemoryIsOneCycleOfSixteenBits) {
  RecordedCycles bus;
  EXPECT_EQ(bus.read_memory(0xD1050, 3), 0x5150);
  bus.read_memory(0xD1050, 1);
  bus.read_memory(0xD1050, 2);
  EXPECT_EQ(bus.take(), (Lines{"MEMR D1050 FFFF SBHE", "MEMR D1050 FFFF", "MEMR D1051 FFFF SBHE"}));
  for (const unsigned lanes : {3u, 1u, 2u}) bus.write_memory(0xD1050, 0xBEEF, lanes);
  EXPECT_EQ(bus.take(), (Lines{"MEMW D1050 BEEF SBHE", "MEMW D1050 BEEF", "MEMW D1051 BEEF SBHE"}));
}

// Memory that does not say MEMCS16# has answered for its low byte at most: each byte once more, on the low lane.
TEST(IsaCycles, MemoryOfEightBitsTakesACycleForEachByte) {
  RecordedCycles bus;
  bus.narrow = true;
  for (const unsigned slot : {16u, 8u}) {
    bus.slot = slot;
    const auto behind_the_word = [&](Lines bytes, const std::string& word) {
      if (slot == 16) bytes.insert(bytes.begin(), word);
      return bytes;
    };
    EXPECT_EQ(bus.read_memory(0xD1050, 3), 0x5150);
    EXPECT_EQ(bus.take(), behind_the_word({"MEMR D1050 FFFF", "MEMR D1051 FFFF"}, "MEMR D1050 FFFF SBHE"));
    EXPECT_EQ(bus.read_memory(0xD1050, 1), 0xFF50) << "the other lane reads ones";
    EXPECT_EQ(bus.take(), behind_the_word({"MEMR D1050 FFFF"}, "MEMR D1050 FFFF"));
    EXPECT_EQ(bus.read_memory(0xD1050, 2), 0x51FF);
    EXPECT_EQ(bus.take(), behind_the_word({"MEMR D1051 FFFF"}, "MEMR D1051 FFFF SBHE"));
    bus.write_memory(0xD1050, 0xBEEF, 3);
    EXPECT_EQ(bus.take(), behind_the_word({"MEMW D1050 FFEF", "MEMW D1051 FFBE"}, "MEMW D1050 BEEF SBHE"));
    bus.write_memory(0xD1050, 0xBEEF, 1);
    EXPECT_EQ(bus.take(), behind_the_word({"MEMW D1050 FFEF"}, "MEMW D1050 BEEF"));
    bus.write_memory(0xD1050, 0xBEEF, 2);
    EXPECT_EQ(bus.take(), behind_the_word({"MEMW D1051 FFBE"}, "MEMW D1051 BEEF SBHE"));
  }
}

}  // namespace
}  // namespace brick
