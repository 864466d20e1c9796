// What every test of the ISA slave starts from: both twins idle with the default switches (isa_bench.h), and at its end
// a comparison that has seen no difference.
#pragma once

#include "testbench/unit/host/isa_bench.h"

namespace brick {

class IsaSlaveTest : public ::testing::Test, protected IsaBench {
 protected:
  void TearDown() override {
    if (!both.mutate) { EXPECT_LOCKSTEP(both); }
  }
  // Ticks from now until `name` shows `value`; -1 if it does not within `most`.
  int ticks_until(std::string_view name, unsigned value, int most) {
    for (int n = 0; n <= most; ++n) {
      if (both.get(name) == value) return n;
      tick();
    }
    return -1;
  }
  // The slave stands idle, and the next edge of clk_ref comes `phase` + 1 ticks from now.
  void at_phase(int phase) {
    ticks(12);
    while (next_ref_edge(both.now()) - both.now() != phase + 1) tick();
  }
};

// Complete periods of clk_pwm within a time.
constexpr int within(std::int64_t ns) { return static_cast<int>(ns_to_ticks(ns)) - 1; }

}  // namespace brick
