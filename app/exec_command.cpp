// `brick exec`: starts the controller, plays a host script, prints the replies.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <utility>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/commands.h"
#include "app/script_player.h"
#include "app/simulation.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

std::vector<ScriptLine> open_script(const std::string& file, const std::string& name) {
  if (file == "-") return read_script(std::cin, name);
  std::ifstream in(file);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(file, ignored))
    throw UsageError(
        fmt::format("{}: cannot be read; expected a command file or host script, or - for standard input", file));
  return read_script(in, name);
}

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

int exec_command(const RunOptions& options, const std::string& file, bool raw) {
  const std::string name = file == "-" ? "stdin" : file;
  const MachineConfig config = machine_config(options);
  const auto script = open_script(file, name);
  Simulation simulation(options, config, "exec");
  ScriptPlayer player(simulation.link(), std::cout, raw);
  player.check(script);
  const auto tell = [&simulation](const std::string& text) { simulation.tell("brick exec: " + text); };
  player.on_refused = tell;
  player.before_output = [&simulation] { simulation.before_output(); };
  simulation.progress_text = [&] {
    return fmt::format(", line {} of {}, {} refused", player.played(), script.size(), player.refused().count());
  };
  std::string failure;
  try {
    simulation.run([&] {
      if (!simulation.link().connect(HostLink::kBootTime))
        throw ScriptFailure(
            simulation.bus().tripped()
                ? "the controller does not answer after power-on: the watchdog has tripped; expected an acknowledge, "
                  "see --jumper E3"
                : "the controller does not answer after power-on; expected an acknowledge within 500 ms");
      player.play(script);
    });
  } catch (const std::exception& e) {  // the script, the engines or the bus: bad input was found before
    failure = e.what();
  }
  if (const std::string sum = player.refused().summary(script.size()); !sum.empty()) tell(sum);
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
    results["exchanges"] = exchanges_json(player);
    write_json(options.json, results);
  }
  return failures.empty() ? 0 : 1;
}

}  // namespace brick
