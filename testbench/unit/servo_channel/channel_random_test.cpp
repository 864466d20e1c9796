// Random traffic on all four channels: writes of every register, pins that move as encoders do and at random, PHASE and
// SERVO of every ratio, trips and resets. RTL and model are compared at every tick. The negative controls distort one
// written word each.
#include <gtest/gtest.h>

#include <random>

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
    rig_.write(true, 0x04, kOwnClocks);
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
    }
  }

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
    if (chance(2)) word = (word & ~0xFu) | 3 | value(1) << 2;
    hall_[ch - 1] = (word & 0xB) == 0xB;
    if (!chance(6)) word &= ~0x400u;
    if (chance(2)) word &= ~0x40000u;
    rig_.write(true, base(ch) + 5, word);
  }

  void bus() {
    const unsigned ch = between(1, 4), at = base(ch);
    switch (value(15)) {
      case 0:
        rig_.write(true, 0x04, value(4095) | (chance(3) ? value(3) << 12 : 0) | value(2) << 16 | value(2) << 20);
        break;
      case 1:
        rig_.write(true, 0x04,
                   value(3) | value(3) << 3 | value(2) << 6 | value(2) << 9 | value(1) << 16 | value(2) << 20);
        break;
      case 2:
        rig_.write(true, 0x1C, (chance(2) ? value(40) : value(700)) << 8 | (chance(2) ? value(2) : value(20)));
        break;
      case 3:
        rig_.write(true, chance(2) ? 0x0C : 0x14, value(0xFFFFFF));
        break;
      case 4:
        if (chance(4)) control(ch);
        break;
      case 5:
      case 6: {
        const std::uint32_t size = chance(2) ? 0x7FFFFF : 60000;
        rig_.write(false, at + 2 + value(2), value(size) * (chance(2) ? 1 : 0xFFFFFF) & 0xFFFFFF);
        break;
      }
      case 7: {  // compares near the position
        const std::uint32_t near = rig_.peek(true, at + 1) + value(20) - 10;
        rig_.write(chance(2), at + 7, near & 0xFFFFFF);
        break;
      }
      case 8:
        rig_.write(true, at + 6, value(10));
        break;
      case 9:
        rig_.write(false, at + value(1), value(0xFFF));
        break;
      case 10:
        rig_.write(true, at, value(0xFFF));
        break;
      case 11:
        rig_.read(true, at + 3);
        break;
      case 12:
        rig_.write(chance(2), chance(2) ? value(31) & ~4u : at + 6, value(0xFFFFFF));
        break;
      default:
        rig_.peek(chance(2), value(31));
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
  bool x;
  unsigned offset;  // all four channels, or an IC register
  std::uint32_t bits;
};

class ServoChannelNegativeControl : public ::testing::TestWithParam<Distortion> {};

TEST_P(ServoChannelNegativeControl, ComparisonFindsTheDistortedWord) {
  const Distortion d = GetParam();
  std::string difference;
  for (std::uint32_t seed = 100; seed < 108 && difference.empty(); ++seed) {
    ChannelsRig rig;
    rig.mutate = [d](bool x, unsigned addr, std::uint32_t& value) {
      const bool global = d.offset > 7 || (d.x && d.offset == 4);
      if (x == d.x && (global ? addr : addr & 7) == d.offset) value ^= d.bits;
    };
    Stimulus(rig, seed).run(300'000);
    difference = rig.difference;
  }
  EXPECT_NE(difference, "");
}
INSTANTIATE_TEST_SUITE_P(
    Words, ServoChannelNegativeControl,
    ::testing::Values(Distortion{"DecodeDirection", true, 5, 1 << 2}, Distortion{"DecodeFactor", true, 5, 1 << 0},
                      Distortion{"CaptureSource", true, 5, 1 << 4}, Distortion{"IndexInvert", true, 5, 1 << 6},
                      Distortion{"FlagInvert", true, 5, 1 << 7}, Distortion{"FlagSelect", true, 5, 1 << 8},
                      Distortion{"CounterReset", true, 5, 1 << 10}, Distortion{"EquState", true, 5, 1 << 12},
                      Distortion{"CompareChannel", true, 5, 1 << 13}, Distortion{"AmplifierEnable", true, 5, 1 << 14},
                      Distortion{"GatedIndex", true, 5, 1 << 15}, Distortion{"GateState", true, 5, 1 << 16},
                      Distortion{"Demultiplex", true, 5, 1 << 17}, Distortion{"Hardware1T", true, 5, 1 << 18},
                      Distortion{"PfmDirection", true, 5, 1 << 19}, Distortion{"InvertAb", true, 5, 1 << 20},
                      Distortion{"InvertC", true, 5, 1 << 21}, Distortion{"DacMode", true, 5, 1 << 22},
                      Distortion{"PfmMode", true, 5, 1 << 23}, Distortion{"CompareA", false, 7, 1},
                      Distortion{"CompareB", true, 7, 1}, Distortion{"Increment", true, 6, 1},
                      Distortion{"ErrorClear", true, 0, 1 << 7}, Distortion{"OutAPwm", false, 2, 1 << 8},
                      Distortion{"OutBDac", false, 3, 1 << 6}, Distortion{"OutCPfm", false, 4, 1 << 0},
                      Distortion{"SclkDivider", true, 4, 1 << 0}, Distortion{"PfmDivider", true, 4, 1 << 3},
                      Distortion{"DacDivider", true, 4, 1 << 6}, Distortion{"AdcDivider", true, 4, 1 << 9},
                      Distortion{"DacStrobe", true, 0x0C, 1 << 0}, Distortion{"AdcStrobe", true, 0x14, 1 << 23},
                      Distortion{"DeadTime", true, 0x1C, 1 << 0}, Distortion{"MaxCount", true, 0x1C, 1 << 8}),
    [](const auto& word) { return std::string(word.param.name); });

// Large jumps of the model alone end where single ticks end.
TEST(ServoChannelModel, JumpsAndSingleTicksEndInTheSameState) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
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
    write(true, 0x04, (kOwnClocks & ~0xFFFu) | value(4095));
    write(true, 0x1C, value(300) << 8 | value(20));
    for (unsigned ch = 1; ch <= 4; ++ch) {
      write(true, base(ch) + 5, value(0xFFFFFF) & ~0x400u);
      write(false, base(ch) + 2, value(0xFFFFFF));
      write(false, base(ch) + 4, value(0xFFFFFF));
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
