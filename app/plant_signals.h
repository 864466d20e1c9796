// What a plant does, as named signals: `plant.axis1.position` and so on (docs/signals.md), numbers with a fraction.
// They are sampled while a waveform wants them; otherwise they cost nothing.
#pragma once

#include <array>
#include <vector>

#include "systemc/machine/machine.h"
#include "testbench/plant/plant.h"

namespace brick {

class PlantSignals : public MotorPeer {
 public:
  static constexpr Tick kPeriod = 9216;  // 12.8 kHz, whole steps of the motors of the ready plants

  // Declares the signals; `machine` has the plant attached already. Both must live longer.
  PlantSignals(Machine& machine, const plant::Plant& plant);

  std::uint32_t ics() const override { return 0; }
  Tick next_event() const override;
  bool step(Tick now, MotorInputPins& inputs) override;

 private:
  struct Shown {
    Signals::Id id;
    std::size_t axis;
    double (*value)(const plant::Plant& plant, const plant::Axis& axis, Tick now);
  };
  void add(const std::string& name, std::size_t axis,
           double (*value)(const plant::Plant& plant, const plant::Axis& axis, Tick now));

  Machine& machine_;
  Signals& signals_;
  const plant::Plant& plant_;
  std::vector<Shown> shown_;
  Tick last_ = -kPeriod;  // sample
};

}  // namespace brick
