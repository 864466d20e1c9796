// Motor side of the model of the board: pins on demand against pins watched, words and EQU interrupts of ICs that
// nobody watches, run lengths, stops, watchdog trip.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/board/words.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr std::uint32_t kThree = 0x7;
constexpr MotorTrafficOptions kBusy{kThree, 3'000, 400, true, 50};

struct Change {
  Tick tick;
  unsigned ic;
  MotorOutputs before, after;
  bool operator==(const Change& o) const {
    return tick == o.tick && ic == o.ic && before == o.before && after == o.after;
  }
};

class MotorPins : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(MotorPins, OnDemandAreTheWatchedOnesTickByTick) {
  constexpr Tick kEnd = 250'000;
  auto watched = make_model_board(kThree);
  std::array<std::map<Tick, MotorOutputs>, 3> shown;
  for (unsigned ic = 0; ic < 3; ++ic) shown[ic][0] = watched->motor_outputs(ic);
  watched->watch_motors(kThree);
  watched->on_motor_change = [&](Tick t, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
    ASSERT_TRUE(before == shown[ic].rbegin()->second) << "tick " << t;
    ASSERT_TRUE(shown[ic].emplace(t, after).second) << "tick " << t;
  };
  MotorTraffic(GetParam(), kBusy).run(*watched, kEnd, 100'000);

  auto asked = make_model_board(kThree);
  asked->on_motor_change = [](Tick, unsigned, const MotorOutputs&, const MotorOutputs&) { FAIL() << "nobody watches"; };
  MotorTraffic again(GetParam(), kBusy);
  std::array<unsigned, 6> words{};  // that changed
  for (Tick t = 1; t <= kEnd; ++t) {
    again.run(*asked, t);
    for (unsigned ic = 0; ic < 3; ++ic) {
      const MotorOutputs& expected = std::prev(shown[ic].upper_bound(t))->second;
      const MotorOutputs now = asked->motor_outputs(ic);
      for (unsigned i = 0; i < kMotorOutputWords; ++i)
        ASSERT_EQ(now.w[i], expected.w[i]) << "tick " << t << " IC " << ic << " word " << i;
      const auto at = shown[ic].find(t);
      if (at != shown[ic].end() && at != shown[ic].begin())
        for (unsigned i = 0; i < kMotorOutputWords; ++i) words[i] += std::prev(at)->second.w[i] != now.w[i] ? 1 : 0;
    }
  }
  for (unsigned i = 0; i < kMotorOutputWords; ++i)
    EXPECT_GT(words[i], 20u) << "word " << i << " hardly moves: the test shows nothing";
}

std::vector<Change> changes(std::uint64_t seed, Tick end, Tick stretch, std::vector<BoardOutputs>* pins) {
  auto board = make_model_board(kThree);
  std::vector<Change> list;
  board->watch_motors(0x5);
  board->on_motor_change = [&](Tick t, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
    list.push_back({t, ic, before, after});
  };
  board->on_change = [&](Tick, const BoardOutputs&, const BoardOutputs& after) { pins->push_back(after); };
  MotorTraffic(seed, kBusy).run(*board, end, stretch);
  return list;
}

TEST_P(MotorPins, DoNotDependOnRunLength) {
  BRICK_COVERS("CARD-6");
  std::vector<BoardOutputs> pins;
  const std::vector<Change> whole = changes(GetParam(), 300'000, 100'000, &pins);
  EXPECT_GT(whole.size(), 1000u);
  for (std::size_t i = 1; i < whole.size(); ++i)
    ASSERT_TRUE(whole[i - 1].tick < whole[i].tick ||
                (whole[i - 1].tick == whole[i].tick && whole[i - 1].ic < whole[i].ic));
  for (const Tick stretch : {1, 7, 1000}) {
    std::vector<BoardOutputs> same;
    EXPECT_TRUE(changes(GetParam(), 300'000, stretch, &same) == whole) << stretch;
    EXPECT_TRUE(same == pins) << stretch;
  }
}

// Interrupts by EQU and words being read come at their edge, whether anybody watches the motor pins or not.
TEST_P(MotorPins, LeaveTheBoardPinsAloneWhenWatched) {
  const auto seen = [](std::uint64_t seed, const MotorTrafficOptions& options, std::uint32_t watched, Tick end) {
    auto board = make_model_board(kThree);
    board->watch_motors(watched);
    std::vector<std::pair<Tick, BoardOutputs>> list;
    board->on_change = [&](Tick t, const BoardOutputs&, const BoardOutputs& after) { list.emplace_back(t, after); };
    MotorTraffic(seed, options).run(*board, end);
    return list;
  };
  const MotorTrafficOptions rare{kThree, 100'000, 30'000, false, 0}, turning{kThree, 40'000, 150, false, 0};
  for (const MotorTrafficOptions* options : {&kBusy, &rare, &turning}) {
    const Tick end = options == &kBusy ? 250'000 : 1'200'000;
    for (std::uint64_t seed = 10 * GetParam(); seed < 10 * GetParam() + 2; ++seed) {
      const auto watched = seen(seed, *options, kThree, end), alone = seen(seed, *options, 0, end);
      ASSERT_GT(watched.size(), 100u);
      for (std::size_t i = 0; i < std::min(watched.size(), alone.size()); ++i)
        ASSERT_TRUE(watched[i] == alone[i])
            << "seed " << seed << " tick " << std::min(watched[i].first, alone[i].first);
      ASSERT_EQ(watched.size(), alone.size()) << "seed " << seed;
    }
  }
}

// Who watches some outputs is told of these, at the same edges as one who watches all.
TEST_P(MotorPins, SelectedAreReportedAtTheirEdgesAndNoOthers) {
  BRICK_COVERS("CARD-4");
  constexpr Tick kEnd = 250'000;
  const auto seen = [](std::uint64_t seed, const MotorOutputs& select) {
    auto board = make_model_board(kThree);
    for (unsigned ic = 0; ic < 3; ++ic) board->watch_motor(ic, select);
    std::vector<Change> list;
    board->on_motor_change = [&](Tick t, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
      list.push_back({t, ic, before, after});
    };
    MotorTraffic(seed, kBusy).run(*board, kEnd, 100'000);
    return list;
  };
  const std::vector<Change> all = seen(GetParam(), kAllMotorOutputs);
  for (const MotorField& field : motor_pin::kAll) {
    MotorOutputs select;
    select.set(field, 1, ~0u);
    std::vector<Change> expected;
    for (const Change& c : all)
      if (c.before.differs(c.after, select)) expected.push_back({c.tick, c.ic, c.before & select, c.after & select});
    EXPECT_TRUE(seen(GetParam(), select) == expected) << field.name;
    EXPECT_GT(expected.size(), 0u) << field.name << " never moves: the test shows nothing";
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MotorPins, ::testing::Range<std::uint64_t>(1, 4));

// PHASE has just risen and the streams run: with their clocks the next event is a bit away, without them the fall of
// PHASE, half a period of 2 (2 I7m00 + 3) ticks later, I7m00 = 6527, or what a servo IC does on the way at a turn.
TEST(LeftOutMotorPins, MakeNoEvent) {
  const auto quiet = [](const MotorOutputs& select) {
    BoardRig rig(make_model_board(kThree), kThree);
    rig.board().watch_motor(0, select);
    rig.write(true, kServoIcBase[0] + 4, 0x0008D2);
    while (rig.board().outputs().get(pin::kPhase) != 0) rig.board().run_until(200'000, select_pins(pin::kPhase));
    while (rig.board().outputs().get(pin::kPhase) == 0) rig.board().run_until(200'000, select_pins(pin::kPhase));
    rig.board().run_until(rig.board().now() + 120);
    return rig.board().quiet_until(select_pins(pin::kPicIst)) - rig.board().now();
  };
  MotorOutputs clocks, data;
  clocks.set(motor_pin::kDacClk, 0, 1);
  data.set(motor_pin::kDac, 0, 1);
  data.set(motor_pin::kCount, 0, ~0u);
  EXPECT_GT(quiet({}), 5'000);
  EXPECT_GT(quiet(data), 5'000);
  EXPECT_LT(quiet(clocks), 100);
}

// A word that PHASE or SERVO latches, read again and again: each read takes the same position as when the IC is
// watched.
TEST(LatchedWord, ReadsTheSameWithoutAnyoneWatching) {
  const auto seen = [](std::uint32_t watched, bool x, std::uint32_t offset) {
    BoardRig rig(make_model_board(kThree), kThree);
    rig.board().watch_motors(watched);
    rig.write(true, kServoIcBase[0] + 4, 0x0008D2);
    rig.write(true, kServoIcBase[0] + 5, 0x800008);  // PFM pulses, counted
    rig.write(false, kServoIcBase[0] + 4, 0x012345);
    std::vector<std::uint32_t> list;
    unsigned changes = 0;
    while (rig.now() < 400'000) {
      list.push_back(rig.read(x, kServoIcBase[0] + offset));
      changes += list.size() > 1 && list[list.size() - 2] != list.back();
    }
    EXPECT_GT(changes, 10u);
    return list;
  };
  for (const auto& [x, offset] : std::vector<std::pair<bool, std::uint32_t>>{{true, 1}, {true, 2}, {false, 1}})
    EXPECT_TRUE(seen(0, x, offset) == seen(1, x, offset)) << offset;
}

// The same of EQU that counted PFM pulses switch, in a channel where nothing else moves: it interrupts at its edge.
TEST(EquOfPulses, InterruptsAtItsEdgeWithoutAnyoneWatching) {
  const auto seen = [](std::uint32_t watched) {
    BoardRig rig(make_model_board(kThree), kThree);
    rig.in.line_select = 0x111;
    rig.apply();
    rig.board().watch_motors(watched);
    rig.write(true, kServoIcBase[0] + 5, 0x800008);
    rig.write(false, kServoIcBase[0] + 7, 3);  // A at 3, 11, 19 ..; B at 7, 15 ..
    rig.write(true, kServoIcBase[0] + 7, 0xFFFFFF);
    rig.write(true, kServoIcBase[0] + 6, 8);
    std::vector<Tick> list;
    rig.board().on_change = [&](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
      if (before.get(pin::kPicSig) != after.get(pin::kPicSig)) list.push_back(t);
    };
    rig.write(false, kServoIcBase[0] + 4, 0x001234);  // a pulse every 3600 PFM_CLK
    rig.run(4'000'000);
    return list;
  };
  const std::vector<Tick> watched = seen(1);
  EXPECT_GT(watched.size(), 10u);
  EXPECT_TRUE(seen(0) == watched);
}

constexpr std::uint32_t kCompareA = 7, kCompareB = 7;  // Y and X

class MotorBoard : public ::testing::Test {
 protected:
  void start_clocks() { rig.write(true, 0x78004, 0x3008D2); }
  // An encoder of channel 1 makes one quadrature step, held for 100 ticks: SCLK is every 12.
  void step(unsigned ic, bool up = true) {
    constexpr unsigned kQuadrature[4] = {0, 1, 3, 2};
    place = (place + (up ? 1u : 3u)) % 4;
    motor.pins[0] = static_cast<std::uint16_t>((kIdleChannelPins & ~7u) | kQuadrature[place]);
    rig.board().set_motor_inputs(ic, motor);
    rig.run(100);
  }
  std::uint32_t ist() const { return rig.get(pin::kPicIst); }
  void isa_write(std::uint32_t address, std::uint16_t value) {
    rig.in.set_address(address);
    rig.in.isa_sd = value;
    rig.apply();
    rig.run(20);
    rig.in.isa_iow_n = false;
    rig.apply();
    rig.run(40);
    rig.in.isa_iow_n = true;
    rig.apply();
    rig.run(20);
  }

  BoardRig rig{make_model_board(kThree), kThree};
  MotorInputs motor;
  unsigned place = 0;
};

TEST_F(MotorBoard, CompareOfTheFirstChannelInterruptsTheHost) {
  // IR5 is EQU1, channel 1 of IC 0; IR6 is EQU5, channel 1 of IC 1; IC 2 has no line. Mask register: I/O 0x210 + 10.
  isa_write(0x21A, 0xFF);
  for (unsigned ic = 0; ic < 3; ++ic) {
    place = 0;
    step(ic);
    rig.write(true, kServoIcBase[ic] + kChannelControl, 0x400 | 3);  // counter held at 0
    rig.run(12);
    rig.write(true, kServoIcBase[ic] + kChannelControl, 3);
    rig.write(false, kServoIcBase[ic] + kCompareA, 3);
    rig.write(true, kServoIcBase[ic] + kCompareB, 1000);
    const std::uint32_t before = ist(), mine = ic < 2 ? 0x20u << ic : 0;
    EXPECT_EQ(before & mine, 0u);
    for (int i = 0; i < 3; ++i) step(ic);
    EXPECT_EQ(rig.board().motor_outputs(ic).get(motor_pin::kCount, 0), 3u);
    EXPECT_EQ(ist(), before) << "EQU of IC " << ic << " came before the counter left 3";
    step(ic);
    EXPECT_EQ(rig.board().motor_outputs(ic).get(motor_pin::kEqu, 0), 1u);
    EXPECT_EQ(ist(), before | mine) << "IC " << ic;
  }
}

TEST_F(MotorBoard, CompareInterruptComesAtItsEdgeWithoutAnyoneWatching) {
  // EQU changes at the SCLK edge at which the counter leaves A; the controller shows it three clk_ref edges later: two
  // stages of its synchroniser, then the latch. Found here by asking each tick, against one long run that stops at the
  // pin.
  isa_write(0x21A, 0x20);
  rig.write(true, 0x78000 + kChannelControl, 3);
  rig.write(false, 0x78000 + kCompareA, 0);
  rig.write(true, 0x78000 + kCompareB, 1000);
  rig.run(200);
  motor.pins[0] = static_cast<std::uint16_t>((kIdleChannelPins & ~7u) | 1);  // an illegal transition: no count
  rig.board().set_motor_inputs(0, motor);
  rig.run(200);
  const std::uint32_t first = rig.board().motor_outputs(0).get(motor_pin::kEqu, 0);
  EXPECT_EQ(first, 0u);
  motor.pins[0] = static_cast<std::uint16_t>((kIdleChannelPins & ~7u) | 3);
  rig.board().set_motor_inputs(0, motor);
  BoardOutputs stop = select_pins(pin::kPicIst);
  const Tick start = rig.now();
  rig.board().run_until(start + 1000, stop);
  const Tick interrupt = rig.now();
  ASSERT_EQ(ist() & 0x20, 0x20u);
  // The same again, asked tick by tick.
  BoardRig other{make_model_board(kThree), kThree};
  std::swap(rig, other);
  isa_write(0x21A, 0x20);
  rig.write(true, 0x78000 + kChannelControl, 3);
  rig.write(false, 0x78000 + kCompareA, 0);
  rig.write(true, 0x78000 + kCompareB, 1000);
  rig.run(200);
  motor.pins[0] = static_cast<std::uint16_t>((kIdleChannelPins & ~7u) | 1);
  rig.board().set_motor_inputs(0, motor);
  rig.run(200);
  motor.pins[0] = static_cast<std::uint16_t>((kIdleChannelPins & ~7u) | 3);
  rig.board().set_motor_inputs(0, motor);
  Tick equ = kNever;
  while (rig.now() < start + 1000 && equ == kNever) {
    rig.run(1);
    if (rig.board().motor_outputs(0).get(motor_pin::kEqu, 0) != 0) equ = rig.now();
  }
  EXPECT_EQ(interrupt, equ + 3 * kTicksPerRef);
}

TEST_F(MotorBoard, StopsAtASelectedMotorPin) {
  start_clocks();
  MotorOutputs select;
  select.set(motor_pin::kPwmATop, 2, 1);
  rig.board().watch_motors(0x2);
  rig.board().stop_on_motor(1, select);
  Tick last = 0;
  std::uint32_t top = rig.board().motor_outputs(1).get(motor_pin::kPwmATop, 2);
  for (int i = 0; i < 20; ++i) {
    rig.board().run_until(rig.now() + 1'000'000);
    const std::uint32_t now = rig.board().motor_outputs(1).get(motor_pin::kPwmATop, 2);
    ASSERT_NE(now, top) << "stopped at " << rig.now();
    top = now;
    // On for 2 cmd + 2 I7m00 + 3 ticks a period less the dead time of 16 x I7m04.
    if (i > 6 && now == 0) { EXPECT_EQ(rig.now() - last, 2 * 6527 + 3 - 16 * 15); }
    last = rig.now();
  }
}

TEST_F(MotorBoard, TripSwitchesTheOutputsOff) {
  start_clocks();
  for (const auto base : kServoIcBase) {
    rig.write(true, base + kChannelControl, 0x4003);         // PWM, amplifier enabled
    rig.write(true, base + 8 + kChannelControl, 0x5803);     // EQU of channel 2 set by hand
    rig.write(true, base + 16 + kChannelControl, 0xC04003);  // DAC, PFM
    rig.write(false, base + 16 + kOutA, 0x7FFFC0);
    rig.write(false, base + 16 + kOutC, 0x300000);
  }
  rig.board().watch_motors(0x1);
  unsigned reported = 0;
  rig.board().on_motor_change = [&](Tick, unsigned ic, const MotorOutputs&, const MotorOutputs&) {
    reported += ic == 0 ? 1 : 1000;
  };
  rig.run(100'000);
  EXPECT_GT(reported, 100u);
  EXPECT_LT(reported, 100'000u) << "changes of an IC that is not watched";
  for (unsigned ic = 0; ic < 3; ++ic) {
    const MotorOutputs o = rig.board().motor_outputs(ic);
    EXPECT_EQ(o.get(motor_pin::kAena, 0), 1u);
    EXPECT_EQ(o.get(motor_pin::kEqu, 1), 1u);
    EXPECT_NE(o.w[0] & 0x3F, 0u);
  }
  // Nobody strobes: 25 ms = 960 periods of 1024 clk_ref.
  rig.edge(pin::kWdTripped, 1, 4'000'000);
  for (unsigned ic = 0; ic < 3; ++ic) {
    const MotorOutputs at_once = rig.board().motor_outputs(ic);
    EXPECT_EQ(at_once.w[0] & 0xFFFFFF & ~(0x3Fu << 12), 0u) << "switches of IC " << ic;
    EXPECT_EQ(at_once.w[1] & 0xFF00, 0u) << "AENA and EQU of IC " << ic;
  }
  rig.run(60'000);
  for (unsigned ic = 0; ic < 3; ++ic) {
    for (Tick i = 0; i < 14'000; ++i) {
      rig.run(1);
      const MotorOutputs o = rig.board().motor_outputs(ic);
      ASSERT_EQ(o.get(motor_pin::kPfmPulse, 2), 0u);
      ASSERT_EQ(o.w[1] & 0xFFFF, 0u) << "DAC, AENA, EQU of IC " << ic;
    }
  }
}

TEST_F(MotorBoard, AnIcThatIsNotBuiltShowsNothing) {
  rig.board().set_motor_inputs(9, motor);
  rig.board().watch_motors(~0u);
  rig.run(1000);
  EXPECT_TRUE(rig.board().motor_outputs(9) == MotorOutputs{});
  EXPECT_TRUE(rig.board().motor_outputs(99) == MotorOutputs{});
}

}  // namespace
}  // namespace brick
