// The edge with which the watchdog trips, as flip-flops see it: `trip_d` before it, `trip` behind it. Between the two
// stands what would show at a pin for as long as the ways of the trip and of the flip-flop differ: a tick knows nothing
// of it, so here the trip comes late.
#include <gtest/gtest.h>

#include "rtl/pins/motor_pins.hpp"
#include "rtl/regs/brick_regs.hpp"
#include "testbench/unit/servo_ic/servo_ic_rig.h"

namespace brick {
namespace {

namespace trip_words = regs::servo_channel;

constexpr unsigned kChannel3 = 2 * 8;
constexpr std::uint64_t kEnabled = 1ull << 42, kEqual = 1ull << 46;  // AENA and EQU of channel 3 in motor_o
constexpr std::uint32_t kBoth = trip_words::control::kAena.at(1) | trip_words::control::kEquState.at(1) |
                                trip_words::control::kEquWrite.at(1) | trip_words::control::kDecode.at(3);

class TripEdge : public ::testing::Test {
 protected:
  TripEdge() { rig.power_up(); }

  std::uint64_t shown() { return rig.ic().motor() & (kEnabled | kEqual); }
  void write(std::uint32_t value) { rig.write(true, kChannel3 + trip_words::kControl.address, value); }
  void told(bool on) { rig.ic().in.trip_d = on; }

  RtlRig rig;
};

TEST_F(TripEdge, AenaAndEquWrittenAtThatEdgeDoNotRise) {
  told(true);
  write(kBoth);
  EXPECT_EQ(shown(), 0u);
  EXPECT_EQ(rig.read(true, kChannel3 + trip_words::kControl.address) | trip_words::control::kEquWrite.at(1), kBoth)
      << "the write itself counts";
}

TEST_F(TripEdge, AnEquThatACountTurnsAtThatEdgeDoesNotRise) {
  for (const bool trips : {false, true}) {
    told(false);
    rig.ic().in.pins[2] = 0;
    rig.power_up();
    rig.write(true, 4, 0x3038D0);  // SCLK with each clk_ref
    write(trip_words::control::kDecode.at(3));
    rig.write(false, kChannel3 + trip_words::kCompareA.address, 0);
    rig.write(true, kChannel3 + trip_words::kCompareB.address, 5);
    rig.run(60);
    told(trips);
    rig.ic().in.pins[2] = 1;  // A rises: the counter leaves 0, and so compare A
    rig.run(30);
    EXPECT_EQ(shown(), trips ? 0u : kEqual);
  }
}

TEST_F(TripEdge, BothFallWithTheEdge) {
  write(kBoth);
  ASSERT_EQ(shown(), kEnabled | kEqual);
  told(true);
  rig.run(3);
  EXPECT_EQ(shown(), 0u);
  rig.ic().in.trip = true;
  write(kBoth);
  EXPECT_EQ(shown(), 0u);
}

// A chip of its own is told by a pin alone.
TEST_F(TripEdge, WithoutWordOfItTheTripItselfTurnsThemOff) {
  write(kBoth);
  rig.ic().in.trip = true;
  rig.ic().settle();
  EXPECT_EQ(shown(), 0u);
}

}  // namespace
}  // namespace brick
