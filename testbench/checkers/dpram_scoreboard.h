// The dual-ported RAM as its users know it (host-bus:6.9): a word of 16 bits is old or new, never a mixture, and no
// write is lost. Each access is told with the span from the fall of its strobe to the rise; where spans overlap either
// order will do. It knows nothing of clocks, BUSY or arbitration.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class DpramScoreboard {
 public:
  // Every value written to one word must differ, so that a read tells which write it saw. Before the first write a
  // word reads `initial`.
  explicit DpramScoreboard(std::uint16_t initial = 0) : initial_(initial) {}

  void write(unsigned word, std::uint16_t value, TimeFs from, TimeFs to) {
    words_[word].writes.push_back({value, from, to});
  }
  void read(unsigned word, std::uint16_t value, TimeFs from, TimeFs to) {
    words_[word].reads.push_back({value, from, to});
  }

  // All accesses that were told, in any order. What is wrong, the first of each word; empty if nothing is.
  std::vector<std::string> judge() const;

  // How many reads there were, and of how many more than one value was right: they met a write.
  struct Counts {
    unsigned reads = 0, writes = 0, met = 0;
  };
  Counts counts() const;

 private:
  struct Access {
    std::uint16_t value;
    TimeFs from, to;
  };
  struct Word {
    std::vector<Access> writes, reads;
  };
  std::string judge(unsigned index, const Word& word) const;

  std::uint16_t initial_;
  std::map<unsigned, Word> words_;
};

}  // namespace brick
