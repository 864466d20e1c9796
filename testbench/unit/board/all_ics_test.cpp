// The board with all 22 ICs through its pins: every IC at its address, each as the source of the clocks in turn, two at
// once, the kinds. On the model, and on the RTL beside it in lock-step. Addresses are those of servo-ic:1.2 and
// servo-ic:1.3.
#include <gtest/gtest.h>

#include <string>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/board/words.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/servo_ic/clock_words.h"

namespace brick {
namespace {

constexpr std::uint32_t kAll = 0x3FFFFF;
constexpr unsigned kFirstMacro = 18;
constexpr std::uint32_t kBases[22] = {0x78000, 0x78100, 0x78200, 0x78300, 0x79200, 0x79300, 0x7A200, 0x7A300,
                                      0x7B200, 0x7B300, 0x78220, 0x78320, 0x79220, 0x79320, 0x7A220, 0x7A320,
                                      0x7B220, 0x7B320, 0x78400, 0x79400, 0x7A400, 0x7B400};

std::uint32_t clock_address(unsigned ic) { return kBases[ic] + (ic < kFirstMacro ? 0x04 : 0x0C); }
std::uint32_t pwm_address(unsigned ic) { return kBases[ic] + (ic < kFirstMacro ? 0x1C : 0x0D); }
std::uint32_t strobe_address(unsigned ic) { return kBases[ic] + (ic < kFirstMacro ? 0x14 : 0x0E); }

class AllIcs : public ::testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Board> make(std::uint32_t fitted) {
    if (GetParam() == "Model") return make_model_board(fitted);
    return make_lockstep_board(make_rtl_board(fitted), make_model_board(fitted));
  }
  BoardRig rig{make(kAll), kAll};
};

TEST_P(AllIcs, EveryIcHasAPlaceOfItsOwn) {
  for (unsigned ic = 0; ic < 22; ++ic) rig.write(true, strobe_address(ic), 0x010101 * (ic + 1));
  for (unsigned ic = 0; ic < 22; ++ic)
    EXPECT_EQ(rig.read(true, strobe_address(ic)), 0x010101 * (ic + 1)) << "IC " << ic;
  for (unsigned ic = 0; ic < 22; ++ic) EXPECT_EQ(rig.read(true, clock_address(ic)), 0x3038D2u) << "IC " << ic;
}

TEST_P(AllIcs, AnIcThatIsNotFittedIsNotThere) {
  for (unsigned ic = 0; ic < 22; ++ic) {
    rig.in.fitted = kAll & ~(1u << ic);
    rig.apply();
    rig.run(3);
    rig.write(true, clock_address(ic), clock_word(0, 3, 0));
    EXPECT_EQ(rig.read(true, strobe_address(ic)), 0u) << "IC " << ic;
    EXPECT_EQ(rig.get(pin::kPhaseSource), kNoSource) << "IC " << ic;
    const unsigned next = (ic + 1) % 22;
    EXPECT_EQ(rig.read(true, strobe_address(next)), 0xFFFFFEu) << "IC " << next;
  }
}

TEST_P(AllIcs, EachCanSupplyTheBoard) {
  BRICK_COVERS("I19-2 CLK-2");
  for (unsigned ic = 0; ic < 22; ++ic) {
    const std::uint32_t max_count = 300 + ic;
    rig.write(true, pwm_address(ic), pwm_word(max_count));
    rig.write(true, clock_address(ic), clock_word(0, 3, 0));
    rig.run(60'000);  // past the period of the reset value, and the pins are taken with rising edges
    EXPECT_EQ(rig.get(pin::kPhaseSource), ic);
    EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
    const Tick period = 2 * Tick{max_count} + 3;
    const Tick rise = rig.edge(pin::kPhase, 1);
    EXPECT_EQ(rig.edge(pin::kPhase, 1) - rise, period) << "IC " << ic;
    const Tick fall = rig.edge(pin::kServo, 0);
    EXPECT_EQ(rig.edge(pin::kServo, 0) - fall, 4 * period) << "IC " << ic;
    rig.write(true, clock_address(ic), clock_word(0, 3, 3));
    rig.run(4 * period);  // released while high
  }
  EXPECT_EQ(rig.get(pin::kPhaseSource), kNoSource);
}

TEST_P(AllIcs, LowestIndexOfSeveralSourcesWins) {
  for (unsigned ic = 22; ic-- > 0;) {
    rig.write(true, clock_address(ic), clock_word(0, 3, 0));
    rig.run(60'000);
    EXPECT_EQ(rig.get(pin::kPhaseSource), ic);
    EXPECT_EQ(rig.get(pin::kSourceConflict), ic == 21 ? 0u : 1u);
  }
}

TEST_P(AllIcs, AMacroGateDrivesPhaseAtMostAndHasNoSupplementaryChannels) {
  for (unsigned gates : {0u, 5u, 15u}) {
    rig.in.macro_gate = gates;
    rig.apply();
    rig.run(3);
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned ic = kFirstMacro + i;
      const bool gate = (gates >> i & 1) != 0;
      rig.write(true, kBases[ic] + 0x15, 0x39FFFF);
      EXPECT_EQ(rig.read(true, kBases[ic] + 0x15), gate ? 0u : 0x39FFFFu);
      rig.write(true, clock_address(ic), clock_word(0, 3, 3));
      EXPECT_EQ(rig.read(true, clock_address(ic)), clock_word(0, 3, gate ? 1 : 3));
      rig.write(true, clock_address(ic), clock_word(0, 3, 0));
      rig.run(60'000);
      EXPECT_EQ(rig.get(pin::kPhaseSource), ic);
      rig.edge(pin::kPhase, 0);
      Tick low = 0;
      for (int t = 0; t < 60; ++t) {
        rig.run(1000);
        low += rig.get(pin::kServo) == 0;
      }
      EXPECT_EQ(low == 0, gate) << "SERVO of MACRO IC " << i;
      rig.write(true, clock_address(ic), clock_word(0, 3, 3));
      rig.run(4 * 13057);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, AllIcs, ::testing::Values("Model", "Lockstep"),
                         [](const auto& p) { return p.param; });

// Whatever is fitted, there is a Verilated board that has it, and nothing else answers.
TEST(Variants, EveryCombinationOfIcsHasOne) {
  for (const std::uint32_t fitted : {0x1u, 0x3u, 0x4000Cu, 0x40000u, 0x3FFFFFu, 0x200000u}) {
    BoardRig rig(make_rtl_board(fitted), fitted);
    for (unsigned ic = 0; ic < 22; ++ic)
      EXPECT_EQ(rig.read(true, strobe_address(ic)), (fitted >> ic & 1) != 0 ? 0xFFFFFEu : 0u)
          << std::hex << fitted << " IC " << ic;
  }
}

}  // namespace
}  // namespace brick
