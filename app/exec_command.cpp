// `brick exec`: starts the controller, plays a host script, prints the replies.
#include <iostream>
#include <sstream>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/commands.h"
#include "app/script_player.h"
#include "app/session_end.h"
#include "app/set_up.h"
#include "app/simulation.h"
#include "systemc/core/input_file.h"

namespace brick {

namespace {

std::vector<ScriptLine> open_script(const std::string& file, const std::string& name) {
  if (file == "-") return read_script(std::cin, name);
  std::istringstream in(read_input_file(file, "a command file or host script, or - for standard input"));
  return read_script(in, name);
}

}  // namespace

int exec_command(const RunOptions& options, const std::string& file, bool raw) {
  const std::string name = file == "-" ? "stdin" : file;
  const MachineConfig config = machine_config(options);
  const auto script = open_script(file, name);
  const SetUp set_up(options);
  Simulation simulation(options, config, "exec");
  ScriptPlayer player(simulation.link(), std::cout, raw);
  set_up.check(simulation);
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
      connect_at_start(simulation);
      set_up.send(simulation);
      player.play(script);
    });
  } catch (const std::exception& e) {  // the script, the engines or the bus: bad input was found before
    failure = e.what();
  }
  if (const std::string sum = player.refused().summary(script.size()); !sum.empty()) tell(sum);
  return end_session(simulation, player, options, config, failure, tell);
}

}  // namespace brick
