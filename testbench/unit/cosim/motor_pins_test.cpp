// The motor side of the board on all engines: equal at every tick under random life; the report of a difference names
// the pin; who watches is told edge by edge, and a run stops at a selected pin. A long run:
// BRICK_MOTOR_TICKS=1000000000 bin/unit_cosim --gtest_filter='*MotorPinsAre*OneIc' (seed: BRICK_MOTOR_SEED).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdlib>
#include <tuple>
#include <vector>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 0);
}

constexpr std::uint32_t kServoIcMask = (1u << kMaxServoIcs) - 1;

struct Size {
  const char* name;
  std::uint32_t fitted;
  Tick ticks;
  bool macro_drives = false;
};

class MotorPins : public ::testing::TestWithParam<Size> {};

TEST_P(MotorPins, AreEqualAtEveryTickUnderRandomLife) {
  BRICK_COVERS("CARD-6");
  const auto [name, fitted, ticks, macro_drives] = GetParam();
  auto board = make_lockstep_board(make_rtl_board(fitted), make_model_board(fitted));
  const Tick end = from_environment("BRICK_MOTOR_TICKS", ticks);
  MotorTrafficOptions options{fitted};
  options.macro_drives = macro_drives;
  const std::uint64_t seed = from_environment("BRICK_MOTOR_SEED", 1);
  MotorTraffic traffic(seed, options);
  std::array<MotorOutputs, kMaxServoIcs> moved;
  std::uint32_t sources = 0, trips = 0;  // ICs whose PHASE the board took; of the watchdog
  board->on_change = [&](Tick, const BoardOutputs& before, const BoardOutputs& after) {
    sources |= 1u << after.get(pin::kPhaseSource);
    trips += after.get(pin::kWdTripped) & ~before.get(pin::kWdTripped);
  };
  board->watch_motors(~0u);
  board->on_motor_change = [&](Tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
    for (unsigned i = 0; i < kMotorOutputWords; ++i) moved[ic].w[i] |= before.w[i] ^ after.w[i];
  };
  ASSERT_NO_THROW(traffic.run(*board, end)) << "seed " << seed;
  RecordProperty("watchdog_trips", static_cast<int>(trips));
  if (seed != 1 && end < 10'000'000) return;  // a short run may miss something of what follows
  // Life there was: of every fitted servo IC a switch and a counter moved, and of the whole board every kind of pin.
  MotorOutputs all;
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
    if ((fitted >> ic & 1) == 0) continue;
    EXPECT_NE(moved[ic].w[0] & 0xFFFFFF, 0u) << servo_ic_scope(ic);
    EXPECT_NE(moved[ic].w[2] | moved[ic].w[3] | moved[ic].w[4] | moved[ic].w[5], 0u) << servo_ic_scope(ic);
    for (unsigned n = 0; n < kChannels; ++n)
      for (const MotorField& f : motor_pin::kAll) all.set(f, 0, all.get(f, 0) | moved[ic].get(f, n));
  }
  for (const MotorField& f : motor_pin::kAll) { EXPECT_NE(all.get(f, 0), 0u) << f.name << " never moved"; }
  if (end >= 200'000'000) { EXPECT_NE(trips, 0u); }
  EXPECT_NE(sources & fitted & (macro_drives ? ~kServoIcMask : kServoIcMask), 0u);
}

INSTANTIATE_TEST_SUITE_P(Boards, MotorPins,
                         ::testing::Values(Size{"OneIc", 0x1, 400'000}, Size{"TwoIcs", 0x3, 400'000},
                                           Size{"AllIcs", 0x3FFFFF, 120'000},
                                           Size{"AllIcsByMacro", 0x3FFFFF, 120'000, true}),
                         [](const auto& size) { return std::string(size.param.name); });

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

void write(Board& board, BoardInputs& in, std::uint32_t address, bool x, std::uint32_t word) {
  in.pa_addr = address;
  in.pa_x = x;
  in.pa_aa = 2;
  in.pa_wdata = word;
  board.set_inputs(in);
  board.run_until(board.now() + 6);
  in.pa_wr_n = false;
  board.set_inputs(in);
  board.run_until(board.now() + 12);
  in.pa_wr_n = true;
  board.set_inputs(in);
  board.run_until(board.now() + 12);
}

// The reset is asynchronous: what it clears is seen at the first tick in reset, wherever that lies between two edges of
// clk_ref. So soon after the last reset no other pin has left its level.
TEST(MotorPinsOfAnEngine, LoseTheirCountAtTheFirstTickOfAReset) {
  for (const bool rtl : {true, false})
    for (const Tick at : {240, 241, 242}) {
      auto board = rtl ? make_rtl_board(0x1) : make_model_board(0x1);
      BoardInputs in;
      in.fitted = 1;
      in.rst_n = false;
      board->set_inputs(in);
      board->run_until(30);
      in.rst_n = true;
      board->set_inputs(in);
      write(*board, in, 0x07801D, true, 3);  // channel 4: quadrature x 4
      board->run_until(130);
      MotorInputs turned;
      turned.pins[3] ^= 1;
      board->set_motor_inputs(0, turned);
      board->run_until(at);
      ASSERT_NE(board->motor_outputs(0).get(motor_pin::kCount, 3), 0u);
      std::vector<Tick> cleared;
      board->watch_motors(1);
      board->on_motor_change = [&](Tick t, unsigned, const MotorOutputs& before, const MotorOutputs& after) {
        if (before.get(motor_pin::kCount, 3) != 0 && after.get(motor_pin::kCount, 3) == 0) cleared.push_back(t);
      };
      in.rst_n = false;
      board->set_inputs(in);
      board->run_until(at + 30);
      EXPECT_THAT(cleared, ::testing::ElementsAre(at + 1)) << "rtl " << rtl;
    }
}

// 25 ms without a strobe: servo-ic:10. 960 periods of 1024 clk_ref are 2949120 ticks.
TEST(MotorPinsOfTheBoard, AreOffAfterTheWatchdogTripped) {
  auto board = make_lockstep_board(make_rtl_board(0x3), make_model_board(0x3));
  BoardInputs in;
  start_clocks(*board, in);
  write(*board, in, 0x078005, true, 1u << 14 | 1u << 11 | 1u << 12);  // channel 1: AENA; EQU set by hand
  write(*board, in, 0x07800D, true, 1u << 23);                        // channel 2: PFM
  write(*board, in, 0x07800C, false, 0x100000);
  write(*board, in, 0x078015, true, 1u << 22);  // channel 3: DAC
  write(*board, in, 0x078012, false, 0x7FFFFF);
  board->watch_motors(1);
  MotorOutputs moved;
  board->on_motor_change = [&](Tick, unsigned, const MotorOutputs& before, const MotorOutputs& after) {
    for (unsigned i = 0; i < kMotorOutputWords; ++i) moved.w[i] |= before.w[i] ^ after.w[i];
  };
  const Tick trip = board->run_until(4'000'000, select_pins(pin::kWdTripped));
  ASSERT_LT(trip, 2'949'120 + 200'000);
  EXPECT_EQ(moved.get(motor_pin::kPwmATop, 0), 1u);
  EXPECT_EQ(moved.get(motor_pin::kPfmPulse, 1), 1u);
  EXPECT_EQ(moved.get(motor_pin::kDac, 2), 1u);
  EXPECT_EQ(moved.get(motor_pin::kAena, 0), 1u) << "falls with the trip";
  EXPECT_EQ(moved.get(motor_pin::kEqu, 0), 1u) << "falls with the trip";
  board->run_until(trip + 2 * 26114);  // the next DAC word starts at PHASE
  moved = {};
  board->run_until(trip + 6 * 26114);
  const MotorOutputs off = board->motor_outputs(0);
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
