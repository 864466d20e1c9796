// All 22 ICs of a board as the source of the clocks in turn, by one line in both orders of writing, with the clock
// checker at every edge. The bench clock-select does a half of them in lock-step.
#include <sstream>

#include "testbench/benches/clock_host.h"
#include "testbench/checkers/timing_book.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class ClockMoves : public Controller {};

TEST_P(ClockMoves, OneLineMakesEveryIcTheSourceInBothOrders) {
  BRICK_COVERS("I19-2 CLK-2 CLK-6");
  MachineConfig config;
  config.board.fitted = (1u << kClockIcs) - 1;
  start(config);
  std::ostringstream out;
  BenchReport report(out, machine());
  TimingBook timing(machine());
  BenchContext bench{machine(), bus(), link(), report, config.board, 1, false, timing, false, nullptr};
  {
    ClockHost host(bench);
    for (unsigned ic = 0; ic < kClockIcs; ++ic) host.program(ic, {2600 + 100 * ic, ic % 3, 2 + ic % 3});
    bool new_first = false;
    for (unsigned round = 0; round < 2; ++round) {
      for (unsigned i = 0; i < kClockIcs; ++i) {
        const unsigned ic = (7 * i + 5) % kClockIcs;
        if (ic == host.source()) continue;
        const std::string on = "I" + std::to_string(direction_variable(ic)) + "=0";
        const std::string off = "I" + std::to_string(direction_variable(host.source())) + "=3";
        host.move(ic, new_first ? on + " " + off : off + " " + on);
        host.verdict(std::to_string(direction_variable(ic)), 1);
      }
      new_first = !new_first;
    }
    EXPECT_GE(host.checker().counts().odd_highs, 42u);
  }
  EXPECT_GE(report.steps().size(), 42u);
  EXPECT_TRUE(report.passed()) << out.str();
}

BRICK_ON_ENGINES(ClockMoves, Engine::kSystemC);

}  // namespace
}  // namespace brick
