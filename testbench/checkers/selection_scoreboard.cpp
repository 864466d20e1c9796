#include "testbench/checkers/selection_scoreboard.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

unsigned SelectionScoreboard::selected() const {
  constexpr unsigned kSelectable = 8;
  if (!fitted_ || (i2_ & 1) != 0) return host_;
  if (number_ < 1 || number_ > kSelectable) return kNone;
  return number_ - 1 + (i59_ % 2 != 0 ? kSelectable : 0);
}

void SelectionScoreboard::begin(Tick now, Tick limit) {
  start_ = last_ = now;
  limit_ = limit;
  edges_ = 0;
  phases_.clear();
  real_times_.clear();
}

void SelectionScoreboard::violate(Tick now, const std::string& text) {
  const unsigned cs = selected();
  violations_.push_back(fmt::format("tick {}: {}; {} is selected (&{}, I2={}, I59={}, FPD {})", now, text,
                                    cs == kNone ? "none" : fmt::format("C.S. {}", cs + 1), host_ + 1, i2_, i59_,
                                    number_));
}

void SelectionScoreboard::edge(Tick now, bool breq, bool lamp_n) {
  ++edges_;
  ++counts_.edges;
  last_ = now;
  if (lamp_n != (!fitted_ || !breq)) violate(now, fmt::format("BRLD/={:d} with BREQ={:d}", lamp_n, breq));
}

void SelectionScoreboard::settled(Tick now, bool breq, bool sig) {
  // A task begins that much after PHASE at the latest: WX, which makes the edge that counts, holds the servo task back
  // while it writes.
  constexpr Tick kRecognised = ns_to_ticks(2000);
  const bool expect = expected(), by_host = limit_ == kHostLimit;
  const auto came = [&](const std::vector<Tick>& ticks, Tick before) {
    return std::any_of(ticks.begin(), ticks.end(), [&](Tick t) { return t <= last_ && t >= start_ - before; });
  };
  const bool calculated = by_host && calculation_ > 0 && came(real_times_, 0);
  const bool interrupted = by_host && (calculated || came(phases_, kRecognised));
  const Tick allowed = limit_ + (interrupted ? kTasks : 0) + (calculated ? calculation_ : 0);
  const unsigned changes = level_ != expect ? 1 : 0;
  if (breq != expect || edges_ != changes)
    violate(now, fmt::format("BREQ={:d} after {} edges, expected {:d} after {}", breq, edges_, expect, changes));
  else if (edges_ != 0 && last_ - start_ > allowed)
    violate(last_, fmt::format("BREQ {} ticks after its cause, expected {} at most", last_ - start_, allowed));
  if (sig != breq) violate(now, fmt::format("SIG bit 1 is {:d}, BREQ {:d}", sig, breq));
  if (edges_ != 0 && !calculated) {
    Tick& longest = interrupted ? longest_interrupted_ : by_host ? longest_host_ : longest_panel_;
    longest = std::max(longest, last_ - start_ - (by_host ? 0 : real_time_));
    interrupted_ += interrupted ? 1 : 0;
    undisturbed_ += by_host && !interrupted ? 1 : 0;
  }
  ++counts_.causes;
  const unsigned cs = selected();
  ++(cs == kNone                      ? counts_.none
     : buffers_[cs] == Buffer::kIdle  ? counts_.idle
     : buffers_[cs] == Buffer::kReady ? counts_.ready
                                      : counts_.full);
  level_ = breq;
  edges_ = 0;
}

}  // namespace brick
