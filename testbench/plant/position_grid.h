// Positions at which something may change: `offset` + k * num / den, rounded up, for every whole k. A pattern of pins
// that depends on the position alone (encoder.h, switches.h) lists its grids; between two neighbouring lines of all
// grids it is constant.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "testbench/plant/motion.h"

namespace brick::plant {

struct PositionGrid {
  std::int64_t offset, num, den;

  std::int64_t index(std::int64_t p) const { return detail::scaled_down(p - offset, den, num); }  // of the last <= p
  std::int64_t line(std::int64_t k) const { return offset + detail::scaled_up(k, num, den); }
};

// The line that a motion from `p` passes first: the next above, or the last at or below (passed when the position is
// below it).
inline std::int64_t next_line(const std::vector<PositionGrid>& grids, std::int64_t p, bool up) {
  std::int64_t next = up ? INT64_MAX : INT64_MIN;
  for (const PositionGrid& g : grids) {
    const std::int64_t k = g.index(p);
    next = up ? std::min(next, g.line(k + 1)) : std::max(next, g.line(k));
  }
  return next;
}

}  // namespace brick::plant
