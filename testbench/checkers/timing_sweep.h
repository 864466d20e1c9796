// The least wait states of each region at each CPU clock, found by driving the bus with them (`brick timing --sweep`):
// a number passes when no rule of the CPU's bus is violated and every word is right, at every phase of the two clocks,
// and so do all greater ones.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "testbench/checkers/timing_traffic.h"

namespace brick {

struct SweepCell {
  unsigned i52 = 0;
  PortATiming::Region region = PortATiming::kGateIcs;
  std::optional<unsigned> least;  // none: not even the most that the field holds
  std::string below;              // rules that fail with one less, "-" where nothing is less than 1
  std::string address;            // of the first of these violations
};

// `progress` is told each clock that is done.
std::vector<SweepCell> timing_sweep(Machine& machine, std::uint64_t seed,
                                    const std::function<void(unsigned)>& progress = {});
std::string sweep_table(const std::vector<SweepCell>& cells);

}  // namespace brick
