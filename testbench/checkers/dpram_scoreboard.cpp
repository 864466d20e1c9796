#include "testbench/checkers/dpram_scoreboard.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr TimeFs kBefore = -1;  // all writes

std::string at(TimeFs t) { return fmt::format("{:.1f} ns", static_cast<double>(t) / static_cast<double>(kFsPerNs)); }
}  // namespace

// A write is over for good when another one began after its end; a read that begins after the end of that other one
// must not show it any more, nor one that begins after a read that showed a write begun after its end.
std::string DpramScoreboard::judge(unsigned index, const Word& word) const {
  std::vector<Access> reads = word.reads;
  std::sort(reads.begin(), reads.end(), [](const Access& a, const Access& b) { return a.from < b.from; });
  struct Seen {
    TimeFs to, began;  // end of a read, begin of the write that it showed
  };
  std::vector<Seen> seen;
  for (const Access& read : reads) {
    TimeFs latest = kBefore;  // begin of the last write that must be over
    for (const Access& w : word.writes)
      if (w.to <= read.from) latest = std::max(latest, w.from);
    for (const Seen& s : seen)
      if (s.to <= read.from) latest = std::max(latest, s.began);
    const auto shown = std::find_if(word.writes.begin(), word.writes.end(),
                                    [&](const Access& w) { return w.value == read.value && w.from <= read.to; });
    const bool initial = shown == word.writes.end() && read.value == initial_;
    if (shown == word.writes.end() && !initial)
      return fmt::format("word {:X}: read {:04X} at {}, which nobody has written there", index, read.value,
                         at(read.from));
    if (latest != kBefore && (initial || shown->to <= latest))
      return fmt::format("word {:X}: read {:04X} at {}, which was over with the write that began at {}", index,
                         read.value, at(read.from), at(latest));
    seen.push_back({read.to, initial ? kBefore : shown->from});
  }
  return "";
}

std::vector<std::string> DpramScoreboard::judge() const {
  std::vector<std::string> wrong;
  for (const auto& [index, word] : words_)
    if (std::string text = judge(index, word); !text.empty()) wrong.push_back(std::move(text));
  return wrong;
}

DpramScoreboard::Counts DpramScoreboard::counts() const {
  Counts n;
  for (const auto& [index, word] : words_) {
    n.reads += static_cast<unsigned>(word.reads.size());
    n.writes += static_cast<unsigned>(word.writes.size());
    for (const Access& r : word.reads)
      n.met += std::any_of(word.writes.begin(), word.writes.end(),
                           [&](const Access& w) { return w.from < r.to && r.from < w.to; });
  }
  return n;
}

}  // namespace brick
