// The digest: what an engine says of serial streams and PWM at once is what the pins show edge by edge. Both runs must
// have the same DAC values, conversions, commands, positions and pins at every tick.
#include <set>

#include "testbench/unit/plant/ic_rig.h"

namespace brick::plant {
namespace {

using namespace servo_channel;

constexpr std::uint32_t kMode = control::kAbDac.mask() | control::kAena.mask() | 3u;

// What can be seen of the converters after a tick.
struct Sample {
  std::array<std::int32_t, 2 * kChannels> dac{};
  std::array<std::uint32_t, 2 * kChannels> adc{};
  std::array<std::uint16_t, kChannels> pins{};

  bool operator==(const Sample& o) const { return dac == o.dac && adc == o.adc && pins == o.pins; }
};

struct Scene {
  std::uint32_t clocks = 0x0008D2;      // dividers of the bit clocks
  std::uint32_t dac_strobe = 0x7FFFC0;  // 18 bits
  std::uint32_t adc_strobe = 0xFFFFFE;
  unsigned dac_bits = 18;
  Tick change = 0;  // after a rising PHASE: the control words change
};

std::vector<Sample> samples(const Scene& scene, bool words) {
  PlantParameters parameters;
  parameters.dac_bits = scene.dac_bits;
  for (unsigned n = 0; n < kChannels; ++n) {
    AxisParameters axis;
    axis.channel = n;
    axis.drive = Drive::kTorque;
    axis.motor.inertia = 1e-3 * (n + 1);
    axis.amplifier.adc_noise = 5;
    axis.amplifier.trip_amps = 9;
    parameters.axes.push_back(axis);
  }
  Plant plant(parameters);
  IcRig rig(plant, words);
  std::vector<Sample> seen;
  rig.on_edge = [&](Tick) {
    Sample s;
    for (unsigned n = 0; n < kChannels; ++n) {
      for (const bool b : {false, true}) s.dac[(b ? kChannels : 0) + n] = plant.dac(0).value(n, b);
      s.adc[n] = rig.read(n, kAdcA);
      s.adc[kChannels + n] = rig.read(n, kAdcB);
      s.pins[n] = rig.inputs[0].pins[n];
    }
    seen.push_back(s);
  };
  rig.write(0, servo_ic::kClockControl, scene.clocks);
  rig.write(0, servo_ic::kDacStrobe, scene.dac_strobe);
  rig.write(0, servo_ic::kAdcStrobe, scene.adc_strobe);
  for (unsigned n = 0; n < kChannels; ++n) rig.write(n, kControl, kMode);
  for (unsigned i = 0; i < 8; ++i) {
    for (unsigned n = 0; n < kChannels; ++n) {
      rig.write(n, kOutA, (0x123456 * (i + 1) + 0x654321 * n) & 0xFFFFFF);
      rig.write(n, kOutB, (0xABCDEF * (i + 3) + 0x13579B * n) & 0xFFFFFF);
    }
    rig.run(IcRig::kPhase - rig.now() % IcRig::kPhase + scene.change);
    for (unsigned n = 0; n < kChannels; ++n)
      rig.write(n, kControl,
                kMode ^ (i % 2 == 0   ? control::kAbInvert.mask()
                         : i % 3 == 0 ? control::kAbDac.mask()
                                      : 0));
    rig.run(IcRig::kPhase);
  }
  return seen;
}

void expect_equal(const Scene& scene, std::size_t least_dac, std::size_t least_adc) {
  const auto pins = samples(scene, false), words = samples(scene, true);
  ASSERT_EQ(pins.size(), words.size());
  std::set<std::int32_t> dac;
  std::set<std::uint32_t> adc;
  for (std::size_t t = 0; t < pins.size(); ++t) {
    ASSERT_TRUE(pins[t] == words[t]) << "tick " << t << ", clocks " << scene.clocks << ", change " << scene.change;
    dac.insert(pins[t].dac.begin(), pins[t].dac.end());
    adc.insert(pins[t].adc.begin(), pins[t].adc.end());
  }
  EXPECT_GE(dac.size(), least_dac) << "too little was sent to compare";
  EXPECT_GE(adc.size(), least_adc) << "too little was measured to compare";
}

TEST(MotorDigest, AreWhatThePinsShowAtEveryBitRate) {
  for (unsigned n = 0; n <= 4; ++n) {
    Scene scene;
    scene.clocks = n << 9 | n << 6 | 0x12;
    expect_equal(scene, 40, 40);
  }
}

// The lines change in the middle of a stream: each tick of a bit (24 of them) and of its neighbours.
TEST(MotorDigest, AreWhatThePinsShowWhenTheOutputModeChanges) {
  for (Tick change = 0; change < 60; change += 9) {
    Scene scene;
    scene.change = change;
    expect_equal(scene, 40, 40);
  }
  Scene fast;
  fast.clocks = 0x12;
  for (fast.change = 0; fast.change < 6; ++fast.change) expect_equal(fast, 40, 40);
}

TEST(MotorDigest, AreWhatThePinsShowWithOtherStrobes) {
  Scene sixteen;
  sixteen.dac_strobe = 0x7FFF00;
  sixteen.dac_bits = 16;
  expect_equal(sixteen, 40, 40);
  Scene late;  // the strobes rise later: conversions that cross the streams
  late.adc_strobe = 0x000FFE;
  late.dac_strobe = 0x1FFFF0;
  expect_equal(late, 40, 40);
  Scene chatter;  // a strobe that rises often starts one conversion only
  chatter.adc_strobe = 0xF8A5A4;
  expect_equal(chatter, 40, 40);
}

// $F8CDFE + $010000 n clears the faults of channel n + 1: FAULT falls with the last bit of the word.
TEST(MotorDigest, CommandsComeWithTheirLastBit) {
  for (unsigned n = 0; n < 2; ++n) {
    Scene scene;
    scene.adc_strobe = 0xF8CDFE + 0x010000 * n;
    const auto seen = samples(scene, true);
    std::size_t falls = 0;
    for (std::size_t t = 1; t < seen.size(); ++t)
      falls += (seen[t - 1].pins[n] >> kFault & 1) != 0 && (seen[t].pins[n] >> kFault & 1) == 0 ? 1 : 0;
    EXPECT_GE(falls, 1u) << "the fault was never cleared";
    expect_equal(scene, 40, 40);
  }
}

// A three-phase and a brush motor at PWM outputs whose commands, modes and polarity change: currents and positions.
std::vector<double> motions(bool digest, Tick change, unsigned deadtime) {
  PlantParameters parameters;
  for (const unsigned n : {0u, 1u}) {
    AxisParameters axis;
    axis.channel = n;
    axis.drive = n == 0 ? Drive::kThreePhase : Drive::kBrush;
    axis.motor.inertia = 1e-6;
    axis.motor.viscous = 1e-5;
    parameters.axes.push_back(axis);
  }
  Plant plant(parameters);
  IcRig rig(plant, digest);
  std::vector<double> seen;
  rig.on_edge = [&](Tick t) {
    if (t % 64 != 0) return;
    const Plant& same = plant;
    for (const unsigned n : {0u, 1u}) {
      seen.push_back(static_cast<double>(same.axis(n).position(t)));
      seen.push_back(same.axis(n).motor().current_a());
      seen.push_back(same.axis(n).motor().current_b());
      seen.push_back(static_cast<double>(rig.inputs[0].pins[n]));
    }
  };
  rig.write(0, servo_ic::kPwmControl, IcRig::kMaxCount << 8 | deadtime);
  constexpr std::uint32_t kOn = control::kAena.mask() | 3u;
  for (const unsigned n : {0u, 1u}) rig.write(n, kControl, kOn);
  for (unsigned i = 0; i < 12; ++i) {
    for (const unsigned n : {0u, 1u}) {
      rig.write(n, kOutA, (0x10000u + 800 - 130 * i) << 8 & 0xFFFFFF);
      rig.write(n, kOutB, (0x10000u - 1700 + 290 * i) << 8 & 0xFFFFFF);  // beyond the triangle at first
      rig.write(n, kOutC, (0x10000u + 100 * n + 55 * i) << 8 & 0xFFFFFF);
    }
    rig.run(IcRig::kPhase + change);
    if (i == 4) rig.write(0, kControl, kOn | control::kCPfm.mask());
    if (i == 5) rig.write(0, kControl, kOn);
    if (i == 6) rig.write(1, kControl, kOn | control::kAbDac.mask());
    if (i == 7) rig.write(1, kControl, kOn);
    if (i == 10) rig.write(1, kControl, kOn | control::kAbInvert.mask());
    rig.run(IcRig::kPhase);
  }
  return seen;
}

TEST(MotorDigest, TimesOfThePwmAreWhatThePinsShow) {
  for (const unsigned deadtime : {0u, 1u, 15u}) {
    for (Tick change = 0; change < 1600; change += 397) {
      const auto pins = motions(false, change, deadtime), digest = motions(true, change, deadtime);
      ASSERT_EQ(pins, digest) << "dead time " << deadtime << ", change " << change;
      EXPECT_GE(std::set<double>(pins.begin(), pins.end()).size(), 200u) << "too little has moved to compare";
    }
  }
}

}  // namespace
}  // namespace brick::plant
