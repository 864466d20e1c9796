// Lock-step compares every pin, stops where the engines do and reports a difference so that it can be found.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_map.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

std::unique_ptr<Board> lockstep(const RtlOptions& options = {}) {
  return make_lockstep_board(make_rtl_board(kTwoServoIcs, options), make_model_board(kTwoServoIcs, options.seed));
}

TEST(Lockstep, StopsAtTheSelectedEdgeAsTheEnginesDo) {
  auto board = lockstep();
  BoardInputs in;
  start_clocks(*board, in);
  const BoardOutputs select = select_pins(pin::kPhase);
  Tick falls = 0, last = 0;
  while (falls < 4) {
    const bool before = board->outputs().get(pin::kPhase) != 0;
    const Tick t = board->run_until(10'000'000, select);
    ASSERT_LT(t, 10'000'000);
    ASSERT_NE(board->outputs().get(pin::kPhase) != 0, before);
    if (before) {
      // Phase period at reset values, servo-ic:3: (2 I7000 + 3) (I7001 + 1) ticks, I7000 = 6527, I7001 = 0.
      if (++falls > 1) { EXPECT_EQ(t - last, 2 * 6527 + 3); }
      last = t;
    }
  }
}

TEST(Lockstep, ReportsTheSeededBugWithSignalTickAndAccesses) {
  BRICK_COVERS("CARD-6");
  // The true fifth fall of SERVO, from the model alone.
  auto model = make_model_board(kTwoServoIcs);
  BoardInputs in;
  start_clocks(*model, in);
  Tick fall = 0;
  for (int falls = 0; falls < 5;) {
    fall = model->run_until(100'000'000, select_pins(pin::kServo));
    if (model->outputs().get(pin::kServo) == 0) ++falls;
  }

  auto board = lockstep({0, true});
  BoardInputs again;
  start_clocks(*board, again);
  try {
    board->run_until(fall + 1000);
    FAIL() << "the seeded bug was not seen";
  } catch (const LockstepDifference& e) {
    const std::string text = e.what();
    EXPECT_THAT(text, ::testing::HasSubstr("differ at tick " + std::to_string(fall) + " "));
    EXPECT_THAT(text, ::testing::HasSubstr("\n  clock.servo: rtl 1, systemc 0"));
    EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("clock.phase:")));
    EXPECT_THAT(text, ::testing::HasSubstr("last bus accesses:\n  tick           30  reset released\n"
                                           "  tick           40  CPU  write X:$078004 = $3008D2 AA=2"));
  }
}

// A board that does nothing but report one pin at tick 5, or no pin, which is a change on the other board only.
class OnePinBoard : public Board {
 public:
  explicit OnePinBoard(const PinField* pin) : pin_(pin) {}
  Tick now() const override { return now_; }
  void set_inputs(const BoardInputs&) override {}
  const BoardOutputs& outputs() const override { return outputs_; }
  Tick run_until(Tick limit, const BoardOutputs&) override {
    if (now_ < 5 && limit >= 5) {
      const BoardOutputs before = outputs_;
      if (pin_ != nullptr) outputs_.set(*pin_, 1);
      on_change(5, before, outputs_);
    }
    return now_ = limit;
  }

 private:
  const PinField* pin_;
  BoardOutputs outputs_;
  Tick now_ = 0;
};

class AtOnceBoard final : public OnePinBoard {
 public:
  AtOnceBoard() : OnePinBoard(nullptr) {}
  BoardOutputs port_a_at_once() const override {
    BoardOutputs o = outputs();
    o.set(pin::kPaTaN, 1);
    return o;
  }
};

TEST(Lockstep, ComparesWhatFollowsAStrobeWithoutAClock) {
  BRICK_COVERS("CARD-6");
  const auto board = make_lockstep_board(std::make_unique<AtOnceBoard>(), std::make_unique<OnePinBoard>(nullptr));
  EXPECT_THROW(board->port_a_at_once(), LockstepDifference);
  const auto alike = make_lockstep_board(std::make_unique<AtOnceBoard>(), std::make_unique<AtOnceBoard>());
  EXPECT_EQ(alike->port_a_at_once().get(pin::kPaTaN), 1u);
}

TEST(Lockstep, ComparesEveryPinInBothDirections) {
  BRICK_COVERS("CARD-6");
  for (const PinField& f : pin::kAll) {
    for (const bool rtl_moves : {true, false}) {
      auto board = make_lockstep_board(std::make_unique<OnePinBoard>(rtl_moves ? &f : nullptr),
                                       std::make_unique<OnePinBoard>(rtl_moves ? nullptr : &f));
      try {
        board->run_until(100);
        ADD_FAILURE() << f.name << " was not compared";
      } catch (const LockstepDifference& e) {
        EXPECT_THAT(e.what(), ::testing::HasSubstr("differ at tick 5 "));
        EXPECT_THAT(e.what(), ::testing::HasSubstr("\n  " + std::string(f.name) + ": rtl "));
      }
    }
  }
}

// A host that polls must not push everything else out of the report.
TEST(Lockstep, ReportsEqualAccessesInARowAsOneLineAndEachSideForItself) {
  BRICK_COVERS("CARD-6");
  auto board = lockstep({0, true});
  BoardInputs in;
  start_clocks(*board, in);
  in.set_address(0x212);
  constexpr unsigned kPolls = 6000;  // 100 ticks each: past the fifth fall of SERVO, 5 x 52228 ticks at reset values
  const Tick first = board->now();
  unsigned polls = 0;
  std::string text;
  try {
    while (polls < kPolls) {
      in.isa_ior_n = false;
      board->set_inputs(in);
      ++polls;
      board->run_until(board->now() + 60);
      in.isa_ior_n = true;
      board->set_inputs(in);
      board->run_until(board->now() + 40);
    }
  } catch (const LockstepDifference& e) { text = e.what(); }
  EXPECT_THAT(text, ::testing::HasSubstr("CPU  write X:$078004 = $3008D2 AA=2\n"));
  EXPECT_THAT(text,
              ::testing::HasSubstr("tick " + fmt::format("{:>12}", first + 100 * (polls - 1)) +
                                   "  host I/O read  00212, " + fmt::format("{} times since tick {}", polls, first)));
}

// Flip-flops and the dual-ported RAM start at random; every register is read before anything is written to most.
TEST(Lockstep, RandomStartValuesMakeNoDifferenceUnderTraffic) {
  BRICK_COVERS("CARD-6");
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    auto board = lockstep({seed, false});
    BoardTraffic traffic(seed, {40, true});
    ASSERT_NO_THROW(traffic.run(*board, 40'000)) << "seed " << seed;
  }
}

TEST(Lockstep, DualPortedRamStartsByTheSeedOnBothEngines) {
  BRICK_COVERS("CARD-6");
  const auto read = [](std::uint64_t seed) {
    auto board = lockstep({seed, false});
    BoardInputs in;
    board->run_until(30);
    in.rst_n = true;
    std::vector<std::uint32_t> words;
    for (std::uint32_t offset = 0; offset < 0x10000; offset += 0x3FE) {
      in.set_address(0xD0000 + offset);
      board->set_inputs(in);
      board->run_until(board->now() + 12);
      in.isa_memr_n = false;
      board->set_inputs(in);
      board->run_until(board->now() + 30);
      words.push_back(board->outputs().get(pin::kIsaSd));
      in.isa_memr_n = true;
      board->set_inputs(in);
      board->run_until(board->now() + 12);
    }
    return words;
  };
  const std::vector<std::uint32_t> zeros(65), two = read(2), three = read(3);  // 65 = 65536 / 1022, rounded up
  EXPECT_EQ(read(0), zeros);
  EXPECT_EQ(read(1), zeros);
  EXPECT_NE(read(~std::uint64_t{0}), zeros);
  for (std::size_t i = 1; i < two.size(); ++i) {  // neighbours and seeds differ: 2 of 65536 words are equal by chance
    EXPECT_NE(two[i], two[i - 1]) << i;
    EXPECT_NE(two[i], three[i]) << i;
  }
}

TEST(RtlEngine, SaysThatNoVariantHasTheFittedIcs) {
  EXPECT_THROW(
      {
        try {
          make_rtl_board(0x400000);  // no such IC
        } catch (const std::runtime_error& e) {
          EXPECT_THAT(e.what(), ::testing::HasSubstr("$400000"));
          throw;
        }
      },
      std::runtime_error);
}

}  // namespace
}  // namespace brick
