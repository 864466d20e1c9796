// What a board does depends on its inputs only, not on how the run is cut into calls of run_until().
#include <vector>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

struct WordChange {
  Tick tick;
  BoardOutputs before, after;
  bool operator==(const WordChange& o) const { return tick == o.tick && before == o.before && after == o.after; }
};

constexpr Tick kEnd = 120'000;

// `longest` = 0: as far as the inputs allow; else pieces of random length up to `longest`, some stopped by pins.
std::vector<WordChange> changes(Board& board, Tick longest) {
  std::vector<WordChange> list;
  board.on_change = [&](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    list.push_back({t, before, after});
  };
  BoardTraffic traffic(random_seed(77));
  std::mt19937_64 random(random_seed(static_cast<std::uint64_t>(longest)));
  while (board.now() < kEnd) {
    const Tick end = std::min(traffic.next(), kEnd);
    while (board.now() < end) {
      const Tick limit =
          longest == 0 ? end : std::min<Tick>(end, board.now() + 1 + static_cast<Tick>(random()) % longest);
      const bool stop = longest != 0 && random() % 2 == 0;
      board.run_until(std::max(limit, board.now() + 1),
                      stop ? select_pins(pin::kPhase, pin::kIsaSd, pin::kPaData) : BoardOutputs{});
    }
    if (board.now() == traffic.next()) {
      traffic.change();
      board.set_inputs(traffic.inputs());
    }
  }
  return list;
}

class RunLength : public ::testing::TestWithParam<std::unique_ptr<Board> (*)()> {};

TEST_P(RunLength, DoesNotChangeAnyPinAtAnyTick) {
  BRICK_COVERS("CARD-6");
  auto whole = GetParam()();
  const std::vector<WordChange> expected = changes(*whole, 0);
  ASSERT_GT(expected.size(), 1000u);
  for (std::size_t i = 1; i < expected.size(); ++i) {
    ASSERT_LT(expected[i - 1].tick, expected[i].tick);
    ASSERT_EQ(expected[i - 1].after, expected[i].before);
  }
  for (const Tick longest : {1, 2, 7, 1000}) {
    auto cut = GetParam()();
    EXPECT_TRUE(changes(*cut, longest) == expected) << "pieces of at most " << longest << " ticks";
  }
}

std::unique_ptr<Board> rtl() { return make_rtl_board(3); }
std::unique_ptr<Board> model() { return make_model_board(3); }
std::unique_ptr<Board> both() { return make_lockstep_board(rtl(), model()); }
INSTANTIATE_TEST_SUITE_P(Engines, RunLength, ::testing::Values(rtl, model, both));

}  // namespace
}  // namespace brick
