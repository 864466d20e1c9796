// What the signals of a run did: every change with its tick. A value holds from the tick of its change on; a window
// from a to b is the ticks a .. b-1.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "testbench/unit/vectors/vector.h"

namespace brick {

class Record {
 public:
  void declare(std::size_t signals) { changes_.resize(signals); }
  void change(Tick t, unsigned signal, std::uint32_t value) { changes_[signal].emplace_back(t, value); }

  std::uint32_t value(unsigned signal, Tick t) const {
    const auto& all = changes_[signal];
    const auto after = std::upper_bound(all.begin(), all.end(), t, [](Tick a, const Change& c) { return a < c.first; });
    return after == all.begin() ? 0 : std::prev(after)->second;
  }
  // Ticks at which the signal is not 0.
  Tick high(unsigned signal, Tick from, Tick to) const {
    Tick sum = 0, at = from;
    while (at < to) {
      const Tick next = std::min(to, next_change(signal, at));
      if (value(signal, at) != 0) sum += next - at;
      at = next;
    }
    return sum;
  }
  // Edges at from .. to-1.
  std::vector<Tick> edges(SignalEdge e, Tick from, Tick to) const {
    std::vector<Tick> found;
    for (Tick t = next_change(e.signal, from - 1); t < to; t = next_change(e.signal, t)) {
      const bool was = value(e.signal, t - 1) != 0, is = value(e.signal, t) != 0;
      if (value(e.signal, t - 1) == value(e.signal, t)) continue;
      if (e.edge == Edge::kChanges || (is != was && is == (e.edge == Edge::kRises))) found.push_back(t);
    }
    return found;
  }
  Tick next_change(unsigned signal, Tick after) const {
    const auto& all = changes_[signal];
    const auto next =
        std::upper_bound(all.begin(), all.end(), after, [](Tick a, const Change& c) { return a < c.first; });
    return next == all.end() ? kNever : next->first;
  }

 private:
  using Change = std::pair<Tick, std::uint32_t>;
  std::vector<std::vector<Change>> changes_;
};

}  // namespace brick
