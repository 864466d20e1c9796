// The SystemC engine where every tick counts: a host that reads the status register without a pause, at the shortest
// cycles that the ISA bus allows, a host that reads the dual-ported RAM, and firmware that does nothing but read device
// registers.
#include <fmt/format.h>

#include "testbench/benchmark/benchmark.h"
#include "testbench/benchmark/measure.h"
#include "testbench/host/host_link.h"

namespace brick {
namespace {

// Reads of the loop in register_loop.S and the instructions that a round of it takes.
constexpr std::uint64_t kAccesses = 64, kInstructions = kAccesses + 1;

void measure_host(const std::string& firmware, double simulated) {
  MachineConfig config;
  config.firmware = firmware;
  Machine machine(sc_core::sc_gen_unique_name("machine"), config);
  HostBus bus(machine);
  HostLink link(bus);
  if (!link.connect(static_cast<Tick>(0.2 * kTicksPerSecond))) return row("SystemC engine", "firmware is silent");
  std::vector<double> idle, status, memory, ratio;
  std::uint64_t words = 0;
  for (int round = 0; round < kRounds; ++round) {
    const auto run = [&](const std::function<void()>& work) {
      const Tick begin = machine.now();
      const double took = seconds(work);
      return static_cast<double>(machine.now() - begin) / kTicksPerSecond / took;
    };
    const Tick ticks = static_cast<Tick>(simulated * kTicksPerSecond);
    idle.push_back(run([&] { bus.wait(10 * ticks); }));
    status.push_back(run([&] {
      for (const Tick end = machine.now() + ticks; machine.now() < end;) bus.port_status();
    }));
    ratio.push_back(status.back() / idle.back());
    words = 0;
    memory.push_back(static_cast<double>(ticks) / kTicksPerSecond / run([&] {
                       for (const Tick end = machine.now() + ticks; machine.now() < end; ++words) bus.dpram_read(0x100);
                     }) /
                     static_cast<double>(words) * 1e6);
  }
  row("SystemC, host reads its status without pause", fmt::format("{:.3f} sim s/s", median(status)), ">= 2 sim s/s",
      median(status) >= 2);
  row("  ratio to the idle machine", fmt::format("{:.4f}", median(ratio)));
  row("SystemC, host reads the DPRAM without pause", fmt::format("{:.3f} us a word", median(memory)));
}

void measure_firmware(std::uint64_t accesses) {
  MachineConfig config;
  config.firmware = BRICK_REGISTER_LOOP;
  Machine machine(sc_core::sc_gen_unique_name("machine"), config);
  machine.run_until(static_cast<Tick>(0.001 * kTicksPerSecond));
  std::vector<double> cost;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t before = machine.instructions();
    const double took = seconds([&] {
      while (machine.instructions() - before < accesses) machine.run_until(machine.now() + 100'000);
    });
    cost.push_back(took / static_cast<double>(machine.instructions() - before) * kInstructions / kAccesses * 1e6);
  }
  row("SystemC, firmware reads device registers", fmt::format("{:.3f} us an access", median(cost)),
      "<= 0.3 us an access", median(cost) <= 0.3);
}

}  // namespace

void measure_bus(const std::string& firmware, double simulated) {
  measure_host(firmware, simulated);
  measure_firmware(static_cast<std::uint64_t>(2e6 * simulated));
}

}  // namespace brick
