// `brick timing`: a bench's run as a bus-timing report, or the least wait states of each region (docs/timing.md).
#include <unistd.h>
#include <cstdio>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/run_bench.h"
#include "app/simulation.h"
#include "systemc/core/usage_error.h"
#include "testbench/checkers/timing_report.h"
#include "testbench/checkers/timing_sweep.h"

namespace brick {

namespace {

int sweep_command(const TimingOptions& options) {
  MachineConfig config = machine_config(options.run);
  if (config.bcr) throw UsageError("--bcr: --sweep sets the wait states itself; expected one of the two");
  const std::pair<const char*, bool> of_a_bench[] = {{"--wavedrom", !options.wavedrom.empty()},
                                                     {"--wave", !options.run.wave.empty()},
                                                     {"--waive", options.run.waive.has_value()},
                                                     {"--gdb", !options.run.gdb.empty()}};
  for (const auto& [option, given] : of_a_bench)
    if (given) throw UsageError(fmt::format("{}: --sweep runs no bench; expected one of the two", option));
  config.firmware.clear();
  Machine machine("brick", config);
  const bool terminal = isatty(STDERR_FILENO) == 1;
  const auto cells = timing_sweep(machine, config.seed, [&](unsigned i52) {
    if (terminal) fmt::print(stderr, "\r\033[Ksweep: I52 = {}", i52);
  });
  if (terminal) std::fputs("\r\033[K", stderr);
  std::cout << fmt::format("least wait states by region, engine {}, board {}, seed {}\n{}", options.run.engine,
                           config.board.name, config.seed, sweep_table(cells));
  if (options.run.json.empty()) return 0;
  nlohmann::json list = nlohmann::json::array();
  for (const SweepCell& c : cells) {
    const PortATiming names;
    list.push_back({{"i52", c.i52},
                    {"region", names.ledger().regions()[c.region]},
                    {"least", c.least ? nlohmann::json(*c.least) : nlohmann::json()},
                    {"below", c.below},
                    {"address", c.address}});
  }
  const nlohmann::json results = {
      {"engine", options.run.engine}, {"board", config.board.name}, {"seed", config.seed}, {"sweep", list}};
  write_json(options.run.json, results);
  return 0;
}

}  // namespace

int timing_command(const std::vector<Bench>& benches, const TimingOptions& options) {
  if (options.sweep && options.bench.empty()) return sweep_command(options);
  if (options.sweep)
    throw UsageError(fmt::format("{}: --sweep drives the bus itself; expected no bench", options.bench));
  if (options.bench.empty()) throw UsageError("no bench; expected one of `brick list`, or --sweep");
  if (!options.wavedrom.empty()) need_folder("--wavedrom", options.wavedrom);
  std::unique_ptr<TimingProfile> profile;
  RunExtras extras;
  extras.command = "timing";
  extras.before = [&](Simulation& s) {
    profile = std::make_unique<TimingProfile>(s.machine());
    s.timing().on_cycle = [&](const PortACycle& c) { profile->cycle(c); };
  };
  extras.after = [&](Simulation& s, nlohmann::json& results) {
    const TimeFs run = s.machine().now_fs();
    const PortATiming& port_a = s.timing().port_a();
    std::cout << timing_table(s.timing())
              << fmt::format("/TA moved inside its window (118, 119): seen {}, not seen {}\n", port_a.ta_moves().seen,
                             port_a.ta_moves().missed)
              << timing_spans(*profile) << timing_load(*profile, run);
    results["timing"] = timing_json(s.timing(), *profile, run);
    if (!options.wavedrom.empty()) {
      if (!port_a.worst_read())
        throw UsageError(fmt::format("--wavedrom {}: the bench made no read; expected one", options.wavedrom));
      const std::string caption = fmt::format(
          "{}: the read with the least margin, {}", options.bench,
          s.timing().place_text({port_a.worst_read()->start, 0, ' ', false, true, port_a.worst_read()->pc}));
      write_json(options.wavedrom, timing_figure(*port_a.worst_read(), caption), "--wavedrom");
    }
    profile.reset();
  };
  return run_bench(benches, options.run, options.bench, false, extras);
}

}  // namespace brick
