// Runs a peer as the machine does, tick by tick; here nothing moves at the outputs. step() is
// called when the peer wants it, or at every tick to show that it makes no difference. ic_rig.h has the rig with an IC.
#pragma once

#include <functional>

#include <gtest/gtest.h>

#include "testbench/plant/plant.h"

namespace brick::plant {

class PlantRig {
 public:
  explicit PlantRig(MotorPeer& peer) : peer_(peer) {}

  MotorInputPins inputs;
  bool eager = false;                      // step() at every tick
  std::function<void(Tick seen)> on_edge;  // every edge, with the inputs that it sees

  Tick now() const { return now_; }
  void run(Tick ticks) {
    for (const Tick end = now_ + ticks; now_ < end;) tick();
  }

 protected:
  void tick() {
    if (eager || stopped_ || peer_.next_event() <= now_) {
      stopped_ = false;
      const MotorInputPins before = inputs;
      const bool said = peer_.step(now_, inputs);
      EXPECT_EQ(said, inputs != before) << "tick " << now_;
      EXPECT_GT(peer_.next_event(), now_);
    }
    ++now_;
    edge();
    if (on_edge) on_edge(now_);
  }
  virtual void edge() {}

  MotorPeer& peer_;
  bool stopped_ = false;
  Tick now_ = 0;
};

// A quadrature counter of the test's own: the list of legal steps.
class QuadratureCounter {
 public:
  void look(unsigned pins) {
    const unsigned state = (pins >> kEncA & 1) << 1 | (pins >> kEncB & 1);
    if (known_ && state != state_) {
      static constexpr int kStep[4][4] = {
          {0, -1, 1, 9}, {1, 0, 9, -1}, {-1, 9, 0, 1}, {9, 1, -1, 0}};  // [from][to] by {A, B}
      const int step = kStep[state_][state];
      if (step == 9)
        ++illegal;
      else
        count += step, up += step > 0, down += step < 0;
    }
    state_ = state;
    known_ = true;
  }
  int count = 0, up = 0, down = 0, illegal = 0;

 private:
  unsigned state_ = 0;
  bool known_ = false;
};

}  // namespace brick::plant
