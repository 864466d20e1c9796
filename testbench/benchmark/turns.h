// A component's run against that of its face, turn by turn: neighbours on the machine slow both alike. Each run is a
// process, for SystemC elaborates once in each, and has a turn of processor time after the other.
#pragma once

#include <functional>
#include <string>

#include "systemc/core/ticks.h"

namespace brick {

struct Row {
  std::string name;
  std::function<void()> face, kernel, shell;  // each ends in take_turns(); `kernel` may be missing
  double changes_a_tick;
  bool judged = false;
};

// In the process of a run, and the end of it: `run_until` moves the simulation. Power-on is not counted.
[[noreturn]] void take_turns(const std::function<void(Tick)>& run_until);

// Prints rates, what the shell takes more than the face and what that is for each change, as medians of the rounds with
// the least and the most. A round is 20 turns of 50 ms for each run, and its median turn counts. The median of what is
// more is judged.
void measure(const Row& row);

}  // namespace brick
