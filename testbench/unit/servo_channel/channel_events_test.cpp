// Of the outputs of a servo IC of the model those that are watched make events, each where it changes or where its
// cause does; what nobody watches makes none (systemc/core/model_block.h: too early costs time).
#include <functional>
#include <set>

#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

MotorOutputs one_of(const MotorField& field, unsigned channel = 0) {
  MotorOutputs one;
  one.set(field, channel, ~0u);
  return one;
}
MotorOutputs all_of(const MotorField& field) {
  MotorOutputs all;
  for (unsigned channel = 0; channel < kChannels; ++channel) all.set(field, channel, ~0u);
  return all;
}

class ChannelEvents : public ::testing::Test {
 protected:
  // Channel 1 sends pulses and counts nothing, channel 2 has DACs, channel 3 PWM, at channel 4 an encoder moves.
  struct Life {
    bool dac = true, pulses = true, encoder = true, trip = false;
  };
  static constexpr Tick kSclk = 12, kFirst = kTicksPerRef;  // reset value of the divider, from its first edge on
  static constexpr Tick kSettling = 8 * kSclk;
  static constexpr Tick kBegin = 2 * 13057 + 6, kEnd = kBegin + 20'000, kMove = 1000;
  static constexpr unsigned kMaxCount = 700;  // each stream ends before the next one

  void start(ServoIc& ic, const Life& life) const {
    Tick now = 0;
    const auto write = [&](const regs::Register& word, std::uint32_t value, unsigned channel = 1) {
      ic.advance(now += kTicksPerRef);
      ic.write(word.space == 'X', base(channel) + word.address, value);
    };
    ic.reset(0);
    write(ic_words::kPwmControl, pwm_control(kMaxCount, 1));
    write(ic_words::kClockControl, kOwnClocks);
    write(ic_words::kDacStrobe, 0xFFFFC0);  // begins and ends with an edge
    write(words::kControl, kX4 | (life.pulses ? kPfm : 0), 1);
    write(words::kOutC, 0x080000, 1);
    write(words::kControl, kX4 | (life.dac ? kDac : 0), 2);
    for (const unsigned channel : {2u, 3u}) {
      write(words::kOutA, 0x555540, channel);  // each bit is another level
      write(words::kOutB, channel << 12, channel);
    }
    ic.set_trip(life.trip);
    ic.advance(kBegin);
  }
  static MotorInputs moved(Tick t) {
    constexpr std::array<std::uint16_t, 4> kAb{0, 1, 3, 2};
    MotorInputs in;
    in.pins[3] = kAb[static_cast<std::size_t>(t / kMove % 4)];
    return in;
  }
  // Edge by edge: what an output may wait for.
  void look(const Life& life) {
    ServoIc ic(sc_core::sc_gen_unique_name("awake"));
    start(ic, life);
    shown_.assign(1, ic.motor_outputs());
    chain_.clear();
    rises_.clear();
    for (Tick t = kBegin; t < kEnd; ++t) {
      if (life.encoder && t % kMove == 0) ic.set_motor_inputs(moved(t));
      const bool phase = ic.clock_gen().phase_clock();
      const Tick special = ic.clock_gen().next_special_edge();
      ic.advance(t + 1);
      shown_.push_back(ic.motor_outputs());
      if (special == t + 1) chain_.insert(t + 1);
      if (!phase && ic.clock_gen().phase_clock()) rises_.insert(next_ref_edge(t + 1));
    }
  }
  std::vector<Tick> events(const Life& life, const MotorOutputs& select) const {
    ServoIc ic(sc_core::sc_gen_unique_name("asleep"));
    start(ic, life);
    std::vector<Tick> list;
    Tick move = kBegin + kMove - kBegin % kMove;
    for (Tick t = kBegin; t < kEnd;) {
      const Tick next = ic.next_motor_event(select);
      t = std::min({next, life.encoder ? move : kNever, kEnd});
      ic.advance(t);
      if (t == next) list.push_back(t);
      if (t == move && life.encoder) {
        ic.set_motor_inputs(moved(t));
        move += kMove;
      }
    }
    return list;
  }
  static Tick sclk_from(Tick now, Tick n) { return kFirst + ((now - kFirst) / kSclk + n) * kSclk; }  // the nth
  bool pulses_before(Tick t) const {  // it may be counted
    for (Tick at = std::max(kBegin + 1, t - kSettling); at <= t; ++at)
      if (changes(at, one_of(motor_pin::kPfmPulse))) return true;
    return false;
  }
  static bool is_sclk(Tick t) { return t % kSclk == kFirst; }
  bool changes(Tick t, const MotorOutputs& select) const {
    const auto i = static_cast<std::size_t>(t - kBegin);
    return shown_[i].differs(shown_[i - 1], select);
  }
  // How many events there are; each must be one that `allowed` allows.
  std::size_t count(const char* name, const Life& life, const MotorOutputs& select,
                    const std::function<bool(Tick)>& allowed) const {
    const std::vector<Tick> list = events(life, select);
    for (const Tick t : list) {
      EXPECT_TRUE(allowed(t)) << name << ": an event at tick " << t << " for nothing";
      if (!allowed(t)) break;
    }
    return list.size();
  }

  std::vector<MotorOutputs> shown_;
  std::set<Tick> chain_,
      rises_;  // edges of the clock chain that do more than a step; clk_ref that takes a rise of PHASE
};

constexpr MotorField kSwitches[] = {motor_pin::kPwmATop, motor_pin::kPwmABot, motor_pin::kPwmBTop,
                                    motor_pin::kPwmBBot, motor_pin::kPwmCTop, motor_pin::kPwmCBot};

TEST_F(ChannelEvents, AreThoseOfTheOutputsThatAreWatched) {
  for (const bool trip : {false, true}) {
    SCOPED_TRACE(::testing::Message() << "trip " << trip);
    Life life;
    life.trip = trip;
    look(life);
    MotorOutputs pwm;
    for (const MotorField& field : kSwitches) pwm |= all_of(field);
    MotorOutputs of_dac = one_of(motor_pin::kDacClk), of_adc = one_of(motor_pin::kAdcClk);
    of_dac |= one_of(motor_pin::kDacStrobe);
    of_adc |= one_of(motor_pin::kAdcStrobe);
    const auto chain = [this](Tick t) { return chain_.count(t) != 0; };
    const auto stream = [&](const MotorOutputs& of) {
      return [&, of](Tick t) { return changes(t, of) || chain(t) || rises_.count(t) != 0; };
    };
    for (const MotorField& field : kSwitches)
      for (unsigned channel = 0; channel < kChannels; ++channel)
        EXPECT_GT(count("PWM", life, one_of(field, channel),
                        [&](Tick t) { return changes(t, pwm) || chain(t) || chain(t - 1); }),
                  20u);
    for (unsigned channel = 0; channel < kChannels; ++channel) {
      const MotorOutputs pulse = one_of(motor_pin::kPfmPulse);
      const auto pulses = [&](Tick t) { return changes(t, pulse); };
      EXPECT_EQ(count("PULSE", life, one_of(motor_pin::kPfmPulse, channel), pulses) > 10, !trip);
      EXPECT_EQ(count("DIR", life, one_of(motor_pin::kPfmDir, channel), pulses) > 10, !trip);
      EXPECT_EQ(count("AENA", life, one_of(motor_pin::kAena, channel), [](Tick) { return false; }), 0u);
      const auto sclk = [&](Tick t) {
        return pulses(t) || (is_sclk(t) && (t % kMove <= kSettling || pulses_before(t)));
      };
      EXPECT_GT(count("EQU", life, one_of(motor_pin::kEqu, channel), sclk), 40u);
      EXPECT_GT(count("count", life, one_of(motor_pin::kCount, channel), sclk), 40u);
      EXPECT_GT(count("DAC A", life, one_of(motor_pin::kDac, channel), stream(of_dac)), 20u);
      EXPECT_GT(count("DAC B", life, one_of(motor_pin::kDacB, channel), stream(of_dac)), 20u);
    }
    EXPECT_GT(count("DAC_CLK", life, one_of(motor_pin::kDacClk), stream(of_dac)), 100u);
    EXPECT_GT(count("ADC_CLK", life, one_of(motor_pin::kAdcClk), stream(of_adc)), 100u);
    EXPECT_GT(count("DAC_STROBE", life, one_of(motor_pin::kDacStrobe), stream(one_of(motor_pin::kDacStrobe))), 20u);
    EXPECT_GT(count("ADC_STROBE", life, one_of(motor_pin::kAdcStrobe), stream(one_of(motor_pin::kAdcStrobe))), 20u);
    EXPECT_EQ(count("nothing", life, {}, [](Tick) { return false; }), 0u);
  }
}

// Lines of DACs that no channel has, pulses of no channel, counts where nothing moves.
TEST_F(ChannelEvents, AreNoneOfWhatRests) {
  Life life;
  life.dac = life.pulses = life.encoder = false;
  for (const MotorField& field : {motor_pin::kDac, motor_pin::kDacB, motor_pin::kPfmPulse, motor_pin::kPfmDir,
                                  motor_pin::kAena, motor_pin::kEqu, motor_pin::kCount})
    for (unsigned channel = 0; channel < kChannels; ++channel)
      EXPECT_EQ(events(life, one_of(field, channel)).size(), 0u) << field.name;
}

// A compare is left at the SCLK edge behind the one that arrives there, at a count an edge (servo-ic:5.10); with the
// fraction of 1/T up to three counts sooner, as systemc/servo_ic/channel_compare.h allows itself. One that another
// channel's position drives may be left with each edge.
TEST_F(ChannelEvents, OfEquAreNotBeforeTheCountsToTheCompare) {
  for (const bool fine : {false, true})
    for (const std::uint32_t at : {1u, 4u, 9u, 0xFFFFFFu, 0xFFFFFAu}) {
      const auto distance = static_cast<Tick>(std::min(at, 0x1000000 - at));
      ServoIc ic(sc_core::sc_gen_unique_name("ic"));
      Tick now = 0;
      const auto write = [&](const regs::Register& word, std::uint32_t value, unsigned channel) {
        ic.advance(now += kTicksPerRef);
        ic.write(word.space == 'X', base(channel) + word.address, value);
      };
      ic.reset(0);
      write(words::kControl, fine ? kX4 | kFine : kX4, 2);
      write(words::kControl, kX4 | kFromChannel1, 3);
      write(words::kCompareB, 100, 2);
      write(words::kCompareA, at, 2);
      EXPECT_EQ(ic.next_equ_event(2), sclk_from(now, 1 + distance - std::min<Tick>(distance, fine ? 3 : 0)))
          << fine << ", " << at;
      ic.advance(now += 300);
      for (const unsigned channels : {0u, 1u, 2u, 4u, 8u, 15u})
        EXPECT_EQ(ic.next_equ_event(channels), kNever) << channels;
      write(words::kCompareIncrement, 1, 1);
      EXPECT_EQ(ic.next_equ_event(4), sclk_from(now, 1)) << "of channel 1's position";
      EXPECT_EQ(ic.next_equ_event(8), kNever);
      EXPECT_EQ(ic.next_equ_event(2), kNever);
    }
}

}  // namespace
}  // namespace brick
