// A board that promises quiet pins keeps the promise: the CPU runs ahead on the strength of it.
#include <vector>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

class Quiet : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Quiet, PromiseHoldsForInterruptPinsWhileInputsStay) {
  BRICK_COVERS("CARD-1");
  constexpr std::size_t kForeseen = 4;
  std::vector<BoardOutputs> watched{select_pins(pin::kPhase, pin::kServo, pin::kIrqHost, pin::kWdTripped, pin::kBreq),
                                    select_pins(pin::kPhase, pin::kServo), select_pins(pin::kWdTripped),
                                    select_pins(pin::kIrqHost)};
  for (const PinField& pin : pin::kAll) watched.push_back(select_pins(pin));
  const std::uint32_t ics = GetParam() % 4 < 2 ? 0x3 : 0xC0407;  // as BoardInputs::fitted: with 2*, MACRO ICs 0 and 1
  auto board = make_model_board(ics);
  BoardTraffic traffic(GetParam(), {300, GetParam() % 2 == 0, ics});
  std::vector<Tick> promised(watched.size()), useful(watched.size());
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
  for (std::size_t i = 0; i < kForeseen; ++i) EXPECT_GT(useful[i], 100) << "promises beyond the present tick";
}

// Or it would be of no use: on a board at rest the next edge of PHASE ends the promise for the clocks, the 25 ms of the
// watchdog that for its trip (from tick 15 on, servo-ic:10/5), and none that for the host's interrupt. A pin that has
// no cause of its own ends with any of them.
TEST(QuietBoard, PromisesUpToTheEdgeThatIsToCome) {
  constexpr Tick kTrip = 960 * 1024 * kTicksPerRef + 12;
  BoardRig rig(make_model_board(0x3), 0x3);
  rig.run(100);
  const auto quiet = [&](const auto&... pins) { return rig.board().quiet_until(select_pins(pins...)); };
  EXPECT_EQ(quiet(pin::kWdTripped), kTrip - 1);
  EXPECT_EQ(quiet(pin::kWdo, pin::kWdTripped), kTrip - 1);
  EXPECT_GE(quiet(pin::kPhase, pin::kServo), kNever - 1) << "nobody drives them";
  EXPECT_GE(quiet(pin::kIrqHost), kNever - 1);
  EXPECT_GE(quiet(), kNever - 1);
  EXPECT_EQ(quiet(pin::kBreq), kTrip - 1);
  EXPECT_EQ(quiet(pin::kIrqHost, pin::kWdTripped), kTrip - 1);

  rig.write(true, kServoIcBase[0] + 4, 0x0008D2);
  for (int edges = 0; edges < 8; ++edges) {
    rig.edge(pin::kPhase, edges % 2 == 0 ? 1 : 0);
    rig.run(100 + edges);
    const Tick clocks = quiet(pin::kPhase, pin::kServo), trip = quiet(pin::kWdTripped), any = quiet(pin::kBreq);
    EXPECT_EQ(trip, kTrip - 1);
    const Tick edge = rig.edge(pin::kPhase, edges % 2 == 0 ? 0 : 1);
    EXPECT_LT(clocks, edge);
    EXPECT_GE(clocks, edge - kNetDelay - 1) << "the IC's pin";
    EXPECT_LE(any, clocks);
    EXPECT_GE(quiet(pin::kIrqHost), kNever - 1);
  }
}

// A write that is under way may end in any pin, an access of the on-chip page in the host's interrupt.
TEST(QuietBoard, PromisesNothingBeyondAWriteThatIsUnderWay) {
  for (const bool internal : {false, true}) {
    BoardRig rig(make_model_board(0x3), 0x3);
    rig.in.pa_addr = internal ? 0x7FFC6 : kHostSignals;
    rig.in.pa_int = internal;
    rig.in.pa_x = true;
    rig.apply();
    rig.run(3 - rig.now() % 3);
    (internal ? rig.in.pa_rd_n : rig.in.pa_wr_n) = false;
    rig.apply();
    EXPECT_LT(rig.board().quiet_until(select_pins(pin::kIrqHost)), rig.now() + 9);
    if (!internal) { EXPECT_LT(rig.board().quiet_until(select_pins(pin::kWdTripped)), rig.now() + 9); }
  }
}

// A cycle of the host may end in its interrupt, but moves no clock and trips no watchdog.
TEST(QuietBoard, PromisesClocksAndTripDuringACycleOfTheHost) {
  BoardRig rig(make_model_board(0x3), 0x3);
  rig.run(100);
  const auto quiet = [&](const auto&... pins) { return rig.board().quiet_until(select_pins(pins...)); };
  const Tick clocks = quiet(pin::kPhase, pin::kServo), trip = quiet(pin::kWdTripped);
  rig.in.isa_sa = 0x210;
  rig.in.isa_ior_n = false;
  rig.apply();
  EXPECT_LT(quiet(pin::kIrqHost), rig.now() + 100);
  EXPECT_EQ(quiet(pin::kPhase, pin::kServo), clocks);
  EXPECT_EQ(quiet(pin::kWdTripped), trip);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Quiet, ::testing::Range<std::uint64_t>(1, 13));

}  // namespace
}  // namespace brick
