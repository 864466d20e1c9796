#include "app/pace.h"

#include <algorithm>

namespace brick {

namespace {
constexpr Tick kShortest = ns_to_ticks(1'000), kLongest = ns_to_ticks(10'000'000);

Tick ticks(std::chrono::nanoseconds time) { return ns_to_ticks(time.count()); }
}  // namespace

void Pace::start() {
  origin_ = Clock::now();
  from_ = host_.now();
}

std::chrono::milliseconds Pace::follow() {
  const auto begin = Clock::now();
  const Tick target = from_ + ticks(begin - origin_);
  auto before = begin;
  while (host_.now() < target && before - begin < kStep) {
    host_.advance_to(std::min(target, host_.now() + slice_));
    const auto after = Clock::now();
    if (after - before > kStep / 4)
      slice_ = std::max(kShortest, slice_ / 2);
    else if (after - before < kStep / 16)
      slice_ = std::min(kLongest, slice_ * 2);
    before = after;
  }
  if (target - host_.now() > ticks(kMostLag)) start();
  return host_.now() < target ? std::chrono::milliseconds(0) : kStep;
}

}  // namespace brick
