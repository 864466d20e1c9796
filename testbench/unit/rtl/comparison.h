// Whether rigs with RTL and model side by side compare them. Off only in `./dev mutate`, which asks what would hold a
// rule that both had misread (docs/mutation.md); the negative controls of the comparisons fail then.
#pragma once

#include <cstdlib>
#include <string_view>

namespace brick {

inline bool engines_compared() {
  static const bool compared = [] {
    const char* text = std::getenv("BRICK_COMPARE");
    return text == nullptr || std::string_view(text) != "off";
  }();
  return compared;
}

}  // namespace brick
