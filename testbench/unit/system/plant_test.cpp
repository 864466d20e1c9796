// The controller with motors at its pins: host, firmware, bus, servo IC, plant, and back through the encoder. What the
// firmware reads in its registers must be what the plant did.
#include "testbench/plant/plant.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class PlantOnController : public Controller {
 protected:
  void start_with(const plant::PlantParameters& parameters) {
    start();
    plant_ = std::make_unique<plant::Plant>(parameters);
    machine().attach(*plant_);
  }
  void TearDown() override {
    if (plant_ != nullptr) machine().detach(*plant_);
  }
  plant::Plant& plant() { return *plant_; }
  int number(const std::string& command) { return std::stoi(ask(command)); }

 private:
  std::unique_ptr<plant::Plant> plant_;
};

plant::PlantParameters one_axis(plant::Drive drive) {
  plant::AxisParameters axis;
  axis.channel = 1;
  axis.drive = drive;
  plant::PlantParameters parameters;
  parameters.axes = {axis};
  return parameters;
}

// Channel 2: OUT C = $010000 is 38400 pulses a second, a step and a count each; decode x4, A leads.
TEST_P(PlantOnController, PulsesBecomeStepsAndCounts) {
  start_with(one_axis(plant::Drive::kStepper));
  ask("M201->Y:$07800C,0,24,S");
  ask("M202->X:$07800D,14");
  ask("M203->X:$078009,0,24,S");
  ask("I7020=3 I7026=2");
  const int before = number("M203");
  ask("M202=1 M201=65536");
  wait(ms_to_ticks(5));
  ask("M201=0");
  wait(ms_to_ticks(1));
  const std::int64_t steps = plant().axis(0).stepper().steps();
  EXPECT_GE(steps, 192);  // 5 ms, and what the second command takes on the bus
  EXPECT_LE(steps, 192 + 38 * 5);
  EXPECT_EQ(number("M203") - before, steps);
  EXPECT_EQ(plant().axis(0).counts(machine().now()), steps);
}

// What a peer is told of two servo ICs that it watches and of one that is not fitted.
class Listener : public MotorPeer {
 public:
  struct Call {
    Tick tick;
    unsigned ic;
    MotorOutputs before, after;
  };
  std::uint32_t ics() const override { return 1u << 0 | 1u << 1 | 1u << 5; }
  Tick next_event() const override { return kNever; }
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) override {
    calls.push_back({tick, ic, before, after});
  }
  bool step(Tick, MotorInputPins&) override { return false; }
  std::vector<Call> calls;
};

// Channel 2 is enabled, and AENA does not move again.
TEST_P(PlantOnController, AttachedLateKnowsTheOutputsAsTheyStand) {
  start();
  ask("M202->X:$07800D,14");
  ask("M202=1");
  wait(ms_to_ticks(1));
  Listener listener;
  machine().attach(listener);
  ASSERT_EQ(listener.calls.size(), 2u);
  for (unsigned ic = 0; ic < 2; ++ic) {
    const Listener::Call& call = listener.calls[ic];
    EXPECT_EQ(call.tick, machine().now());
    EXPECT_EQ(call.ic, ic);
    EXPECT_TRUE(call.before == call.after && call.after == machine().motor_outputs(ic));
    EXPECT_EQ(call.after.get(motor_pin::kAena, 1), ic == 0 ? 1u : 0u);
  }
  machine().detach(listener);

  plant::Plant late(one_axis(plant::Drive::kTorque));
  EXPECT_FALSE(late.axis(0).amplifier().on());
  machine().attach(late);
  EXPECT_TRUE(late.axis(0).amplifier().on());
  machine().detach(late);
}

// A current of 5 A by DAC A: ADC A must read $400000, the motor gain 5000 rad/s2.
TEST_P(PlantOnController, DacMovesTheMotorAndTheAdcReadsItsCurrent) {
  start_with(one_axis(plant::Drive::kTorque));
  ask("M201->Y:$07800A,0,24,S");
  ask("M202->X:$07800D,14");
  ask("M203->X:$078009,0,24,S");
  ask("M204->Y:$07800D,0,24,S");
  ask("I7020=3 I7026=1");
  ask("M201=$400000");
  const int before = number("M203");
  ask("M202=1");
  const Tick on = machine().now();
  wait(ms_to_ticks(4));
  EXPECT_EQ(plant().dac(0).volts(1), 5);
  EXPECT_EQ(number("M204"), 0x400000);
  EXPECT_NEAR(plant().axis(0).motor().speed(), 5000.0 * static_cast<double>(machine().now() - on) / kPwmClockHz,
              5000 * 0.0005);
  ask("M202=0 M201=0");
  wait(ms_to_ticks(1));
  const int counts = number("M203") - before;
  EXPECT_NEAR(counts, static_cast<double>(plant().axis(0).counts(machine().now())),
              4);  // it coasts on while the reply is made
  EXPECT_GT(counts, 20);
}

BRICK_ON_ENGINES(PlantOnController, Engine::kSystemC, at_night(Engine::kLockstep));

}  // namespace
}  // namespace brick
