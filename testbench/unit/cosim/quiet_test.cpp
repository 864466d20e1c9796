// A board that promises quiet pins keeps the promise: the CPU runs ahead on the strength of it.
#include <array>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

class Quiet : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Quiet, PromiseHoldsForInterruptPinsWhileInputsStay) {
  BRICK_COVERS("CARD-1");
  const std::array watched{select_pins(pin::kPhase, pin::kServo, pin::kIrqHost, pin::kWdTripped, pin::kBreq),
                           select_pins(pin::kPhase, pin::kServo), select_pins(pin::kWdTripped),
                           select_pins(pin::kIrqHost)};
  const std::uint32_t ics = GetParam() % 4 < 2 ? 0x3 : 0xC0407;  // as BoardInputs::fitted: with 2*, MACRO ICs 0 and 1
  auto board = make_model_board(ics);
  BoardTraffic traffic(GetParam(), {300, GetParam() % 2 == 0, ics});
  std::array<Tick, 4> promised{}, useful{};
  board->on_change = [&](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    for (std::size_t i = 0; i < watched.size(); ++i)
      if (before.differs(after, watched[i])) { ASSERT_GT(t, promised[i]) << "at tick " << t << ", pins " << i; }
  };
  while (board->now() < 400'000) {
    for (std::size_t i = 0; i < watched.size(); ++i) {
      promised[i] = board->quiet_until(watched[i]);
      ASSERT_GE(promised[i], board->now());
      useful[i] += promised[i] > board->now();
    }
    // Look again now and then, not only when inputs change.
    const Tick target = std::min(traffic.next(), board->now() + 1 + static_cast<Tick>(GetParam() * 37));
    board->run_until(target);
    if (HasFatalFailure()) return;
    if (board->now() == traffic.next()) {
      traffic.change();
      board->set_inputs(traffic.inputs());
    }
  }
  for (const Tick times : useful) EXPECT_GT(times, 100) << "promises beyond the present tick";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Quiet, ::testing::Range<std::uint64_t>(1, 13));

}  // namespace
}  // namespace brick
