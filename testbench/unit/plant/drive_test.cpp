// Plant and servo IC together: what is written to the IC's registers moves the motor, and its counters and words show
// it.
#include "testbench/unit/plant/ic_rig.h"

namespace brick::plant {
namespace {

// Control word: x4 decode, AENA; A and B as DACs; C as PFM.
using namespace servo_channel;
constexpr std::uint32_t kX4 = 3, kAena = control::kAena.mask(), kDacMode = control::kAbDac.mask(),
                        kPfmMode = control::kCPfm.mask(), kInvertAb = control::kAbInvert.mask();

PlantParameters one_axis(Drive drive, unsigned channel = 0) {
  AxisParameters axis;
  axis.channel = channel;
  axis.drive = drive;
  PlantParameters plant;
  plant.axes = {axis};
  return plant;
}

// $010000 is a pulse every 256 PFM_CLK = 3072 ticks. A step is one count here; the counter must follow each.
TEST(PlantAtIc, StepperTurnsPfmPulsesIntoCounts) {
  Plant plant(one_axis(Drive::kStepper, 1));
  IcRig rig(plant);
  int pulses = 0;
  bool last = false;
  rig.on_edge = [&](Tick) {
    const bool pulse = rig.outputs().get(motor_pin::kPfmPulse, 1) != 0;
    pulses += pulse && !last;
    last = pulse;
  };
  rig.write(1, kControl, kX4 | kPfmMode);
  rig.write(1, kOutC, 0x010000);
  rig.run(2 * 3072);
  EXPECT_EQ(pulses, 2);
  EXPECT_EQ(plant.axis(0).stepper().steps(), 0) << "AENA is off";
  rig.write(1, kControl, kX4 | kPfmMode | kAena);
  rig.run(100 * 3072);
  rig.write(1, kOutC, 0);
  rig.run(2 * IcRig::kPhase);
  EXPECT_EQ(pulses, 102);
  EXPECT_EQ(plant.axis(0).stepper().steps(), 100);
  EXPECT_EQ(rig.counter(1), 100);
  EXPECT_EQ(plant.axis(0).counts(rig.now()), 100);

  rig.write(1, kOutC, 0xFE0000);  // twice as fast, down
  rig.run(150 * 1536);
  rig.write(1, kOutC, 0);
  rig.run(2 * IcRig::kPhase);
  EXPECT_NEAR(rig.counter(1), -50, 1);  // where in its period the first pulse falls is the accumulator's business
  EXPECT_EQ(rig.counter(1), plant.axis(0).stepper().steps());
  EXPECT_FALSE(rig.status(1, status::kEncoderError));
}

// 0.5 N m of gravity on 1e-4 kg m2: 5000 rad/s2 once the brake has let go, 10 ms after AENA of channel 2 has risen; it
// grips 10 ms after the fall. The amplifier of the axis itself is off.
TEST(PlantAtIc, BrakeFollowsAnOutput) {
  constexpr Tick kMs = kPwmClockHz / 1000;
  PlantParameters parameters = one_axis(Drive::kTorque);
  parameters.axes[0].load = -0.5;
  parameters.axes[0].brake = {2.0, 0, 2, 10 * kMs};
  Plant plant(parameters);
  IcRig rig(plant);
  rig.write(1, kControl, kX4 | kAena);
  rig.run(20 * kMs);
  EXPECT_EQ(plant.axis(0).counts(rig.now()), 0) << "that is another channel";
  rig.write(2, kControl, kX4 | kAena);
  rig.run(9 * kMs);
  EXPECT_EQ(plant.axis(0).motor().speed(), 0) << "not yet";
  rig.run(11 * kMs);
  EXPECT_NEAR(plant.axis(0).motor().speed(), 50, 0.2);
  rig.write(2, kControl, kX4);
  rig.run(9 * kMs);
  EXPECT_NEAR(plant.axis(0).motor().speed(), 95, 0.2) << "it has not gripped yet";
  rig.run(8 * kMs);
  EXPECT_EQ(plant.axis(0).motor().speed(), 0) << "100 rad/s at (2 - 0.5) N m are 6.7 ms";
}

// OUT A = $400000 is 5 V, half of full scale: 5 A x 0.1 N m/A on 1e-4 kg m2 = 5000 rad/s2. 10 ms: 50 rad/s, 0.25 rad =
// 159 counts of 4000 a turn.
TEST(PlantAtIc, DacTorqueAcceleratesTheMotor) {
  Plant plant(one_axis(Drive::kTorque));
  IcRig rig(plant);
  rig.write(0, kControl, kX4 | kDacMode);
  rig.write(0, kOutA, 0x400000);
  rig.run(2 * IcRig::kPhase);
  EXPECT_EQ(plant.dac(0).volts(0), 5);
  EXPECT_EQ(plant.axis(0).motor().speed(), 0) << "AENA is off";
  rig.write(0, kControl, kX4 | kDacMode | kAena);
  rig.run(1024 * 1152);
  EXPECT_NEAR(plant.axis(0).motor().speed(), 50, 0.06);  // one step more or less
  EXPECT_NEAR(static_cast<double>(plant.axis(0).counts(rig.now())), 0.25 * 4000 / 6.283185, 1);
  EXPECT_EQ(rig.read(0, kAdcA), 0x400000u);  // ADC A: 5 A of 10
  EXPECT_EQ(rig.read(0, kAdcB), 0xC00000u);  // what goes in at A comes out at B

  rig.write(0, kControl, kX4 | kDacMode);
  rig.run(4 * IcRig::kPhase);
  EXPECT_EQ(rig.read(0, kAdcA), 0u);
  const double speed = plant.axis(0).motor().speed();
  EXPECT_GT(speed, 49.9);
  rig.run(1024 * 1152);
  EXPECT_EQ(plant.axis(0).motor().speed(), speed) << "it coasts without friction";
  EXPECT_NEAR(rig.counter(0), static_cast<double>(plant.axis(0).counts(rig.now())),
              2);  // latched up to a phase ago: 0.8 counts
}

// Commands +300 and -300: 4 x 300 / (4 x 1500 + 6) of half the bus each, so 48 V x 1200/6006 = 9.59 V between A and B,
// and without load 95.9 rad/s. Both time constants (L/R and J R/k2) are 0.1 ms, 40 of them pass before the measurement.
TEST(PlantAtIc, PwmRunsABrushMotor) {
  PlantParameters parameters = one_axis(Drive::kBrush);
  parameters.axes[0].motor.inertia = 1e-6;
  parameters.axes[0].motor.inductance = 1e-4;
  Plant plant(parameters);
  IcRig rig(plant);
  rig.write(0, kOutA, 300u << 8);
  rig.write(0, kOutB, (0x10000u - 300) << 8);
  rig.write(0, kControl, kX4 | kAena);
  rig.run(472000);
  const std::int64_t from = plant.axis(0).position(rig.now());
  const Tick begin = rig.now();
  rig.run(96 * 6006);  // 96 PWM periods of 6006 ticks are 500.5 steps
  const double seconds = static_cast<double>(rig.now() - begin) / kPwmClockHz;
  const double turns = static_cast<double>(plant.axis(0).position(rig.now()) - from) / kUnitsPerCount / 4000;
  EXPECT_NEAR(turns * 6.283185307 / seconds, 48 * 1200.0 / 6006 / 0.1, 1.0);
  EXPECT_NEAR(rig.counter(0), static_cast<double>(plant.axis(0).counts(rig.now())), 3);  // 1.6 counts a phase
  EXPECT_FALSE(rig.status(0, status::kEncoderError));
}

// Commands -300, 600, -300 are a vector along B: 48/2 V x 4 x 600 / 6006 = 9.59 V, on 1 ohm 9.59 A. The rotor comes to
// rest a third of an electrical turn from A, 4000/12 = 333.3 counts, with -4.795 A in A and 9.59 A in B. Their ripple
// at most: 24 V for half a PWM period, 25 us, on 1 mH, 0.3 A either way.
TEST(PlantAtIc, PwmHoldsAThreePhaseRotor) {
  PlantParameters parameters = one_axis(Drive::kThreePhase);
  parameters.axes[0].motor.inertia = 1e-6;
  parameters.axes[0].motor.viscous = 1e-3;
  parameters.axes[0].motor.torque_constant = 0.05;
  Plant plant(parameters);
  IcRig rig(plant);
  rig.write(0, kOutA, (0x10000u - 300) << 8);
  rig.write(0, kOutB, 600u << 8);
  rig.write(0, kOutC, (0x10000u - 300) << 8);
  rig.write(0, kControl, kX4 | kAena);
  rig.run(1800000);
  EXPECT_NEAR(rig.counter(0), 4000.0 / 12, 1.5);
  EXPECT_NEAR(static_cast<std::int32_t>(rig.read(0, kAdcA) << 8) / 256.0 / 8388608.0 * 10, -4.795, 0.3);
  EXPECT_NEAR(static_cast<std::int32_t>(rig.read(0, kAdcB) << 8) / 256.0 / 8388608.0 * 10, 9.59, 0.3);
}

// 24 bits at 39.3216 MHz / 2^n fit into half a phase period of 3003 ticks up to n = 4.
TEST(PlantAtIc, ConvertersWorkAtEveryBitRate) {
  for (unsigned n = 0; n <= 4; ++n) {
    PlantParameters parameters = one_axis(Drive::kTorque, n % 4);
    parameters.axes[0].motor.inertia = 1000;
    Plant plant(parameters);
    IcRig rig(plant);
    rig.write(0, servo_ic::kClockControl, n << 9 | n << 6 | 0x12);
    rig.write(n % 4, kControl, kDacMode | kAena);
    rig.write(n % 4, kOutA, 0x345000);
    rig.run(8 * IcRig::kPhase);
    EXPECT_EQ(plant.dac(0).value(n % 4), 0x345000 >> 6) << n;
    EXPECT_EQ(rig.read(n % 4, kAdcA), 0x345000u) << n;  // full scale of both is the same; the low ten bits are 0
    EXPECT_EQ(plant.adc(0).command(), 0xFFFFFEu) << n;
  }
}

TEST(PlantAtIc, WrongPolarityShortsTheBus) {
  PlantParameters parameters = one_axis(Drive::kThreePhase);
  Plant plant(parameters);
  IcRig rig(plant);
  rig.write(0, servo_ic::kPwmControl, IcRig::kMaxCount << 8 | 15);  // dead time
  rig.write(0, kControl, kX4 | kAena);
  rig.run(8000);
  EXPECT_EQ(plant.axis(0).amplifier().fault(), Amplifier::Fault::kNone);
  EXPECT_FALSE(rig.status(0, status::kFault));
  rig.write(0, kControl, kX4 | kAena | kInvertAb);  // the dead time is an overlap now
  rig.run(8000);
  EXPECT_EQ(plant.axis(0).amplifier().fault(), Amplifier::Fault::kShortedBus);
  EXPECT_TRUE(rig.status(0, status::kFault));
}

// 48 V and no load on 1 ohm: beyond 20 A the stage trips, says so on FAULT and in ADC A, and is cleared through the
// strobe word.
TEST(PlantAtIc, OverCurrentTripsAndIsCleared) {
  PlantParameters parameters = one_axis(Drive::kBrush, 2);
  parameters.axes[0].motor.coulomb = 10;
  Plant plant(parameters);
  IcRig rig(plant);
  rig.write(2, kOutA, 1501u << 8);  // all of the bus
  rig.write(2, kOutB, (0x10000u - 1502) << 8);
  rig.write(2, kControl, kX4 | kAena);
  rig.run(100000);
  EXPECT_TRUE(rig.status(2, status::kFault));
  EXPECT_EQ(rig.read(2, kAdcA) >> 6, 1u) << "no current, cause 1";
  rig.write(0, servo_ic::kAdcStrobe, 0xF9CDFE);  // another axis
  rig.run(3 * IcRig::kPhase);
  EXPECT_TRUE(rig.status(2, status::kFault));
  rig.write(2, kOutA, 0);
  rig.write(2, kOutB, 0);
  rig.write(0, servo_ic::kAdcStrobe, 0xFACDFE);
  rig.run(3 * IcRig::kPhase);
  EXPECT_FALSE(rig.status(2, status::kFault));
  EXPECT_TRUE(plant.axis(0).amplifier().on());
}

// The index of 20-line encoder begins at count 42; the trigger latches the counter there, two turns in a row.
TEST(PlantAtIc, IndexIsCapturedAtItsCount) {
  PlantParameters parameters = one_axis(Drive::kHand);
  parameters.axes[0].encoder.lines = 20;
  parameters.axes[0].encoder.index_at = 42;
  Plant plant(parameters);
  IcRig rig(plant);
  rig.write(0, kControl, kX4 | control::kCaptureSource.set(0, 1) | control::kGatedIndex.mask());
  plant.axis(0).turn(60, 60 * 400);
  rig.run(60 * 400 + 100);
  EXPECT_TRUE(rig.status(0, status::kCaptured));
  EXPECT_EQ(rig.read(0, kFlagPosition), 42u);
  plant.axis(0).turn(80, 80 * 400);
  rig.run(80 * 400 + 2 * IcRig::kPhase);
  EXPECT_EQ(rig.read(0, kFlagPosition), 42u) << "one shot";
  EXPECT_EQ(rig.counter(0), 140);
}

TEST(PlantAtIc, FaultyDiscAndCutWiresAreFound) {
  PlantParameters parameters = one_axis(Drive::kHand, 3);
  parameters.axes[0].encoder.lines = 20;
  parameters.axes[0].encoder.joint_lines = {7};
  parameters.axes[0].encoder.wiring = EncoderParameters::Wiring::kComplements;
  Plant plant(parameters);
  IcRig rig(plant);
  rig.write(3, kControl, kX4);
  rig.write(3, kStatus, 0);  // nothing was wired at reset
  plant.axis(0).turn(28, 28 * 400);
  rig.run(28 * 400 + 100);
  EXPECT_FALSE(rig.status(3, status::kEncoderError));
  EXPECT_FALSE(rig.status(3, status::kEncoderLoss));
  plant.axis(0).turn(4, 4 * 400);
  rig.run(4 * 400 + 2 * IcRig::kPhase);
  EXPECT_TRUE(rig.status(3, status::kEncoderError));
  EXPECT_FALSE(rig.status(3, status::kEncoderLoss));
  EXPECT_EQ(rig.counter(3), 32 - 2);
  plant.axis(0).cut(1u << kW);  // B is low at count 32: V = 0, W stays pulled up
  rig.run(100);
  EXPECT_FALSE(rig.status(3, status::kEncoderLoss));
  plant.axis(0).turn(2, 2 * 400);  // B high
  rig.run(2 * 400 + 100);
  EXPECT_TRUE(rig.status(3, status::kEncoderLoss));
}

// Pulse and direction: each disturbance of A that passes the filter counts, down because B is low. Shorter than SCLK
// (12 ticks): none; from two SCLK periods on: all. Looked at whenever PHASE has latched another count; one disturbance
// may be under way then.
TEST(PlantAtIc, FilterPassesNoiseByItsLength) {
  for (const bool passes : {false, true}) {
    PlantParameters parameters = one_axis(Drive::kHand);
    parameters.axes[0].noise = {600, passes ? 24 : 1, passes ? 60 : 11, 1u << kEncA};
    Plant plant(parameters);
    IcRig rig(plant);
    int begun = 0, latches = 0;
    Tick quiet_since = 0;
    bool last = true;
    int counter = 0;
    bool counting = false;
    rig.on_edge = [&](Tick t) {
      const bool a = (rig.inputs[0].pins[0] & 1) != 0;
      begun += a && !last;
      if (a) quiet_since = t;
      last = a;
      if (!counting || rig.counter(0) == counter) return;
      counter = rig.counter(0);
      ++latches;
      EXPECT_LE(-counter, begun);
      EXPECT_GE(-counter, begun - 1);
    };
    rig.write(0, kControl, control::kCounterReset.mask());  // holds the counter at 0
    rig.run(2 * IcRig::kPhase);
    while (rig.now() < quiet_since + 100) rig.run(1);
    rig.write(0, kControl, 0);
    begun = 0;
    counting = true;
    rig.run(300000);
    EXPECT_GT(begun, 400);
    if (passes)
      EXPECT_GT(latches, 90);
    else
      EXPECT_EQ(rig.counter(0), 0);
  }
}

}  // namespace
}  // namespace brick::plant
