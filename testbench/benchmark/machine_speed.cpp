// The whole controller on one engine: idle, asked without a pause, and idle with waveforms.
#include <fmt/format.h>

#include "systemc/core/trace.h"
#include "testbench/benchmark/benchmark.h"
#include "testbench/benchmark/measure.h"
#include "testbench/host/host_link.h"

namespace brick {

void measure_machine(Engine engine, const std::string& name, const std::string& firmware, double simulated,
                     const std::string& wave) {
  MachineConfig config;
  config.engine = engine;
  config.firmware = firmware;
  Machine machine(sc_core::sc_gen_unique_name("machine"), config);
  HostBus bus(machine);
  HostLink link(bus);
  if (!link.connect(static_cast<Tick>(0.2 * kTicksPerSecond)))
    return row(fmt::format("{} engine", name), "firmware is silent");

  const auto ticks = static_cast<Tick>(simulated * kTicksPerSecond);
  const auto idle_rate = [&](Tick length) {
    return static_cast<double>(length) / kTicksPerSecond / seconds([&] { machine.run_until(machine.now() + length); });
  };
  const bool judged = engine == Engine::kSystemC;
  std::vector<double> idle, busy, instructions, traced, ratio;
  for (int round = 0; round < kRounds; ++round) {
    idle.push_back(idle_rate(ticks));
    {
      const auto writer = TraceWriter::open(wave + ".3.vcd");
      machine.signals().attach(writer.get(), TraceGroups());
      traced.push_back(idle_rate(ticks / 10));
      ratio.push_back(traced.back() / idle.back());
      machine.signals().attach(nullptr);
    }
    const Tick begin = machine.now();
    const std::uint64_t before = machine.instructions();
    const double busy_seconds = seconds([&] {
      while (machine.now() < begin + ticks / 10) link.command("I10,20 P1=P1+SQRT(2) P1");
    });
    busy.push_back(static_cast<double>(machine.now() - begin) / kTicksPerSecond / busy_seconds);
    instructions.push_back(static_cast<double>(machine.instructions() - before) / busy_seconds);
  }
  row(fmt::format("{} engine, idle firmware", name), fmt::format("{:.3f} sim s/s", median(idle)),
      judged ? ">= 10 sim s/s" : "", median(idle) >= 10);
  row("  the same, waveform with the default signals (VCD)", fmt::format("{:.3f} sim s/s", median(traced)));
  row("  ratio to the run without", fmt::format("{:.3f}", median(ratio)), judged ? ">= 0.10" : "",
      median(ratio) >= 0.1);
  row(fmt::format("{} engine, host asks without pause", name), fmt::format("{:.3f} sim s/s", median(busy)));
  row("  instructions", fmt::format("{:.2f} M/s", median(instructions) / 1e6));
}

}  // namespace brick
