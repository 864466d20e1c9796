// `--load FILE`: a command file that is sent before anything else, so that what follows finds a controller that is set
// up. Its replies are not printed; a line that the controller refuses ends the run.
#pragma once

#include <vector>

#include "app/options.h"
#include "app/script.h"

namespace brick {

class Simulation;

class SetUp {
 public:
  explicit SetUp(const RunOptions& options);  // reads the file; throws UsageError

  bool empty() const { return script_.empty(); }
  void check(Simulation& simulation) const;  // names of signals; throws UsageError
  void send(Simulation& simulation) const;   // to the controller, which answers already; throws ScriptFailure

 private:
  std::vector<ScriptLine> script_;
};

}  // namespace brick
