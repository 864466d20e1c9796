#include "testbench/plant/axis.h"

#include <algorithm>
#include <stdexcept>

namespace brick::plant {

Axis::Axis(const AxisParameters& parameters, std::uint64_t seed, Tick step)
    : par_(parameters),
      step_(step),
      owned_(Encoder::kPins),
      encoder_(parameters.encoder),
      switches_(parameters.switches),
      grids_(encoder_.grids()),
      noise_(parameters.noise, Random(seed, 2 * (kChannels * parameters.ic + parameters.channel))),
      adc_random_(seed, 2 * (kChannels * parameters.ic + parameters.channel) + 1),
      motor_(parameters.motor, encoder_.units_per_revolution(), parameters.start * kUnitsPerCount),
      amplifier_(parameters.amplifier),
      stepper_(parameters.stepper, parameters.start * kUnitsPerCount),
      brake_(parameters.brake),
      motion_{0, 1, parameters.start * kUnitsPerCount, parameters.start * kUnitsPerCount},
      goal_(parameters.start * kUnitsPerCount) {
  if (par_.ic >= kMaxServoIcs || par_.channel >= kChannels) throw std::invalid_argument("axis: no such channel");
  if (step_ < 1 || par_.stepper.move_time < 1) throw std::invalid_argument("axis: a time below one tick");
  if ((switches_.mask() & owned_) != 0) throw std::invalid_argument("axis: a switch on a pin of the encoder");
  owned_ = static_cast<std::uint16_t>(owned_ | switches_.mask() | (has_amplifier() ? 1u << kFault : 0));
  if (par_.noise.every != 0 && (par_.noise.pins & ~unsigned{owned_}) != 0)
    throw std::invalid_argument("axis: noise on a pin of others");
  if (par_.absolute) {
    if (par_.ic > 1) throw std::invalid_argument("axis: no serial input for an absolute encoder");
    absolute_.emplace(*par_.absolute, seed, 2 * kChannels * kMaxServoIcs + ssi_channel());
  }
  if (par_.brake.torque > 0 && !has_motor()) throw std::invalid_argument("axis: a brake without a motor");
  motor_.set_load(par_.load);
  grids_.insert(grids_.end(), switches_.grids().begin(), switches_.grids().end());
}

MotorOutputs Axis::watched(bool digest) const {
  MotorOutputs watched = stops();
  if (!has_amplifier()) return watched;
  watched.set(motor_pin::kAena, par_.channel, 1);
  if (par_.drive == Drive::kStepper) watched.set(motor_pin::kPfmDir, par_.channel, 1);
  if (has_pwm() && !digest)
    for (const MotorField& pin : {motor_pin::kPwmATop, motor_pin::kPwmABot, motor_pin::kPwmBTop, motor_pin::kPwmBBot,
                                  motor_pin::kPwmCTop, motor_pin::kPwmCBot})
      watched.set(pin, par_.channel, 1);
  return watched;
}

std::uint64_t Axis::absolute_position(Tick now) const {
  const std::int64_t steps = std::int64_t{1} << (par_.absolute->bits - par_.absolute_turns);
  return static_cast<std::uint64_t>(detail::scaled_down(position(now), steps, encoder_.units_per_revolution()));
}

void Axis::ssi_clocked(Tick tick, bool level) { absolute_->clock(tick, level, absolute_position(tick)); }

MotorOutputs Axis::stops() const {
  MotorOutputs stops;
  if (par_.drive == Drive::kStepper) stops.set(motor_pin::kPfmPulse, par_.channel, 1);
  return stops;
}

MotorOutputs Axis::watched_brake() const {
  MotorOutputs watched;
  watched.set(motor_pin::kAena, par_.brake.channel, 1);
  return watched;
}

void Axis::changed_brake(Tick tick, const MotorOutputs& after) {
  brake_.output(tick, after.get(motor_pin::kAena, par_.brake.channel) != 0);
}

void Axis::changed(Tick tick, const MotorOutputs& before, const MotorOutputs& after, bool digest) {
  const unsigned n = par_.channel;
  amplifier_.enable(after.get(motor_pin::kAena, n) != 0);
  const auto pwm = [n](const MotorOutputs& o) { return o.w[0] >> (motor_pin::kPwmATop.stride * n) & 0x3F; };
  const bool pulse = after.get(motor_pin::kPfmPulse, n) != 0, down = after.get(motor_pin::kPfmDir, n) != 0;
  if (before == after) {  // just attached
    if (has_pwm()) meter_.begin(tick, pwm(after));
    stepper_.begin(pulse, down);
    return;
  }
  if (has_pwm() && !digest && pwm(before) != pwm(after)) meter_.changed(tick, pwm(after));
  if (par_.drive == Drive::kStepper && stepper_.changed(tick, pulse, down, amplifier_.on())) wake();
}

bool Axis::step(Tick now, double dac_volts, MotorInputs& inputs) {
  move(now, dac_volts);

  const Tick seen = now + 1;
  const std::uint16_t present = this->pins(motion_.at(seen));
  unsigned pins = present;
  if (has_amplifier()) pins |= static_cast<unsigned>(amplifier_.fault_pin()) << kFault;
  pins ^= noise_.mask(seen);
  pins = (pins & ~unsigned{held_}) | (held_levels_ & held_);
  std::uint16_t& shown = inputs.pins[par_.channel];
  const auto edited = static_cast<std::uint16_t>((shown & ~unsigned{owned_}) | (pins & owned_));
  const bool differs = edited != shown;
  shown = edited;

  next_ = std::min(next_pin_change(seen, present), noise_.next_change(seen)) - 1;
  if (has_motor()) next_ = std::min(next_, motion_.t1);
  return differs;
}

void Axis::move(Tick now, double dac_volts) {
  switch (par_.drive) {
    case Drive::kHand:
      if (duration_ == 0) return;
      motion_ = {now, now + duration_, motion_.at(now), goal_};
      duration_ = 0;
      return;
    case Drive::kStepper:
      motion_ = stepper_.motion(now, motion_);
      return;
    default:
      break;
  }
  if (!started_) {
    started_ = true;
    motion_ = {now - step_, now, motion_.p1, motion_.p1};
  }
  if (now < motion_.t1) return;
  const auto phases = has_pwm() ? meter_.take(now) : std::array<double, PwmMeter::kPhases>{};
  if (has_pwm() && meter_.take_short()) amplifier_.trip(Amplifier::Fault::kShortedBus);
  while (now >= motion_.t1) integrate(dac_volts, phases);
}

void Axis::integrate(double dac_volts, const std::array<double, PwmMeter::kPhases>& phases) {
  const double dt = static_cast<double>(step_) / static_cast<double>(kPwmClockHz);
  const AmplifierParameters& amplifier = par_.amplifier;
  const double half_bus = amplifier.bus_volts / 2;
  motor_.set_brake(brake_.torque(motion_.t1));
  if (!amplifier_.on())
    motor_.coast(dt);
  else if (par_.drive == Drive::kTorque)
    motor_.drive_current(dt, dac_volts / 10 * amplifier.full_scale_amps);
  else if (par_.drive == Drive::kBrush)
    motor_.drive_brush(dt, (phases[0] - phases[1]) * half_bus);
  else
    motor_.drive_three_phase(dt, phases[0] * half_bus, phases[1] * half_bus, phases[2] * half_bus);
  amplifier_.watch(motor_.current_a());
  amplifier_.watch(motor_.current_b());
  motion_ = {motion_.t1, motion_.t1 + step_, motion_.p1, motor_.position()};
}

std::uint16_t Axis::pins(std::int64_t position) const {
  return static_cast<std::uint16_t>(encoder_.pins(position) | switches_.pins(position));
}

// The first edge after t that sees other pins than those at t, as far as the motion is known.
Tick Axis::next_pin_change(Tick t, std::uint16_t present) const {
  for (;;) {
    const Tick change = motion_.crosses(next_line(grids_, motion_.at(t), motion_.up()));
    if (change == kNever || pins(motion_.at(change)) != present) return change;
    t = change;
  }
}

std::uint32_t Axis::adc_word(bool b) {
  const double amps = b ? motor_.current_b() : motor_.current_a();
  const std::int64_t noise = adc_random_.noise(par_.amplifier.adc_noise);
  return amplifier_.adc_word(amps, noise, b ? 0 : static_cast<unsigned>(amplifier_.fault()));
}

double Axis::velocity(Tick now) const {
  if (now >= motion_.t1 && !has_motor()) return 0;
  return static_cast<double>(motion_.p1 - motion_.p0) / static_cast<double>(kUnitsPerCount) *
         static_cast<double>(kPwmClockHz) / static_cast<double>(motion_.t1 - motion_.t0);
}

void Axis::turn(std::int64_t counts, Tick duration) {
  if (par_.drive != Drive::kHand) throw std::logic_error("axis: only a free axis can be turned by hand");
  if (duration < 1) throw std::invalid_argument("axis: a time below one tick");
  goal_ += counts * kUnitsPerCount;
  duration_ = duration;
  wake();
}

}  // namespace brick::plant
