// The motor side of the board on all engines: who watches is told edge by edge, a run stops at a selected pin, and the
// report of a difference names the pin.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <tuple>
#include <vector>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/servo_ic/clock_words.h"

namespace brick {
namespace {

TEST(MotorPinsOfAnEngine, DoNotDependOnHowARunIsCut) {
  using Seen = std::vector<std::tuple<Tick, unsigned, std::uint32_t>>;
  const auto changes = [](std::unique_ptr<Board> board, Tick batch) {
    Seen seen;
    board->watch_motors(~0u);
    board->on_motor_change = [&](Tick t, unsigned ic, const MotorOutputs&, const MotorOutputs& after) {
      for (const std::uint32_t w : after.w) seen.emplace_back(t, ic, w);
    };
    MotorTraffic(7, {0x3}).run(*board, 60'000, batch);
    return seen;
  };
  const Seen once = changes(make_rtl_board(0x3), kNever);
  EXPECT_GT(once.size(), 1000u);
  for (const Tick batch : {1, 7, 1000}) {
    EXPECT_TRUE(changes(make_rtl_board(0x3), batch) == once) << batch;
    EXPECT_TRUE(changes(make_model_board(0x3), batch) == once) << batch;
  }
}

// At reset values the command is 0, so TOP is wanted for half of the period of 2 (2 I7m00 + 3) ticks, I7m00 = 6527, and
// comes late by the dead time of 16 x 15 ticks (servo-ic:5.11/3).
TEST(MotorPinsOfAnEngine, StopAtTheSelectedPin) {
  for (const bool rtl : {true, false}) {
    auto board = rtl ? make_rtl_board(0x3) : make_model_board(0x3);
    BoardInputs in;
    board->watch_motors(1u << 0);
    MotorOutputs select;
    select.set(motor_pin::kPwmBTop, 2, 1);
    board->stop_on_motor(0, select);
    std::vector<Tick> moved;
    board->on_motor_change = [&](Tick t, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
      EXPECT_EQ(ic, 0u);
      if (before.differs(after, select)) moved.push_back(t);
    };
    start_clocks(*board, in);
    const Tick on = board->run_until(1'000'000);
    EXPECT_EQ(board->motor_outputs(0).get(motor_pin::kPwmBTop, 2), 1u) << "rtl " << rtl;
    const Tick off = board->run_until(1'000'000);
    EXPECT_EQ(off - on, 2 * 6527 + 3 - 16 * 15) << "rtl " << rtl;
    EXPECT_THAT(moved, ::testing::ElementsAre(on, off));
    board->stop_on_motor(0, {});
    EXPECT_EQ(board->run_until(100'000), 100'000);
  }
}

TEST(MotorPinsOfAnEngine, OfAnIcThatIsNotFittedShowZero) {
  for (const bool rtl : {true, false}) {
    auto board = rtl ? make_rtl_board(0x1) : make_model_board(0x1);
    BoardInputs in;
    in.fitted = 1;
    board->watch_motors(~0u);
    board->on_motor_change = [](Tick, unsigned ic, const MotorOutputs&, const MotorOutputs&) { EXPECT_EQ(ic, 0u); };
    start_clocks(*board, in);
    board->set_motor_inputs(1, {});
    board->set_motor_inputs(17, {});
    board->run_until(40'000);
    EXPECT_TRUE(board->motor_outputs(1) == MotorOutputs{});
    EXPECT_TRUE(board->motor_outputs(17) == MotorOutputs{});
    EXPECT_NE(board->motor_outputs(0).w[0], 0u);
  }
}

// The reset is asynchronous: what it clears is seen at the first tick in reset, wherever that lies between two edges of
// clk_ref. So soon after the last reset no other pin has left its level.
TEST(MotorPinsOfAnEngine, LoseTheirCountAtTheFirstTickOfAReset) {
  for (const bool rtl : {true, false})
    for (const Tick at : {240, 241, 242}) {
      BoardRig rig(rtl ? make_rtl_board(0x1) : make_model_board(0x1), 0x1);
      Board& board = rig.board();
      rig.write(true, 0x07801D, 3);  // channel 4: quadrature x 4
      board.run_until(130);
      MotorInputs turned;
      turned.pins[3] ^= 1;
      board.set_motor_inputs(0, turned);
      board.run_until(at);
      ASSERT_NE(board.motor_outputs(0).get(motor_pin::kCount, 3), 0u);
      std::vector<Tick> cleared;
      board.watch_motors(1);
      board.on_motor_change = [&](Tick t, unsigned, const MotorOutputs& before, const MotorOutputs& after) {
        if (before.get(motor_pin::kCount, 3) != 0 && after.get(motor_pin::kCount, 3) == 0) cleared.push_back(t);
      };
      rig.in.rst_n = false;
      rig.apply();
      board.run_until(at + 30);
      EXPECT_THAT(cleared, ::testing::ElementsAre(at + 1)) << "rtl " << rtl;
    }
}

// 25 ms without a strobe: servo-ic:10. 960 periods of 1024 clk_ref are 2949120 ticks.
TEST(MotorPinsOfTheBoard, AreOffAfterTheWatchdogTripped) {
  BoardRig rig(make_lockstep_board(make_rtl_board(0x3), make_model_board(0x3)), 0x3);
  Board& board = rig.board();
  rig.write(true, 0x078000 + kClockWord, clock_word(0, 3, 0));
  rig.write(true, 0x078005, 1u << 14 | 1u << 11 | 1u << 12);  // channel 1: AENA; EQU set by hand
  rig.write(true, 0x07800D, 1u << 23);                        // channel 2: PFM
  rig.write(false, 0x07800C, 0x100000);
  rig.write(true, 0x078015, 1u << 22);  // channel 3: DAC
  rig.write(false, 0x078012, 0x7FFFFF);
  board.watch_motors(1);
  MotorOutputs moved;
  board.on_motor_change = [&](Tick, unsigned, const MotorOutputs& before, const MotorOutputs& after) {
    for (unsigned i = 0; i < kMotorOutputWords; ++i) moved.w[i] |= before.w[i] ^ after.w[i];
  };
  const Tick trip = board.run_until(4'000'000, select_pins(pin::kWdTripped));
  ASSERT_LT(trip, 2'949'120 + 200'000);
  EXPECT_EQ(moved.get(motor_pin::kPwmATop, 0), 1u);
  EXPECT_EQ(moved.get(motor_pin::kPfmPulse, 1), 1u);
  EXPECT_EQ(moved.get(motor_pin::kDac, 2), 1u);
  EXPECT_EQ(moved.get(motor_pin::kAena, 0), 1u) << "falls with the trip";
  EXPECT_EQ(moved.get(motor_pin::kEqu, 0), 1u) << "falls with the trip";
  board.run_until(trip + 2 * 26114);  // the next DAC word starts at PHASE
  moved = {};
  board.run_until(trip + 6 * 26114);
  const MotorOutputs off = board.motor_outputs(0);
  for (unsigned n = 0; n < kChannels; ++n)
    for (const MotorField& f : motor_pin::kAll) {
      if (f.shared || f.name == "count") continue;
      EXPECT_EQ(off.get(f, n), 0u) << f.name << " of channel " << n + 1;
      EXPECT_EQ(moved.get(f, n), 0u) << f.name << " of channel " << n + 1;
    }
}

// A board that does nothing but move one motor pin at tick 5, or none.
class OneMotorPinBoard : public Board {
 public:
  OneMotorPinBoard(unsigned ic, MotorOutputs after) : ic_(ic), after_(after) {}
  Tick now() const override { return now_; }
  void set_inputs(const BoardInputs&) override {}
  const BoardOutputs& outputs() const override { return outputs_; }
  Tick run_until(Tick limit, const BoardOutputs&) override {
    if (now_ < 5 && limit >= 5 && after_ != MotorOutputs{}) on_motor_change(5, ic_, {}, after_);
    return now_ = limit;
  }

 private:
  unsigned ic_;
  MotorOutputs after_;
  BoardOutputs outputs_;
  Tick now_ = 0;
};

TEST(Lockstep, ComparesEveryMotorPinInBothDirectionsAndNamesIt) {
  BRICK_COVERS("CARD-6");
  for (const unsigned ic : {0u, 1u, 10u})
    for (const MotorField& f : motor_pin::kAll)
      for (unsigned n = 0; n < (f.shared ? 1 : kChannels); ++n)
        for (const bool rtl_moves : {true, false}) {
          MotorOutputs after;
          after.set(f, n, 1);
          auto board = make_lockstep_board(std::make_unique<OneMotorPinBoard>(ic, rtl_moves ? after : MotorOutputs{}),
                                           std::make_unique<OneMotorPinBoard>(ic, rtl_moves ? MotorOutputs{} : after));
          const std::string name = fmt::format("{}.ch{}.{}",
                                               ic == 10  ? "servo_ic2s"
                                               : ic == 1 ? "servo_ic1"
                                                         : "servo_ic0",
                                               n + 1, f.name);
          try {
            board->run_until(100);
            ADD_FAILURE() << name << " was not compared";
          } catch (const LockstepDifference& e) {
            EXPECT_THAT(e.what(), ::testing::HasSubstr("differ at tick 5 "));
            const char* values = f.width > 1
                                     ? (rtl_moves ? "rtl $000001, systemc $000000" : "rtl $000000, systemc $000001")
                                     : (rtl_moves ? "rtl 1, systemc 0" : "rtl 0, systemc 1");
            EXPECT_THAT(e.what(), ::testing::HasSubstr(fmt::format("\n  {}: {}\n", name, values)));
          }
        }
}

}  // namespace
}  // namespace brick
