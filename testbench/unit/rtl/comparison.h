// What rigs with RTL and model side by side do: they compare the two, unless `./dev mutate` asks what would hold a rule
// that both had misread (docs/mutation.md); the negative controls of the comparisons fail then. What a test reads of
// such a rig is the RTL's, or the model's while it is the model that is judged: the RTL stands still then, and what a
// model shows that sleeps until its next event is compared with what it shows when it is kept awake.
#pragma once

#include <algorithm>
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

// Of all fields, whoever adds one. What lies between them may differ: equal ones are taken for others then.
template <class Inputs>
bool same_bytes(const Inputs& a, const Inputs& b) {
  const auto bytes = [](const Inputs& in) { return reinterpret_cast<const unsigned char*>(&in); };
  return std::equal(bytes(a), bytes(a) + sizeof a, bytes(b));
}

}  // namespace brick
