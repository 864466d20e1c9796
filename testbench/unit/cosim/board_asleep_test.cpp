// A board of the model sleeps until something is to come, and so do its blocks. One that is woken before each edge, and
// copies its wires each time, shows the same pins at the same ticks: what says that nothing is to come says it in time.
#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "systemc/board/board_top.h"
#include "systemc/cosim/drive.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"

namespace brick {

// Every block executes the next edge, whatever it has to do there, and whoever drives the clocks or is watched.
class BoardWaker {
 public:
  static void wake(BoardTop& board) {
    const Tick next = board.now_ + 1;
    board.next_.fill(next);
    board.seldom_ = board.first_ = next;
    board.gate_ics_.look_.fill(next);
    board.gate_ics_.next_clock_ = board.gate_ics_.next_look_ = next;
  }
};

namespace {

// Both, as one board. The motors of the one that is awake are watched, those of the other are asked now and then.
class TwinBoard : public Board {
 public:
  explicit TwinBoard(std::uint32_t ics, std::uint64_t seed = 0)
      : asleep_(sc_core::sc_gen_unique_name("asleep"), ics, seed),
        awake_(sc_core::sc_gen_unique_name("awake"), ics, seed) {
    asleep_.on_change = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
      shown_.push_back({t, after});
      if (on_change) on_change(t, before, after);
    };
    awake_.on_change = [this](Tick t, const BoardOutputs&, const BoardOutputs& after) { is_.push_back({t, after}); };
    awake_.watch_motors(~0u);
  }

  std::string difference;

  Tick now() const override { return asleep_.now(); }
  void set_inputs(const BoardInputs& inputs) override {
    BoardInputs of_port_a = inputs_;
    static_cast<PortAPins&>(of_port_a) = inputs;
    const bool others = !same(of_port_a, inputs);
    inputs_ = inputs;
    others ? asleep_.set_inputs(inputs) : asleep_.set_port_a(inputs);
    awake_.set_inputs(inputs);
    const BoardOutputs a = asleep_.port_a_at_once(), b = awake_.port_a_at_once();
    if (a != b) note(now(), a, b);
  }
  const BoardOutputs& outputs() const override { return asleep_.outputs(); }
  void set_motor_inputs(unsigned ic, const MotorInputs& inputs) override {
    asleep_.set_motor_inputs(ic, inputs);
    awake_.set_motor_inputs(ic, inputs);
  }
  MotorOutputs motor_outputs(unsigned ic) const override { return asleep_.motor_outputs(ic); }
  Tick run_until(Tick limit, const BoardOutputs&) override {
    shown_.clear();
    is_.clear();
    asleep_.run_until(limit);
    while (awake_.now() < limit) {
      BoardWaker::wake(awake_);
      awake_.run_until(awake_.now() + 1);
    }
    compare();
    return now();
  }

 private:
  struct Change {
    Tick tick;
    BoardOutputs after;
    bool operator==(const Change& o) const { return tick == o.tick && after == o.after; }
  };
  static bool same(const BoardInputs& a, const BoardInputs& b) { return a.rst_n == b.rst_n && pack(a) == pack(b); }
  void compare() {
    if (!(shown_ == is_)) {
      const std::size_t least = std::min(shown_.size(), is_.size());
      std::size_t i = 0;
      while (i < least && shown_[i] == is_[i]) ++i;
      const auto tick = [i](const std::vector<Change>& list) { return i < list.size() ? list[i].tick : kNever; };
      const Tick first = std::min(tick(shown_), tick(is_));
      const BoardOutputs before = i == 0 ? before_ : is_[i - 1].after;
      note(first, tick(shown_) == first ? shown_[i].after : before, tick(is_) == first ? is_[i].after : before);
    }
    before_ = awake_.outputs();
    if (++asked_ % 5 != 0) return;
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      if (asleep_.motor_outputs(ic) != awake_.motor_outputs(ic) && difference.empty())
        difference = "motors of IC " + std::to_string(ic) + " before tick " + std::to_string(now());
  }
  void note(Tick tick, const BoardOutputs& asleep, const BoardOutputs& awake) {
    if (!difference.empty()) return;
    difference = "at tick " + std::to_string(tick);
    for (const PinField& f : pin::kAll)
      if (asleep.get(f) != awake.get(f))
        difference += std::string(", ") + std::string(f.name) + " asleep " + std::to_string(asleep.get(f)) +
                      ", awake " + std::to_string(awake.get(f));
  }

  BoardTop asleep_, awake_;
  BoardInputs inputs_;
  BoardOutputs before_ = awake_.outputs();
  std::vector<Change> shown_, is_;
  unsigned asked_ = 0;
};

class BoardAsleep : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(BoardAsleep, ShowsWhatAnAwakeOneShowsUnderTraffic) {
  BoardTraffic::Options options;
  options.ics = GetParam() % 2 != 0 ? 0x3 : 0xC0407;  // as BoardInputs::fitted: with 2*, MACRO ICs 0 and 1
  options.dense = GetParam() % 4 < 2;
  if (GetParam() % 3 == 0) options.fail_every = 200;
  TwinBoard board(options.ics, GetParam());
  unsigned changes = 0;
  board.on_change = [&](Tick, const BoardOutputs&, const BoardOutputs&) { ++changes; };
  BoardTraffic traffic(random_seed(GetParam()), options);
  // Longer with a seed that leaves the clocks still.
  for (Tick end = 250'000; end == 250'000 || (changes <= 500 && end <= 4'000'000); end += 250'000)
    traffic.run(board, end);
  EXPECT_EQ(board.difference, "");
  EXPECT_GT(changes, 500u);
}

TEST_P(BoardAsleep, ShowsWhatAnAwakeOneShowsWhileMotorsMove) {
  MotorTrafficOptions options{GetParam() % 2 != 0 ? 0x3u : 0xC0407u};
  options.may_trip = false;
  TwinBoard board(options.ics, GetParam());
  MotorTraffic(random_seed(GetParam()), options).run(board, 200'000);
  EXPECT_EQ(board.difference, "");
}

INSTANTIATE_TEST_SUITE_P(Seeds, BoardAsleep, ::testing::Range<std::uint64_t>(1, 5));

}  // namespace
}  // namespace brick
