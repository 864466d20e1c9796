#include "app/set_up.h"

#include <ostream>
#include <sstream>

#include <fmt/format.h>

#include "app/paths.h"
#include "app/script_player.h"
#include "app/simulation.h"
#include "systemc/core/input_file.h"

namespace brick {

SetUp::SetUp(const RunOptions& options) {
  if (options.load.empty()) return;
  const std::string path = setup_path(options.load);
  std::istringstream in(read_input_file(path, "a command file", "--load " + path));
  script_ = read_script(in, path);
}

void SetUp::check(Simulation& simulation) const {
  std::ostream nowhere(nullptr);
  ScriptPlayer(simulation.link(), nowhere, false).check(script_);
}

void SetUp::send(Simulation& simulation) const {
  std::ostream nowhere(nullptr);
  ScriptPlayer player(simulation.link(), nowhere, false);
  player.on_refused = [](const std::string& text) { throw ScriptFailure(text + "; expected a set-up that is taken"); };
  player.play(script_);
}

}  // namespace brick
