// `brick regress`: the runs of a plan, in parallel, each in a folder of its own; what is there already is not made
// again; reports for people and machines (docs/regress.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/bench.h"

namespace brick {

struct RegressOptions {
  std::string plan;
  std::string output;  // "" = waves/out/regress/NAME of the plan
  unsigned jobs = 0;   // 0 = one a processor
  bool resume = false, rerun_failed = false, list = false, no_replay = false;
  bool rank = false;                      // the runs by what they add to the covers
  bool slurm = false;                     // on a cluster, in tasks as long as this
  double task_seconds = 60;               //
  bool task = false;                      // this is such a task, `plan` its file
  std::optional<std::string> fresh_from;  // none: the clock
  std::optional<double> minutes;          // begins nothing after so much of the wall; none: makes all
};

// Exit status. Throws UsageError before anything runs when the plan is bad.
int regress_command(const std::vector<Bench>& benches, const RegressOptions& options);

}  // namespace brick
