// One axis at one channel of a servo IC: what drives it (DAC, PWM, PFM or a hand), the motor, the encoder, switches
// along the travel and noise on the wires. Between two calls of step() everything it shows is known in advance, so it
// is asked for at edges only.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "systemc/core/motor_pins.h"
#include "testbench/plant/amplifier.h"
#include "testbench/plant/brake.h"
#include "testbench/plant/encoder.h"
#include "testbench/plant/line_noise.h"
#include "testbench/plant/motor.h"
#include "testbench/plant/pwm_meter.h"
#include "testbench/plant/ssi_encoder.h"
#include "testbench/plant/stepper.h"
#include "testbench/plant/switches.h"

namespace brick::plant {

// kHand: turned by turn() only. kTorque: 10 V of DAC A are the full-scale current. kBrush: winding between PWM outputs
// A and B. kThreePhase: PWM A, B, C. kStepper: PFM.
enum class Drive { kHand, kTorque, kBrush, kThreePhase, kStepper };

struct AxisParameters {
  unsigned ic = 0, channel = 0;  // channel 0..3
  Drive drive = Drive::kHand;
  EncoderParameters encoder;
  MotorParameters motor;
  AmplifierParameters amplifier;
  StepperParameters stepper;
  BrakeParameters brake;
  std::vector<Switch> switches;
  NoiseParameters noise;
  // An absolute encoder on the same shaft, at the serial input of the axis's number (channels of servo ICs 0 and 1).
  // `absolute_turns` of its bits count revolutions.
  std::optional<SsiEncoderParameters> absolute;
  unsigned absolute_turns = 0;
  std::int64_t start = 0;  // counts, where it stands at power-on
  double load = 0;         // N m, as set_load()
};

class Axis {
 public:
  Axis(const AxisParameters& parameters, std::uint64_t seed, Tick step);

  unsigned ic() const { return par_.ic; }
  unsigned channel() const { return par_.channel; }
  std::uint16_t drives() const { return owned_; }  // input pins, bits as ChannelPin
  bool has_pwm() const { return par_.drive == Drive::kBrush || par_.drive == Drive::kThreePhase; }
  bool has_amplifier() const { return par_.drive != Drive::kHand; }
  bool has_adc() const { return has_motor() && par_.amplifier.adc; }
  const BrakeParameters& brake() const { return par_.brake; }
  bool has_brake_at(unsigned ic) const { return brake().torque > 0 && brake().ic == ic; }

  // The plant's side, as MotorPeer.
  MotorOutputs watched(bool digest) const;  // but for the converters, which axes share
  bool integrates(Tick now) const { return has_pwm() && now >= motion_.t1; }
  void begin_pwm(Tick tick, const PwmTimes& times) { meter_.begin(tick, times); }
  void add_pwm(Tick now, const PwmTimes& times) { meter_.add(now, times); }  // before such a step(), with a digest
  MotorOutputs stops() const;
  MotorOutputs watched_brake() const;  // at the brake's IC
  void changed_brake(Tick tick, const MotorOutputs& after);
  void changed(Tick tick, const MotorOutputs& before, const MotorOutputs& after, bool digest);
  bool step(Tick now, double dac_volts, MotorInputs& inputs);
  Tick next_event() const { return next_; }
  unsigned ssi_channel() const { return kChannels * par_.ic + par_.channel; }  // from 0
  const SsiEncoder* absolute() const { return absolute_ ? &*absolute_ : nullptr; }
  void ssi_clocked(Tick tick, bool level);
  bool ssi_level(Tick now) { return absolute_->level(now); }
  std::uint64_t absolute_position(Tick now) const;  // in steps of the absolute encoder, revolutions counted on
  std::uint32_t adc_word(bool b);                   // at the start of a conversion
  void command(std::uint32_t word) { amplifier_.command(par_.channel, word), wake(); }

  // For tests and benches, while the machine stands.
  void turn(std::int64_t counts, Tick duration);  // kHand: evenly, from the next edge on
  void cut(std::uint16_t wires) { encoder_.cut(wires), wake(); }
  void trip(Amplifier::Fault cause) { amplifier_.trip(cause), wake(); }
  void set_load(double torque) { motor_.set_load(torque); }
  // Of its pins, those of `pins` show `levels` whatever the axis does, all others what it does.
  void hold(std::uint16_t pins, std::uint16_t levels) { held_ = pins, held_levels_ = levels, wake(); }
  std::uint16_t held() const { return held_; }
  std::uint16_t held_levels() const { return held_levels_; }
  std::int64_t position(Tick now) const { return motion_.at(now); }  // units, kUnitsPerCount
  std::int64_t counts(Tick now) const { return detail::floor_div(position(now), kUnitsPerCount); }
  double velocity(Tick now) const;  // counts/s
  Drive drive() const { return par_.drive; }
  bool has_motor() const { return par_.drive != Drive::kHand && par_.drive != Drive::kStepper; }
  const Amplifier& amplifier() const { return amplifier_; }
  const Motor& motor() const { return motor_; }
  const Stepper& stepper() const { return stepper_; }

 private:
  void wake() { next_ = 0; }
  void move(Tick now, double dac_volts);
  void integrate(double dac_volts, const std::array<double, PwmMeter::kPhases>& phases);
  std::uint16_t pins(std::int64_t position) const;
  Tick next_pin_change(Tick t, std::uint16_t present) const;

  AxisParameters par_;
  Tick step_;
  std::uint16_t owned_;  // pins that it drives; the others of the channel belong to somebody else
  std::uint16_t held_ = 0, held_levels_ = 0;
  Encoder encoder_;
  std::optional<SsiEncoder> absolute_;
  Switches switches_;
  std::vector<PositionGrid> grids_;
  LineNoise noise_;
  Random adc_random_;
  Motor motor_;
  Amplifier amplifier_;
  Stepper stepper_;
  Brake brake_;
  PwmMeter meter_;
  Motion motion_;
  std::int64_t goal_ = 0;  // of turn()
  Tick duration_ = 0;      // of a turn that has not begun yet
  bool started_ = false;
  Tick next_ = 0;
};

}  // namespace brick::plant
