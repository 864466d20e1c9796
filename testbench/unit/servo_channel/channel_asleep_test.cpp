// A servo IC of the model of which some outputs are watched sleeps until one of them is to change (next_motor_event(),
// next_equ_event()), and makes these outputs alone: they are those of an IC that executes each edge.
#include <random>

#include "testbench/unit/random_seed.h"
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

MotorOutputs select(const MotorField& field, unsigned channel = 0) {
  MotorOutputs one;
  one.set(field, channel, ~0u);
  return one;
}

class Sleeper {
 public:
  Sleeper(std::string name, const MotorOutputs& select) : name_(std::move(name)), select_(select) { ic.reset(0); }

  // Before an input of it changes, and after.
  void wake(Tick now) { ic.advance(now); }
  void look(Tick now) {
    next_ = ic.next_motor_event(select_);
    equ_ = ic.next_equ_event(kEquOf);
    shown_ = ic.motor_outputs(select_) & select_;
    shown_equ_ = ic.equ() & kEquOf;
    late_ = late_ || next_ <= now;
  }
  // Behind the edge `now`, at which an IC that is awake shows `all`.
  void edge(Tick now, const MotorOutputs& all) {
    if (std::min(next_, equ_) <= now) {
      ic.advance(now);
      look(now);
    }
    if (wrong.empty() && late_) wrong = name_ + ": an event that is over";
    if (wrong.empty() && (all & select_) != shown_) wrong = name_ + " at tick " + std::to_string(now);
    if (wrong.empty() && (all.w[1] >> 12 & kEquOf) != shown_equ_) wrong = name_ + ", EQU at " + std::to_string(now);
    changes += (all & select_) != before_;
    before_ = all & select_;
  }

  ServoIc ic{sc_core::sc_gen_unique_name("asleep")};
  std::string wrong;
  unsigned changes = 0;

 private:
  static constexpr unsigned kEquOf = 0x6;  // channels 2 and 3
  std::string name_;
  MotorOutputs select_, shown_, before_;
  unsigned shown_equ_ = 0;
  Tick next_ = 0, equ_ = kNever;
  bool late_ = false;
};

class ChannelAsleep : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  void SetUp() override {
    awake_.reset(0);
    for (const MotorField& field : motor_pin::kAll) sleep(std::string(field.name), select(field, pick(kChannels)));
    for (unsigned channel = 0; channel < kChannels; ++channel) sleep("count", select(motor_pin::kCount, channel));
    sleep("nothing", MotorOutputs{});
    for (const std::uint32_t mask : {pick(1u << 24), pick(1u << 24)})
      sleep("some", {{mask, mask >> 4, 0, mask & 1, 0, 0}});
    in_.phase = in_.servo = in_.rst_n = true;
    inputs();
  }
  void sleep(std::string name, const MotorOutputs& of) {
    sleepers_.push_back(std::make_unique<Sleeper>(std::move(name), of));
  }
  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  bool one_in(std::uint32_t n) { return pick(n) == 0; }
  template <class Act>
  void all(const Act& act) {
    act(awake_);
    for (const auto& sleeper : sleepers_) {
      sleeper->wake(now_);
      act(sleeper->ic);
      sleeper->look(now_);
    }
  }
  void inputs() {
    all([&](ServoIc& ic) { set_inputs(ic, in_); });
  }
  void write(unsigned channel, const regs::Register& word, std::uint32_t value) {  // at an edge of clk_ref
    run(kTicksPerRef - now_ % kTicksPerRef);
    all([&](ServoIc& ic) { ic.write(word.space == 'X', base(channel) + word.address, value); });
  }
  void run(Tick ticks) {
    for (; ticks > 0; --ticks) {
      awake_.advance(++now_);
      const MotorOutputs outputs = awake_.motor_outputs();
      for (const auto& sleeper : sleepers_) sleeper->edge(now_, outputs);
      if (awake_.phase() == in_.phase && awake_.servo() == in_.servo) continue;
      in_.phase = awake_.phase();
      in_.servo = awake_.servo();
      inputs();
    }
  }
  void write_something() {
    using namespace ic_words::clock_control;
    const unsigned channel = 1 + pick(kChannels);
    switch (pick(10)) {
      case 0:
        return write(1, ic_words::kClockControl, (kOwnClocks & ~0xFFFu) | pick(one_in(3) ? 4096 : 8) | pick(8) << 6);
      case 1:
        return write(1, ic_words::kPwmControl, pwm_control(20 + pick(300), pick(one_in(2) ? 3 : 20)));
      case 2:
        return write(1, one_in(2) ? ic_words::kDacStrobe : ic_words::kAdcStrobe, pick(1u << 24));
      case 3:
      case 4:
        return control_word(channel);
      case 5:
        return write(channel, one_in(2) ? words::kCompareA : words::kCompareB, (pick(12) - 6) & 0xFFFFFF);
      case 6:
        return write(channel, words::kCompareIncrement, pick(4));
      default:
        return write(channel,
                     one_in(3)   ? words::kOutC
                     : one_in(2) ? words::kOutA
                                 : words::kOutB,
                     one_in(2) ? pick(1u << 24) : (pick(400) - 200) << 8 & 0xFFFFFF);
    }
  }
  void control_word(unsigned channel) {
    std::uint32_t word = pick(1u << 24);
    if (!one_in(6)) word &= ~kCounterReset;
    if (!one_in(3)) word = field::kDecode.set(word, one_in(2) ? regs::decode::kX4Cw : regs::decode::kInternalPulse);
    write(channel, words::kControl, word);
  }
  void pins_move() {
    const unsigned channel = pick(kChannels);
    if (one_in(4)) {
      in_.adc_a = pick(16);
      in_.adc_b = pick(16);
    } else if (one_in(4)) {
      in_.pins[channel] ^= 1u << pick(kChannelPins);
    } else {
      in_.pins[channel] ^= in_.pins[channel] % 4 == 0 || in_.pins[channel] % 4 == 3 ? 1 : 2;  // one way round
    }
    if (one_in(500)) in_.trip = !in_.trip;
    inputs();
  }

  std::mt19937 random_{random_seed(GetParam())};
  ServoIc awake_{sc_core::sc_gen_unique_name("awake")};
  std::vector<std::unique_ptr<Sleeper>> sleepers_;
  ServoIcInputs in_{};
  Tick now_ = 0;
};

TEST_P(ChannelAsleep, OutputsThatAreWatchedAreThoseOfOneThatIsAwake) {
  write(1, ic_words::kPwmControl, pwm_control(100, 1));
  write(1, ic_words::kClockControl, kOwnClocks);
  for (unsigned channel = 1; channel <= kChannels; ++channel) control_word(channel);
  run(2 * 13057);
  for (int round = 0; round < 3000; ++round) {
    if (one_in(3))
      write_something();
    else
      pins_move();
    run(one_in(20) ? pick(2000) : pick(60));
  }
  unsigned moved = 0;
  for (const auto& sleeper : sleepers_) {
    EXPECT_EQ(sleeper->wrong, "");
    moved += sleeper->changes > 0;
  }
  EXPECT_GE(moved, 15u);
}
INSTANTIATE_TEST_SUITE_P(ChannelSeeds, ChannelAsleep, ::testing::Range(1u, 4u));

}  // namespace
}  // namespace brick
