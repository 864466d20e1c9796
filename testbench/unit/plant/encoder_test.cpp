// Encoder, switches and line noise: levels, exact edge ticks, and what is wrong with them, counted by the test's own
// counter.
#include <array>
#include <cstdlib>
#include <set>
#include <vector>

#include "testbench/unit/plant/plant_rig.h"

namespace brick::plant {
namespace {

constexpr std::int64_t kU1 = kUnitsPerCount;

unsigned ab(std::uint16_t pins) { return (pins >> kEncA & 1) << 1 | (pins >> kEncB & 1); }
bool has(unsigned pins, unsigned pin) { return (pins >> pin & 1) != 0; }

PlantParameters hand(const EncoderParameters& encoder, const NoiseParameters& noise = {}, std::uint64_t seed = 1) {
  AxisParameters axis;
  axis.encoder = encoder;
  axis.noise = noise;
  PlantParameters plant;
  plant.seed = seed;
  plant.axes = {axis};
  return plant;
}

EncoderParameters lines(unsigned n) {
  EncoderParameters encoder;
  encoder.lines = n;
  return encoder;
}

TEST(Encoder, ALeadsBGoingUp) {
  const Encoder encoder(lines(10));
  for (std::int64_t cycle : {-2, 0, 7})
    for (unsigned count = 0; count < 4; ++count)
      for (std::int64_t rest : {std::int64_t{0}, kU1 - 1})
        EXPECT_EQ(ab(encoder.pins((4 * cycle + count) * kU1 + rest)),
                  (std::vector<unsigned>{0b00, 0b10, 0b11, 0b01})[count])
            << count;
}

TEST(Encoder, ShowsIdleLevelsOnWhatItDoesNotDrive) {
  const Encoder encoder(lines(10));
  EXPECT_EQ(encoder.pins(0), 1u << kT | 1u << kU | 1u << kV | 1u << kW);
}

// 70 counts in 9973 ticks from tick 1000 on: count k is reached at 1000 + ceil(9973 k / 70), both ways.
TEST(Encoder, EdgesAreExactInTicks) {
  Plant plant(hand(lines(10)));
  PlantRig rig(plant);
  std::vector<Tick> edges;
  unsigned last = 0;
  rig.on_edge = [&](Tick t) {
    const unsigned present = ab(rig.inputs[0].pins[0]);
    if (t > 1 && present != last) edges.push_back(t);
    last = present;
  };
  rig.run(1000);
  plant.axis(0).turn(70, 9973);
  rig.run(11000);
  ASSERT_EQ(edges.size(), 70u);
  for (Tick k = 1; k <= 70; ++k) EXPECT_EQ(edges[static_cast<std::size_t>(k - 1)], 1000 + (9973 * k + 69) / 70) << k;

  // Down: count 70 - k is left at the first tick at which the position is below 71 - k counts: position 70 - 70 x /
  // 9973 < 71 - k.
  edges.clear();
  plant.axis(0).turn(-70, 9973);
  rig.run(11000);
  ASSERT_EQ(edges.size(), 70u);
  for (Tick k = 1; k <= 70; ++k)
    EXPECT_EQ(edges[static_cast<std::size_t>(k - 1)], 12000 + 9973 * (k - 1) / 70 + 1) << k;
}

// A tenth of a unit per tick: going up, count 1 is reached after 10 x 65536 ticks; going down it is left one tick after
// the position was there again.
TEST(Encoder, EdgesOfASlowMotionAreExact) {
  Plant plant(hand(lines(10)));
  PlantRig rig(plant);
  plant.axis(0).turn(1, 10 * kU1);
  rig.run(10 * kU1 - 1);
  EXPECT_EQ(ab(rig.inputs[0].pins[0]), 0b00u);
  rig.run(1);
  EXPECT_EQ(ab(rig.inputs[0].pins[0]), 0b10u);
  plant.axis(0).turn(1, 100);
  rig.run(100);
  EXPECT_EQ(ab(rig.inputs[0].pins[0]), 0b11u);
  plant.axis(0).turn(-2, 20 * kU1);
  rig.run(1);
  EXPECT_EQ(ab(rig.inputs[0].pins[0]), 0b10u);
  rig.run(10 * kU1 - 1);
  EXPECT_EQ(ab(rig.inputs[0].pins[0]), 0b10u);
  rig.run(1);
  EXPECT_EQ(ab(rig.inputs[0].pins[0]), 0b00u);
}

TEST(Encoder, AnIndependentCounterFollowsBothWays) {
  Plant plant(hand(lines(250)));
  PlantRig rig(plant);
  QuadratureCounter counter;
  rig.on_edge = [&](Tick) { counter.look(rig.inputs[0].pins[0]); };
  plant.axis(0).turn(5000, 60000);
  rig.run(60001);
  EXPECT_EQ(counter.count, 5000);
  plant.axis(0).turn(-8000, 70000);
  rig.run(70001);
  EXPECT_EQ(counter.count, -3000);
  EXPECT_EQ(counter.up, 5000);
  EXPECT_EQ(counter.down, 8000);
  EXPECT_EQ(counter.illegal, 0);
  EXPECT_EQ(plant.axis(0).counts(rig.now()), -3000);
}

TEST(Encoder, TurnTakesOverFromATurnUnderWay) {
  Plant plant(hand(lines(250)));
  PlantRig rig(plant);
  plant.axis(0).turn(100, 10000);
  rig.run(5000);
  EXPECT_EQ(plant.axis(0).counts(rig.now()), 50);
  plant.axis(0).turn(-100, 10000);  // the goal is 0 now
  rig.run(5000);
  EXPECT_EQ(plant.axis(0).counts(rig.now()), 25);
  rig.run(5000);
  EXPECT_EQ(plant.axis(0).counts(rig.now()), 0);
}

// 20 lines = 80 counts, 100 ticks each: per revolution C is high once, for 100 ticks a count.
TEST(Encoder, IndexComesOnceARevolution) {
  for (unsigned width = 1; width <= 4; ++width) {
    EncoderParameters encoder = lines(20);
    encoder.index_at = 42;
    encoder.index_width = width;
    Plant plant(hand(encoder));
    PlantRig rig(plant);
    int pulses = 0, high = 0, with_ab = 0;
    bool last = false;
    rig.on_edge = [&](Tick) {
      const unsigned pins = rig.inputs[0].pins[0];
      const bool c = has(pins, kEncC);
      pulses += c && !last;
      high += c;
      with_ab += c && has(pins, kEncA) && has(pins, kEncB);
      last = c;
    };
    plant.axis(0).turn(5 * 80, 5 * 8000);
    rig.run(5 * 8000);
    EXPECT_EQ(pulses, 5);
    EXPECT_EQ(high, 5 * 100 * static_cast<int>(width));
    EXPECT_EQ(with_ab, 5 * 100);  // the gated index is one count wide, however wide C is: count 42 = 2 mod 4
  }
}

// A period of four counts of 1000 ticks. B late by a quarter of a count: its edges come 250 ticks later, A's stay; A
// too long by half a count: it falls 500 ticks later.
TEST(Encoder, PhaseErrorMovesEdges) {
  EncoderParameters encoder = lines(10);
  encoder.b_late = kU1 / 4;
  encoder.a_long = kU1 / 2;
  Plant plant(hand(encoder));
  PlantRig rig(plant);
  std::vector<Tick> a, b;
  unsigned last = 0;
  rig.on_edge = [&](Tick t) {
    const unsigned pins = rig.inputs[0].pins[0];
    if (t > 1 && has(pins ^ last, kEncA)) a.push_back(t);
    if (t > 1 && has(pins ^ last, kEncB)) b.push_back(t);
    last = pins;
  };
  plant.axis(0).turn(8, 8000);
  rig.run(9000);
  EXPECT_EQ(a, (std::vector<Tick>{1000, 3500, 5000, 7500}));
  EXPECT_EQ(b, (std::vector<Tick>{250, 2250, 4250, 6250}));  // B of the line before falls at 250; 8250 is not reached
}

// A line whose pulse of A is missing: of its four counts the counter sees B rise before A (-1) and fall again (+1).
TEST(Encoder, DarkLineLosesFourCounts) {
  EncoderParameters encoder = lines(10);
  encoder.dark_lines = {3, 7};
  Plant plant(hand(encoder));
  PlantRig rig(plant);
  QuadratureCounter counter;
  rig.on_edge = [&](Tick) { counter.look(rig.inputs[0].pins[0]); };
  plant.axis(0).turn(3 * 40, 12000);
  rig.run(12001);
  EXPECT_EQ(counter.count, 3 * (40 - 2 * 4));
  EXPECT_EQ(counter.down, 3 * 2);
  EXPECT_EQ(counter.illegal, 0);
}

// 00 -> 11 is no count, 11 -> 01 -> 00 are two: two counts are lost and one transition is illegal.
TEST(Encoder, JointEdgesAreIllegal) {
  EncoderParameters encoder = lines(10);
  encoder.joint_lines = {0, 9};
  Plant plant(hand(encoder));
  PlantRig rig(plant);
  QuadratureCounter counter;
  rig.on_edge = [&](Tick) { counter.look(rig.inputs[0].pins[0]); };
  plant.axis(0).turn(3 * 40, 12000);
  rig.run(12001);
  EXPECT_EQ(counter.illegal, 3 * 2);
  EXPECT_EQ(counter.count, 3 * (40 - 2 * 2));
  plant.axis(0).turn(-3 * 40, 12000);
  rig.run(12001);
  EXPECT_EQ(counter.illegal, 2 * 3 * 2);
  EXPECT_EQ(counter.count, 0);
}

// Mode 11 counts 001 011 010 110 100 101 of {A,B,C} up. Three pole pairs: 18 steps a revolution, 40 counts = 18 steps
// do not divide.
TEST(Encoder, HallsStepThroughTheirOrder) {
  for (const auto wiring : {EncoderParameters::Wiring::kHalls, EncoderParameters::Wiring::kHallsOnAbc}) {
    EncoderParameters encoder = lines(10);
    encoder.pole_pairs = 3;
    encoder.wiring = wiring;
    const bool on_abc = wiring == EncoderParameters::Wiring::kHallsOnAbc;
    Plant plant(hand(encoder));
    PlantRig rig(plant);
    std::vector<unsigned> seen;
    std::vector<Tick> when;
    rig.on_edge = [&](Tick t) {
      const unsigned p = rig.inputs[0].pins[0];
      const unsigned hall = on_abc ? (has(p, kEncA) ? 4u : 0) | (has(p, kEncB) ? 2u : 0) | (has(p, kEncC) ? 1u : 0)
                                   : (has(p, kU) ? 4u : 0) | (has(p, kV) ? 2u : 0) | (has(p, kW) ? 1u : 0);
      if (!seen.empty() && seen.back() == hall) return;
      seen.push_back(hall);
      when.push_back(t);
    };
    plant.axis(0).turn(40, 18000);
    rig.run(17999);
    const std::vector<unsigned> order{1, 3, 2, 6, 4, 5};
    ASSERT_EQ(seen.size(), 18u);
    for (std::size_t i = 0; i < 18; ++i) {
      EXPECT_EQ(seen[i], order[i % 6]) << i;
      // Sector i begins at i/18 of the revolution, rounded up to the position's resolution (1/65536 count = 0.007
      // tick).
      if (i == 0) continue;
      EXPECT_NEAR(static_cast<double>(when[i]), 1000.0 * static_cast<double>(i), 1) << i;
    }
  }
}

TEST(Encoder, ComplementsOpposeAAndBUntilAWireIsCut) {
  EncoderParameters parameters = lines(10);
  parameters.wiring = EncoderParameters::Wiring::kComplements;
  Encoder encoder(parameters);
  for (std::int64_t count = 0; count < 40; ++count) {
    const unsigned pins = encoder.pins(count * kU1);
    EXPECT_EQ(has(pins, kU), has(pins, kEncA));
    EXPECT_NE(has(pins, kT), has(pins, kU));
    EXPECT_EQ(has(pins, kV), has(pins, kEncB));
    EXPECT_NE(has(pins, kW), has(pins, kV));
  }
  encoder.cut(1u << kT);  // pulled up, so equal to U whenever A is high
  for (std::int64_t count = 0; count < 40; ++count) {
    const unsigned pins = encoder.pins(count * kU1);
    EXPECT_TRUE(has(pins, kT));
    EXPECT_EQ(has(pins, kU), count % 4 == 1 || count % 4 == 2);
  }
  encoder.cut(1u << kEncA | 1u << kEncB);  // the receiver of A shows 0, B is pulled up
  EXPECT_EQ(ab(encoder.pins(2 * kU1)), 0b01u);
}

TEST(Encoder, RejectsNonsense) {
  EncoderParameters none = lines(0), wide = lines(10), dark = lines(10), halls = lines(10);
  wide.index_width = 5;
  dark.dark_lines = {10};
  halls.wiring = EncoderParameters::Wiring::kHalls;
  EXPECT_THROW(Encoder{none}, std::invalid_argument);
  EXPECT_THROW(Encoder{wide}, std::invalid_argument);
  EXPECT_THROW(Encoder{dark}, std::out_of_range);
  EXPECT_THROW(Encoder{halls}, std::invalid_argument);
}

// A home switch from count 30 to 50 and a limit below -20, passed at 100 ticks a count.
TEST(Switches, CloseAtTheirPlace) {
  PlantParameters parameters = hand(lines(1000));
  parameters.axes[0].switches = {{kHmfl, 30, 50, true}, {kMlim, -20, 1000000, false}};
  Plant plant(parameters);
  PlantRig rig(plant);
  std::vector<std::pair<Tick, unsigned>> changes;
  unsigned last = 0;
  rig.on_edge = [&](Tick t) {
    const unsigned pins = rig.inputs[0].pins[0] & (1u << kHmfl | 1u << kMlim);
    if (pins != last) changes.emplace_back(t, pins);
    last = pins;
  };
  plant.axis(0).turn(100, 10000);
  rig.run(10000);
  EXPECT_EQ(changes, (std::vector<std::pair<Tick, unsigned>>{{3000, 1u << kHmfl}, {5000, 0}}));
  changes.clear();
  plant.axis(0).turn(-130, 13000);  // count 50 is left 5000 ticks later, one tick after the position reached exactly 50
  rig.run(13000);
  EXPECT_EQ(changes, (std::vector<std::pair<Tick, unsigned>>{{15001, 1u << kHmfl}, {17001, 0}, {22001, 1u << kMlim}}));
}

struct Glitch {
  Tick start, width;
  unsigned pin;
  bool operator==(const Glitch& o) const { return start == o.start && width == o.width && pin == o.pin; }
};

std::vector<Glitch> glitches(std::uint64_t seed, const NoiseParameters& noise, Tick ticks) {
  Plant plant(hand(lines(10), noise, seed));
  PlantRig rig(plant);
  std::vector<Glitch> found;
  unsigned last = 0;
  const unsigned rest = Encoder(lines(10)).pins(0);
  rig.on_edge = [&](Tick t) {
    const unsigned wrong = (rig.inputs[0].pins[0] ^ rest) & Encoder::kPins;
    if (wrong != 0 && last == 0) {
      unsigned pin = 0;
      while (wrong >> pin != 1) ++pin;
      found.push_back({t, 1, pin});
    } else if (wrong != 0) {
      EXPECT_EQ(wrong, last) << "one pin at a time";
      ++found.back().width;
    }
    last = wrong;
  };
  rig.run(ticks);
  return found;
}

TEST(LineNoise, StaysWithinItsLimits) {
  const NoiseParameters noise{1000, 3, 7, 1u << kEncA | 1u << kEncB};
  const std::vector<Glitch> found = glitches(5, noise, 1000000);
  // 1000 ticks and 5 of the disturbance itself on average: 995 of them, +- 5 standard deviations of 9.
  EXPECT_NEAR(static_cast<double>(found.size()), 995, 50);
  std::set<Tick> widths;
  std::set<unsigned> pins;
  for (std::size_t i = 0; i < found.size(); ++i) {
    widths.insert(found[i].width);
    pins.insert(found[i].pin);
    const Tick gap = i == 0 ? found[i].start : found[i].start - found[i - 1].start - found[i - 1].width;
    EXPECT_GE(gap, 500);
    EXPECT_LE(gap, 1502);
  }
  EXPECT_EQ(widths, (std::set<Tick>{3, 4, 5, 6, 7}));
  EXPECT_EQ(pins, (std::set<unsigned>{kEncA, kEncB}));
}

TEST(LineNoise, FollowsTheSeed) {
  const NoiseParameters noise{1000, 1, 100, 1u << kEncA};
  const auto first = glitches(1, noise, 100000);
  EXPECT_EQ(first, glitches(1, noise, 100000));
  const auto other = glitches(2, noise, 100000);
  EXPECT_FALSE(first == other);
}

TEST(Random, IsEvenAndCentred) {
  Random random(1, 2), same(1, 2), other_stream(1, 3);
  std::array<int, 3> hits{};
  int sum = 0, equal = 0;
  for (int i = 0; i < 30000; ++i) {
    const std::uint64_t x = random.below(3);
    ASSERT_LT(x, 3u);
    EXPECT_EQ(x, same.below(3));
    equal += x == other_stream.below(3);
    ++hits[x];
    const std::int64_t noise = random.noise(2);
    EXPECT_EQ(noise, same.noise(2));
    EXPECT_LE(std::abs(noise), 2);
    sum += static_cast<int>(noise);
  }
  // Standard deviations: sqrt(30000 x 2/9) = 82 and, of the difference of two numbers 0..2, sqrt(30000 x 4/3) = 200.
  for (int h : hits) EXPECT_NEAR(h, 10000, 5 * 82);
  EXPECT_NEAR(equal, 10000, 5 * 82);
  EXPECT_NEAR(sum, 0, 5 * 200);
}

}  // namespace
}  // namespace brick::plant
