#include "testbench/plant/plant.h"

#include <algorithm>
#include <stdexcept>

namespace brick::plant {

Plant::Plant(const PlantParameters& parameters) : incidents_(parameters.incidents) {
  for (const AxisParameters& p : parameters.axes) {
    for (const auto& other : axes_)
      if (other->ic() == p.ic && other->channel() == p.channel)
        throw std::invalid_argument("plant: two axes at one channel");
    axes_.push_back(std::make_unique<Axis>(p, parameters.seed, parameters.step));
    Converters& converters =
        converters_.try_emplace(p.ic, Converters{DacPeer(parameters.dac_bits), AdcPeer(parameters.adc_header)})
            .first->second;
    converters.uses_dac = converters.uses_dac || p.drive == Drive::kTorque;
    converters.uses_adc = converters.uses_adc || axes_.back()->has_adc();
  }
  std::stable_sort(incidents_.begin(), incidents_.end(),
                   [](const Incident& a, const Incident& b) { return a.at < b.at; });
}

void Plant::happen(const Incident& incident) {
  Axis& axis = *axes_.at(incident.axis);
  if (incident.trip) axis.trip(*incident.trip);
  if (incident.cut) axis.cut(*incident.cut);
  if (incident.load) axis.set_load(*incident.load);
  if (incident.turn != 0) axis.turn(incident.turn, incident.turn_time);
}

std::uint32_t Plant::ics() const {
  std::uint32_t ics = 0;
  for (const auto& axis : axes_) {
    if (axis->has_amplifier()) ics |= 1u << axis->ic();
    if (axis->brake().torque > 0) ics |= 1u << axis->brake().ic;
  }
  return ics;
}

void Plant::begin(MotorDigest* digest) {
  digest_ = digest;
  next_ = 0;
}

std::uint16_t Plant::drives(unsigned ic, unsigned channel) const {
  for (const auto& axis : axes_)
    if (axis->ic() == ic && axis->channel() == channel) return axis->drives();
  return 0;
}

MotorOutputs Plant::watched(unsigned ic) const {
  MotorOutputs watched;
  for (const auto& axis : axes_) {
    if (axis->ic() == ic) watched |= axis->watched(digest_ != nullptr);
    if (axis->has_brake_at(ic)) watched |= axis->watched_brake();
  }
  const auto found = converters_.find(ic);
  if (found == converters_.end()) return watched;
  if (found->second.uses_dac) watched |= DacPeer::watched(digest_ != nullptr);
  if (found->second.uses_adc) watched |= AdcPeer::watched(digest_ != nullptr);
  return watched;
}

MotorOutputs Plant::stops(unsigned ic) const {
  MotorOutputs stops;
  for (const auto& axis : axes_)
    if (axis->ic() == ic) stops |= axis->stops();
  const auto found = converters_.find(ic);
  if (digest_ == nullptr && found != converters_.end() && found->second.uses_adc) stops |= AdcPeer::watched(false);
  return stops;
}

std::uint8_t Plant::ssi_channels() const {
  unsigned channels = 0;
  for (const auto& axis : axes_)
    if (axis->absolute() != nullptr) channels |= 1u << axis->ssi_channel();
  return static_cast<std::uint8_t>(channels);
}

void Plant::ssi_clocked(Tick tick, std::uint8_t before, std::uint8_t after) {
  for (const auto& axis : axes_)
    if (axis->absolute() != nullptr && ((before ^ after) >> axis->ssi_channel() & 1) != 0)
      axis->ssi_clocked(tick, (after >> axis->ssi_channel() & 1) != 0);
}

std::uint8_t Plant::ssi_data(Tick now) {
  unsigned data = 0xFF;
  for (const auto& axis : axes_)
    if (axis->absolute() != nullptr && !axis->ssi_level(now)) data &= ~(1u << axis->ssi_channel());
  return static_cast<std::uint8_t>(data);
}

void Plant::changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
  for (const auto& axis : axes_)
    if (axis->has_brake_at(ic)) axis->changed_brake(tick, after);
  const auto found = converters_.find(ic);
  if (found == converters_.end()) return;
  if (digest_ != nullptr)
    serial_digest(ic, found->second, before, after);
  else
    serial_pins(tick, ic, found->second, before, after);
  for (const auto& axis : axes_) {
    if (axis->ic() != ic || !axis->has_amplifier()) continue;
    axis->changed(tick, before, after, digest_ != nullptr);
    if (before == after && digest_ != nullptr && axis->has_pwm())
      axis->begin_pwm(tick, digest_->pwm_times(ic, axis->channel()));
    next_ = std::min(next_, axis->next_event());
  }
}

void Plant::serial_pins(Tick tick, unsigned ic, Converters& converters, const MotorOutputs& before,
                        const MotorOutputs& after) {
  converters.dac.changed(before, after);
  const AdcPeer::Event event = converters.adc.changed(tick, before, after);
  if (event.command) command(ic, converters.adc);
  if (event.start) start_conversion(ic, converters.adc);
}

void Plant::serial_digest(unsigned ic, Converters& converters, const MotorOutputs& before, const MotorOutputs& after) {
  if (converters.uses_dac && DacPeer::latches(before, after)) converters.dac.latch(digest_->dac_lines(ic));
  if (!converters.uses_adc || !AdcPeer::starts(before, after) || !converters.adc.started(digest_->adc_stream(ic)))
    return;
  start_conversion(ic, converters.adc);
  digest_->send_adc(ic, converters.adc.words());
  next_ = std::min(next_, converters.adc.command_end());
}

void Plant::start_conversion(unsigned ic, AdcPeer& adc) {
  for (const auto& axis : axes_) {
    if (axis->ic() != ic || !axis->has_adc()) continue;
    for (const bool b : {false, true}) adc.set_word(axis->channel(), b, axis->adc_word(b));
  }
}

void Plant::command(unsigned ic, const AdcPeer& adc) {
  for (const auto& axis : axes_)
    if (axis->ic() == ic && axis->has_adc()) axis->command(adc.command());
  next_ = 0;
}

bool Plant::step(Tick now, MotorInputPins& inputs) {
  while (happened_ < incidents_.size() && incidents_[happened_].at <= now) happen(incidents_[happened_++]);
  for (auto& [ic, converters] : converters_) {
    if (converters.adc.command_end() > now) continue;
    converters.adc.take_command();
    command(ic, converters.adc);
  }
  bool edited = false;
  next_ = happened_ < incidents_.size() ? incidents_[happened_].at : kNever;
  for (const auto& axis : axes_) {
    if (axis->next_event() <= now) {
      if (digest_ != nullptr && axis->integrates(now))
        axis->add_pwm(now, digest_->pwm_times(axis->ic(), axis->channel()));
      edited = axis->step(now, converters_.at(axis->ic()).dac.volts(axis->channel()), inputs[axis->ic()]) || edited;
    }
    next_ = std::min(next_, axis->next_event());
    if (axis->absolute() != nullptr) {
      axis->ssi_level(now);  // what has come is no event any more
      next_ = std::min(next_, axis->absolute()->next_change());
    }
  }
  for (const auto& [ic, converters] : converters_) {
    next_ = std::min(next_, converters.adc.command_end());
    if (digest_ == nullptr && converters.uses_adc) edited = show_adc(ic, converters, inputs[ic]) || edited;
  }
  return edited;
}

bool Plant::show_adc(unsigned ic, const Converters& converters, MotorInputs& inputs) const {
  const MotorInputs before = inputs;
  unsigned mine = 0;
  for (const auto& axis : axes_)
    if (axis->ic() == ic && axis->has_adc()) mine |= 1u << axis->channel();
  inputs.adc_a = static_cast<std::uint8_t>((inputs.adc_a & ~mine) | (converters.adc.lines(false) & mine));
  inputs.adc_b = static_cast<std::uint8_t>((inputs.adc_b & ~mine) | (converters.adc.lines(true) & mine));
  return inputs != before;
}

}  // namespace brick::plant
