#include "testbench/checkers/timing_sweep.h"

#include <fmt/format.h>

namespace brick {

namespace {

constexpr unsigned kQuick = 24, kSure = 600;  // accesses: to look for the least, to confirm it

class Sweep {
 public:
  Sweep(Machine& machine, std::uint64_t seed) : machine_(machine), traffic_(machine, seed) {
    pins_.on_cycle = [this](const PinCycle& c) { judge_.cycle(c); };
    pins_.board_moved(machine.now_fs(), machine.outputs());
    machine_.attach_port_a_watch(&pins_);
  }
  ~Sweep() { machine_.attach_port_a_watch(nullptr); }

  SweepCell cell(unsigned i52, PortATiming::Region region) {
    SweepCell cell{i52, region, {}, "-"};
    unsigned ws = BusTraffic::most_wait_states(region);
    std::string fails = trial(i52, region, ws, kQuick);
    while (fails.empty() && ws > 1) fails = trial(i52, region, --ws, kQuick);
    if (!fails.empty()) {
      cell.below = fails;
      if (ws++ == BusTraffic::most_wait_states(region)) return cell;
    }
    for (; ws <= BusTraffic::most_wait_states(region); ++ws) {
      fails = trial(i52, region, ws, kSure);
      if (fails.empty()) {
        cell.least = ws;
        break;
      }
      cell.below = fails;
    }
    return cell;
  }
  bool has(PortATiming::Region region) const { return traffic_.has(region); }

 private:
  // What fails: "" or rules.
  std::string trial(unsigned i52, PortATiming::Region region, unsigned ws, unsigned accesses) {
    traffic_.set_wait_states(region, ws);
    traffic_.set_clock(i52 + 1);
    judge_.forget();
    traffic_.exercise(region, accesses);
    std::string fails;
    for (unsigned rule = 0; rule < PortATiming::kRules; ++rule)
      if (judge_.ledger().row(rule, region).violations > 0)
        fails += (fails.empty() ? "" : " ") + judge_.ledger().rules()[rule].id;
    if (!traffic_.verify(region).empty()) fails += fails.empty() ? "write lost" : ", write lost";
    return fails;
  }

  Machine& machine_;
  PinWatch pins_;
  PortATiming judge_;
  BusTraffic traffic_;
};

}  // namespace

std::vector<SweepCell> timing_sweep(Machine& machine, std::uint64_t seed,
                                    const std::function<void(unsigned)>& progress) {
  Sweep sweep(machine, seed);
  std::vector<SweepCell> cells;
  for (unsigned i52 = 0; i52 < BusTraffic::kMultipliers; ++i52) {
    for (unsigned region = 0; region < PortATiming::kRegions; ++region)
      if (sweep.has(static_cast<PortATiming::Region>(region)))
        cells.push_back(sweep.cell(i52, static_cast<PortATiming::Region>(region)));
    if (progress) progress(i52);
  }
  return cells;
}

std::string sweep_table(const std::vector<SweepCell>& cells) {
  const PortATiming names;
  const auto& regions = names.ledger().regions();
  std::string text = fmt::format("{:>4}{:>9}", "I52", "MHz");
  for (const std::string& region : regions) text += fmt::format("  {:<30}", region);
  text += "\n";
  for (std::size_t i = 0; i < cells.size();) {
    const unsigned i52 = cells[i].i52;
    text += fmt::format("{:>4}{:>9.2f}", i52, 9.8304 * (i52 + 1));
    for (unsigned region = 0; region < regions.size(); ++region) {
      std::string entry = "not there";
      if (i < cells.size() && cells[i].i52 == i52 && cells[i].region == region) {
        const SweepCell& c = cells[i++];
        entry = c.least ? fmt::format("{} (below: {})", *c.least, c.below) : fmt::format("none ({})", c.below);
      }
      text += fmt::format("  {:<30}", entry);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

}  // namespace brick
