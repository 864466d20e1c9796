#include "app/session_end.h"

#include <iostream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/build_info.h"
#include "app/byte_text.h"

namespace brick {

namespace {

nlohmann::json exchanges_json(const ScriptPlayer& player) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& e : player.exchanges()) {
    nlohmann::json reply = nlohmann::json::array();
    for (const auto& text : e.reply) reply.push_back(utf8_text(text));
    list.push_back({{"place", utf8_text(e.place)}, {"line", utf8_text(e.line)}, {"reply", reply}, {"error", e.error}});
  }
  return list;
}

}  // namespace

nlohmann::json failures_json(const std::vector<std::string>& failures) {
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& text : failures) list.push_back(utf8_text(text));
  return list;
}

std::string no_answer(Simulation& simulation) {
  Machine& machine = simulation.machine();
  const std::string fault = machine.last_exception();
  return fmt::format("nothing in {:.3f} ms{}, the CPU {} {}{}", static_cast<double>(machine.now_fs()) * 1e-12,
                     simulation.bus().tripped() ? ", the watchdog has tripped" : "",
                     machine.cpu().asleep() ? "sleeps at" : "stands at", machine.cpu_place(),
                     fault.empty() ? "" : ", its last exception: " + fault);
}

void connect_at_start(Simulation& simulation) {
  if (simulation.link().connect(HostLink::kBootTime)) return;
  throw ScriptFailure(
      fmt::format("the controller does not answer after power-on: {}; expected an acknowledge within 500 ms, "
                  "see --jumper E3",
                  no_answer(simulation)));
}

int end_session(Simulation& simulation, const ScriptPlayer& player, const RunOptions& options,
                const MachineConfig& config, const std::string& failure,
                const std::function<void(const std::string&)>& tell) {
  if (config.aperture > 0) std::cerr << simulation.aperture_text() << '\n';
  std::vector<std::string> failures;
  if (!failure.empty()) failures.push_back(failure);
  if (!std::cout.flush()) failures.emplace_back("the replies cannot be written to stdout; expected room for them");
  const Simulation::TimingVerdict timing = simulation.timing_verdict();
  for (const auto& list : {simulation.machine().take_run_errors(), timing.failures})
    failures.insert(failures.end(), list.begin(), list.end());
  for (const auto* list : {&std::as_const(failures), &timing.waived, &timing.unused})
    for (const std::string& text : *list) tell(text);
  if (!options.json.empty()) {
    nlohmann::json results = simulation.measures();
    results["engine"] = options.engine;
    results["board"] = config.board.name;
    results["seed"] = config.seed;
    results["passed"] = failures.empty();
    if (!failures.empty()) results["failure"] = utf8_text(failures.front());
    results["failures"] = failures_json(failures);
    results["exchanges"] = exchanges_json(player);
    add_origin(results, config.firmware);
    write_json(options.json, results);
  }
  return failures.empty() ? 0 : 1;
}

}  // namespace brick
