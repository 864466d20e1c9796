#include "testbench/unit/component/traffic.h"

namespace brick::component {

Seen run(Block& block, const Traffic& traffic) {
  Seen seen;
  auto pin = traffic.pins.begin();
  auto access = traffic.accesses.begin();
  const auto next_edge = [](Picoseconds time) {
    return (edge_after(time) + kTicksPerRef - 1) / kTicksPerRef * kTicksPerRef;
  };
  Tick at = access == traffic.accesses.end() ? kNever : next_edge(access->idle);
  std::map<std::string, std::uint32_t> shown = block.outputs();
  for (Tick t = 1; edge_time(t) < traffic.end; ++t) {
    for (; pin != traffic.pins.end() && pin->time < edge_time(t); ++pin) block.set(pin->pin, pin->value);
    const bool reads = t == at && !access->write;
    const std::uint32_t value = reads ? block.read(access->address) : 0;
    if (t == at) block.before(*access);
    block.edge(t);
    if (t == at) {
      block.accessed(*access);
      seen.answers.emplace_back(edge_time(t), reads ? value : access->value);
      at = ++access == traffic.accesses.end() ? kNever : next_edge(edge_time(t) + access->idle);
    }
    if (!block.moved()) continue;
    std::map<std::string, std::uint32_t> now = block.outputs();
    for (const auto& [name, level] : now)
      if (shown[name] != level) seen.changes.emplace_back(edge_time(t), name, level);
    shown = std::move(now);
  }
  return seen;
}

}  // namespace brick::component
