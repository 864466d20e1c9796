// The seed of a test's random input: its own, so that each run of the suite is the same; with BRICK_RANDOM_SEED=n in
// the environment another for each n. Tests that have a limit of time or activity take it, so that they can be run by
// many (docs/verification-plan.md).
#pragma once

#include <cstdint>
#include <cstdlib>

namespace brick {

inline std::uint32_t random_seed(std::uint64_t own) {
  const char* const text = std::getenv("BRICK_RANDOM_SEED");
  const std::uint64_t other = text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
  return static_cast<std::uint32_t>(own + 1'000'003 * other);  // 0: its own
}

}  // namespace brick
