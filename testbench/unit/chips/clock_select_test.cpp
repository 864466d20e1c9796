// The project's firmware on a board of chips: the source of PHASE and SERVO moves from chip to chip by the pins' own
// turning round. With BRICK_CHIP_TICKS in the environment by the whole bench clock-select.
#include <cstdlib>
#include <sstream>

#include "systemc/cosim/engines.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/clock_host.h"
#include "testbench/unit/chips/chip_lockstep.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class ClockSelectOnChips : public Controller {};

void there_and_back(BenchContext& bench) {
  ClockHost host(bench);
  host.program(0, {2600, 0, 2});
  host.program(1, {3100, 1, 1});
  for (const char* line : {"I7007=3 I7107=0", "I7007=0 I7107=3"}) {
    host.move(1 - host.source(), line);
    host.verdict(line, 1);
  }
}

TEST_P(ClockSelectOnChips, PassesWithoutContention) {
  MachineConfig config;  // two servo ICs
  ChipLockstep* chips = nullptr;
  config.rewire = [&](std::unique_ptr<Board> board) {
    auto beside = std::make_unique<ChipLockstep>(std::move(board), config.board.fitted, config.seed);
    chips = beside.get();
    return beside;
  };
  start(config);
  std::ostringstream out;
  BenchReport report(out, machine());
  TimingBook timing(machine());
  BenchContext bench{machine(), bus(), link(), report, config.board, 1, false, timing, false, nullptr};
  const bool whole = std::getenv("BRICK_CHIP_TICKS") != nullptr;
  ASSERT_NO_THROW(whole ? clock_select_bench().run(bench) : there_and_back(bench)) << out.str();
  EXPECT_GE(report.steps().size(), whole ? 16u : 2u);
  EXPECT_TRUE(report.passed()) << out.str();
  EXPECT_THAT(chips->chips().take_contention(), ::testing::IsEmpty());
  EXPECT_EQ(chips->counts().shared, 0u);
  EXPECT_GE(chips->counts().reads_by_ics, 1000u);
  RecordProperty("ticks", std::to_string(chips->counts().ticks));
}

BRICK_ON_ENGINES(ClockSelectOnChips, Engine::kRtl);

}  // namespace
}  // namespace brick
