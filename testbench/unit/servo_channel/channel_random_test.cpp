// Random traffic on all four channels: writes of every register, pins that move as encoders do and at random, PHASE and
// SERVO of every ratio, trips and resets. RTL and model are compared at every tick. The negative controls distort one
// written word each.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include "testbench/unit/random_seed.h"
#include "testbench/unit/servo_channel/channels_rig.h"

namespace brick {
namespace {

class Stimulus {
 public:
  Stimulus(ChannelsRig& rig, std::uint32_t seed) : rig_(rig), random_(seed) {}

  void run(Tick ticks) {
    rig_.reset();
    for (unsigned ch = 1; ch <= 4; ++ch) {
      speed_[ch - 1] = static_cast<Tick>(between(20, 400));
      control(ch);
    }
    rig_.write(ic_words::kClockControl, kOwnClocks);
    const Tick end = rig_.now() + ticks;
    while (rig_.now() < end && rig_.difference.empty()) {
      for (unsigned ch = 1; ch <= 4; ++ch) move(ch);
      if (chance(700)) external();
      if (chance(200)) bus();
      if (chance(60000)) rig_.in.trip = !rig_.in.trip;
      if (chance(80000)) rig_.reset();
      if (chance(50)) rig_.in.adc_a = value(15);
      if (chance(50)) rig_.in.adc_b = value(15);
      rig_.tick();
      if (each_tick) each_tick();
    }
  }

  std::function<void()> each_tick;
  std::uint32_t peeked = 0;  // the last word that was looked at

 private:
  std::uint32_t between(std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random_);
  }
  std::uint32_t value(std::uint32_t limit) { return between(0, limit); }
  bool chance(std::uint32_t one_in) { return between(1, one_in) == 1; }

  // An encoder turns, now and then changes direction or stops; flags and the other lines toggle at random.
  void move(unsigned ch) {
    if (rig_.now() >= next_[ch - 1]) {
      next_[ch - 1] = rig_.now() + speed_[ch - 1] + value(10);
      if (chance(30)) up_[ch - 1] = !up_[ch - 1];
      if (chance(40)) speed_[ch - 1] = static_cast<Tick>(chance(3) ? between(3, 20) : between(20, 3000));
      unsigned& place = place_[ch - 1];
      place = (place + (up_[ch - 1] ? 1u : 11u)) % 12;
      constexpr unsigned kHall[6] = {4, 6, 2, 3, 1, 5};  // {C, B, A}
      constexpr unsigned kQuadrature[4] = {0, 1, 3, 2};
      const unsigned abc = hall_[ch - 1] ? kHall[place % 6] : kQuadrature[place % 4] | (chance(4) ? 4u : 0u);
      rig_.in.pins[ch - 1] = (rig_.in.pins[ch - 1] & ~7u) | abc;
    }
    if (chance(800)) rig_.in.pins[ch - 1] ^= 1u << between(0, 11);
  }

  void external() {
    if (chance(2)) rig_.in.phase = !rig_.in.phase;
    if (chance(2)) rig_.in.servo = !rig_.in.servo;
  }

  void control(unsigned ch) {
    std::uint32_t word = value(0xFFFFFF);
    if (chance(2)) word = field::kDecode.set(word, value(1) != 0 ? regs::decode::kX4Ccw : regs::decode::kX4Cw);
    const std::uint32_t mode = field::kDecode.get(word);
    hall_[ch - 1] = mode == regs::decode::kHallCw || mode == regs::decode::kHallCcw;
    if (!chance(6)) word &= ~kCounterReset;
    if (chance(2)) word &= ~kFine;
    rig_.write(ch, words::kControl, word);
  }
  // Something else for a few edges of clk_ref: over before SCLK sees it, or not.
  void blink(unsigned ch) {
    const std::uint32_t word = rig_.peek(ch, words::kControl);
    const std::uint32_t other[] = {word ^ kFine, word ^ kCounterReset, word ^ kFromChannel1,
                                   field::kDecode.set(word, regs::decode::kMldt)};
    rig_.write(ch, words::kControl, other[value(3)]);
    if (chance(4)) blink(ch == 1 ? between(2, 4) : 1);
    if (chance(2)) rig_.ref(static_cast<int>(between(1, 3)));
    rig_.write(ch, words::kControl, word);
  }

  void bus() {
    const unsigned ch = between(1, 4), at = base(ch);
    switch (value(15)) {
      case 0:
        rig_.write(ic_words::kClockControl,
                   value(4095) | (chance(3) ? value(3) << 12 : 0) | value(2) << 16 | value(2) << 20);
        break;
      case 1:
        rig_.write(ic_words::kClockControl,
                   value(3) | value(3) << 3 | value(2) << 6 | value(2) << 9 | value(1) << 16 | value(2) << 20);
        break;
      case 2:
        rig_.write(ic_words::kPwmControl,
                   pwm_control(chance(2) ? value(40) : value(700), chance(2) ? value(2) : value(20)));
        break;
      case 3:
        rig_.write(chance(2) ? ic_words::kDacStrobe : ic_words::kAdcStrobe, value(0xFFFFFF));
        break;
      case 4:
        if (chance(4))
          control(ch);
        else
          blink(ch);
        break;
      case 5:
      case 6: {
        const std::uint32_t size = chance(2) ? 0x7FFFFF : 60000;
        rig_.write(false, at + words::kOutA.address + value(2), value(size) * (chance(2) ? 1 : 0xFFFFFF) & 0xFFFFFF);
        break;
      }
      case 7: {  // compares near the position
        const std::uint32_t near = rig_.peek(ch, words::kPhasePosition) + value(20) - 10;
        rig_.write(ch, chance(2) ? words::kCompareB : words::kCompareA, near & 0xFFFFFF);
        break;
      }
      case 8:
        rig_.write(ch, words::kCompareIncrement, value(10));
        break;
      case 9:
        rig_.write(ch, value(1) != 0 ? words::kTimer2 : words::kTimer1, value(0xFFF));
        break;
      case 10:
        rig_.write(ch, words::kStatus, value(0xFFF));
        break;
      case 11:
        rig_.read(ch, words::kFlagPosition);
        break;
      case 12:
        rig_.write(chance(2), chance(2) ? value(31) & ~4u : at + 6, value(0xFFFFFF));
        break;
      default:
        peeked = rig_.peek(chance(2), value(31));
        break;
    }
  }

  ChannelsRig& rig_;
  std::mt19937 random_;
  Tick next_[4] = {}, speed_[4] = {};
  unsigned place_[4] = {};
  bool up_[4] = {}, hall_[4] = {};
};

class ServoChannelLockstep : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(ServoChannelLockstep, EnginesAgreeAtEveryTickOnRandomTraffic) {
  ChannelsRig rig;
  rig.lazy = GetParam() % 2 == 0;
  Stimulus(rig, GetParam()).run(300'000);
  EXPECT_EQ(rig.difference, "") << "seed " << GetParam();
}
INSTANTIATE_TEST_SUITE_P(Seeds, ServoChannelLockstep, ::testing::Range(1u, 17u));

// What one written word does differently must show on a pin or in a word that the hardware makes.
struct Distortion {
  const char* name;
  regs::Register word;  // of all four channels, or of the IC
  std::uint32_t bits;
};

class ServoChannelNegativeControl : public ::testing::TestWithParam<Distortion> {};

TEST_P(ServoChannelNegativeControl, ComparisonFindsTheDistortedWord) {
  const Distortion d = GetParam();
  std::string difference;
  for (std::uint32_t seed = 100; seed < 108 && difference.empty(); ++seed) {
    ChannelsRig rig;
    rig.mutate = [d](bool x, unsigned addr, std::uint32_t& value) {
      const bool of_ic = x && (addr & 7) == 4;
      if (x == (d.word.space == 'X') && (of_ic ? addr : addr & 7) == d.word.address) value ^= d.bits;
    };
    Stimulus(rig, seed).run(300'000);
    difference = rig.difference;
  }
  EXPECT_NE(difference, "");
}
INSTANTIATE_TEST_SUITE_P(
    Words, ServoChannelNegativeControl,
    ::testing::Values(Distortion{"DecodeDirection", words::kControl, field::kDecode.at(4)},
                      Distortion{"DecodeFactor", words::kControl, field::kDecode.at(1)},
                      Distortion{"CaptureSource", words::kControl, field::kCaptureSource.at(1)},
                      Distortion{"IndexInvert", words::kControl, field::kIndexInvert.at(1)},
                      Distortion{"FlagInvert", words::kControl, field::kFlagInvert.at(1)},
                      Distortion{"FlagSelect", words::kControl, field::kFlagSelect.at(1)},
                      Distortion{"CounterReset", words::kControl, field::kCounterReset.at(1)},
                      Distortion{"EquState", words::kControl, field::kEquState.at(1)},
                      Distortion{"CompareChannel", words::kControl, field::kCompareChannel.at(1)},
                      Distortion{"AmplifierEnable", words::kControl, field::kAena.at(1)},
                      Distortion{"GatedIndex", words::kControl, field::kGatedIndex.at(1)},
                      Distortion{"GateState", words::kControl, field::kGateState.at(1)},
                      Distortion{"Demultiplex", words::kControl, field::kIndexDemux.at(1)},
                      Distortion{"Hardware1T", words::kControl, field::kHardware1t.at(1)},
                      Distortion{"PfmDirection", words::kControl, field::kPfmDirInvert.at(1)},
                      Distortion{"InvertAb", words::kControl, field::kAbInvert.at(1)},
                      Distortion{"InvertC", words::kControl, field::kCInvert.at(1)},
                      Distortion{"DacMode", words::kControl, field::kAbDac.at(1)},
                      Distortion{"PfmMode", words::kControl, field::kCPfm.at(1)},
                      Distortion{"CompareA", words::kCompareA, 1}, Distortion{"CompareB", words::kCompareB, 1},
                      Distortion{"Increment", words::kCompareIncrement, 1},
                      Distortion{"ErrorClear", words::kStatus, status_bit::kEncoderLoss.at(1)},
                      Distortion{"OutAPwm", words::kOutA, 1 << 8}, Distortion{"OutBDac", words::kOutB, 1 << 6},
                      Distortion{"OutCPfm", words::kOutC, 1 << 0},
                      Distortion{"SclkDivider", ic_words::kClockControl, ic_words::clock_control::kSclkDivider.at(1)},
                      Distortion{"PfmDivider", ic_words::kClockControl, ic_words::clock_control::kPfmDivider.at(1)},
                      Distortion{"DacDivider", ic_words::kClockControl, ic_words::clock_control::kDacDivider.at(1)},
                      Distortion{"AdcDivider", ic_words::kClockControl, ic_words::clock_control::kAdcDivider.at(1)},
                      Distortion{"DacStrobe", ic_words::kDacStrobe, 1 << 0},
                      Distortion{"AdcStrobe", ic_words::kAdcStrobe, 1 << 23},
                      Distortion{"DeadTime", ic_words::kPwmControl, pwm_control(0, 1)},
                      Distortion{"MaxCount", ic_words::kPwmControl, pwm_control(1, 0)}),
    [](const auto& word) { return std::string(word.param.name); });

// Behind a reset the IC lives as it did behind the first one, whatever it did in between.
TEST(ServoChannelReset, ForgetsAllThatWas) {
  constexpr Tick kLife = 100'000;
  struct Shown {
    ChannelPins pins;
    std::uint32_t word;
    bool operator==(const Shown& o) const { return pins == o.pins && word == o.word; }
  };
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    ChannelsRig rig;
    const auto life = [&](std::uint32_t number) {
      std::vector<Shown> shown;
      rig.in = ServoIcInputs();
      rig.ref();
      Stimulus stimulus(rig, number);
      stimulus.each_tick = [&] { shown.push_back({rig.pins(), stimulus.peeked}); };
      stimulus.run(kLife);
      return shown;
    };
    const std::uint32_t number = random_seed(seed);
    const std::vector<Shown> first = life(number);
    life(~number);
    const std::vector<Shown> again = life(number);
    ASSERT_EQ(rig.difference, "") << "seed " << number;
    ASSERT_EQ(first.size(), again.size()) << "seed " << number;
    const auto differ = std::mismatch(first.begin(), first.end(), again.begin()).first;
    EXPECT_TRUE(differ == first.end()) << "seed " << number << ", " << differ - first.begin() << " steps on";
    unsigned changes = 0;
    for (std::size_t i = 1; i < first.size(); ++i) changes += !(first[i] == first[i - 1]);
    EXPECT_GE(changes, 1000u) << "seed " << number;
  }
}

// Large jumps of the model alone end where single ticks end.
TEST(ServoChannelModel, JumpsAndSingleTicksEndInTheSameState) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(random_seed(seed));
    const auto value = [&](std::uint32_t limit) {
      return std::uniform_int_distribution<std::uint32_t>(0, limit)(random);
    };
    ServoIc slow{sc_core::sc_gen_unique_name("ic")}, fast{sc_core::sc_gen_unique_name("ic")};
    slow.reset(0);
    fast.reset(0);
    Tick now = 0;
    ServoIcInputs in;
    const auto write = [&](bool x, unsigned addr, std::uint32_t word) {
      now += 3;
      for (ServoIc* m : {&slow, &fast}) {
        m->advance(now);
        m->write(x, addr, word);
      }
    };
    write(true, ic_words::kClockControl.address, (kOwnClocks & ~0xFFFu) | value(4095));
    write(true, ic_words::kPwmControl.address, pwm_control(value(300), value(20)));
    for (unsigned ch = 1; ch <= 4; ++ch) {
      write(true, base(ch) + words::kControl.address, value(0xFFFFFF) & ~kCounterReset);
      write(false, base(ch) + words::kOutA.address, value(0xFFFFFF));
      write(false, base(ch) + words::kOutC.address, value(0xFFFFFF));
    }
    for (int jump = 0; jump < 40; ++jump) {
      for (unsigned& pins : in.pins) pins = value(0xFFF);
      in.adc_a = value(15);
      in.adc_b = value(15);
      for (ServoIc* m : {&slow, &fast}) set_inputs(*m, in);
      const Tick end = now + 3 * (1 + value(20'000));
      fast.advance(end);
      while (now < end) slow.advance(++now);
      ASSERT_TRUE(channel_pins(slow) == channel_pins(fast)) << "seed " << seed;
      for (unsigned addr = 0; addr < 64; ++addr)
        ASSERT_EQ(slow.read(addr >= 32, addr & 31), fast.read(addr >= 32, addr & 31))
            << "seed " << seed << " word " << addr;
    }
  }
}

}  // namespace
}  // namespace brick
