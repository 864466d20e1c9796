// How commands that talk to a controller begin and end: what failed is told, the results are written.
#pragma once

#include <functional>
#include <string>

#include "app/options.h"
#include "app/script_player.h"
#include "app/simulation.h"

namespace brick {

void connect_at_start(Simulation& simulation);  // throws ScriptFailure when the controller does not answer

// Exit status. `failure` is what ended the session before its end, or nothing.
int end_session(Simulation& simulation, const ScriptPlayer& player, const RunOptions& options,
                const MachineConfig& config, const std::string& failure,
                const std::function<void(const std::string&)>& tell);

}  // namespace brick
