#include "app/run_bench.h"

#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/build_info.h"
#include "app/hand_encoder.h"
#include "app/script_player.h"
#include "app/session_end.h"
#include "app/set_up.h"
#include "app/simulation.h"
#include "systemc/core/usage_error.h"
#include "systemc/cosim/engines.h"

namespace brick {

namespace {

const Bench& need_bench(const std::vector<Bench>& benches, const std::string& name) {
  if (const Bench* bench = find_bench(benches, name)) return *bench;
  std::vector<std::string> names;
  for (const Bench& bench : benches) names.push_back(bench.name);
  throw UsageError(fmt::format("{}: no such bench; expected {}", name, fmt::join(names, " or ")));
}

// 0: as much as it has by itself.
std::uint64_t size_of(const Bench& bench, const std::string& text) {
  if (text.empty()) return 0;
  if (bench.least_size == 0)
    throw UsageError(fmt::format("--size {}: {} has an end of its own; expected no --size", text, bench.name));
  const std::uint64_t size = parse_count("--size", text);
  if (size < bench.least_size)
    throw UsageError(
        fmt::format("--size {}: is too little for {}; expected {} or more", text, bench.name, bench.least_size));
  return size;
}

// The motors that it brings along, at channels of this board.
std::vector<plant::AxisParameters> motors_of(const Bench& bench, std::uint32_t fitted) {
  std::vector<plant::AxisParameters> motors;
  if (bench.motors == nullptr) return motors;
  for (plant::AxisParameters& axis : bench.motors()) {
    const auto place = motor_place(fitted, static_cast<unsigned>(motors.size()) + 1);
    if (!place) break;
    axis.ic = place->ic;
    axis.channel = place->channel;
    motors.push_back(axis);
  }
  return motors;
}

nlohmann::json steps_json(const BenchReport& report) {
  nlohmann::json list = nlohmann::json::array();
  for (const BenchStep& s : report.steps())
    list.push_back({{"ns", fs_to_ns(tick_to_fs(s.at))}, {"name", s.name}, {"passed", s.passed}, {"detail", s.detail}});
  return list;
}

// Those of the bench by its name; those of the buses, which every bench has, by rule and region.
nlohmann::json covers_json(const Bench& bench, const BenchReport& report, const TimingBook& timing) {
  nlohmann::json list = nlohmann::json::object();
  const auto add = [&](const std::string& name, const Cover& cover) {
    list[name] = {{"count", cover.count}, {"least", cover.least}};
  };
  for (const auto& [name, cover] : report.covers()) add(bench.name + ": " + name, cover);
  for (const TimingLedger* ledger : timing.ledgers())
    for (unsigned rule = 0; rule < ledger->rules().size(); ++rule)
      for (unsigned region = 0; region < ledger->regions().size(); ++region)
        if (const std::uint64_t judged = ledger->row(rule, region).evaluations; judged > 0)
          add(fmt::format("bus: {}, {}", ledger->rules()[rule].id, ledger->regions()[region]), {judged, 1});
  return list;
}

}  // namespace

int run_bench(const std::vector<Bench>& benches, const RunOptions& given, const std::string& name, bool negative,
              const RunExtras& extras) {
  const Bench& bench = need_bench(benches, name);
  RunOptions options = given;
  if (options.board.empty()) options.board = bench.board;
  MachineConfig config = machine_config(options);
  if (!bench.need.met(config.board))
    throw UsageError(fmt::format("{} needs {}, which board {} has not; expected a board such as {}", bench.name,
                                 bench.need.what, config.board.name, bench.board));
  if (!bench.firmware) config.firmware.clear();
  if (negative && bench.negative.seed_bug) bench.negative.seed_bug(config);
  const std::uint64_t size = size_of(bench, options.size);
  const SetUp set_up(options);
  if (!set_up.empty() && !bench.firmware)
    throw UsageError(fmt::format("--load {}: nobody takes it, because no firmware runs in {}; expected no --load",
                                 options.load, bench.name));
  if (!extras.of_firmware.empty() && !bench.firmware)
    throw UsageError(fmt::format("{}: no firmware runs in {}; expected no {}", extras.of_firmware, bench.name,
                                 extras.of_firmware.substr(0, extras.of_firmware.find(' '))));
  const auto motors = motors_of(bench, config.board.fitted);
  Simulation simulation(options, config, bench.name, motors);
  set_up.check(simulation);
  if (extras.before) extras.before(simulation);
  std::cout << fmt::format("{}: {}, engine {}, board {}, seed {}{}{}{}\n", bench.name, bench.description,
                           options.engine, config.board.name, config.seed,
                           config.aperture > 0 ? fmt::format(", aperture {} ns", options.aperture) : "",
                           config.skew ? ", skew" : "", negative ? ", NEGATIVE CONTROL: " + bench.negative.does : "");
  BenchReport report(std::cout, simulation.machine());
  bool answered = false;
  try {
    simulation.run([&] {
      if (bench.firmware) {
        const bool up = simulation.link().connect(HostLink::kBootTime);
        report.step(
            "controller answers", up,
            up ? "I3=2 I6=1 I4=0" : no_answer(simulation) + ", expected an acknowledge within 500 ms of power-on");
        if (!up) return;
        answered = true;
        set_up.send(simulation);
      }
      BenchContext context{simulation.machine(),
                           simulation.bus(),
                           simulation.link(),
                           report,
                           config.board,
                           config.seed,
                           negative,
                           simulation.timing(),
                           config.bcr.has_value(),
                           simulation.plant(),
                           static_cast<unsigned>(motors.size()),
                           size};
      bench.run(context);
    });
  } catch (const LockstepDifference& e) { report.fail("engines agree", e.what()); } catch (const HostBusError& e) {
    report.fail("host", e.what());
  } catch (const ScriptFailure& e) { report.fail("set-up is taken", e.what()); } catch (const GdbKilled& e) {
    report.fail("debugger", e.what());
  } catch (const Interrupted& e) { report.fail("run to its end", e.what()); } catch (const std::exception& e) {
    report.fail("no error of the run", e.what());  // a file of results, for example
  }
  if (answered && !negative && !report.passed() && simulation.bus().tripped())
    report.fail("watchdog at the end", "has tripped, the CPU stands at " + simulation.machine().cpu_place());
  for (const std::string& error : simulation.machine().take_run_errors()) {
    report.fail("no error of the machine", error);
    std::cerr << "brick " << extras.command << ": " << error << '\n';
  }
  const Simulation::TimingVerdict timing = simulation.timing_verdict();
  for (const std::string& violation : timing.failures) report.fail("bus timing", violation);
  for (const auto* list : {&timing.failures, &timing.waived, &timing.unused})
    for (const std::string& line : *list) std::cerr << "brick " << extras.command << ": " << line << '\n';
  nlohmann::json results = simulation.measures();
  try {
    if (extras.after) extras.after(simulation, results);
  } catch (const std::exception& e) { report.fail("results are written", e.what()); }
  std::cout << fmt::format("{} {}\n{}\n", report.passed() ? "PASS" : "FAIL", bench.name, simulation.measures_text());
  if (!std::cout.flush()) {
    const std::string lost = "stdout took no more; expected room for what the command prints";
    report.fail("output is written", lost);
    std::cerr << "brick " << extras.command << ": " << lost << '\n';
  }
  const bool passed = report.passed();
  results["bench"] = bench.name;
  results["engine"] = options.engine;
  results["board"] = config.board.name;
  results["seed"] = config.seed;
  results["negative"] = negative;
  results["verdict"] = passed ? "PASS" : "FAIL";
  results["steps"] = steps_json(report);
  results["covers"] = covers_json(bench, report, simulation.timing());
  if (!options.wave.empty()) results["wave"] = options.wave;
  add_origin(results, config.firmware);
  if (!options.json.empty()) write_json(options.json, results);
  return passed ? 0 : 1;
}

}  // namespace brick
