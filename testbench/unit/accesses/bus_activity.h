// What has happened on the buses of one or more machines: how often each line of each pin moved, and how often each
// rule of each checker was evaluated in each region. A line that rests and a rule that nobody asked prove nothing, so
// lacks() names those that had less than their share, and those that cannot act but did.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "testbench/checkers/timing_book.h"

namespace brick {

class BusActivity {
 public:
  BusActivity();

  void watch(Machine& machine);         // after a TimingBook has taken its hooks
  void finish(const TimingBook& book);  // adds what it holds

  std::vector<std::string> lacks(std::uint64_t accesses) const;
  const std::vector<std::string>& violations() const { return violations_; }
  const PortATiming::TaMoves& ta_moves() const { return ta_moves_; }
  std::string text() const;  // a pin or a rule a line

 private:
  struct Pin {
    std::string name;
    std::uint32_t can_move;            // lines
    std::vector<std::uint64_t> moves;  // by line
  };

  void add(const std::string& name, unsigned width, std::uint32_t can_move);
  void moved(std::size_t index, std::uint32_t lines);
  void inputs(const BoardInputs& before, const BoardInputs& after);
  void outputs(const BoardOutputs& before, const BoardOutputs& after);
  void cycle(const PortACycle& c);

  std::vector<Pin> pins_;                                              // outputs, inputs, Port A
  std::map<std::string, std::map<std::string, std::uint64_t>> rules_;  // evaluations by "bus id" and region
  std::vector<std::string> violations_;
  PortATiming::TaMoves ta_moves_;
  BoardInputs inputs_;
  std::optional<PortACycle> cycle_;  // the last
  std::uint32_t written_ = 0;
};

}  // namespace brick
