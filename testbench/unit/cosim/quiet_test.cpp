// A board that promises quiet pins keeps the promise: the CPU runs ahead on the strength of it.
#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

class Quiet : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Quiet, PromiseHoldsForInterruptPinsWhileInputsStay) {
  BRICK_COVERS("CARD-1");
  const BoardOutputs watched = select_pins(pin::kPhase, pin::kServo, pin::kIrqHost, pin::kWdTripped, pin::kBreq);
  const std::uint32_t ics = GetParam() % 4 < 2 ? 0x3 : 0xC0407;  // as BoardInputs::fitted: with 2*, MACRO ICs 0 and 1
  auto board = make_model_board(ics);
  BoardTraffic traffic(GetParam(), {300, GetParam() % 2 == 0, ics});
  Tick promised = 0, useful = 0;
  board->on_change = [&](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    if (before.differs(after, watched)) { ASSERT_GT(t, promised) << "at tick " << t; }
  };
  while (board->now() < 400'000) {
    promised = board->quiet_until(watched);
    ASSERT_GE(promised, board->now());
    useful += promised > board->now();
    // Look again now and then, not only when inputs change.
    const Tick target = std::min(traffic.next(), board->now() + 1 + static_cast<Tick>(GetParam() * 37));
    board->run_until(target);
    if (HasFatalFailure()) return;
    if (board->now() == traffic.next()) {
      traffic.change();
      board->set_inputs(traffic.inputs());
    }
  }
  EXPECT_GT(useful, 100) << "promises beyond the present tick";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Quiet, ::testing::Range<std::uint64_t>(1, 13));

}  // namespace
}  // namespace brick
