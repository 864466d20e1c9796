// `brick exec`: starts the controller, plays a host script, prints the replies.
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/script_player.h"
#include "app/simulation.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

std::vector<ScriptLine> open_script(const std::string& file, const std::string& name) {
  if (file == "-") return read_script(std::cin, name);
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    throw UsageError(
        fmt::format("{}: cannot be read; expected a command file or host script, or - for standard input", file));
  return read_script(in, name);
}

nlohmann::json exchanges_json(const ScriptPlayer& player) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& e : player.exchanges())
    list.push_back({{"place", e.place}, {"line", e.line}, {"reply", e.reply}, {"error", e.error}});
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
  if (!failure.empty()) std::cerr << "brick exec: " << failure << '\n';
  for (const std::string& error : simulation.machine().take_run_errors()) {
    std::cerr << "brick exec: " << error << '\n';
    if (failure.empty()) failure = error;
  }
  const Simulation::TimingVerdict timing = simulation.timing_verdict();
  for (const std::string& violation : timing.failures) {
    std::cerr << "brick exec: " << violation << '\n';
    if (failure.empty()) failure = violation;
  }
  for (const auto* list : {&timing.waived, &timing.unused})
    for (const std::string& line : *list) std::cerr << "brick exec: " << line << '\n';
  if (!options.json.empty()) {
    nlohmann::json results = simulation.measures();
    results["engine"] = options.engine;
    results["board"] = config.board.name;
    results["seed"] = config.seed;
    results["passed"] = failure.empty();
    if (!failure.empty()) results["failure"] = failure;
    results["exchanges"] = exchanges_json(player);
    write_json(options.json, results.dump(2));
  }
  return failure.empty() ? 0 : 1;
}

}  // namespace brick
