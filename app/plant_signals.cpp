#include "app/plant_signals.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/hand_encoder.h"

namespace brick {

namespace {

using plant::Axis;
using plant::Drive;
using plant::Plant;

double position(const Plant&, const Axis& axis, Tick now) {
  return static_cast<double>(axis.position(now)) / static_cast<double>(plant::kUnitsPerCount);
}
double velocity(const Plant&, const Axis& axis, Tick now) { return axis.velocity(now) / 1000; }
double torque(const Plant&, const Axis& axis, Tick) { return axis.motor().torque(); }
double current_a(const Plant&, const Axis& axis, Tick) { return axis.motor().current_a(); }
double current_b(const Plant&, const Axis& axis, Tick) { return axis.motor().current_b(); }
double command(const Plant& plant, const Axis& axis, Tick) { return plant.dac(axis.ic()).volts(axis.channel()); }

}  // namespace

PlantSignals::PlantSignals(Machine& machine, const Plant& plant)
    : machine_(machine), signals_(machine.signals()), plant_(plant) {
  for (std::size_t i = 0; i < plant.axes(); ++i) {
    const Axis& axis = plant.axis(i);
    add("position", i, position);
    add("velocity", i, velocity);
    if (!axis.has_motor()) continue;
    add("torque", i, torque);
    add("current_a", i, current_a);
    if (axis.drive() == Drive::kThreePhase) add("current_b", i, current_b);
    if (axis.drive() == Drive::kTorque) add("command", i, command);
  }
  machine.attach(*this);
}

void PlantSignals::add(const std::string& name, std::size_t axis,
                       double (*value)(const Plant& plant, const Axis& axis, Tick now)) {
  const Axis& of = plant_.axis(axis);
  const std::string scope = fmt::format("plant.axis{}.", motor_number(machine_.fitted(), of.ic(), of.channel()));
  const Signals::Id id = signals_.add(scope + name, 64, Radix::kReal, bits_of(value(plant_, of, 0)));
  signals_.ask(
      id, [this, axis, value] { return bits_of(value(plant_, plant_.axis(axis), machine_.now())); }, true);
  shown_.push_back({id, axis, value});
}

Tick PlantSignals::next_event() const {
  if (!signals_.traced()) return kNever;
  const bool any = std::any_of(shown_.begin(), shown_.end(), [this](const Shown& s) { return signals_.traced(s.id); });
  return any ? last_ + kPeriod : kNever;
}

bool PlantSignals::step(Tick now, MotorInputPins&) {
  last_ = now - now % kPeriod;
  for (const Shown& s : shown_)
    if (signals_.traced(s.id)) signals_.set(s.id, tick_to_fs(now), bits_of(s.value(plant_, plant_.axis(s.axis), now)));
  return false;
}

}  // namespace brick
