// Cycles of the CPU at every CPU clock (I52), number of wait states and phase to clk_pwm, at the limits of
// host-bus:2.2: write data as late and everything gone as early as they may, and each pin that moves within 1 ns of an
// edge taken early or late at random. Where right words must come and go follows from the formulas (docs/dpram.md).
#include <array>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "systemc/cpu/port_a_timing.h"
#include "testbench/unit/host/dpram_bench.h"

namespace brick {
namespace {

constexpr TimeFs kAperture = kFsPerNs, kPeriod = detail::kBlockFs / detail::kBlockTicks;  // of clk_pwm, 8.48 ns
constexpr TimeFs tc(unsigned i52) { return 12 * detail::kBlockFs / detail::kBlockTicks / (i52 + 1); }

// A cycle in quarters of TC from the rows of host-bus:2.2 without their guard bands, for the 1 to 7 wait states of the
// RAM's area. Not the CPU model's own table.
struct Shape {
  unsigned clocks, strobe_low, strobe_high, data_driven, idle_clocks, held_clocks;
};
constexpr Shape shape(unsigned ws, bool write) {
  Shape s{};
  s.clocks = ws + (ws <= 3 ? 1 : 2);                          // row 100
  s.strobe_low = !write ? 2 : ws == 1 ? 1 : ws <= 3 ? 3 : 5;  // rows 115, 101
  s.strobe_high = 4 * ws + 3;                                 // rows 104, 107
  s.data_driven = s.strobe_high - (4 * ws - 1);               // row 108 before row 107; 101 and 110 say the same
  s.idle_clocks = ws <= 3 ? 1 : 0;  // rows 113 and 114, of which rows 100, 115, 101 give the rest
  s.held_clocks = !write && (ws == 2 || ws == 3) ? 1 : 0;  // row 117
  return s;
}
constexpr TimeFs kTaSetup = 2 * kFsPerNs, kDataSetup = 5 * kFsPerNs;  // rows 118 and 104

// host-bus:2.5, row 3.
constexpr unsigned wait_states_of(unsigned i52) { return i52 <= 4 ? 4 : i52 <= 7 ? 3 : i52 <= 9 ? 4 : 7; }

// From the fall of the strobe: when the CPU first looks at /TA, and how late write data may be.
constexpr TimeFs ta_look(unsigned i52, unsigned ws, bool write) {
  const Shape s = shape(ws, write);
  return (s.strobe_high - 1 - s.strobe_low) * tc(i52) / 4 - kTaSetup;
}
constexpr TimeFs data_lag(unsigned i52, unsigned ws) {
  const Shape s = shape(ws, true);
  return (static_cast<TimeFs>(s.data_driven) - s.strobe_low) * tc(i52) / 4 + 3 * kFsPerNs;  // row 108
}
// /TA must be there when the CPU looks; the model shows it at the first edge after the toggle. Data must stand two
// edges after the fall.
constexpr bool right(unsigned i52, unsigned ws) {
  return ta_look(i52, ws, false) >= kPeriod + kAperture && ta_look(i52, ws, true) >= kPeriod + kAperture &&
         data_lag(i52, ws) + kAperture <= 2 * kPeriod - kAperture;
}

// Clocks that /TA adds at most: until it is low at the look, by the times of host-bus:6.9/8.
constexpr unsigned most_stretched(unsigned i52, unsigned ws) {
  constexpr TimeFs kAfterRead = 4 * kPeriod + kAperture, kAfterWrite = 3 * kPeriod + kAperture;  // 34.9 and 26.4 ns
  const auto added = [&](TimeFs low, TimeFs look) {
    return low <= look ? 0u : static_cast<unsigned>((low - look + tc(i52) - 1) / tc(i52));
  };
  return std::max(added(kAfterRead, ta_look(i52, ws, false)), added(kAfterWrite, ta_look(i52, ws, true)));
}
static_assert(most_stretched(31, 7) == 5 && most_stretched(16, 7) == 0);

class CpuCycles : public DpramBench {
 public:
  explicit CpuCycles(unsigned seed) : random_(seed) {}

  // One cycle from `start` on. Returns what a read took.
  unsigned cycle(TimeFs start, unsigned i52, unsigned ws, bool write, unsigned word, unsigned value) {
    const Shape s = shape(ws, write);
    const auto quarters = [&](unsigned n) { return start + n * tc(i52) / 4; };
    auto& in = both.in;
    at(start, [&in, word] {
      in.cpu_sel = true;
      in.cpu_x = word % 2;
      in.cpu_addr = static_cast<std::uint16_t>(word / 2);
    });
    at(quarters(s.strobe_low), [&in, write] {
      std::uint8_t& falls = write ? in.wr_falls : in.rd_falls;
      falls = next_fall(falls);
    });
    at(quarters(s.strobe_low), [&in, write] { (write ? in.cpu_wr_n : in.cpu_rd_n) = false; });
    if (write) {
      in.cpu_wdata = static_cast<std::uint16_t>(~value);
      at(quarters(s.data_driven) + 3 * kFsPerNs, [&in, value] { in.cpu_wdata = static_cast<std::uint16_t>(value); });
    }
    TimeFs high = quarters(s.strobe_high);
    unsigned data = 0;
    for (stretched = 0;; ++stretched, high += tc(i52)) {
      const TimeFs look = high - tc(i52) / 4 - kTaSetup, sample = high - kDataSetup;
      run_to(std::min(look, sample));
      if (sample <= look) data = both.get("cpu_rdata");
      run_to(look);
      const bool wait = shown_wait_;
      run_to(std::max(look, sample));
      if (sample > look) data = both.get("cpu_rdata");
      if (!wait) break;
      if (stretched > 100) return 0xBAD;
    }
    // As early as it may be gone: rows 103, 109, 117 less their guard bands.
    at(high, [this, &in] {
      in.cpu_rd_n = in.cpu_wr_n = true;
      both.get("cpu_drive");  // though the next strobe may fall before a tick has seen it
    });
    const TimeFs clocks = (s.clocks + stretched + s.held_clocks) * tc(i52), gone = start + clocks - 2 * kFsPerNs;
    at(std::max(gone, high), [&in, value] {
      in.cpu_sel = false;
      in.cpu_addr ^= 0x155;
      in.cpu_wdata = static_cast<std::uint16_t>(~value);
    });
    end = start + (s.clocks + stretched + std::max(s.idle_clocks, s.held_clocks)) * tc(i52);
    run_to(std::max(end - 1, high + kAperture));
    return data;
  }

  TimeFs end = 0;
  unsigned stretched = 0;  // clocks added by /TA in the last cycle

 private:
  // An input that moves at `time` is first seen by the edge after it; within the aperture by either.
  void at(TimeFs time, std::function<void()> change) {
    const TimeFs shift = static_cast<TimeFs>(random_() % (2 * kAperture + 1)) - kAperture;
    changes_.emplace(std::max(fs_to_tick(time + shift), both.now() + 1), std::move(change));
  }
  void run_to(TimeFs time) {
    while (both.now() < fs_to_tick_floor(time)) {
      for (auto it = changes_.begin(); it != changes_.end() && it->first <= both.now() + 1; it = changes_.erase(it))
        it->second();
      both.tick();
      shown_wait_ = cpu_wait();  // what moves without a clock shows at the next edge, as on the board
    }
  }

  std::mt19937_64 random_;
  std::multimap<Tick, std::function<void()>> changes_;
  bool shown_wait_ = false;
};

struct Seen {
  unsigned wrong = 0, stretched = 0, most = 0;
};

// Writes and reads back to back, two words in turn, each time at another phase.
Seen play(unsigned i52, unsigned ws, unsigned phases) {
  CpuCycles cpu(i52 * 100 + ws);
  cpu.both.lazy = ws % 2 != 0;
  std::array<unsigned, 2> content{};
  Seen seen;
  for (unsigned phase = 0; phase < phases; ++phase) {
    TimeFs start = tick_to_fs(next_ref_edge(cpu.both.now() + 3)) + phase * kTicksPerRef * kPeriod / phases;
    for (unsigned k = 0; k < 4; ++k) {
      const bool write = k < 2;
      const unsigned word = k % 2, value = (phase * 0x1235 + word * 0x777 + 1) & 0xFFFF;
      const unsigned read = cpu.cycle(start, i52, ws, write, 8 + word, value);
      if (write)
        content[word] = value;
      else
        seen.wrong += read != content[word];
      seen.stretched += cpu.stretched;
      seen.most = std::max(seen.most, cpu.stretched);
      start = cpu.end;
    }
  }
  EXPECT_LOCKSTEP(cpu.both);
  return seen;
}

TEST(DpramTiming, CyclesOfTheCpuModelHaveTheShapeOfTheRows) {
  for (unsigned ws = 1; ws <= 7; ++ws)
    for (const bool write : {false, true}) {
      const Shape rows = shape(ws, write);
      const PortAShape cpu = port_a_shape(ws, write);
      EXPECT_EQ(cpu.clocks, rows.clocks) << ws << (write ? ", write" : ", read");
      EXPECT_EQ(cpu.strobe_low, rows.strobe_low) << ws << (write ? ", write" : ", read");
      EXPECT_EQ(cpu.strobe_high, rows.strobe_high) << ws << (write ? ", write" : ", read");
      if (write) { EXPECT_EQ(cpu.data_driven, rows.data_driven) << ws; }
      EXPECT_EQ(cpu.idle_clocks, rows.idle_clocks) << ws << (write ? ", write" : ", read");
      EXPECT_EQ(cpu.held_clocks, rows.held_clocks) << ws << (write ? ", write" : ", read");
    }
}

TEST(DpramTiming, RightAtEveryClockAndPhaseWhereTheFormulasHold) {
  unsigned held = 0, failed = 0;
  for (unsigned i52 = 0; i52 < 32; ++i52)
    for (unsigned ws = 1; ws <= 7; ++ws) {
      const Seen seen = play(i52, ws, 32);
      if (right(i52, ws)) {
        ++held;
        EXPECT_EQ(seen.wrong, 0u) << "I52 " << i52 << ", " << ws << " wait states";
      } else {
        failed += seen.wrong != 0;
      }
    }
  EXPECT_GE(held, 150u);
  EXPECT_GE(failed, 10u) << "beyond them it goes wrong";
}

TEST(DpramTiming, TheWaitStatesOfTheDataSheetHoldAndAddNothingUpToI52Of15) {
  for (unsigned i52 = 0; i52 < 32; ++i52) {
    const unsigned ws = wait_states_of(i52);
    EXPECT_TRUE(right(i52, ws)) << i52;
    const Seen seen = play(i52, ws, 64);
    EXPECT_EQ(seen.wrong, 0u) << i52;
    if (i52 <= 15)
      EXPECT_EQ(seen.stretched, 0u) << i52;
    else
      EXPECT_LE(seen.most, most_stretched(i52, ws)) << i52;
  }
}

// Three wait states at I52 = 0: the least of host-bus:2.5's formula, and one too few for a write.
TEST(DpramTiming, WriteDataOfTheSlowestClocksNeedTheFourthWaitState) {
  for (const unsigned i52 : {0u, 1u}) {
    EXPECT_FALSE(right(i52, 3)) << i52;
    EXPECT_NE(play(i52, 3, 512).wrong, 0u) << i52;
  }
}

}  // namespace
}  // namespace brick
