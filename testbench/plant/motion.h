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
template <class T>
constexpr std::int64_t floor_div(T a, T b) {  // b > 0
  return static_cast<std::int64_t>(a >= 0 ? a / b : -((-a + b - 1) / b));
}
// a * b / c, rounded down or up; c > 0. A product that fits is divided in 64 bits, which is most of the plant's time.
inline std::int64_t scaled_down(std::int64_t a, std::int64_t b, std::int64_t c) {
  std::int64_t product = 0;
  if (__builtin_mul_overflow(a, b, &product) || product < -(INT64_MAX / 2)) return floor_div<Wide>(Wide{a} * b, c);
  return floor_div(product, c);
}
inline std::int64_t scaled_up(std::int64_t a, std::int64_t b, std::int64_t c) { return -scaled_down(-a, b, c); }
}  // namespace detail

struct Motion {
  Tick t0 = 0, t1 = 1;  // t0 < t1
  std::int64_t p0 = 0, p1 = 0;

  std::int64_t at(Tick t) const {
    if (t >= t1) return p1;
    if (t <= t0) return p0;
    return p0 + detail::scaled_down(p1 - p0, t - t0, t1 - t0);
  }
  bool up() const { return p1 >= p0; }

  // First tick at which the position has reached `boundary` going up, or is below it going down; kNever when it does
  // not.
  Tick crosses(std::int64_t boundary) const {
    if (p1 > p0) {
      if (boundary > p1) return kNever;
      return t0 + std::max<Tick>(0, detail::scaled_up(boundary - p0, t1 - t0, p1 - p0));
    }
    if (p1 < p0) {
      if (boundary <= p1) return kNever;
      return t0 + std::max<Tick>(0, detail::scaled_down(p0 - boundary, t1 - t0, p0 - p1) + 1);
    }
    return kNever;
  }
};

}  // namespace brick::plant
