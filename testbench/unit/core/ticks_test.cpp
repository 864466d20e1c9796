// The time base: exact conversion between ticks of clk_pwm and femtoseconds.
#include "systemc/core/ticks.h"

#include <random>

#include "systemc/core/board_pins.h"
#include "systemc/core/cpu_clock.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

TEST(Ticks, OneSecondIsTheClockFrequency) {
  EXPECT_EQ(fs_to_tick(1'000'000'000'000'000), 117'964'800);
  EXPECT_EQ(tick_to_fs(117'964'800), 1'000'000'000'000'000);
}

TEST(Ticks, InputOnAnEdgeIsSeenByThatEdgeAndLaterByTheNext) {
  for (const Tick t : {1LL, 2LL, 9216LL, 117'964'801LL, 1'000'000'000'007LL}) {
    const TimeFs edge = tick_to_fs(t);
    EXPECT_EQ(fs_to_tick(edge), t);
    EXPECT_EQ(fs_to_tick(edge + 1), t + 1) << "more than one femtosecond after the edge's integer time";
    EXPECT_EQ(fs_to_tick_floor(edge), t);
    EXPECT_EQ(fs_to_tick_floor(edge - 1), t - 1);
  }
}

// A tick is 5^13 fs / 144: by long division, at all places where a number of 64 bits or the quotient by the reciprocal
// might be wrong.
TEST(Ticks, ConversionIsExactForAllTimes) {
  constexpr TimeFs kBlock = 1'220'703'125;
  std::mt19937_64 random(1);
  std::vector<TimeFs> times = {0};
  for (int bit = 1; bit < 86; ++bit)
    for (const TimeFs power : {TimeFs{1} << bit, (TimeFs{1} << bit) / kBlock * kBlock})
      for (TimeFs off = -2; off <= 2; ++off) times.push_back(power + off);
  for (int n = 0; n < 100'000; ++n) {
    const TimeFs any = (static_cast<TimeFs>(random()) << 64 | random()) >> (43 + random() % 60);
    times.push_back(any < 0 ? -any : any);
    times.push_back(times.back() / kBlock * kBlock);  // on an edge
  }
  for (const TimeFs time : times) {
    if (time < 0) continue;
    const TimeFs numerator = time * 144;
    ASSERT_EQ(TimeFs{fs_to_tick(time)}, (numerator + kBlock - 1) / kBlock) << static_cast<double>(time) << " fs";
    // An edge's time is rounded down to a femtosecond, and counts as the edge.
    ASSERT_EQ(TimeFs{fs_to_tick_floor(time)}, (numerator + 143) / kBlock) << static_cast<double>(time) << " fs";
    const Tick tick = fs_to_tick(time);
    ASSERT_EQ(tick_to_fs(tick), static_cast<TimeFs>(tick) * kBlock / 144) << tick;
  }
}

// What stands for "never" is compared with ticks too, so it has one: the last, behind every other.
TEST(Ticks, ForeverHasATick) {
  EXPECT_EQ(fs_to_tick(kForever), INT64_MAX);
  EXPECT_EQ(fs_to_tick_floor(kForever), INT64_MAX);
  EXPECT_EQ(fs_to_tick_floor(kForever - 1), INT64_MAX - 1);
  EXPECT_GT(fs_to_tick_floor(kForever), kNever);
}

TEST(Ticks, ATimeBeforePowerOnIsRoundedTheSameWay) {
  EXPECT_EQ(fs_to_tick(-1), 0);
  EXPECT_EQ(fs_to_tick(-1'220'703'125), -144);
  EXPECT_EQ(fs_to_tick_floor(-2), -1);
}

// Cycle c begins 12 c / n ticks after the edge at which the clock was set.
TEST(Ticks, CpuClockIsExactForYears) {
  for (const Tick edge : {Tick{0}, Tick{1'088'000'000'000}, Tick{1} << 41, Tick{1} << 50, Tick{1} << 52})
    for (const unsigned n : {1u, 7u, 8u, 18u, 32u}) {
      CpuClock clock;
      clock.restart(edge, 12'345, n);
      for (const std::int64_t cycles : {0LL, 1LL, 5LL, 1LL << 31, 1LL << 32, 1LL << 40, 1LL << 52}) {
        const TimeFs parts = static_cast<TimeFs>(edge) * n + static_cast<TimeFs>(cycles) * 12;  // of a tick / n
        EXPECT_EQ(clock.time(12'345 + cycles), parts * 1'220'703'125 / (144 * n)) << edge << ' ' << n << ' ' << cycles;
        EXPECT_EQ(TimeFs{clock.tick(12'345 + cycles)}, (parts + n - 1) / n);
        const TimeFs first = (static_cast<TimeFs>(cycles) * n + 11) / 12;  // that begins so many ticks after the edge
        EXPECT_EQ(TimeFs{clock.first_cycle(edge + cycles)}, 12'345 + first);
      }
    }
}

TEST(Ticks, NanosecondsRoundUp) {
  EXPECT_EQ(ns_to_ticks(1), 1);
  EXPECT_EQ(ns_to_ticks(78'125), 9216);  // exactly 78.125 us
}

TEST(BoardPins, FieldsDoNotOverlapAndFitTheirWords) {
  BoardOutputs used;
  for (const PinField& f : pin::kAll) {
    ASSERT_LT(f.word, kBoardOutputWords) << f.name;
    ASSERT_LE(f.lsb + f.width, 32u) << f.name;
    EXPECT_EQ(used.get(f), 0u) << f.name;
    used.set(f, ~0u);
  }
}

}  // namespace
}  // namespace brick
