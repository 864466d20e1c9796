// Behind a reset the board lives as it did behind the first one, whatever it did in between, on either engine. Words of
// the dual-ported RAM outlive a reset, so data on the two buses are left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr std::uint32_t kIcs = 0x4000F;                       // as BoardInputs::fitted
constexpr Tick kLife = 60'000 / kTicksPerRef * kTicksPerRef;  // so that clk_ref meets the next as this one
constexpr Tick kReset = 12;                                   // that each life begins with, at least

class BoardReset : public ::testing::TestWithParam<bool> {};

TEST_P(BoardReset, ForgetsAllThatWas) {
  using Change = std::pair<Tick, BoardOutputs>;
  for (std::uint32_t own = 1; own <= 3; ++own) {
    const auto board = GetParam() ? make_rtl_board(kIcs) : make_model_board(kIcs);
    const std::uint32_t seed = random_seed(own);
    SCOPED_TRACE(seed);
    const auto life = [&](std::uint32_t number) {
      std::vector<Change> changes;
      BoardOutputs last;
      const Tick begin = board->now();
      board->on_change = [&](Tick t, const BoardOutputs&, BoardOutputs now) {
        now.set(pin::kPaData, 0);
        now.set(pin::kIsaSd, 0);
        if (t - begin > kReset && now != last) changes.emplace_back(t - begin, now);
        last = now;
      };
      BoardTraffic::Options options;
      options.ics = kIcs;
      BoardTraffic traffic(number, options);
      board->set_inputs(traffic.inputs());
      while (traffic.next() < kLife) {
        board->run_until(begin + traffic.next());
        traffic.change();
        board->set_inputs(traffic.inputs());
      }
      board->run_until(begin + kLife);
      return changes;
    };
    life(seed + 1);  // so that the first that is compared begins from something, too
    const std::vector<Change> first = life(seed);
    life(seed + 2);
    const std::vector<Change> again = life(seed);
    ASSERT_GE(first.size(), 2000u);
    const auto [a, b] = std::mismatch(first.begin(), first.end(), again.begin(), again.end());
    if (a == first.end() && b == again.end()) continue;
    const Tick at = std::min(a == first.end() ? kNever : a->first, b == again.end() ? kNever : b->first);
    std::string words;
    for (unsigned i = 0; a != first.end() && b != again.end() && i < kBoardOutputWords; ++i)
      if (a->second.w[i] != b->second.w[i]) words += " " + std::to_string(i);
    ADD_FAILURE() << "tick " << at << " of the life, words" << words;
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, BoardReset, ::testing::Values(true, false),
                         [](const auto& engine) { return std::string(engine.param ? "Rtl" : "Model"); });

}  // namespace
}  // namespace brick
