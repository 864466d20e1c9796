// Position as a function of time: a straight line between two ticks, at rest before and after. All integer, so that the
// tick at which an encoder edge falls is exact. Positions are in 1/65536 of a quadrature count (a quarter of a line).
#pragma once

#include <algorithm>
#include <cstdint>

#include "systemc/core/ticks.h"

namespace brick::plant {

constexpr std::int64_t kUnitsPerCount = 65536;

namespace detail {
__extension__ using Wide = __int128;
constexpr std::int64_t floor_div(Wide a, Wide b) {  // b > 0
  return static_cast<std::int64_t>(a >= 0 ? a / b : -((-a + b - 1) / b));
}
constexpr std::int64_t ceil_div(Wide a, Wide b) { return -floor_div(-a, b); }
}  // namespace detail

struct Motion {
  Tick t0 = 0, t1 = 1;  // t0 < t1
  std::int64_t p0 = 0, p1 = 0;

  std::int64_t at(Tick t) const {
    if (t >= t1) return p1;
    if (t <= t0) return p0;
    return p0 + detail::floor_div(detail::Wide{p1 - p0} * (t - t0), t1 - t0);
  }
  bool up() const { return p1 >= p0; }

  // First tick at which the position has reached `boundary` going up, or is below it going down; kNever when it does
  // not.
  Tick crosses(std::int64_t boundary) const {
    if (p1 > p0) {
      if (boundary > p1) return kNever;
      return t0 + std::max<Tick>(0, detail::ceil_div(detail::Wide{boundary - p0} * (t1 - t0), p1 - p0));
    }
    if (p1 < p0) {
      if (boundary <= p1) return kNever;
      return t0 + std::max<Tick>(0, detail::floor_div(detail::Wide{p0 - boundary} * (t1 - t0), p0 - p1) + 1);
    }
    return kNever;
  }
};

}  // namespace brick::plant
