// How commands that talk to a controller begin and end: what failed is told, the results are written.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/options.h"
#include "app/script_player.h"
#include "app/simulation.h"

namespace brick {

// What is known of a controller that has not answered since power-on: how long, watchdog, CPU, its last exception.
std::string no_answer(Simulation& simulation);

void connect_at_start(Simulation& simulation);  // throws ScriptFailure when the controller does not answer

nlohmann::json failures_json(const std::vector<std::string>& failures);

// Exit status. `failure` is what ended the session before its end, or nothing.
int end_session(Simulation& simulation, const ScriptPlayer& player, const RunOptions& options,
                const MachineConfig& config, const std::string& failure,
                const std::function<void(const std::string&)>& tell);

}  // namespace brick
