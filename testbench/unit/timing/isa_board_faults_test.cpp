// Faults of the board that only its silence shows: a host reads at the right place, the board stands somewhere else.
// The checker must name the row of the data that never came, on each engine; without the fault nothing is broken.
#include <gmock/gmock.h>

#include "testbench/checkers/timing_book.h"
#include "testbench/host/host_bus.h"
#include "testbench/unit/cosim/distorted_board.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

class IsaBoardFault : public ::testing::TestWithParam<Engine> {
 protected:
  using Fault = std::function<void(BoardInputs&)>;
  static constexpr Tick kReset = 240;  // and a little more

  // What a host at the machine breaks when it reads IVR, as its first cycle, and the first word of the RAM.
  static std::vector<std::string> broken(const Fault& fault, const isa::HostTimes& times = isa::kTypical,
                                         bool reset = false) {
    MachineConfig config;
    config.engine = GetParam();
    config.rewire = [&fault](std::unique_ptr<Board> board) {
      auto faulty = std::make_unique<DistortedBoard>(std::move(board));
      faulty->distort = fault;
      return faulty;
    };
    Machine machine(sc_core::sc_gen_unique_name("machine"), config);
    machine.run_until(kReset);  // nothing moves any more
    TimingBook book(machine);
    HostBus host(machine);
    host.set_times(times);
    if (reset) {
      machine.reset();
      host.wait(kReset);
    }
    host.io_read(3);
    host.dpram_read(0);
    std::vector<std::string> found;
    for (const TimingViolation& v : book.isa().ledger().violations())
      found.push_back(book.isa().ledger().rules()[v.rule].id + " at " + timing_address(v.where));
    return found;
  }
};

TEST_P(IsaBoardFault, NoneBreaksNothing) {
  EXPECT_THAT(broken([](BoardInputs&) {}), ::testing::IsEmpty());
}
TEST_P(IsaBoardFault, BaseSwitchThatIsReadWronglyBreaksRow4) {
  EXPECT_THAT(broken([](BoardInputs& in) { in.io_base ^= 0x02; }), ::testing::ElementsAre("t4 at I/O 0x213"));
}
// The set-up of the first cycle, 91 ns, is shorter than the 120 ns that the board has after its reset: the checker must
// know that the reset is over since long.
TEST_P(IsaBoardFault, FirstReadIsOwedItsAnswerAtTheLimitsToo) {
  EXPECT_THAT(broken([](BoardInputs&) {}, isa::kTight, true), ::testing::IsEmpty());
  EXPECT_THAT(broken([](BoardInputs& in) { in.io_base ^= 0x02; }, isa::kTight, true),
              ::testing::ElementsAre("t4 at I/O 0x213"));
}
TEST_P(IsaBoardFault, FirstCycleOfAHostIsJudged) {
  isa::HostTimes hasty = isa::kTypical;
  hasty.io.address = isa::ns(60);
  EXPECT_THAT(broken([](BoardInputs&) {}, hasty), ::testing::ElementsAre("t1 at I/O 0x213"));
}
TEST_P(IsaBoardFault, WindowThatStandsElsewhereInTheBlockBreaksRow14) {
  EXPECT_THAT(broken([](BoardInputs& in) { in.window ^= 0x04; }), ::testing::ElementsAre("t14 at memory 0x0D0000"));
}
TEST_P(IsaBoardFault, UpperByteThatIsNotConnectedBreaksRow14) {
  EXPECT_THAT(broken([](BoardInputs& in) { in.isa_sbhe_n = true; }), ::testing::ElementsAre("t14 at memory 0x0D0000"));
}

INSTANTIATE_TEST_SUITE_P(Engines, IsaBoardFault, ::testing::Values(Engine::kSystemC, Engine::kRtl),
                         [](const auto& engine) { return engine.param == Engine::kRtl ? "rtl" : "systemc"; });

}  // namespace
}  // namespace brick
