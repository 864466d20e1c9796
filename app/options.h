// Options shared by the commands that run a controller, and how they become a machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/named_files.h"
#include "systemc/core/ticks.h"
#include "systemc/machine/machine.h"

namespace CLI {
class App;
}

namespace brick {

struct RunOptions {
  std::string engine = "systemc";
  std::string board = "geobrick-lv-8";  // "" = the bench's own
  std::string firmware;                 // "" = the one that belongs to this brick
  std::string wave;
  std::string wave_from, wave_to;
  std::vector<std::string> trace;  // patterns, separated by commas
  std::string seed = "1";
  std::string plant = "none";
  std::string load;               // "" = nothing is sent first
  std::string record, record_of;  // "" = no record, the usual columns
  std::string profile;            // "" = none
  std::vector<std::string> jumpers;
  std::string flash;
  std::string json;
  std::string gdb;  // port, "" = no debugger
  std::string aperture = "0";
  bool skew = false;
  std::string batch = "0";
  std::string size;                  // "" = the bench's own
  std::optional<std::string> bcr;    // hexadecimal; none: as the firmware sets it
  std::optional<std::string> waive;  // file of timing waivers
  NamedFiles files;                  // that the command names beside these options
};

// Adds --engine, --board and so on to a command. `engine` is the default.
void add_run_options(CLI::App& command, RunOptions& options, const std::string& engine);

// Adds --plant, --load, --record and --profile to a command whose controller may have motors.
void add_plant_options(CLI::App& command, RunOptions& options);

// Checks everything that can be checked without running; throws UsageError with one line.
MachineConfig machine_config(const RunOptions& options);

struct WaveWindow {
  TimeFs from = 0;
  TimeFs to = kForever;
};
WaveWindow wave_window(const RunOptions& options);
TraceGroups trace_groups(const RunOptions& options);  // throws UsageError

TimeFs parse_aperture(const std::string& text);                                 // throws UsageError
std::uint16_t gdb_port(const RunOptions& options);                              // throws UsageError
std::uint64_t parse_count(const std::string& option, const std::string& text);  // throws UsageError
std::string engine_name(Engine engine);

// Writes the file of an option; throws UsageError when it cannot be written.
void write_json(const std::string& file, const nlohmann::json& value, const std::string& option = "--json");
// Throws UsageError when `file` stands in no folder, or is one.
void need_folder(const std::string& option, const std::string& file);

}  // namespace brick
