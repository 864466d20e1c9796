// Simulated time beside wall time. A controller that others talk to keeps pace with the clock on the wall when it can;
// what it cannot make up for it forgets, so that nobody waits while it hurries.
#pragma once

#include <chrono>

#include "systemc/core/ticks.h"

namespace brick {

class Pacing {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kLead{20};         // by so much work may run ahead
  static constexpr std::chrono::milliseconds kMostBehind{500};  // more than that is forgotten

  explicit Pacing(Tick now) : begin_(Clock::now()), first_(now) {}

  // Tick that simulated time should have reached, when it has reached `now`.
  Tick due(Tick now) { return due(now, Clock::now()); }
  Tick due(Tick now, Clock::time_point wall);
  Clock::time_point when(Tick tick) const;  // `tick` is due

  // So much time has passed without a pause, and took so long.
  void ran(Tick ticks, Clock::duration wall);
  // Of simulated time for one of the wall's, lately; 1 when it is kept up with.
  double speed() const { return speed_; }

 private:
  Clock::time_point begin_;
  Tick first_;  // was due then
  double speed_ = 1;
};

}  // namespace brick
