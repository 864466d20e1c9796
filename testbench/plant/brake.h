// A brake that a spring closes and an output opens, as vertical axes have it. It grips, or lets go, some time after the
// output has changed.
#pragma once

#include "systemc/core/ticks.h"

namespace brick::plant {

struct BrakeParameters {
  double torque = 0;             // N m, 0: there is none
  unsigned ic = 0, channel = 0;  // whose AENA opens it
  Tick delay = 0;                // from the output's edge to the brake's
};

class Brake {
 public:
  explicit Brake(const BrakeParameters& parameters) : par_(parameters) {}

  void output(Tick tick, bool open) {
    settle(tick);
    if (open == asked_) return;
    asked_ = open;
    at_ = tick + par_.delay;
  }
  double torque(Tick now) {  // N m, friction that it adds
    settle(now);
    return open_ ? 0 : par_.torque;
  }

 private:
  void settle(Tick now) {
    if (now >= at_) open_ = asked_;
  }

  BrakeParameters par_;
  bool asked_ = false, open_ = false;
  Tick at_ = 0;
};

}  // namespace brick::plant
