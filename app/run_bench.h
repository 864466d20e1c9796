// One run of a bench, as `brick run` and `brick timing` make it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/bench.h"
#include "app/options.h"

namespace brick {

class Simulation;

// What a command adds to the run.
struct RunExtras {
  std::string command = "run";                              // for messages
  std::string of_firmware;                                  // an option that is about the firmware of the run
  std::function<void(Simulation&)> before;                  // the machine is made, nothing has run
  std::function<void(Simulation&, nlohmann::json&)> after;  // the verdict is printed; may add to the results
};

// The one of `benches` with that name; exit status. Throws UsageError.
int run_bench(const std::vector<Bench>& benches, const RunOptions& options, const std::string& name, bool negative,
              const RunExtras& extras = {});

}  // namespace brick
