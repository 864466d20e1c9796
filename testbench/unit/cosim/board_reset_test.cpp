// Behind a reset the board lives as it did behind the first one, whatever it did in between, failures of 5 V too, on
// either engine: all pins, the motors' as well, but D and SD: words of the dual-ported RAM outlive a reset. What words
// of a servo IC a reset forgets, ServoChannelReset shows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr std::uint32_t kIcs = 0x4000F;                       // as BoardInputs::fitted
constexpr Tick kLife = 60'000 / kTicksPerRef * kTicksPerRef;  // so that clk_ref meets the next as this one
constexpr Tick kReset = 12;                                   // that each life begins with, at least

struct Change {
  Tick at;
  unsigned ic;  // of the motors; kBoard: of the board
  BoardOutputs pins;
  MotorOutputs motor;
  bool operator==(const Change& o) const { return at == o.at && ic == o.ic && pins == o.pins && motor == o.motor; }
};
constexpr unsigned kBoard = ~0u;

class BoardReset : public ::testing::TestWithParam<bool> {
 protected:
  BoardReset() : board_(GetParam() ? make_rtl_board(kIcs) : make_model_board(kIcs)) { board_->watch_motors(~0u); }

  std::vector<Change> life(std::uint32_t seed, unsigned fail_every = 0) {
    std::vector<Change> changes;
    const Tick begin = board_->now();
    BoardTraffic::Options options;
    options.ics = kIcs;
    options.fail_every = fail_every;
    BoardTraffic traffic(seed, options);
    const auto shown = [](BoardOutputs pins) {
      pins.set(pin::kPaData, 0);
      pins.set(pin::kIsaSd, 0);
      return pins;
    };
    BoardOutputs last = shown(board_->outputs());
    board_->on_change = [&](Tick t, const BoardOutputs&, const BoardOutputs& now) {
      const BoardOutputs pins = shown(now);
      if (t - begin > kReset && pins != last) changes.push_back({t - begin, kBoard, pins, {}});
      last = pins;
    };
    board_->on_motor_change = [&](Tick t, unsigned ic, const MotorOutputs&, const MotorOutputs& now) {
      if (t - begin > kReset) changes.push_back({t - begin, ic, {}, now});
    };
    board_->set_inputs(traffic.inputs());
    while (traffic.next() < kLife) {
      board_->run_until(begin + traffic.next());
      traffic.change();
      board_->set_inputs(traffic.inputs());
    }
    board_->run_until(begin + kLife);
    board_->on_change = nullptr;
    board_->on_motor_change = nullptr;
    return changes;
  }

  // Where the two part, "" where they do not.
  static std::string difference(const std::vector<Change>& first, const std::vector<Change>& again) {
    const auto [a, b] = std::mismatch(first.begin(), first.end(), again.begin(), again.end());
    if (a == first.end() && b == again.end()) return "";
    const Change& one = a == first.end() ? *b : *a;
    std::string text =
        one.ic == kBoard ? fmt::format("tick {}", one.at) : fmt::format("tick {}, IC {}", one.at, one.ic);
    for (const PinField& f : pin::kAll)
      if (a != first.end() && b != again.end() && a->pins.get(f) != b->pins.get(f)) text += fmt::format(" {}", f.name);
    return text;
  }

  std::unique_ptr<Board> board_;
};

TEST_P(BoardReset, ForgetsAllThatWas) {
  for (std::uint32_t own = 1; own <= 3; ++own) {
    const std::uint32_t seed = random_seed(own);
    SCOPED_TRACE(seed);
    life(seed + 1);  // so that the first that is compared begins from something, too
    const std::vector<Change> first = life(seed);
    life(seed + 2, 40);
    EXPECT_EQ(difference(first, life(seed)), "");
    EXPECT_GE(first.size(), 1900u) << "a third of what the least of 40 seeds gave";
  }
}

// The comparison itself: one level of one pin, and a change that is not there.
TEST_P(BoardReset, ADifferenceIsFound) {
  const std::vector<Change> first = life(random_seed(1));
  std::vector<Change> again = first;
  const std::size_t at = first.size() / 2;
  again[at].pins.set(pin::kBreq, ~first[at].pins.get(pin::kBreq));
  EXPECT_EQ(difference(first, again).find(fmt::format("tick {}", first[at].at)), 0u);
  again = first;
  again.pop_back();
  EXPECT_EQ(difference(first, again).find(fmt::format("tick {}", first.back().at)), 0u);
}

INSTANTIATE_TEST_SUITE_P(Engines, BoardReset, ::testing::Values(true, false),
                         [](const auto& engine) { return std::string(engine.param ? "Rtl" : "Model"); });

}  // namespace
}  // namespace brick
