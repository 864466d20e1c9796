// What the dual-ported RAM holds when the power comes on, by the seed, the same on every engine: rtl/board/board_sim.sv
// has this very function. Seed 1, the default of `--seed`, leaves it zero, and so does 0.
#pragma once

#include <cstdint>

namespace brick {

// What board_sim gets.
constexpr std::uint32_t start_seed(std::uint64_t seed) {
  if (seed <= 1) return 0;
  const auto folded = static_cast<std::uint32_t>(seed ^ seed >> 32);
  return folded == 0 ? 1 : folded;  // both halves equal, as in the largest seed, is no reason to start with zero
}

constexpr std::uint16_t start_word(std::uint32_t start_seed, std::uint32_t index) {
  std::uint32_t x = start_seed ^ index * 0x9E3779B9u;
  x = (x ^ x >> 16) * 0x7FEB352Du;
  x = (x ^ x >> 15) * 0x846CA68Bu;
  return start_seed == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(x >> 16);
}

}  // namespace brick
