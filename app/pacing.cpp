#include "app/pacing.h"

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
  return begin_ + std::chrono::nanoseconds(tick_to_fs(tick - first_) / kFsPerNs);
}

}  // namespace brick
