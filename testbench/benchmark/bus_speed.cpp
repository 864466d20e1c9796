// The SystemC engine where every tick counts: a host that reads the status register without a pause, at the shortest
// cycles that the ISA bus allows, a host that reads the dual-ported RAM, and firmware that does nothing but read device
// registers. Each as the machine alone, which the goals are for, and with the checkers of every `brick run`.
#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "testbench/benchmark/benchmark.h"
#include "testbench/benchmark/measure.h"
#include "testbench/checkers/timing_book.h"
#include "testbench/host/host_link.h"

namespace brick {
namespace {

// Reads of the loop in register_loop.S and the instructions that a round of it takes.
constexpr std::uint64_t kAccesses = 64, kInstructions = kAccesses + 1;

struct HostSpeed {
  std::vector<double> status, memory, ratio;  // simulated s/s, us a word, to the idle machine
  std::uint64_t judged = 0;                   // evaluations of the checkers
};

// With the checkers and without in turn, so that both meet the same weather.
void measure_host(const std::string& firmware, double simulated) {
  MachineConfig config;
  config.firmware = firmware;
  Machine machine(sc_core::sc_gen_unique_name("machine"), config);
  HostBus bus(machine);
  HostLink link(bus);
  if (!link.connect(static_cast<Tick>(0.2 * kTicksPerSecond))) return row("SystemC engine", "firmware is silent");
  bus.set_times(isa::kTight);
  const Tick ticks = static_cast<Tick>(simulated * kTicksPerSecond);
  const auto rate = [&](const std::function<void()>& work) {
    const Tick begin = machine.now();
    const double took = seconds(work);
    return static_cast<double>(machine.now() - begin) / kTicksPerSecond / took;
  };
  HostSpeed alone, checked;
  for (int round = 0; round < kRounds; ++round) {
    const double idle = rate([&] { bus.wait(10 * ticks); });
    for (HostSpeed* speed : {&alone, &checked}) {
      std::optional<TimingBook> book;
      if (speed == &checked) book.emplace(machine);
      speed->status.push_back(rate([&] {
        for (const Tick end = machine.now() + ticks; machine.now() < end;) bus.port_status();
      }));
      speed->ratio.push_back(speed->status.back() / idle);
      std::uint64_t words = 0;
      const double memory = rate([&] {
        for (const Tick end = machine.now() + ticks; machine.now() < end; ++words) bus.dpram_read(0x100);
      });
      speed->memory.push_back(static_cast<double>(ticks) / kTicksPerSecond / memory / static_cast<double>(words) * 1e6);
      if (book) speed->judged += book->isa().read_cycles_answered();
    }
  }
  row("SystemC, host reads its status without pause", fmt::format("{:.3f} sim s/s", median(alone.status)),
      ">= 2 sim s/s", median(alone.status) >= 2);
  row("  ratio to the idle machine", fmt::format("{:.4f}", median(alone.ratio)));
  row("  the same under the checkers of the buses", fmt::format("{:.3f} sim s/s", median(checked.status)));
  row("SystemC, host reads the DPRAM without pause", fmt::format("{:.3f} us a word", median(alone.memory)));
  row("  the same under the checkers of the buses", fmt::format("{:.3f} us a word", median(checked.memory)));
  if (checked.judged == 0) throw std::logic_error("the checkers have seen no read");
}

void measure_firmware(std::uint64_t accesses) {
  MachineConfig config;
  config.firmware = BRICK_REGISTER_LOOP;
  Machine machine(sc_core::sc_gen_unique_name("machine"), config);
  machine.run_until(static_cast<Tick>(0.001 * kTicksPerSecond));
  std::vector<double> alone, checked;
  for (int round = 0; round < kRounds; ++round) {
    for (std::vector<double>* cost : {&alone, &checked}) {
      std::optional<TimingBook> book;
      if (cost == &checked) book.emplace(machine);
      const std::uint64_t before = machine.instructions();
      const double took = seconds([&] {
        while (machine.instructions() - before < accesses) machine.run_until(machine.now() + 100'000);
      });
      cost->push_back(took / static_cast<double>(machine.instructions() - before) * kInstructions / kAccesses * 1e6);
    }
  }
  row("SystemC, firmware reads device registers", fmt::format("{:.3f} us an access", median(alone)),
      "<= 0.3 us an access", median(alone) <= 0.3);
  row("  the same under the checkers of the buses", fmt::format("{:.3f} us an access", median(checked)));
}

}  // namespace

void measure_bus(const std::string& firmware, double simulated) {
  measure_host(firmware, simulated);
  measure_firmware(static_cast<std::uint64_t>(2e6 * simulated));
}

}  // namespace brick
