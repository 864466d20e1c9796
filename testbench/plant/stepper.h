// A stepper drive with its motor at the PFM outputs: each rising edge of PULSE moves the rotor by one step, in the
// direction that DIR shows (0 up). The rotor follows evenly within `move_time`, so that its encoder makes proper edges.
// Too short pulses and too late changes of DIR are counted.
#pragma once

#include <cstdint>

#include "testbench/plant/motion.h"

namespace brick::plant {

struct StepperParameters {
  std::int64_t units_per_step = kUnitsPerCount;
  Tick move_time = 240;  // ticks; a rotor that is still moving is taken over from where it is
  Tick min_width = 0;    // of a pulse
  Tick dir_setup = 0;    // DIR must stand for that long before a pulse
};

class Stepper {
 public:
  explicit Stepper(const StepperParameters& parameters, std::int64_t position = 0)
      : par_(parameters), zero_(position) {}

  // Levels from which it starts; without it both low.
  void begin(bool pulse, bool down) {
    pulse_ = pulse;
    down_ = down;
  }
  // Levels of the pins after an edge. True when the rotor has somewhere else to go.
  bool changed(Tick tick, bool pulse, bool down, bool enabled) {
    if (down != down_) dir_edge_ = tick;
    down_ = down;
    const std::int64_t before = steps_;
    if (pulse && !pulse_) {
      if (tick - dir_edge_ < par_.dir_setup) ++violations_;
      pulse_edge_ = tick;
      if (enabled) steps_ += down ? -1 : 1;
    } else if (!pulse && pulse_ && tick - pulse_edge_ < par_.min_width) {
      ++violations_;
    }
    pulse_ = pulse;
    return steps_ != before;
  }

  std::int64_t steps() const { return steps_; }
  std::uint64_t violations() const { return violations_; }

  // Where the rotor goes from `now` on; `present` is the motion until now.
  Motion motion(Tick now, const Motion& present) const {
    const std::int64_t goal = zero_ + steps_ * par_.units_per_step;
    return goal == present.p1 ? present : Motion{now, now + par_.move_time, present.at(now), goal};
  }

 private:
  StepperParameters par_;
  std::int64_t zero_;  // position without a step
  std::int64_t steps_ = 0;
  std::uint64_t violations_ = 0;
  bool pulse_ = false, down_ = false;
  Tick pulse_edge_ = 0, dir_edge_ = -kNever;
};

}  // namespace brick::plant
