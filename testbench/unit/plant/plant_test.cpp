// The plant as a peer: equal seeds give equal runs, however often it is asked; it keeps to its own pins.
#include "testbench/unit/plant/ic_rig.h"

namespace brick::plant {
namespace {

PlantParameters everything(std::uint64_t seed) {
  AxisParameters brush, stepper, hand;
  brush.drive = Drive::kBrush;
  brush.motor.inertia = 1e-6;
  brush.amplifier.adc_noise = 20;
  brush.noise = {3000, 1, 40, 1u << kEncA | 1u << kEncC};
  stepper.channel = 1;
  stepper.drive = Drive::kStepper;
  stepper.stepper.units_per_step = 5 * kUnitsPerCount / 3;
  stepper.encoder.b_late = -9999;
  hand.channel = 3;
  hand.encoder.pole_pairs = 7;
  hand.encoder.wiring = EncoderParameters::Wiring::kHalls;
  hand.switches = {{kHmfl, 10, 20, true}};
  PlantParameters plant;
  plant.seed = seed;
  plant.axes = {brush, stepper, hand};
  return plant;
}

// Every edge's inputs, in one number.
struct Outcome {
  std::uint64_t hash = 0xCBF29CE484222325;
  std::int64_t position = 0;
  std::uint32_t adc = 0;
};

Outcome run(std::uint64_t seed, bool eager) {
  Plant plant(everything(seed));
  IcRig rig(plant);
  Outcome outcome;
  rig.eager = eager;
  rig.on_edge = [&](Tick) {
    for (const std::uint64_t word :
         {rig.inputs[0].pins[0], rig.inputs[0].pins[1], rig.inputs[0].pins[2], rig.inputs[0].pins[3],
          static_cast<std::uint16_t>(rig.inputs[0].adc_a), static_cast<std::uint16_t>(rig.inputs[0].adc_b)})
      outcome.hash = (outcome.hash ^ word) * 0x100000001B3;
  };
  using namespace servo_channel;
  rig.write(0, kControl, 3u | control::kAena.mask());
  rig.write(1, kControl, 3u | control::kAena.mask() | control::kCPfm.mask());
  rig.write(0, kOutA, 400u << 8);
  rig.write(1, kOutC, 0x013579);
  plant.axis(2).turn(300, 50000);
  rig.run(100000);
  plant.axis(2).turn(-320, 33333);
  rig.run(50000);
  outcome.position = plant.axis(0).position(rig.now());
  outcome.adc = rig.read(0, kAdcA);
  return outcome;
}

TEST(Plant, RepeatsARunWithTheSameSeed) {
  const Outcome first = run(1, false), again = run(1, false), other = run(2, false);
  EXPECT_EQ(first.hash, again.hash);
  EXPECT_EQ(first.position, again.position);
  EXPECT_EQ(first.adc, again.adc);
  EXPECT_NE(first.hash, other.hash);
  EXPECT_EQ(first.position, other.position) << "noise on the wires does not move the motor";
  EXPECT_NE(first.position, 0);
  EXPECT_NE(first.adc, other.adc);
}

TEST(Plant, GivesEachAxisNoiseOfItsOwn) {
  PlantParameters parameters;
  parameters.axes.resize(2);
  for (unsigned n = 0; n < 2; ++n) {
    parameters.axes[n].channel = n;
    parameters.axes[n].drive = Drive::kTorque;
    parameters.axes[n].amplifier.adc_noise = 20;
  }
  Plant plant(parameters), same(parameters);
  int equal = 0;
  for (int i = 0; i < 200; ++i) {
    const std::uint32_t word = plant.axis(0).adc_word(false);
    EXPECT_EQ(word, same.axis(0).adc_word(false));
    equal += word == plant.axis(1).adc_word(false);
  }
  EXPECT_LT(equal, 30);  // about one in 31: two triangles of +- 20 meet with the likelihood 2/3 / 21 = 0.032
}

TEST(Plant, ShowsTheSameWhenAskedAtEveryTick) {
  const Outcome asked_rarely = run(1, false), asked_always = run(1, true);
  EXPECT_EQ(asked_rarely.hash, asked_always.hash);
  EXPECT_EQ(asked_rarely.position, asked_always.position);
}

TEST(Plant, SaysWhatItNeedsToSee) {
  PlantParameters parameters = everything(1);
  parameters.axes[2].ic = 11;
  Plant plant(parameters);
  EXPECT_EQ(plant.ics(), 1u) << "an axis turned by hand sees nothing";
  const MotorOutputs stops = plant.stops(0);
  EXPECT_EQ(stops.w[0], 1u << 25) << "PULSE of channel 2";
  EXPECT_EQ(stops.w[1], 3u << 18) << "ADC clock and strobe";
  EXPECT_EQ(plant.stops(11), MotorOutputs{});
  EXPECT_EQ(plant.stops(1), MotorOutputs{});
}

TEST(Plant, LeavesPinsOfOthersAlone) {
  Plant plant(everything(1));
  MotorInputPins inputs;
  for (MotorInputs& in : inputs) {
    in.pins = {0, 0, 0, 0};
    in.adc_a = in.adc_b = 0xF;
  }
  MotorInputPins expected = inputs;
  const unsigned idle = 1u << kT | 1u << kU | 1u << kV | 1u << kW;
  expected[0].pins = {static_cast<std::uint16_t>(idle), static_cast<std::uint16_t>(idle), 0, 1u << kT | 1u << kW};
  expected[0].adc_a = expected[0].adc_b = 0xE;
  EXPECT_TRUE(plant.step(0, inputs));
  EXPECT_EQ(inputs[0].pins, expected[0].pins);
  EXPECT_TRUE(inputs == expected);
  // The other extreme: what it owns goes to its level, the rest stays high.
  for (MotorInputs& in : inputs) in.pins = {0xFFF, 0xFFF, 0xFFF, 0xFFF};
  Plant other(everything(1));
  EXPECT_TRUE(other.step(0, inputs));
  const unsigned others = 1u << kHmfl | 1u << kPlim | 1u << kMlim | 1u << kUser;
  EXPECT_EQ(inputs[0].pins[0], idle | others);
  EXPECT_EQ(inputs[0].pins[2], 0xFFF);
  EXPECT_EQ(inputs[0].pins[3], 1u << kT | 1u << kW | (others & ~(1u << kHmfl)) | 1u << kFault)
      << "a hand has no amplifier";
}

TEST(Plant, RejectsTwoAxesAtOneChannel) {
  PlantParameters parameters = everything(1);
  parameters.axes[2].channel = 1;
  EXPECT_THROW(Plant{parameters}, std::invalid_argument);
  parameters.axes[2].channel = 4;
  EXPECT_THROW(Plant{parameters}, std::invalid_argument);
  parameters.axes[2].channel = 3;
  parameters.axes[2].switches[0].pin = kEncC;
  EXPECT_THROW(Plant{parameters}, std::invalid_argument);
  parameters.axes[2].switches.clear();
  parameters.axes[2].noise = {100, 1, 1, 1u << kPlim};
  EXPECT_THROW(Plant{parameters}, std::invalid_argument);
}

}  // namespace
}  // namespace brick::plant
