// Traffic without an end for a component and for what is inside.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

// `first`, then `loop` again and again, `period` ticks later each time. What a step does is its row's.
struct Step {
  Tick tick;
  unsigned what;
};
struct Traffic {
  std::vector<Step> first, loop;
  Tick period;

  double changes_a_tick() const { return static_cast<double>(loop.size()) / static_cast<double>(period); }
};

class Cursor {
 public:
  explicit Cursor(const Traffic& traffic) : traffic_(traffic), steps_(&traffic.first) {
    if (steps_->empty()) steps_ = &traffic.loop;
  }
  Tick tick() const { return base_ + (*steps_)[at_].tick; }
  unsigned what() const { return (*steps_)[at_].what; }
  void next() {
    if (++at_ < steps_->size()) return;
    if (steps_ == &traffic_.loop) base_ += traffic_.period;
    steps_ = &traffic_.loop;
    at_ = 0;
  }

 private:
  const Traffic& traffic_;
  const std::vector<Step>* steps_;
  std::size_t at_ = 0;
  Tick base_ = 0;
};

// Through a C++ face: `run` to the tick of each step, `act` on it.
template <class Advance, class Act>
std::function<void(Tick)> played(const Traffic& traffic, Advance run, Act act) {
  return [cursor = Cursor(traffic), run, act](Tick end) mutable {
    for (; cursor.tick() < end; cursor.next()) {
      run(cursor.tick());
      act(cursor.what());
    }
    run(end);
  };
}

// Of an event at tick t in `kRecorded` ticks, to be played again and again.
constexpr Tick kRecorded = 2'000'000;
inline void record(Traffic& seen, Tick t) {
  if (seen.loop.empty() || seen.loop.back().tick != t) seen.loop.push_back({t, 0});
}

}  // namespace brick
