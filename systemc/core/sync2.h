// Model of rtl/common/sync2.sv: a level that passes two flip-flops.
#pragma once

#include "systemc/core/ticks.h"

namespace brick {

struct Sync2 {
  bool first = false, second = false;

  bool level() const { return second; }
  // The next edge changes something, as long as the pin stays.
  bool moves(bool pin) const { return pin != first || first != second; }
  void advance(bool pin, Tick edges) {
    if (edges <= 0) return;
    second = edges > 1 ? pin : first;
    first = pin;
  }
};

}  // namespace brick
