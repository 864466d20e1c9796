#include "testbench/benches/output_host.h"

#include <algorithm>

#include "systemc/cpu/port_a.h"

namespace brick {

OutputHost::OutputHost(BenchContext& b) : ServoHost(b, b.seed * 104'729) {
  changes_.resize(places());
  b.machine.attach(*this);
  b.machine.on_bus_cycle = [this](const PortACycle& c) { cycle(c); };
  b.bus.watch(select_pins(pin::kPhase), [this](Tick t, const BoardOutputs&, const BoardOutputs& o) {
    phase_.push_back({t, o.get(pin::kPhase) != 0});
  });
  forget();
}

OutputHost::~OutputHost() {
  bench().bus.watch({}, nullptr);
  bench().machine.on_bus_cycle = nullptr;
  bench().machine.detach(*this);
}

std::uint32_t OutputHost::ics() const {
  std::uint32_t mask = 0;
  for (const unsigned ic : fitted()) mask |= 1u << ic;
  return mask;
}

void OutputHost::changed(Tick tick, unsigned ic, const MotorOutputs&, const MotorOutputs& after) {
  const auto place = static_cast<std::size_t>(std::find(fitted().begin(), fitted().end(), ic) - fitted().begin());
  changes_.at(place).push_back({tick, after});
}

void OutputHost::forget() {
  for (unsigned place = 0; place < places(); ++place) changes_[place] = {{now(), pins(place)}};
  phase_.clear();
  accesses_.clear();
}

Tick OutputHost::written(unsigned channel, const regs::Register& word) const {
  for (auto a = accesses_.rbegin(); a != accesses_.rend(); ++a)
    if (a->write && a->x == (word.space == 'X') && a->address == address(channel, word)) return a->tick;
  return -1;
}

void OutputHost::cycle(const PortACycle& c) {
  if (c.on_chip || c.address < 0x78000 || c.address > 0x7BFFF) return;
  accesses_.push_back({bus_edge(c, bench().machine) - (c.write ? 0 : 1), c.write, c.x, c.address, c.data});
}

}  // namespace brick
