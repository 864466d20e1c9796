// The time base: exact conversion between ticks of clk_pwm and femtoseconds.
#include "systemc/core/ticks.h"

#include "systemc/core/board_pins.h"
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
