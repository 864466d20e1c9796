// Limit and home switches along the travel: a pin is high while the position is inside a stretch (or outside of it).
#pragma once

#include <cstdint>
#include <vector>

#include "systemc/core/motor_pins.h"
#include "testbench/plant/position_grid.h"

namespace brick::plant {

struct Switch {
  unsigned pin;           // ChannelPin
  std::int64_t from, to;  // counts: from <= position < to
  bool level = true;      // inside
};

class Switches {
 public:
  explicit Switches(const std::vector<Switch>& switches) : switches_(switches) {
    for (const Switch& s : switches_) {
      mask_ = static_cast<std::uint16_t>(mask_ | 1u << s.pin);
      // A period longer than any travel: the grid has one line within reach.
      for (std::int64_t edge : {s.from, s.to}) grids_.push_back({edge * kUnitsPerCount, INT64_MAX / 4, 1});
    }
  }

  std::uint16_t mask() const { return mask_; }
  std::uint16_t pins(std::int64_t position) const {
    unsigned pins = 0;
    for (const Switch& s : switches_) {
      const bool inside = position >= s.from * kUnitsPerCount && position < s.to * kUnitsPerCount;
      pins |= static_cast<unsigned>(inside == s.level) << s.pin;
    }
    return static_cast<std::uint16_t>(pins);
  }
  const std::vector<PositionGrid>& grids() const { return grids_; }

 private:
  std::vector<Switch> switches_;
  std::vector<PositionGrid> grids_;
  std::uint16_t mask_ = 0;
};

}  // namespace brick::plant
