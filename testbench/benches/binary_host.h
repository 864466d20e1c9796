// A host that keeps a binary rotary buffer for each coordinate system and tells the scoreboard all it does; what the
// controller writes into the headers is taken from Port A.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "app/bench.h"
#include "testbench/checkers/binary_scoreboard.h"
#include "testbench/host/binary_rotary.h"

namespace brick {

class BinaryHost {
 public:
  explicit BinaryHost(BenchContext& context);
  ~BinaryHost();
  BinaryHost(const BinaryHost&) = delete;
  BinaryHost& operator=(const BinaryHost&) = delete;

  // Rings of `words` for systems 1 to `systems`, open, each with a buffer of `items` (0: by chance) of its own.
  void open(unsigned systems, unsigned words, unsigned items);
  void close();
  void select(unsigned cs);                                       // &n, from 0
  bool send(unsigned cs, const std::vector<std::string>& lines);  // one index for all; false: no room
  void settle();                                                  // until all is copied or stopped
  std::string ask(const std::string& command) const;
  bool verdict(const std::string& step, unsigned least_lines);  // no violation since the last, and as many lines

  unsigned random(unsigned below) { return static_cast<unsigned>(random_() % below); }
  std::string random_line();  // as it is listed
  BinaryRotary& rotary(unsigned cs) { return rotaries_[cs]; }
  BinaryScoreboard& scoreboard() { return scoreboard_; }
  HostBus& bus() { return context_.bus; }

 private:
  void cycle(const PortACycle& c);
  void show(unsigned cs);  // BREQ is judged as this system's from now on

  BenchContext& context_;
  BinaryScoreboard scoreboard_;
  std::vector<BinaryRotary> rotaries_;
  std::mt19937_64 random_;
  std::size_t reported_ = 0;
  unsigned judged_ = 0, lies_ = 0;
};

}  // namespace brick
