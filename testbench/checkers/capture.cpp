#include "testbench/checkers/capture.h"

namespace brick {

std::uint16_t Capture::shown(std::uint16_t level) const {
  if ((gate & 2) == 0) return level;
  const unsigned part = parts(level);
  constexpr unsigned kReplaced = 1u << kEncC | 1u << kU | 1u << kV | 1u << kW;
  // {A,B}: 11 -> C, 10 -> U, 00 -> V, 01 -> W
  return static_cast<std::uint16_t>((level & ~kReplaced) | bit(part, 3) << kEncC | bit(part, 2) << kU |
                                    bit(part, 0) << kV | bit(part, 1) << kW);
}

bool Capture::condition(std::uint16_t level) const {
  static constexpr unsigned kFlags[4] = {kHmfl, kPlim, kMlim, kUser};
  bool index = bit(level, kEncC) != 0;
  if (gated) {
    const unsigned wanted = (gate & 1) != 0 ? 0u : 1u;
    index = index && bit(level, kEncA) == wanted && bit(level, kEncB) == wanted;
  }
  const bool index_true = index != ((code & 4) != 0);
  const bool flag_true = (bit(level, kFlags[flag]) != 0) != ((code & 8) != 0);
  switch (code & 3) {
    case 0:
      return (code & 4) != 0;  // by software
    case 1:
      return index_true;
    case 2:
      return flag_true;
    default:
      return index_true && flag_true;
  }
}

bool Capture::step(std::uint16_t level, std::uint32_t position) {
  seen_ |= 1u << state(level);
  part_ = parts(level);
  const std::uint16_t now = shown(level);
  const bool term = condition(now), by_hall = gated && (code & 1) == 0;
  constexpr unsigned kHalls = 1u << kU | 1u << kV | 1u << kW;
  const bool event = by_hall ? ((now ^ last_) & kHalls) != 0 : term && (level_rule || !term_);
  term_ = term;
  last_ = now;
  if (!armed_ || !event) return false;
  armed_ = false;
  captured_ = true;
  gated_index_ = gated && !by_hall;
  position_ = position;
  if (by_hall) hall_ = bit(now, kU) << 2 | bit(now, kV) << 1 | bit(now, kW);
  return true;
}

}  // namespace brick
