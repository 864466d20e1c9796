// I7 and the phase task on the whole controller, seen from outside: a commutated motor's task shows at Port A as one
// read of its channel's X:+1, and must come every I7+1 falls of the PHASE pin (firmware:2, firmware:8.1; servo-ic:7.4).
// What it makes of the encoder is read back by the host.
#include <algorithm>

#include "systemc/cpu/port_a.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr std::uint32_t kPhasePosition1 = 0x78001;  // X:+1 of servo IC 0 channel 1, the default I183
constexpr int kI7000 = 1473;
constexpr Tick kPeriod = 2 * kI7000 + 3;  // I7001 = 0: 40 kHz, so that 256 periods are not long

class PhaseTask : public Controller {
 protected:
  void start_fast(const std::string& variables) {
    start();
    ask("I7000=" + std::to_string(kI7000) + " I7010=3");
    ask(variables);
    wait(ms_to_ticks(2));
    watch();
  }
  // Also after a reset, when the phase clock has another beginning.
  void watch() {
    const auto falls = falling_edges(pin::kPhase, 2, 4 * kPeriod);
    ASSERT_EQ(falls.size(), 2u);
    ASSERT_EQ(falls[1] - falls[0], kPeriod);
    fall_ = falls[0];
    reads_.clear();
    machine().on_bus_cycle = [this](const PortACycle& c) {
      if (!c.write && c.x && c.address == kPhasePosition1) reads_.push_back(fs_to_tick(c.start));
    };
  }
  Tick fall_at(Tick tick) const { return (tick - fall_) / kPeriod; }  // number of the last fall
  int number(const std::string& command) { return std::stoi(ask(command)); }

  // `count` falls at the pin from now on, and which of them were followed by a read.
  std::vector<std::size_t> falls_with_a_read(unsigned count) {
    reads_.clear();
    const auto falls = falling_edges(pin::kPhase, count, (count + 2) * kPeriod);
    EXPECT_EQ(falls.size(), count);
    std::vector<std::size_t> numbers;
    for (const Tick read : reads_) {
      const auto after = std::upper_bound(falls.begin(), falls.end(), read);
      if (after != falls.begin() && after != falls.end())
        numbers.push_back(static_cast<std::size_t>(after - falls.begin()));
    }
    return numbers;
  }
  void expect_every(unsigned step, unsigned falls) {
    SCOPED_TRACE("every " + std::to_string(step));
    const auto numbers = falls_with_a_read(falls);
    ASSERT_FALSE(numbers.empty());
    EXPECT_LE(numbers.front(), step);
    for (std::size_t i = 1; i < numbers.size(); ++i) EXPECT_EQ(numbers[i] - numbers[i - 1], step);
    EXPECT_GE(numbers.back() + step, falls);  // the next would have been outside
  }

  // Turns the encoder of channel 1 by counts at decode x4; A leads B forward: 00, 10, 11, 01 (servo-ic:5.4).
  void turn(int counts) {
    constexpr std::uint16_t kPins[4] = {0, 1u << kEncA, 1u << kEncA | 1u << kEncB, 1u << kEncB};
    for (int i = 0; i < std::abs(counts); ++i) {
      quadrature_ += counts < 0 ? 3 : 1;
      auto& pins = machine().motor_inputs()[0].pins[0];
      pins = static_cast<std::uint16_t>((pins & ~kPins[2]) | kPins[quadrature_ % 4]);
      machine().apply_motor_inputs();
      wait(60);  // synchroniser, and filter of three SCLK periods of 12 ticks
    }
    wait(3 * kPeriod);
  }

  std::vector<Tick> reads_;

 private:
  Tick fall_ = 0;
  unsigned quadrature_ = 3;  // nothing connected: A low, B high
};

// -cycle/2 .. cycle/2-1
int in_cycle(int value, int cycle) {
  const int rest = ((value % cycle) + cycle) % cycle;
  return rest >= cycle - cycle / 2 ? rest - cycle : rest;
}

TEST_P(PhaseTask, ReadsThePhasePositionEveryI7PlusOneFallsOfPhase) {
  start_fast("I101=1");
  expect_every(1, 40);
  for (const unsigned i7 : {1u, 3u}) {
    ask("I7=" + std::to_string(i7));
    expect_every(i7 + 1, 60);
  }
  ask("I7=255");
  wait(256 * kPeriod);  // the first may come earlier: the count goes on
  expect_every(256, 3 * 256 + 10);
}

TEST_P(PhaseTask, ReadsNothingWithoutACommutatedMotor) {
  start_fast("I101=0");
  EXPECT_TRUE(falls_with_a_read(20).empty());
  for (const auto* off : {"I101=2", "I101=1 I100=0"}) {
    ask(off);
    EXPECT_TRUE(falls_with_a_read(20).empty()) << off;
  }
  ask("I100=1");
  EXPECT_EQ(falls_with_a_read(20).size(), 19u);
  ask("I101=0");
  EXPECT_TRUE(falls_with_a_read(20).empty());
}

TEST_P(PhaseTask, ASmallerI7ActsAtOnceAndALargerOneNeverBreaksTheCount) {
  start_fast("I101=1");
  ask("I7=255");
  wait(256 * kPeriod);
  reads_.clear();
  while (reads_.empty()) wait(kPeriod);
  wait(10 * kPeriod);
  ASSERT_EQ(reads_.size(), 1u);
  ask("I7=1");
  const Tick answered = fall_at(machine().now());
  wait(20 * kPeriod);
  ASSERT_GT(reads_.size(), 5u);
  ASSERT_LT(answered - fall_at(reads_[0]), 250) << "the long wait would have ended by itself";
  EXPECT_LE(fall_at(reads_[1]), answered + 1);
  for (std::size_t i = 2; i < reads_.size(); ++i) EXPECT_EQ(fall_at(reads_[i]) - fall_at(reads_[i - 1]), 2);
  const std::size_t before = reads_.size();
  ask("I7=3");
  wait(20 * kPeriod);
  bool larger = false;
  for (std::size_t i = before; i < reads_.size(); ++i) {
    const Tick step = fall_at(reads_[i]) - fall_at(reads_[i - 1]);
    EXPECT_EQ(step, larger ? 4 : step == 4 ? 4 : 2);
    larger = larger || step == 4;
  }
  EXPECT_TRUE(larger);
}

TEST_P(PhaseTask, PhasePositionFollowsTheEncoder) {
  start_fast("I101=1 I170=3 I171=100");
  ask("M101->X:$078001,0,24,S");
  ask("M171->X:$0000B4,0,24,S");
  ask("M171=0");
  int counts = 0;
  const int counter = number("M101");
  for (const int move :
       {16, 1, 50, -3, -80, -40, 57}) {  // through both ends of the cycle, and the counter through zero
    turn(move);
    counts += move;
    EXPECT_EQ(number("M101") - counter, counts);
    EXPECT_EQ(number("M171"), in_cycle(3 * counts, 100)) << counts;
    if (counts == -56) { EXPECT_LT(number("M101"), 0); }
  }
  ask("I7=9 M171=-50");
  turn(-1);
  wait(10 * kPeriod);
  EXPECT_EQ(number("M171"), in_cycle(-53, 100)) << "nothing is lost between two tasks";
}

TEST_P(PhaseTask, CounterWrapsAt24BitsAndIxx83MayPointAnywhere) {
  start_fast("I170=3 I171=1000");
  ask("M1->X:$0010F0,0,24,S");
  ask("M2->Y:$0010F0,0,24,S");
  ask("M171->X:$0000B4,0,24,S");
  ask("M1=8388600 I183=$10F0 I101=1 M171=0");
  ask("M1=-8388600");
  wait(2 * kPeriod);
  EXPECT_EQ(number("M171"), 48);
  ask("M1=8388590");
  wait(2 * kPeriod);
  EXPECT_EQ(number("M171"), 48 - 78);
  ask("M2=100 I101=3");  // bit 1: a Y register
  ask("M1=0 M2=90");
  wait(2 * kPeriod);
  EXPECT_EQ(number("M171"), 48 - 78 - 30);
}

TEST_P(PhaseTask, NoCycleCountsLeaveThe24BitsOfTheRegister) {
  start_fast("I101=1 I170=255 I171=0");
  ask("M171->X:$0000B4,0,24,S");
  const std::string status = ask("???");
  ask("M171=8388600");
  turn(1);
  EXPECT_EQ(number("M171"), 8388600 + 255 - 16777216);
  turn(-1);
  EXPECT_EQ(number("M171"), 8388600);
  EXPECT_EQ(ask("???"), status);
}

TEST_P(PhaseTask, IsThereAgainAfterSaveAndReset) {
  start_fast("I7=3 I101=1 I171=77");
  EXPECT_EQ(ask("SAVE"), "");
  ask("I7=0 I101=0 I3=2");
  link().command("$$$");
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(ask("I7 I101 I171"), "3|1|77");
  wait(ms_to_ticks(1));
  watch();
  expect_every(4, 60);
}

TEST_P(PhaseTask, DurationIsMeasuredAndBelowThePeriod) {
  start_fast("I101=0");
  const int period = kPeriod * 8 / 12 / 2;  // CPU at 8 x 9.8304 MHz; half cycles
  EXPECT_EQ(number("RX$FFFF8C"), period);
  const int without = number("RX$37");
  EXPECT_EQ(without, 16);
  ask("I101=1");
  wait(2 * kPeriod);
  const int one = number("RX$37");
  EXPECT_GT(one, without);
  EXPECT_LT(one, period);
  ask("I200=1 I201=1");  // more have no room at this rate, with their servo loops
  wait(2 * kPeriod);
  const int two = number("RX$37");
  EXPECT_GT(two, one);
  EXPECT_LT(two, period);
  EXPECT_EQ(number("RX$FFFF8C"), period);
  ask("I101..801=0");
  EXPECT_NE(ask("VERSION"), "");
}

BRICK_ON_ENGINES(PhaseTask, Engine::kSystemC, at_night(Engine::kLockstep));

}  // namespace
}  // namespace brick
