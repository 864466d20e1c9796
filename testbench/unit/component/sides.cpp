#include "testbench/unit/component/sides.h"

namespace brick::component {
namespace {

struct Side {
  const std::vector<Access>& accesses;
  std::vector<Answer>& answers;
  std::size_t next = 0;
  Tick at = kNever;  // first edge after the call
  bool begun = false;

  void call(Picoseconds free) { at = next < accesses.size() ? edge_after(free + accesses[next].idle) : kNever; }
};

}  // namespace

Seen run(Sides& block, const Traffic& traffic) {
  Seen seen;
  Side sides[] = {{traffic.accesses, seen.answers}, {traffic.others, seen.others}};
  for (Side& side : sides) side.call(0);
  std::map<std::string, std::uint32_t> shown = block.outputs();
  auto pin = traffic.pins.begin();
  for (Tick t = 1; edge_time(t) < traffic.end; ++t) {
    for (; pin != traffic.pins.end() && pin->time < edge_time(t); ++pin) block.set(pin->pin, pin->value);
    const auto each = [&](const auto& act) {
      for (unsigned i = 0; i < 2; ++i)
        if (sides[i].at <= t && block.clocked(i, t)) act(i, sides[i]);
    };
    each([&](unsigned i, Side& side) {
      if (!side.begun) block.begin(i, side.accesses[side.next]);
      side.begun = true;
      block.before(i);
    });
    block.edge(t);
    each([&](unsigned i, Side& side) {
      const std::optional<std::uint32_t> value = block.after(i);
      if (!value) return;
      side.answers.emplace_back(edge_time(t), *value);
      side.begun = false;
      ++side.next;
      side.call(edge_time(t));
    });
    if (!block.moved()) continue;
    std::map<std::string, std::uint32_t> now = block.outputs();
    for (const auto& [name, level] : now)
      if (shown[name] != level) seen.changes.emplace_back(edge_time(t), name, level);
    shown = std::move(now);
  }
  return seen;
}

}  // namespace brick::component
