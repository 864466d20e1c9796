// Serial encoder inputs as they are wired into the board, through its pins, the same expectations on both engines:
// which addresses they have on which product, whose clocks trigger, which pins a channel has, what a trip of the
// watchdog is to a frame.
#include <gtest/gtest.h>

#include <string>

#include "testbench/unit/cosim/board_map.h"

namespace brick {
namespace {

// Straps::ssi_kind.
constexpr std::uint8_t kNone = 0, kGeo = 1, kGeoBrick = 2, kGeoPageAlone = 3;

std::unique_ptr<Board> make_board(const std::string& engine) {
  if (engine == "Rtl") return make_rtl_board(kTwoServoIcs);
  if (engine == "Model") return make_model_board(kTwoServoIcs);
  return make_lockstep_board(make_rtl_board(kTwoServoIcs), make_model_board(kTwoServoIcs));
}

class BoardSsi : public ::testing::TestWithParam<const char*> {
 protected:
  BoardSsi() : rig(make_board(GetParam()), kTwoServoIcs) {}

  void start(std::uint8_t kind) {
    rig.in.ssi_kind = kind;
    rig.in.ext_clock = true;
    rig.apply();
    rig.run(30);
  }
  bool driven(bool x, std::uint32_t address) {
    rig.in.pa_addr = address;
    rig.in.pa_x = x;
    rig.in.pa_aa = 2;
    rig.in.pa_rd_n = false;
    rig.apply();
    rig.run(10);
    const bool driven = rig.get(pin::kPaDataOe) != 0;
    rig.in.pa_rd_n = true;
    rig.apply();
    rig.run(8);
    return driven;
  }
  // A level of a clock from outside; ticks from the board's own pin to the first move of a serial clock.
  Tick first_move(bool BoardInputs::*net, const PinField& shown, bool level) {
    rig.in.*net = level;
    rig.apply();
    const Tick moved = rig.edge(shown, level ? 1 : 0, 200);
    const std::uint32_t before = rig.get(pin::kSsiClk);
    for (Tick i = 1; i < 60; ++i) {
      rig.run(1);
      if (rig.get(pin::kSsiClk) != before) return rig.now() - moved;
    }
    return kNever;
  }

  BoardRig rig;
};

// servo-ic:11.4/5: the page is device registers on a Geo PMAC, with the option or without, and reads 0 where nothing
// is; on other boards it is none of this board's.
TEST_P(BoardSsi, AGeoPmacHasItsPage) {
  BRICK_COVERS("SSI-1 SSI-2");
  for (const std::uint8_t kind : {kNone, kGeo, kGeoBrick, kGeoPageAlone}) {
    SCOPED_TRACE(int{kind});
    start(kind);
    for (const std::uint32_t address : {0xFF00u, 0xFF54u, 0xFF80u, 0xFFFFu})
      for (const bool x : {false, true})
        EXPECT_EQ(driven(x, address), kind == kGeo || kind == kGeoPageAlone) << address;
    EXPECT_FALSE(driven(true, 0xFEFF));
    EXPECT_FALSE(driven(true, 0x1FF54));
    if ((kind & kGeo) == 0) continue;
    for (std::uint32_t address = 0xFF00; address < 0x10000; ++address) rig.write(true, address, 0xFFFFFF);
    for (std::uint32_t address = 0xFF00; address < 0x10000; ++address) {
      const bool control = address == 0xFF54 || address == 0xFF74, clock = address == 0xFF55;
      EXPECT_EQ(rig.read(true, address), kind != kGeo ? 0u : control ? 0xFu : clock ? 3u : 0u) << address;
      EXPECT_EQ(rig.read(false, address), 0u) << address;
    }
  }
}

TEST_P(BoardSsi, AGeoBrickHasItsWordsAndNobodyElseHas) {
  BRICK_COVERS("SSI-1");
  for (const std::uint8_t kind : {kNone, kGeo, kGeoBrick, kGeoPageAlone}) {
    SCOPED_TRACE(int{kind});
    start(kind);
    for (std::uint32_t address = 0x78B00; address < 0x78B60; ++address) rig.write(true, address, 0x00E820);
    for (std::uint32_t address = 0x78B00; address < 0x78B60; ++address) {
      const bool here = kind == kGeoBrick && address >= 0x78B20 && address < 0x78B40;
      const std::uint32_t control = here && address % 4 == 0 ? 0xE820 : 0,
                          timing = here && address % 16 == 15 ? 0xE020 : 0;
      EXPECT_EQ(rig.read(true, address), control | timing) << address;
    }
    for (const std::uint32_t other : {0x78A20u, 0x79B20u, 0x7AB20u, 0x7BB20u, 0x78F20u, 0x78320u})
      EXPECT_EQ(rig.read(true, other), 0u) << other;
  }
}

// servo-ic:11.9/8: the first fall is at the edge that sees the net's move, a tick behind the board's pin.
TEST_P(BoardSsi, TheBoardsClocksTrigger) {
  BRICK_COVERS("SSI-1");
  start(kGeoBrick);
  rig.write(true, 0x78B2F, 0x180302);  // SERVO falls
  rig.write(true, 0x78B3F, 0x180002);  // PHASE rises
  rig.write(true, 0x78B20, 0x140C);
  rig.write(true, 0x78B3C, 0x140C);
  EXPECT_EQ(first_move(&BoardInputs::ext_servo, pin::kServo, false), 1);
  EXPECT_EQ(rig.get(pin::kSsiClk), 0xFEu);
  rig.run(4000);
  EXPECT_EQ(first_move(&BoardInputs::ext_servo, pin::kServo, true), kNever);
  EXPECT_EQ(first_move(&BoardInputs::ext_phase, pin::kPhase, false), kNever);
  EXPECT_EQ(first_move(&BoardInputs::ext_phase, pin::kPhase, true), 1);
  EXPECT_EQ(rig.get(pin::kSsiClk), 0x7Fu);
}

TEST_P(BoardSsi, EachChannelHasItsPins) {
  BRICK_COVERS("SSI-1");
  for (unsigned n = 0; n < 8; ++n) {
    SCOPED_TRACE(n + 1);
    start(kGeoBrick);
    rig.write(true, n < 4 ? 0x78B2F : 0x78B3F, 0x180302);
    for (unsigned other = 0; other < 8; ++other) rig.write(true, 0x78B20 + 4 * other, other == n ? 0x140C : 0);
    for (const unsigned data : {1u << n, 0xFFu & ~(1u << n)}) {
      rig.in.ext_servo = true;
      rig.in.ssi_data = static_cast<std::uint8_t>(data);
      rig.apply();
      rig.run(30);
      EXPECT_EQ(first_move(&BoardInputs::ext_servo, pin::kServo, false), 1);
      EXPECT_EQ(rig.get(pin::kSsiClk), 0xFFu & ~(1u << n));
      rig.run(4000);
      EXPECT_EQ(rig.read(false, 0x78B20 + 4 * n), data == 1u << n ? 0xFFFu : 0u);
    }
  }
}

// Feedback option 2 is not fitted (servo-ic:11.4/4): the page is there, nothing else.
TEST_P(BoardSsi, WithoutTheOptionClocksStayHighAndResultsZero) {
  BRICK_COVERS("SSI-2");
  for (const std::uint8_t kind : {kGeoPageAlone, kNone}) {
    start(kind);
    rig.write(true, 0xFF55, 3);
    rig.write(true, 0xFF54, 0xF);
    rig.write(true, 0xFF74, 0xF);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(first_move(&BoardInputs::ext_servo, pin::kServo, false), kNever);
      rig.run(5000);
      EXPECT_EQ(rig.get(pin::kSsiClk), 0xFFu);
      rig.in.ext_servo = true;
      rig.apply();
      rig.run(100);
    }
    EXPECT_EQ(rig.read(false, 0xFF54), 0u);
    EXPECT_EQ(rig.read(false, 0xFF74), 0u);
    EXPECT_EQ(rig.read(true, 0xFF56), 0u);
  }
}

// servo-ic:11.9/9: a trip of the watchdog ends no frame and refuses none.
TEST_P(BoardSsi, ATripOfTheWatchdogIsNothingToAFrame) {
  BRICK_COVERS("SSI-1");
  start(kGeo);
  rig.write(true, 0xFF55, 3);
  rig.write(true, 0xFF54, 0xE);
  EXPECT_EQ(first_move(&BoardInputs::ext_servo, pin::kServo, false), 1);
  const Tick fell = rig.now();
  rig.run(500);
  rig.in.pwr_good = false;
  rig.apply();
  EXPECT_NE(rig.edge(pin::kWdTripped, 1, 1000), kNever);
  for (Tick fall = fell + 96; fall <= fell + 24 * 96; fall += 96)
    if (fall > rig.now()) { EXPECT_EQ(rig.edge(pin::kSsiClk, 0xFE, 100), fall); }
  rig.run(100);
  EXPECT_EQ(rig.get(pin::kSsiClk), 0xFFu);
  rig.run(2000);
  EXPECT_EQ(rig.read(false, 0xFF54), 0xFFFFFFu);
}

INSTANTIATE_TEST_SUITE_P(Engines, BoardSsi, ::testing::Values("Rtl", "Model", "Lockstep"),
                         [](const auto& engine) { return std::string(engine.param); });

}  // namespace
}  // namespace brick
