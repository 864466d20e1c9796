// What rigs with RTL and model side by side do: they compare the two, unless `./dev mutate` asks what would hold a rule
// that both had misread (docs/mutation.md); the negative controls of the comparisons fail then. What a test reads of
// such a rig is the RTL's, or the model's while it is the model that is judged: the RTL stands still then, and what a
// model shows that sleeps until its next event is compared with what it shows when it is kept awake.
#pragma once

#include <cstdlib>
#include <string_view>

namespace brick {

inline std::string_view comparison() {
  static const char* const text = std::getenv("BRICK_COMPARE");
  return text == nullptr ? "on" : text;
}
inline bool engines_compared() {
  static const bool compared = comparison() == "on";
  return compared;
}
inline bool model_judged() {
  static const bool judged = comparison() == "model";
  return judged;
}

}  // namespace brick
