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
    converters_.try_emplace(p.ic, Converters{DacPeer(parameters.dac_bits), AdcPeer(parameters.adc_header)});
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
  for (const auto& axis : axes_)
    if (axis->has_amplifier()) ics |= 1u << axis->ic();
  return ics;
}

MotorOutputs Plant::stops(unsigned ic) const {
  MotorOutputs stops;
  for (const auto& axis : axes_) {
    if (axis->ic() != ic) continue;
    const MotorOutputs more = axis->stops();
    for (unsigned i = 0; i < kMotorOutputWords; ++i) stops.w[i] |= more.w[i];
  }
  return stops;
}

Tick Plant::next_event() const {
  Tick next = happened_ < incidents_.size() ? incidents_[happened_].at : kNever;
  for (const auto& axis : axes_) next = std::min(next, axis->next_event());
  return next;
}

void Plant::changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
  const auto found = converters_.find(ic);
  if (found == converters_.end()) return;
  Converters& converters = found->second;
  converters.dac.changed(before, after);
  const AdcPeer::Event event = converters.adc.changed(tick, before, after);
  for (const auto& axis : axes_) {
    if (axis->ic() != ic || !axis->has_amplifier()) continue;
    axis->changed(tick, before, after);
    if (!axis->has_adc()) continue;
    if (event.command) axis->command(converters.adc.command());
    if (!event.start) continue;
    for (const bool b : {false, true}) converters.adc.set_word(axis->channel(), b, axis->adc_word(b));
  }
}

bool Plant::step(Tick now, MotorInputPins& inputs) {
  while (happened_ < incidents_.size() && incidents_[happened_].at <= now) happen(incidents_[happened_++]);
  bool edited = false;
  for (const auto& axis : axes_) {
    MotorInputs& in = inputs[axis->ic()];
    const Converters& converters = converters_.at(axis->ic());
    edited = axis->step(now, converters.dac.volts(axis->channel()), in) || edited;
    if (!axis->has_adc()) continue;
    const MotorInputs before = in;
    const unsigned mine = 1u << axis->channel();
    in.adc_a = static_cast<std::uint8_t>((in.adc_a & ~mine) | (converters.adc.lines(false) & mine));
    in.adc_b = static_cast<std::uint8_t>((in.adc_b & ~mine) | (converters.adc.lines(true) & mine));
    edited = edited || in != before;
  }
  return edited;
}

}  // namespace brick::plant
