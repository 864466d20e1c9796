// A servo IC that catches up with a history of the clocks, jumping where it can, is where one is that executed every
// edge of them: all words and all outputs, at any tick. The clocks are quick and the dead time may be longer than their
// period, so that much of what an IC remembers reaches over several periods; writes and pins come at any place in the
// period. A long search: BRICK_FOLLOWER_SEEDS=5000 bin/unit_board --gtest_filter='ClockFollower*'.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "systemc/servo_ic/clock_history.h"
#include "systemc/servo_ic/servo_ic.h"
#include "testbench/unit/board/words.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr unsigned kClock = 0x04, kPwm = 0x1C;  // words of an IC
constexpr std::uint32_t kFollows = 3 << 12;
constexpr std::uint32_t kOwn = 1 << 20;  // all hardware clocks at 39.3216 MHz, SERVO at half the speed of PHASE

// Counts the edges of the clocks that it executes.
class CountingIc : public ServoIc {
 public:
  using ServoIc::ServoIc;
  unsigned edges = 0;
  void set_pins(bool phase, bool servo) override {
    ++edges;
    ServoIc::set_pins(phase, servo);
  }
};

class Pair {
 public:
  Pair() {
    for (CountingIc* ic : {&lazy, &eager}) {
      ic->reset(0);
      ic->set_pins(true, true);
      ic->set_motor_inputs(pins);
    }
  }

  // PHASE from outside: `half` ticks a half period; SERVO at half its speed, or none. 0: the IC's own clocks.
  void clocks(Tick half, bool servo) {
    half_ = half;
    servo_runs_ = servo;
    toggle_ = now + half;
  }
  Tick now = 0;
  Tick edge = 0;  // the last one of the clocks

  // Only the eager one sees the edges as they come.
  void run_to(Tick end) {
    while (now < end) {
      Tick t = std::min(end, eager.clock_gen().next_special_edge());
      if (half_ != 0) t = std::min(t, toggle_);
      eager.advance(t);
      now = t;
      bool phase = half_ == 0 ? eager.phase() : phase_, servo = half_ == 0 ? eager.servo() : servo_;
      if (half_ != 0 && t == toggle_) {
        phase = !phase_;
        if (servo_runs_ && !phase) servo = !servo_;
        toggle_ += half_;
      }
      if (phase == phase_ && servo == servo_) continue;
      const ClockHistory::Edge e{now, phase, servo};
      if (history_.should_end(e)) {
        lazy.catch_up(history_, now);
        lazy.restart_history();
        history_.clear();
      }
      history_.push(e);
      phase_ = phase;
      servo_ = servo;
      edge = now;
      eager.set_pins(phase, servo);
    }
  }
  void run(Tick ticks) { run_to(now + ticks); }

  void write(bool x, unsigned offset, std::uint32_t value) {
    run_to(next_ref_edge(now));
    lazy.catch_up(history_, now);
    for (CountingIc* ic : {&lazy, &eager}) ic->write(x, offset, value);
  }
  void set(const MotorInputs& in) {
    pins = in;
    lazy.catch_up(history_, now);
    for (CountingIc* ic : {&lazy, &eager}) ic->set_motor_inputs(in);
  }
  void trip(bool on) {
    lazy.catch_up(history_, now);
    for (CountingIc* ic : {&lazy, &eager}) ic->set_trip(on);
  }
  void send(const ConverterWords& words) {
    lazy.catch_up(history_, now);
    for (CountingIc* ic : {&lazy, &eager}) ic->send_adc(words);
  }
  // The first difference, in words; "" if there is none.
  std::string compare() {
    lazy.catch_up(history_, now);
    const std::string at = " at tick " + std::to_string(now);
    const MotorOutputs a = lazy.motor_outputs(), b = eager.motor_outputs();
    for (unsigned i = 0; i < kMotorOutputWords; ++i)
      if (a.w[i] != b.w[i]) return "pins, word " + std::to_string(i) + at;
    for (unsigned word = 0; word < 64; ++word)
      if (lazy.read(word >= 32, word % 32) != eager.read(word >= 32, word % 32))
        return std::string(word >= 32 ? "X:" : "Y:") + std::to_string(word % 32) + at;
    const ServoChannels &c = lazy.channels(), &d = eager.channels();
    if (c.dac_lines() != d.dac_lines()) return "DAC lines" + at;
    if (c.adc_stream().clocks != d.adc_stream().clocks) return "falls of ADC_CLK" + at;
    for (const bool line : {false, true})
      if (c.adc_lines(line) != d.adc_lines(line)) return "ADC lines" + at;
    for (unsigned channel = 0; channel < kChannels; ++channel)
      if (c.pwm_times(channel).balance != d.pwm_times(channel).balance) return "times of the PWM" + at;
    if (lazy.phase() != eager.phase() || lazy.servo() != eager.servo()) return "clocks" + at;
    return "";
  }

  CountingIc lazy{sc_core::sc_gen_unique_name("lazy")}, eager{sc_core::sc_gen_unique_name("eager")};
  MotorInputs pins;

 private:
  ClockHistory history_;
  Tick half_ = 0, toggle_ = 0;
  bool phase_ = true, servo_ = true, servo_runs_ = false;
};

// A dead time of 4080 ticks, ten periods of PHASE: as long as TOP and BOT are wanted in turn neither comes on.
class ClockFollowerDeadTime : public ::testing::TestWithParam<Tick> {
 protected:
  void start(std::uint32_t command) {
    pair.write(true, kClock, kOwn);  // a half triangle: 2 I7m00 + 3 = 203 ticks
    pair.write(true, kPwm, 100 << 8 | 255);
    pair.write(false, kOutA, command);
    pair.run(30'000);
    ASSERT_EQ(pair.compare(), "");
  }
  Pair pair;
};

// TOP on for good comes 4080 ticks after the last change of mind, however many periods have been left out by then.
TEST_P(ClockFollowerDeadTime, OutlastsPeriodsOfTheClock) {
  start(0);
  ASSERT_EQ(pair.eager.motor_outputs().w[0] & 3, 0u);
  const Tick edge = pair.edge;
  while (pair.edge == edge) pair.run(1);
  pair.run(GetParam());
  pair.write(false, kOutA, 0x7FFF00);
  const Tick written = pair.now;
  pair.run_to(written + 2500 + GetParam());  // some periods, asked between them
  EXPECT_EQ(pair.compare(), "");
  while ((pair.eager.motor_outputs().w[0] & 1) == 0 && pair.now < written + 10'000) pair.run(1);
  EXPECT_GT(pair.now, written + 3500);
  EXPECT_LT(pair.now, written + 4080 + 500);
  EXPECT_EQ(pair.compare(), "");
  pair.run(1000);
  EXPECT_EQ(pair.compare(), "");
}
// The same with nobody asking meanwhile; and the other way round, out of saturation.
TEST_P(ClockFollowerDeadTime, StartsWithACommandWrittenInThePeriodBeforeAJump) {
  for (const std::uint32_t to : {0x7FFF00u, 0x800000u, 0x000000u, 0x003000u}) {
    start(to == 0 || to == 0x3000 ? 0x7FFF00 : 0);
    pair.run(2 * 406 + GetParam());
    ASSERT_EQ(pair.compare(), "");
    pair.run(406);
    pair.write(false, kOutA, to);
    pair.run(3 * 406 + 2 * GetParam());
    ASSERT_EQ(pair.compare(), "") << std::hex << to;
    pair.run(1500);
    ASSERT_EQ(pair.compare(), "") << std::hex << to;
  }
}
// Commands that the triangle, from -102 to 101, just does not reach, or just reaches: one tick beside its place and a
// switch is off for ten periods.
TEST_P(ClockFollowerDeadTime, IsNotStartedByAJumpBesideATurnaround) {
  for (int command = 99; command <= 106; ++command)
    for (const int signed_command : {command, -command}) {
      start(static_cast<std::uint32_t>(signed_command) << 8 & 0xFFFFFF);
      for (int i = 0; i < 8; ++i) {
        pair.run(5 * 406 + GetParam());
        ASSERT_EQ(pair.compare(), "") << signed_command;
      }
    }
}
INSTANTIATE_TEST_SUITE_P(Places, ClockFollowerDeadTime,
                         ::testing::Values(0, 10, 40, 100, 137, 150, 190, 230, 300, 350, 380));

// What repeats with the clocks is left out: of a thousand periods an IC executes a few, whatever its outputs do, as
// long as the streams of the converters are over before the next ones begin: 24 bits of 3 * 2^n ticks, PHASE each 1403
// here.
TEST(ClockFollower, LeavesOutMostOfALongRegularStretch) {
  constexpr Tick kPeriod = 2 * 2 * 1403;  // of SERVO, with its four edges and the triangle's two ways
  for (const bool follows : {false, true})
    for (unsigned bits = 0; bits <= 4; ++bits) {
      SCOPED_TRACE(::testing::Message() << "follows " << follows << ", bit clocks " << bits);
      Pair pair;
      if (follows) pair.clocks(1403, true);
      pair.write(true, kClock, (follows ? kFollows : 0) | 1 << 16 | 1 << 20 | bits << 9 | (4 - bits) << 6 | 2 << 3);
      pair.write(true, kPwm, 700 << 8 | 20);
      for (unsigned channel = 0; channel < kChannels; ++channel) {
        pair.write(true, 8 * channel + kChannelControl, channel == 0 ? 0x400003 : channel == 1 ? 0x800008 : 3);
        for (unsigned out = 0; out < 3; ++out)
          pair.write(false, 8 * channel + kOutA + out, (channel * 12345 + out * 54321) & 0xFFFFFF);
      }
      pair.run(10 * kPeriod);
      ConverterWords words{};
      words.fill(0x5A5A5A);
      for (int round = 0; round < 3; ++round) {
        if (round == 1) pair.send(words);
        if (round == 2) pair.trip(true);
        pair.run(20 * kPeriod + 123 * round);
        ASSERT_EQ(pair.compare(), "") << "round " << round;
        const unsigned before = pair.lazy.edges;
        pair.run(200 * kPeriod);
        ASSERT_EQ(pair.compare(), "") << "round " << round;
        EXPECT_LE(pair.lazy.edges - before, 24u) << "round " << round;
      }
    }
}

std::uint64_t seeds() {
  const char* text = std::getenv("BRICK_FOLLOWER_SEEDS");
  return text == nullptr ? 100 : std::strtoull(text, nullptr, 0);
}

class Life {
 public:
  explicit Life(std::uint64_t seed) : random_(seed) {}

  std::string run() {
    follows_ = one_in(2);
    half_ = 101 + 2 * pick(one_in(2) ? 200 : 1000);
    if (follows_ || one_in(3))
      pair_.clocks(half_, !one_in(4));  // an IC with its own clocks beside them: it drives, but is not chosen
    clock_word();
    pwm_word();
    for (unsigned channel = 0; channel < kChannels; ++channel) {
      std::uint32_t control = pick(1u << 24) & ~0x40Fu;
      control |= one_in(2) ? 0x800008 : 3;  // pulses, counted; or an encoder
      pair_.write(true, 8 * channel + kChannelControl, control);
      for (unsigned out = 0; out < 3; ++out) pair_.write(false, 8 * channel + kOutA + out, command());
    }
    for (int round = 0; round < 60; ++round) {
      disturb();
      pair_.run(one_in(3) ? pick(60'000) : pick(8'000));
      if (one_in(3)) disturb();
      if (one_in(2)) {
        const Tick edge = pair_.edge;
        for (int i = 0; i < 5000 && pair_.edge == edge; ++i) pair_.run(1);
        pair_.run(pick(6));
      }
      std::string difference = pair_.compare();
      if (!difference.empty()) return difference;
    }
    return "";
  }

 private:
  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  bool one_in(std::uint32_t n) { return pick(n) == 0; }
  std::uint32_t command() {
    return one_in(3) ? (pick(2) != 0 ? 0x7FFF00 : 0x800000) : ((pick(4000) - 2000) << 8) & 0xFFFFFF;
  }
  // Mostly with a state that repeats together with SERVO: an even number of half triangles, as long as PHASE.
  void clock_word() {
    const std::uint32_t even = one_in(6) ? pick(3) | pick(3) << 4 : one_in(2) ? 1 | pick(3) << 4 : pick(3) | 1 << 4;
    pair_.write(true, kClock, serial_ << 6 | pick(3) << 3 | pick(3) | (follows_ ? kFollows : 0) | even << 16);
  }
  void pwm_word() {
    const Tick half_triangle = follows_ ? 2 * half_ : half_;  // as long as PHASE at the dividers above, or nearly
    const std::uint32_t max_count = one_in(6) ? 50 + pick(1000) : static_cast<std::uint32_t>(half_triangle - 3) / 2;
    pair_.write(true, kPwm, max_count << 8 | (one_in(2) ? 100 + pick(156) : pick(20)));
  }
  void disturb() {
    const unsigned channel = pick(kChannels);
    switch (pick(9)) {
      case 0:
      case 1:
      case 2:
        return pair_.write(false, 8 * channel + kOutA + pick(3), command());
      case 3:
      case 4: {
        MotorInputs in = pair_.pins;
        in.adc_a = static_cast<std::uint8_t>(pick(16));
        in.adc_b = static_cast<std::uint8_t>(pick(16));
        return pair_.set(in);
      }
      case 5: {
        MotorInputs in = pair_.pins;
        in.pins[channel] = static_cast<std::uint16_t>(in.pins[channel] ^ 1u << pick(kChannelPins));
        return pair_.set(in);
      }
      case 6:
        return one_in(3) ? pwm_word() : pair_.write(true, one_in(2) ? 0x0C : 0x14, pick(1u << 24));
      case 7:
        return one_in(2) ? pair_.trip(one_in(2)) : clock_word();
      default: {
        ConverterWords words;
        for (std::uint32_t& word : words) word = pick(1u << 24);
        return one_in(2) ? pair_.send(words) : void();
      }
    }
  }

  std::mt19937_64 random_;
  Pair pair_;
  Tick half_ = 0;
  bool follows_ = false;
  std::uint32_t serial_ = one_in(3) ? pick(64) : pick(2) | pick(2) << 3;  // bit clocks of the DACs and ADCs
};

TEST(ClockFollower, IsWhereEveryEdgeLeadsTo) {
  for (std::uint64_t seed = 1; seed <= seeds(); ++seed) ASSERT_EQ(Life(seed).run(), "") << "seed " << seed;
}

}  // namespace
}  // namespace brick
