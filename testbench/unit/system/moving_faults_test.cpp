// Eight motors at work, and what takes them away: reset commands, SAVE, lost clocks, the watchdog, ^K. Judged at the
// amplifier enable pins, the DACs and the motors themselves, by the times of motion:6.6.
#include <fstream>

#include "testbench/plant/plant.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr unsigned kMotors = 8;
constexpr double kServoMs = 3713991.0 / 8388608;

double ms(Tick ticks) { return static_cast<double>(ticks) * 1000 / kPwmClockHz; }

// Falls of the amplifier enables.
class Enables : public MotorPeer {
 public:
  std::uint32_t ics() const override { return 3; }
  Tick next_event() const override { return kNever; }
  bool step(Tick, MotorInputPins&) override { return false; }
  void changed(Tick tick, unsigned ic, const MotorOutputs&, const MotorOutputs& after) override {
    for (unsigned n = 0; n < kChannels; ++n) {
      const bool on = after.get(motor_pin::kAena, n) != 0;
      const unsigned motor = 4 * ic + n;
      if (on_.at(motor) && !on) fell_.at(motor) = tick;
      on_.at(motor) = on;
    }
  }
  bool on(unsigned motor) const { return on_.at(motor - 1); }
  Tick fell(unsigned motor) const { return fell_.at(motor - 1); }

 private:
  std::array<bool, kMotors> on_{};
  std::array<Tick, kMotors> fell_{};
};

class MovingFaults : public Controller {
 protected:
  void begin(const std::vector<plant::Incident>& incidents = {}) {
    start();
    plant::PlantParameters parameters;
    parameters.incidents = incidents;
    for (unsigned motor = 0; motor < kMotors; ++motor) {
      plant::AxisParameters axis;
      axis.ic = motor / 4;
      axis.channel = motor % 4;
      axis.drive = plant::Drive::kTorque;
      axis.motor.inertia = 1e-5;
      axis.motor.viscous = 1e-4;
      axis.motor.coulomb = 5e-4;
      axis.amplifier.full_scale_amps = 10;
      parameters.axes.push_back(axis);
    }
    plant_ = std::make_unique<plant::Plant>(parameters);
    machine().attach(*plant_);
    machine().attach(enables_);
    std::ifstream file("examples/setups/dac8.pmc");
    std::string line;
    unsigned lines = 0;
    while (std::getline(file, line)) {
      if (line.empty() || line[0] == ';') continue;
      ASSERT_EQ(ask(line), "") << line;
      ++lines;
    }
    ASSERT_GE(lines, 30u);
    std::string jogs;
    for (unsigned motor = 1; motor <= kMotors; ++motor) jogs += "#" + std::to_string(motor) + "J/";
    ASSERT_EQ(ask(jogs), "");
    wait(ms_to_ticks(20));
  }
  void end() {
    if (plant_ == nullptr) return;
    machine().detach(*plant_);
    machine().detach(enables_);
    enables_ = {};
    plant_.reset();
  }
  void TearDown() override {
    end();
    Controller::TearDown();
  }
  void jog() {
    ASSERT_EQ(ask("#1J+#2J-#3J+#4J-#5J+#6J-#7J+#8J-"), "");
    wait(ms_to_ticks(80));
    for (unsigned motor = 1; motor <= kMotors; ++motor) {
      ASSERT_NEAR(std::abs(speed(motor)), 32, 1) << motor;
      ASSERT_TRUE(enables_.on(motor));
    }
  }
  // Counts a ms.
  double speed(unsigned motor) { return plant_->axis(motor - 1).velocity(machine().now()) / 1000; }
  double volts(unsigned motor) { return plant_->dac((motor - 1) / 4).volts((motor - 1) % 4); }
  bool all_off() {
    for (unsigned motor = 1; motor <= kMotors; ++motor)
      if (enables_.on(motor)) return false;
    return true;
  }
  bool all_zero() {
    for (unsigned motor = 1; motor <= kMotors; ++motor)
      if (volts(motor) != 0) return false;
    return true;
  }
  // Whether all enables and then all DACs are away within so many ms of `since`, never to come back.
  void expect_away(Tick since, double enables_within, double volts_within) {
    Tick zero = 0;
    while (ms(machine().now() - since) < volts_within + 30) {
      wait(ns_to_ticks(50'000));
      if (!all_zero()) zero = 0;
      if (all_zero() && zero == 0) zero = machine().now();
    }
    EXPECT_TRUE(all_off());
    EXPECT_TRUE(all_zero());
    for (unsigned motor = 1; motor <= kMotors; ++motor) {
      EXPECT_GE(enables_.fell(motor), since) << motor;
      EXPECT_LE(ms(enables_.fell(motor) - since), enables_within) << motor;
    }
    EXPECT_LE(ms(zero - since), volts_within + 0.05);
  }

  Enables enables_;
  std::unique_ptr<plant::Plant> plant_;
};

// The decision is the command's execution, some characters and a background pass after its last one.
TEST_P(MovingFaults, ResetCommandsTakeMotorsAway) {
  for (const char* command : {"$$$", "$$$***"}) {
    SCOPED_TRACE(command);
    begin();
    jog();
    const Tick sent = machine().now();
    ASSERT_TRUE(link().send(command));
    expect_away(sent, 2 + kServoMs, 2 + 2 * kServoMs);
    ASSERT_TRUE(link().connect(ms_to_ticks(200)));
    EXPECT_TRUE(all_off());
    // Off, and by default motor 1 is activated. `$$$***` leaves it axis X of &1 (firmware:5.10/2), `$$$` none.
    EXPECT_EQ(ask("#1?"), std::string(command) == "$$$" ? "850000000000" : "850000078000");
    end();
  }
}

TEST_P(MovingFaults, KillAllTakesThemAway) {
  begin();
  jog();
  const Tick sent = machine().now();
  link().send(std::string(1, '\x0B'));
  expect_away(sent, 2, 2 + kServoMs);
  EXPECT_EQ(ask("#1?").substr(0, 6), "850000") << "Ixx34; killed";
}

// PLCs of both kinds, and a host that asks and reads without a pause; the fault comes anywhere in that.
TEST_P(MovingFaults, AFaultIsActedOnUnderLoad) {
  plant::Incident fault;
  fault.at = ms_to_ticks(451);
  fault.axis = 4;
  fault.trip = plant::Amplifier::Fault::kOverTemperature;
  begin({fault});
  for (const char* line : {"OPEN PLC 0 CLEAR", "P1=P1+1 P2=P1*3", "CLOSE", "OPEN PLC 5 CLEAR",
                           "P3=0 WHILE(P3<200) P3=P3+1 P4=SQRT(P3)/3 ENDW", "CLOSE", "I5=3 ENABLE PLC 0,5"})
    ASSERT_EQ(ask(line), "") << line;
  jog();
  ASSERT_LT(machine().now(), fault.at);
  unsigned asked = 0;
  while (machine().now() < fault.at + ms_to_ticks(25)) asked += ask("P0..150 I100..199").size() > 200;
  EXPECT_GT(asked, 3u);
  for (unsigned motor = 1; motor <= kMotors; ++motor) {
    EXPECT_GE(enables_.fell(motor), fault.at);
    EXPECT_LE(ms(enables_.fell(motor) - fault.at), 20) << motor;
  }
}

// A phase of 43 PWM clocks, 28 CPU cycles: not even the real-time task has time any more, and 25 ms behind the last
// strobe the circuit takes all outputs away. Nothing loads the CPU before: the command itself needs time.
TEST_P(MovingFaults, TheWatchdogTakesThemAway) {
  begin();
  jog();
  const Tick sent = machine().now();
  ASSERT_TRUE(link().send("I7000=20"));
  expect_away(sent, 25 + 2, 27 + 2);
  EXPECT_EQ(machine().outputs().get(pin::kWdTripped), 1u);
}

// Lines of the interrupt controller that hosts wait for: in position, following error of a motor of the system.
TEST_P(MovingFaults, SignalsOfMotorsAreAtThePins) {
  begin();
  const auto pins = [this] {
    const BoardOutputs& out = machine().outputs();
    return std::to_string(out.get(pin::kIpos)) + std::to_string(out.get(pin::kF1er)) +
           std::to_string(out.get(pin::kEror));
  };
  EXPECT_EQ(pins(), "100");
  jog();
  EXPECT_EQ(pins(), "000");
  constexpr std::uint16_t kQuadrature = 1u << kEncA | 1u << kEncB;
  plant_->axis(0).cut(kQuadrature);
  wait(ms_to_ticks(40));  // 32 counts/ms: beyond 1000 counts, not yet 2000
  EXPECT_EQ(pins(), "010");
  wait(ms_to_ticks(40));
  EXPECT_EQ(pins(), "011") << "tripped, and the warning stands with that";
  EXPECT_TRUE(all_off());
}

// Loops go on; what is to be found is found when it is over.
TEST_P(MovingFaults, SaveMovesOnAndChecksStand) {
  begin();
  jog();
  ASSERT_TRUE(link().send("SAVE"));
  wait(ms_to_ticks(15));
  for (unsigned motor = 1; motor <= kMotors; ++motor) EXPECT_NEAR(std::abs(speed(motor)), 32, 1) << motor;
  plant_->axis(2).trip(plant::Amplifier::Fault::kOverTemperature);  // motor 3, seen by nobody
  wait(ms_to_ticks(15));
  EXPECT_TRUE(enables_.on(3));
  EXPECT_NEAR(std::abs(speed(1)), 32, 1);
  const Tick still = machine().now();
  ASSERT_TRUE(link().finish(HostLink::kSaveTime).complete);
  const Tick done = machine().now();
  EXPECT_GT(done - still, ms_to_ticks(5)) << "it was not over when the fault came";
  expect_away(still, ms(done - still) + 2, ms(done - still) + 2 + 2 * kServoMs);
  EXPECT_EQ(std::stoul(ask("#3?").substr(6), nullptr, 16) & 8u, 8u) << "amplifier fault";
}

// The source of the clocks is told to take them from outside, where there are none.
TEST_P(MovingFaults, WithoutClocksNothingIsCommanded) {
  begin();
  jog();
  const Tick sent = machine().now();
  link().send("I7007=3");
  expect_away(sent, 25 + 1, 27 + 1);
}

BRICK_ON_ENGINES(MovingFaults, Engine::kSystemC);

}  // namespace
}  // namespace brick
