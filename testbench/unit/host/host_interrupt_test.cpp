// The interrupt line of the host bus: rises anew for all that a service leaves, and is never low for less than an 8259A
// needs to see its edge. RTL and model in lock-step; the lines themselves as RTL and model of the controllers have them
// are in testbench/unit/cosim/board_interrupts_test.cpp.
#include "systemc/host/host_interrupt.h"

#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/host/lockstep.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr int kLowClocks = 4;  // host-bus:3.5/2

class HostInterruptTest : public ::testing::Test {
 protected:
  HostInterrupt model_{"host_interrupt"};
  Lockstep<HostInterrupt> both_{make_rtl_host_interrupt(), model_, [](const HostInterrupt& m) {
                                  return Outputs{{"irq", m.irq()}};
                                }};

  bool irq() { return both_.get("irq") != 0; }
  void serve() {
    both_.in.served = true;
    both_.ref();
    both_.in.served = false;
  }
  int clocks_until(bool level) {
    for (int clocks = 0; clocks < 20; ++clocks) {
      if (irq() == level) return clocks;
      both_.ref();
    }
    return -1;
  }
  void TearDown() override {
    if (!both_.mutate) { EXPECT_LOCKSTEP(both_); }
  }
};

TEST_F(HostInterruptTest, FollowsARequestThroughAFlipFlop) {
  both_.in.request = true;
  EXPECT_FALSE(irq());
  both_.ref();
  EXPECT_TRUE(irq());
  both_.in.request = false;
  EXPECT_TRUE(irq());
  both_.ref();
  EXPECT_FALSE(irq());
}

TEST_F(HostInterruptTest, RisesAnewForWhatAServiceLeaves) {
  BRICK_COVERS("BREQ-5 CARD-1");
  both_.in.request = true;
  both_.ref(3);
  serve();
  EXPECT_FALSE(irq());
  EXPECT_EQ(clocks_until(true), kLowClocks);
}

TEST_F(HostInterruptTest, IsNeverLowForLess) {
  for (int gap = 1; gap <= kLowClocks + 2; ++gap) {  // the request itself goes away for `gap` clocks
    both_.in.request = true;
    both_.ref(10);
    both_.in.request = false;
    both_.ref(gap);
    EXPECT_FALSE(irq());
    both_.in.request = true;
    EXPECT_EQ(clocks_until(true), std::max(kLowClocks + 1 - gap, 1)) << gap;
  }
}

// The low time runs from the fall, not from the last service.
TEST_F(HostInterruptTest, AServiceWhileLowDelaysByItsOwnClockOnly) {
  both_.in.request = true;
  both_.ref(3);
  serve();
  both_.ref(kLowClocks - 1);
  serve();
  EXPECT_FALSE(irq());
  EXPECT_EQ(clocks_until(true), 1);
}

// systemc/core/model_block.h: as long as all inputs rest and nothing will show, no edge is asked for.
TEST_F(HostInterruptTest, SleepsWhileNothingMoves) {
  EXPECT_TRUE(both_.asleep());
  for (const bool request : {true, false}) {
    both_.in.request = request;
    both_.ref(2 * kLowClocks);
    EXPECT_TRUE(both_.asleep()) << request;
  }
}

TEST_F(HostInterruptTest, RandomRequestsAndServicesAgree) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937 random(random_seed(seed));
    both_.lazy = seed % 2 != 0;
    int low = kLowClocks, rises = 0;
    bool was = irq();
    for (int clock = 0; clock < 3000; ++clock) {
      both_.in.request = random() % 4 != 0;
      both_.in.served = random() % 6 == 0;
      const bool served = both_.in.served;
      both_.ref();
      EXPECT_FALSE(served && irq());
      if (irq() && !was) {
        EXPECT_GE(low, kLowClocks);
        ++rises;
      }
      low = irq() ? 0 : low + 1;
      was = irq();
    }
    EXPECT_GT(rises, 200);
  }
}

TEST_F(HostInterruptTest, ComparisonSeesALostService) {
  both_.mutate = [](HostInterrupt::Inputs& in) { in.served = false; };
  both_.in.request = true;
  both_.ref(3);
  serve();
  EXPECT_NE(both_.difference(), "");
}

}  // namespace
}  // namespace brick
