#include "app/options.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/paths.h"
#include "app/recorder.h"
#include "app/time_text.h"
#include "systemc/core/input_file.h"
#include "systemc/core/usage_error.h"
#include "systemc/machine/board_file.h"

namespace brick {

namespace fs = std::filesystem;

namespace {

void need_file(const std::string& option, const std::string& file, const std::string& what) {
  const std::string shown = fmt::format("{} {}", option, file);
  if (!fs::exists(file)) throw UsageError(fmt::format("{}: no such file; expected {}", shown, what));
  need_regular_file(file, what, shown);
}

std::uint32_t forced_bcr(const std::string& text) {
  const std::string digits = text.substr(text[0] == '$' ? 1 : text.compare(0, 2, "0x") == 0 ? 2 : 0);
  if (digits.empty() || digits.size() > 6 || digits.find_first_not_of("0123456789ABCDEFabcdef") != std::string::npos)
    throw UsageError(fmt::format("--bcr \"{}\": is no word; expected up to six hexadecimal digits", text));
  return static_cast<std::uint32_t>(std::stoul(digits, nullptr, 16));
}

}  // namespace

void need_folder(const std::string& option, const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw UsageError(fmt::format("{} {}: no such folder {}; expected an existing one", option, file, folder.string()));
  if (fs::is_directory(file)) throw UsageError(fmt::format("{} {}: is a folder; expected a file", option, file));
}

void add_run_options(CLI::App& command, RunOptions& o, const std::string& engine) {
  o.engine = engine;
  command.add_option("--engine", o.engine, "rtl, systemc or lockstep (both, every pin compared at every tick)")
      ->capture_default_str();
  command.add_option("--board", o.board, "board NAME (see brick boards) or FILE.toml")->capture_default_str();
  command.add_option("--firmware", o.firmware, "firmware image FILE.elf (default: the one built with brick)");
  command.add_option("--wave", o.wave, "write a waveform, FILE.vcd or FILE.fst");
  command.add_option("--wave-from", o.wave_from, "first time in the waveform, for example 10ms");
  command.add_option("--wave-to", o.wave_to, "last time in the waveform");
  command
      .add_option(
          "--trace", o.trace,
          "what goes into the waveform: names or globs of docs/signals.md, for example 'clock.*,host.*', or all; "
          "may be repeated (default: all but the serial clocks)")
      ->type_name("GROUPS")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--seed", o.seed, "seed of what memories and flip-flops start with and of the host's timing")
      ->capture_default_str();
  command.add_option("--jumper", o.jumpers, "jumper that is on: E3 (factory defaults at start); may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--flash", o.flash, "file that keeps SAVEd data between runs");
  command
      .add_option("--aperture", o.aperture,
                  "nanoseconds around a clock edge within which a pin that CPU or host moves is taken early or late "
                  "at random, by --seed; up to 1")
      ->type_name("NS")
      ->capture_default_str();
  command.add_flag("--skew", o.skew,
                   "each line of the CPU's bus comes to the board with a delay of its own, 0 to 8.48 ns by --seed, and "
                   "D and /TA come back 10 ns after their clock");
  command.add_option("--json", o.json, "write the results to FILE");
  command.add_option("--gdb", o.gdb, "wait for a debugger on 127.0.0.1:PORT, 0 = a free port (docs/debugging.md)")
      ->type_name("PORT");
  command
      .add_option_function<std::string>(
          "--waive", [&o](const std::string& file) { o.waive = file; },
          "violations of the bus timing that are known and harmless, FILE.toml")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--bcr", [&o](const std::string& word) { o.bcr = word; },
          "wait states of all areas as in BCR, hexadecimal, whatever the firmware writes after start-up")
      ->type_name("HEX");
  command.add_option("--batch", o.batch, "longest advance in ticks, 0 = as the rules allow; changes speed only")
      ->capture_default_str()
      ->group("Advanced");
}

void add_plant_options(CLI::App& command, RunOptions& o) {
  command
      .add_option("--plant", o.plant, "motors at the pins: dac8, servo8, stepper8, none, or FILE.toml (docs/plant.md)")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  command
      .add_option(
          "--load", o.load,
          "sends a command file before anything else: dac8, servo8, stepper8 (set-ups for these plants), or FILE")
      ->type_name("NAME|FILE");
  command.add_option("--record", o.record, "write a row of numbers each servo interrupt to FILE.csv (docs/record.md)")
      ->type_name("FILE");
  command
      .add_option("--record-of", o.record_of,
                  "the columns, with blanks between: signals, motorN.commanded and the like, M definitions (default: "
                  "commanded, actual, error of each motor, BREQ)")
      ->type_name("COLUMNS");
  command
      .add_option("--profile", o.profile,
                  "write where the firmware's cycles go to FILE, by function and task (docs/profile.md)")
      ->type_name("FILE");
}

std::uint64_t parse_count(const std::string& option, const std::string& text) {
  std::size_t used = 0;
  try {
    const std::uint64_t value = std::stoull(text, &used);
    if (used == text.size() && text[0] >= '0' && text[0] <= '9') return value;
  } catch (const std::exception&) {}
  throw UsageError(fmt::format("{} {}: is no number; expected an integer of 0 or more", option, text));
}

TimeFs parse_aperture(const std::string& text) {
  TimeFs width = -1;
  try {
    width = text == "0" ? 0 : parse_time(text + "ns");
  } catch (const UsageError&) {}
  if (width < 0 || width > Aperture::kMost)
    throw UsageError(
        fmt::format("--aperture {}: is no aperture; expected nanoseconds, 0 to {}", text, Aperture::kMost / kFsPerNs));
  return width;
}

std::uint16_t gdb_port(const RunOptions& o) {
  const std::uint64_t port = parse_count("--gdb", o.gdb);
  if (port > UINT16_MAX) throw UsageError(fmt::format("--gdb {}: is no port; expected 0 to 65535", o.gdb));
  return static_cast<std::uint16_t>(port);
}

std::string engine_name(Engine engine) {
  return engine == Engine::kRtl ? "rtl" : engine == Engine::kSystemC ? "systemc" : "lockstep";
}

namespace {

void check_files(const RunOptions& o, const MachineConfig& config) {
  NamedFiles files = o.files;
  files.reads("--board", board_path(o.board));
  files.reads("--firmware", config.firmware);
  if (o.plant != "none") files.reads("--plant", plant_path(o.plant));
  if (!o.load.empty()) files.reads("--load", setup_path(o.load));
  if (o.waive) files.reads("--waive", *o.waive);
  files.writes("--flash", o.flash);
  files.writes("--wave", o.wave);
  files.writes("--record", o.record);
  files.writes("--profile", o.profile);
  files.writes("--json", o.json);
  files.check();
}

}  // namespace

MachineConfig machine_config(const RunOptions& o) {
  MachineConfig config;
  if (o.engine == "rtl")
    config.engine = Engine::kRtl;
  else if (o.engine == "systemc")
    config.engine = Engine::kSystemC;
  else if (o.engine == "lockstep")
    config.engine = Engine::kLockstep;
  else
    throw UsageError(fmt::format("--engine {}: no such engine; expected rtl, systemc or lockstep", o.engine));
  config.seed = parse_count("--seed", o.seed);
  config.aperture = parse_aperture(o.aperture);
  config.skew = o.skew;
  config.batch = static_cast<Tick>(parse_count("--batch", o.batch));
  if (config.batch < 0 || config.batch >= kNever)
    throw UsageError(fmt::format("--batch {}: is too large; expected ticks", o.batch));
  for (const auto& jumper : o.jumpers) {
    if (jumper != "E3" && jumper != "e3")
      throw UsageError(fmt::format("--jumper {}: no such jumper; expected E3", jumper));
    config.jumper_e3 = true;
  }
  if (o.bcr) config.bcr = forced_bcr(*o.bcr);
  config.board = read_board_file(board_path(o.board));
  config.firmware = o.firmware.empty() ? default_firmware() : o.firmware;
  need_file("--firmware", config.firmware, "an ELF image for RV32");
  config.flash_file = o.flash;
  if (!o.flash.empty()) need_folder("--flash", o.flash);
  if (!o.json.empty()) need_folder("--json", o.json);
  if (!o.gdb.empty()) gdb_port(o);
  if (o.record.empty() && !o.record_of.empty())
    throw UsageError("--record-of needs a file; expected --record FILE.csv");
  if (!o.record.empty()) {
    Recorder::check_name(o.record);
    need_folder("--record", o.record);
  }
  if (!o.profile.empty()) need_folder("--profile", o.profile);
  wave_window(o);
  trace_groups(o);
  check_files(o, config);
  if (!o.json.empty()) need_writable("--json", o.json);
  if (!o.profile.empty()) need_writable("--profile", o.profile);
  return config;
}

WaveWindow wave_window(const RunOptions& o) {
  WaveWindow window;
  const auto read = [](const char* option, const std::string& text, TimeFs& time) {
    if (text.empty()) return;
    try {
      time = parse_time(text);
    } catch (const UsageError& e) { throw UsageError(fmt::format("{}: {}", option, e.what())); }
  };
  read("--wave-from", o.wave_from, window.from);
  read("--wave-to", o.wave_to, window.to);
  if (o.wave.empty() && (!o.wave_from.empty() || !o.wave_to.empty()))
    throw UsageError("--wave-from and --wave-to need a waveform; expected --wave FILE.vcd or FILE.fst");
  const std::string ending = fs::path(o.wave).extension();
  if (!o.wave.empty() && ending != ".vcd" && ending != ".fst")
    throw UsageError(fmt::format("--wave {}: unknown kind of waveform; expected FILE.vcd or FILE.fst", o.wave));
  if (window.from > window.to) throw UsageError("--wave-from is later than --wave-to; expected the earlier time first");
  return window;
}

TraceGroups trace_groups(const RunOptions& o) {
  if (o.trace.empty()) return {};
  if (o.wave.empty()) throw UsageError("--trace needs a waveform; expected --wave FILE.vcd or FILE.fst");
  std::vector<std::string> patterns;
  for (const std::string& list : o.trace) {
    std::stringstream in(list + ',');
    for (std::string pattern; std::getline(in, pattern, ',');) {
      if (pattern.empty())
        throw UsageError(
            fmt::format("--trace {}: an empty name; expected names or globs with commas between them", list));
      patterns.push_back(pattern);
    }
  }
  return TraceGroups(std::move(patterns));
}

// File names come from the system: they may be no UTF-8.
void write_json(const std::string& file, const nlohmann::json& value, const std::string& option) {
  std::ofstream out(file);
  out << value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  out.flush();
  if (!out) throw UsageError(fmt::format("{} {}: cannot be written; expected a writable place", option, file));
}

}  // namespace brick
