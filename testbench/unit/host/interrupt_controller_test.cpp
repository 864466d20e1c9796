#include "systemc/host/interrupt_controller.h"

#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/host/lockstep.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr unsigned kStatus = 0, kSignal = 1, kMask = 2, kEdgeLevel = 3;
constexpr std::uint8_t kBreq = 0x02;

class InterruptControllerTest : public ::testing::Test {
 protected:
  InterruptController model_{"pic"};
  Lockstep<InterruptController> both_{
      make_rtl_interrupt_controller(), model_, [](const InterruptController& m) {
        return Outputs{{"rdata", m.rdata()}, {"ist", m.ist()},         {"sig", m.sig()},      {"msk", m.msk()},
                       {"elr", m.elr()},     {"request", m.request()}, {"served", m.served()}};
      }};

  void write(unsigned addr, std::uint8_t value) {
    both_.in.wr = true;
    both_.in.addr = static_cast<std::uint8_t>(addr);
    both_.in.wdata = value;
    both_.ref();
    both_.in.wr = false;
  }
  std::uint32_t read(unsigned addr) {
    both_.in.addr = static_cast<std::uint8_t>(addr);
    return both_.get("rdata");
  }
  void line(std::uint8_t value) { both_.in.line = value; }
  void TearDown() override {
    if (!both_.mutate) { EXPECT_LOCKSTEP(both_); }
  }
  // Random writes and lines; level changes are rare enough for latches to be seen, common enough to meet clears.
  void random_run(unsigned seed, int ticks) {
    std::mt19937 random(random_seed(seed));
    both_.lazy = seed % 2;
    for (int i = 0; i < ticks && both_.difference().empty(); ++i) {
      if (random() % 7 == 0) both_.in.line ^= static_cast<std::uint8_t>(1u << random() % 8);
      both_.in.addr = random() % 4;
      if (both_.now() % kTicksPerRef == 0) {
        both_.in.wr = random() % 6 == 0;
        both_.in.wdata = static_cast<std::uint8_t>(random());
        both_.in.reset = random() % 40 == 0;
      }
      if (random() % 2000 == 0) both_.reset();
      both_.tick();
    }
  }
};

TEST_F(InterruptControllerTest, ResetBlocksEverythingAndSelectsEdges) {
  line(0xFF);
  both_.ref(4);
  both_.reset();
  EXPECT_EQ(read(kStatus), 0u);
  EXPECT_EQ(read(kSignal), 0u);
  EXPECT_EQ(read(kMask), 0u);
  EXPECT_EQ(read(kEdgeLevel), 0u);
  both_.ref(4);
  EXPECT_EQ(both_.get("request"), 0u) << "mask is 0";
  EXPECT_EQ(read(kSignal), 0xFFu) << "SIG ignores mask and mode";
}

// host-bus:3.8
TEST_F(InterruptControllerTest, ResetdrvClearsRegistersAndLatches) {
  write(kMask, 0xFF);
  write(kEdgeLevel, 0x0F);
  line(0xF0);
  both_.ref(4);
  ASSERT_EQ(read(kStatus), 0xF0u);
  both_.in.reset = true;
  both_.ref();
  EXPECT_EQ(both_.get("request"), 0u);
  both_.in.reset = false;
  both_.ref(4);
  EXPECT_EQ(read(kMask), 0u);
  EXPECT_EQ(read(kEdgeLevel), 0u);
  write(kMask, 0xFF);
  both_.ref(4);
  EXPECT_EQ(read(kStatus), 0u) << "the lines have been high all the time";
}

TEST_F(InterruptControllerTest, ResetdrvClearsOneRegisterAlone) {
  for (const unsigned addr : {kMask, kEdgeLevel}) {
    write(addr, 0x12);
    both_.ref(4);
    both_.in.reset = true;
    both_.ref();
    both_.in.reset = false;
    EXPECT_EQ(read(addr), 0u);
  }
}

// systemc/core/model_block.h: as long as all inputs rest and nothing will show, no edge is asked for.
TEST_F(InterruptControllerTest, SleepsWhileNothingMoves) {
  const auto rests = [&] {
    both_.ref(4);
    return both_.asleep();
  };
  EXPECT_TRUE(rests());
  write(kMask, 0x3C);
  write(kEdgeLevel, 0x0F);
  for (const std::uint8_t lines : {0xFF, 0x00, 0xAA}) {
    line(lines);
    EXPECT_TRUE(rests()) << int{lines};
  }
  write(kStatus, 0);
  EXPECT_TRUE(rests());
  both_.in.reset = true;
  EXPECT_TRUE(rests()) << "RESETDRV";
}

TEST_F(InterruptControllerTest, MaskAndModeHoldEveryBit) {
  for (unsigned bit = 0; bit < 8; ++bit) {
    const auto one = static_cast<std::uint8_t>(1u << bit), other = static_cast<std::uint8_t>(~one);
    write(kMask, one);
    write(kEdgeLevel, other);
    EXPECT_EQ(read(kMask), one);
    EXPECT_EQ(read(kEdgeLevel), other);
  }
  write(kSignal, 0xA5);
  EXPECT_EQ(read(kSignal), 0u) << "SIG cannot be written";
}

TEST_F(InterruptControllerTest, BreqEdgeRaisesStatusAndInterruptAtTheThirdClock) {
  BRICK_COVERS("BREQ-5 CARD-1 CARD-2");
  write(kMask, kBreq);
  line(kBreq);
  both_.ref();
  EXPECT_EQ(both_.get("request"), 0u);
  both_.ref();
  EXPECT_EQ(both_.get("request"), 1u) << "the third clock takes it to the pin";
  EXPECT_EQ(read(kSignal), kBreq) << "polling sees the line one clock earlier";
  EXPECT_EQ(read(kStatus), 0u);
  both_.ref();
  EXPECT_EQ(both_.get("request"), 1u);
  EXPECT_EQ(read(kStatus), kBreq);
}

TEST_F(InterruptControllerTest, ClearedEdgeNeedsAnotherEdge) {
  write(kMask, kBreq);
  line(kBreq);
  both_.ref(3);
  for (std::uint8_t any : {0x00, 0xFF}) {
    write(kStatus, any);
    EXPECT_EQ(read(kStatus), 0u) << "any value clears";
    both_.ref(5);
    EXPECT_EQ(read(kStatus), 0u) << "still high: no new interrupt";
    line(0);
    both_.ref(3);
    EXPECT_EQ(read(kStatus), 0u) << "falling edge: none";
    line(kBreq);
    both_.ref(3);
    EXPECT_EQ(read(kStatus), kBreq);
    line(0);
    both_.ref(5);
    EXPECT_EQ(read(kStatus), kBreq) << "the latch keeps a short pulse";
    line(kBreq);
    both_.ref(3);
  }
}

TEST_F(InterruptControllerTest, LevelModeFollowsTheLineAndRepeatsAfterClear) {
  write(kEdgeLevel, 0x04);
  write(kMask, 0x04);
  line(0x04);
  both_.ref(2);
  EXPECT_EQ(read(kStatus), 0x04u);
  write(kStatus, 0);
  EXPECT_EQ(both_.get("request"), 1u);
  line(0);
  both_.ref(2);
  EXPECT_EQ(both_.get("request"), 0u);
}

TEST_F(InterruptControllerTest, EdgeWhileMaskedIsNotRemembered) {
  line(0x10);
  both_.ref(4);
  write(kMask, 0x10);
  both_.ref(4);
  EXPECT_EQ(read(kStatus), 0u);
}

// The latch belongs to edge mode: an edge seen while the line is level-sensed leaves nothing behind.
TEST_F(InterruptControllerTest, EdgeWhileLevelSensedIsNotRemembered) {
  write(kEdgeLevel, 0x10);
  write(kMask, 0x10);
  line(0x10);
  both_.ref(4);
  EXPECT_EQ(read(kStatus), 0x10u);
  write(kEdgeLevel, 0x00);
  both_.ref(2);
  EXPECT_EQ(read(kStatus), 0u);
}

TEST_F(InterruptControllerTest, SwitchingToLevelsAndBackKeepsTheLatch) {
  write(kMask, 0x10);
  line(0x10);
  both_.ref(3);
  line(0);
  both_.ref(3);
  EXPECT_EQ(read(kStatus), 0x10u);
  write(kEdgeLevel, 0x10);
  both_.ref(3);
  EXPECT_EQ(read(kStatus), 0u) << "the line is low";
  write(kEdgeLevel, 0x00);
  EXPECT_EQ(read(kStatus), 0x10u) << "nobody has cleared it";
  write(kStatus, 0);
  EXPECT_EQ(read(kStatus), 0u);
}

// host-bus:4.4, BREQ alone: whatever was chosen and latched before the set-up, and although all lines are high in it.
TEST_F(InterruptControllerTest, SetUpAndServiceAreThoseOfTheDataSheet) {
  write(kMask, 0xFF);
  line(0xFF);
  both_.ref(4);
  write(kEdgeLevel, 0xF0);
  both_.ref(4);
  ASSERT_EQ(read(kStatus), 0xFFu);
  write(kEdgeLevel, 0x00);
  write(kStatus, 0x00);
  write(kMask, kBreq);
  both_.ref(4);
  EXPECT_EQ(read(kStatus), 0u) << "these lines have risen before";
  EXPECT_EQ(both_.get("request"), 0u);
  for (const std::uint8_t service : {0x00, 0x02, 0xFF}) {
    line(0x00);
    both_.ref(4);
    EXPECT_EQ(read(kSignal) & kBreq, 0u);
    line(0xFF);
    both_.ref(3);
    EXPECT_EQ(read(kStatus), kBreq);
    EXPECT_EQ(both_.get("request"), 1u);
    write(kStatus, service);
    EXPECT_EQ(read(kStatus), 0u) << "any value clears";
    EXPECT_EQ(both_.get("request"), 0u);
    both_.ref(4);
    EXPECT_EQ(read(kStatus), 0u);
  }
  write(kMask, 0x00);
  for (const bool high : {false, true}) {  // without interrupts
    line(high ? kBreq : 0xFF & ~kBreq);
    both_.ref(3);
    EXPECT_EQ(read(kSignal) & kBreq, high ? kBreq : 0u);
  }
  write(kEdgeLevel, 0x00);
  write(kStatus, 0x00);
  write(kMask, kBreq);
  both_.ref(4);
  EXPECT_EQ(read(kStatus), 0u) << "high when it is enabled is no rise";
}

TEST_F(InterruptControllerTest, MaskingClearsTheLatch) {
  write(kMask, 0xFF);
  line(0x81);
  both_.ref(3);
  EXPECT_EQ(read(kStatus), 0x81u);
  write(kMask, 0x7F);
  EXPECT_EQ(read(kStatus), 0x01u);
  both_.ref();
  write(kMask, 0xFF);
  both_.ref(2);
  EXPECT_EQ(read(kStatus), 0x01u);
}

TEST_F(InterruptControllerTest, EdgeThatMeetsTheClearIsKept) {
  for (int lead :
       {0, 1, 2, 3}) {  // clocks from the line's first edge to the clear; the latch is set at clock 2 after it
    both_.reset();
    line(0);
    both_.ref(4);
    write(kMask, kBreq);
    line(kBreq);
    if (lead > 0) both_.ref(lead);
    write(kStatus, 0);
    both_.ref(4);
    EXPECT_EQ(read(kStatus), lead == 3 ? 0u : kBreq) << "lead " << lead;
  }
}

// Two rises and one clear or masking, at every clock to each other. A line driven before clock k is looked at by the
// edge detector at clock k + 2: what comes there at the clear's clock or later stays.
TEST_F(InterruptControllerTest, NoAlignmentOfEdgesAndClearLosesOrDoublesAnInterrupt) {
  constexpr int kClocks = 12, kSeenAfter = 2;
  for (int fall = 1; fall <= 3; ++fall)
    for (int rise = fall + 1; rise <= fall + 3; ++rise)
      for (int clear = 0; clear < kClocks; ++clear)
        for (const bool masked : {false, true}) {  // for one clock, instead of a clear
          both_.reset();
          line(0);
          both_.ref(4);
          write(kMask, kBreq);
          bool latched = false;
          for (int clock = 0; clock < kClocks + 2; ++clock) {
            line(clock < fall || clock >= rise ? kBreq : 0);
            both_.in.wr = clock == clear || (masked && clock == clear + 1);
            both_.in.addr = masked ? kMask : kStatus;
            both_.in.wdata = masked && clock == clear ? 0 : kBreq;
            both_.ref();
            both_.in.wr = false;
            const bool edge = clock == kSeenAfter || clock == rise + kSeenAfter;
            // MSK = 0 stands after its clock: it takes the latch at the next one, and the edge of that clock with it.
            const bool ends = masked ? clock == clear + 1 : clock == clear;
            latched = (latched && !ends) || (edge && !(masked && ends));
            const bool enabled = !masked || clock != clear;
            ASSERT_EQ(read(kStatus), latched && enabled ? kBreq : 0u)
                << "low " << fall << ".." << rise << ", clear " << clear << ", masked " << masked << ", clock "
                << clock;
          }
        }
}

// host-bus:4.1/8: a level of one clk_ref is seen wherever it lies; a shorter one when an edge falls into it.
TEST_F(InterruptControllerTest, LeastPulseIsOneClock) {
  for (Tick width = 1; width <= 2 * kTicksPerRef; ++width)
    for (Tick phase = 0; phase < kTicksPerRef; ++phase) {
      both_.reset();
      line(0);
      both_.ref(4);
      write(kMask, 0xFF);
      both_.ticks(static_cast<int>(phase));
      line(0x80);
      const Tick from = both_.now();
      both_.ticks(static_cast<int>(width));
      line(0);
      const bool sampled = both_.now() / kTicksPerRef > from / kTicksPerRef;
      both_.ref(5);
      EXPECT_EQ(read(kStatus), sampled ? 0x80u : 0u) << width << " ticks, phase " << phase;
      EXPECT_TRUE(sampled || width < kTicksPerRef);
    }
}

TEST_F(InterruptControllerTest, EachLineHasItsOwnBit) {
  write(kMask, 0xFF);
  for (unsigned bit = 0; bit < 8; ++bit) {
    line(static_cast<std::uint8_t>(1u << bit));
    both_.ref(3);
    EXPECT_EQ(read(kStatus), 1u << bit);
    line(0);
    both_.ref(3);
    write(kStatus, 0);
  }
}

TEST_F(InterruptControllerTest, RandomLinesAndWritesAgree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    random_run(seed, 3000);
    ASSERT_EQ(both_.difference(), "") << "seed " << seed;
  }
}

TEST_F(InterruptControllerTest, ComparisonSeesALostClear) {
  both_.mutate = [](InterruptController::Inputs& in) { in.wr = in.wr && in.addr != kStatus; };
  random_run(2, 3000);
  EXPECT_NE(both_.difference(), "");
}

TEST_F(InterruptControllerTest, ComparisonSeesALineOneClockLate) {
  std::uint8_t last = 0;
  Tick seen = 0;
  std::uint8_t late = 0;
  both_.mutate = [&](InterruptController::Inputs& in) {
    if (both_.now() / kTicksPerRef != seen) {
      seen = both_.now() / kTicksPerRef;
      late = last;
      last = in.line;
    }
    in.line = late;
  };
  random_run(2, 3000);
  EXPECT_NE(both_.difference(), "");
}

}  // namespace
}  // namespace brick
