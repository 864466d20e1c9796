// Position compare as rules (servo-ic:5.10/1 to servo-ic:5.10/3, servo-ic:5.10/8): EQU toggles when the counter leaves
// compare A or B, and the other one then moves by the increment in the direction of travel. Modulo 2^24.
#pragma once

#include <cstdint>

namespace brick {

class Compare {
 public:
  std::uint32_t a = 0, b = 0, increment = 0;
  bool equ = false;
  bool on_arrival = false;  // deliberately wrong rule: toggles when the counter gets there

  // The source counted from `from` by `direction`. True when EQU changed.
  bool count(std::uint32_t from, int direction) {
    const auto step = static_cast<std::uint32_t>(direction);
    const std::uint32_t at = on_arrival ? (from + step) & kMask : from;
    const bool passes_a = at == a, passes_b = at == b;
    if (passes_a) b = (b + step * increment) & kMask;
    if (passes_b) a = (a + step * increment) & kMask;
    if (passes_a != passes_b) equ = !equ;
    return passes_a != passes_b;
  }

 private:
  static constexpr std::uint32_t kMask = 0xFFFFFF;
};

}  // namespace brick
