// The watchdog's timers to the edge of clk_ref: what meets the edge at which one would run out (servo-ic:10/5,
// servo-ic:10/6), and which edges of SERVO count (servo-ic:10/4). Reset ends after tick 14, so clk_ref counts from tick
// 15 and both timers would run out at kEnd.
#include <gtest/gtest.h>

#include <string>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = kPwmClockHz / 1000, kTimeout = 960 * 1024 * kTicksPerRef, kEnd = kTimeout + 12;

class WatchdogEdges : public ::testing::TestWithParam<bool> {
 protected:
  WatchdogEdges() {
    rig.in.ext_clock = true;  // SERVO by hand, jumper E1
    rig.apply();
  }
  static std::unique_ptr<Board> make() { return GetParam() ? make_rtl_board(0x3) : make_model_board(0x3); }

  void run_to(Tick t) { rig.run(t - rig.now()); }
  void servo(bool level) {
    rig.in.ext_servo = level;
    rig.apply();
  }
  // A write takes place at the third reference edge from a strobe that falls at one.
  void strobe_at(Tick edge) {
    run_to(edge - 9);
    rig.in.pa_addr = kWatchdogStrobe;
    rig.in.pa_x = true;
    rig.in.pa_wr_n = false;
    rig.apply();
    rig.run(9);
    rig.in.pa_wr_n = true;
    rig.apply();
  }
  bool tripped() { return rig.get(pin::kWdTripped) != 0; }

  BoardRig rig{make(), 0x3};
};
INSTANTIATE_TEST_SUITE_P(Engines, WatchdogEdges, ::testing::Values(true, false),
                         [](const auto& engine) { return std::string(engine.param ? "Rtl" : "Model"); });

TEST_P(WatchdogEdges, StrobeAtTheVeryEdgeWins) {
  run_to(10 * kMillisecond);
  servo(false);
  strobe_at(kEnd);
  EXPECT_FALSE(tripped());
  run_to(kEnd + kMillisecond);
  EXPECT_FALSE(tripped());
}

TEST_P(WatchdogEdges, StrobeOneEdgeLaterIsTooLate) {
  run_to(10 * kMillisecond);
  servo(false);
  strobe_at(kEnd + kTicksPerRef);
  EXPECT_TRUE(tripped());
}

// From outside SERVO reaches the net at the third tick, then two stages on clk_ref; the edge that sees them differ
// reloads. A change 7 ticks before the end is on the net 4 ticks before it, sampled 3 ticks before it and acts at it.
TEST_P(WatchdogEdges, ServoAtTheVeryEdgeWins) {
  strobe_at(kEnd - 3000);
  run_to(kEnd - 7);
  servo(false);
  run_to(kEnd + 10);
  EXPECT_FALSE(tripped());
}

TEST_P(WatchdogEdges, ServoOneEdgeLaterIsTooLate) {
  strobe_at(kEnd - 3000);
  run_to(kEnd - 6);
  servo(false);
  EXPECT_EQ(rig.edge(pin::kWdTripped, 1, 10), kEnd);
}

// A fall after 12 ms and a rise after 24: it trips 25 ms after the rise.
TEST_P(WatchdogEdges, RisesAndFallsOfServoCountAlike) {
  Tick edge = 0;
  for (const bool level : {false, true}) {
    run_to(edge += 12 * kMillisecond);
    servo(level);
    strobe_at(edge / kTicksPerRef * kTicksPerRef + 3000);
  }
  run_to(edge + 24 * kMillisecond);
  EXPECT_FALSE(tripped()) << "the last one was a rise";
  strobe_at((edge + 24 * kMillisecond) / kTicksPerRef * kTicksPerRef + 300);
  run_to(edge + 25 * kMillisecond + 10);
  EXPECT_TRUE(tripped());
}

// Two flip-flops and the latch (servo-ic:10/4), whatever the phase to clk_ref; relay and lamp with the trip.
TEST_P(WatchdogEdges, FiveVoltsThatFailTripAtTheThirdEdge) {
  const auto relay_and_lamp = [&] { return rig.get(pin::kWdRelay) << 1 | rig.get(pin::kWdLed); };
  for (const Tick phase : {0, 1, 2}) {
    run_to(rig.now() + 300 + phase);
    EXPECT_EQ(relay_and_lamp(), 2u) << "energised, dark";
    const Tick third = (rig.now() / kTicksPerRef + 3) * kTicksPerRef;
    rig.in.pwr_good = false;
    rig.apply();
    EXPECT_EQ(rig.edge(pin::kWdTripped, 1, 20), third);
    EXPECT_EQ(relay_and_lamp(), 1u) << "released, lit";
    rig.in.pwr_good = true;
    rig.apply();
    rig.run(kMillisecond);
    EXPECT_TRUE(tripped()) << "latched";
    rig.in.rst_n = false;
    rig.apply();
    rig.run(10 + phase);
    EXPECT_EQ(relay_and_lamp(), 0u);
    rig.in.rst_n = true;
    rig.apply();
  }
  rig.in.rst_n = rig.in.pwr_good = false;
  rig.apply();
  rig.run(10);
  rig.in.rst_n = true;
  rig.apply();
  const Tick works = (rig.now() / kTicksPerRef + 3) * kTicksPerRef, third = works + 2 * kTicksPerRef;
  EXPECT_EQ(rig.edge(pin::kWdTripped, 1, 20), third) << "not good from the start";
}

}  // namespace
}  // namespace brick
