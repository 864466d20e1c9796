#include "app/pacing.h"

#include <algorithm>

namespace brick {

namespace {
Tick ticks(std::chrono::nanoseconds time) { return ns_to_ticks(time.count()); }
}  // namespace

Tick Pacing::due(Tick now, Clock::time_point wall) {
  const Tick due = first_ + ticks(wall - begin_);
  if (due - now <= ticks(kMostBehind)) return due;
  begin_ = wall;
  first_ = now;
  return now;
}

Pacing::Clock::time_point Pacing::when(Tick tick) const {
  return begin_ + std::chrono::nanoseconds(fs_to_ns(tick_to_fs(tick - first_)));
}

// Over some ten milliseconds of the wall, so that one look of the kernel at something else is no slow engine.
void Pacing::ran(Tick ticks, Clock::duration wall) {
  constexpr double kLately = 0.05;
  const double seconds = std::chrono::duration<double>(wall).count();
  const double simulated = static_cast<double>(ticks) / static_cast<double>(kPwmClockHz);
  const double now = seconds > simulated ? simulated / seconds : 1;
  speed_ += (now - speed_) * std::min(1.0, seconds / kLately);
}

}  // namespace brick
