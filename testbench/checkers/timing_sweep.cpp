#include "testbench/checkers/timing_sweep.h"

#include <fmt/format.h>

namespace brick {

namespace {

class Sweep {
 public:
  Sweep(Machine& machine, std::uint64_t seed) : machine_(machine), traffic_(machine, seed) {
    pins_.on_cycle = [this](const PinCycle& c) { judge_.cycle(c); };
    pins_.board_moved(machine.now_fs(), machine.outputs());
    pins_.set_pin_delay(machine.skew().of_strobe(false));
    machine_.attach_port_a_watch(&pins_);
  }
  ~Sweep() { machine_.attach_port_a_watch(nullptr); }

  SweepCell cell(unsigned i52, PortATiming::Region region) {
    SweepCell cell{i52, region, {}, "-", ""};
    for (unsigned ws = BusTraffic::most_wait_states(region); ws > 0; --ws) {
      if (const std::string fails = trial(i52, region, ws); !fails.empty()) {
        cell.below = fails;
        const auto& violations = judge_.ledger().violations();
        if (!violations.empty()) cell.address = timing_address(violations.front().where);
        break;
      }
      cell.least = ws;
    }
    return cell;
  }
  bool has(PortATiming::Region region) const { return traffic_.has(region); }

 private:
  // What fails: "" or rules.
  std::string trial(unsigned i52, PortATiming::Region region, unsigned ws) {
    traffic_.set_wait_states(region, ws);
    traffic_.set_clock(i52 + 1);
    judge_.forget();
    traffic_.every_phase(region);
    std::string fails;
    for (unsigned rule = 0; rule < PortATiming::kRules; ++rule)
      if (judge_.ledger().row(rule, region).violations > 0)
        fails += (fails.empty() ? "" : " ") + judge_.ledger().rules()[rule].id;
    if (fails.empty() && traffic_.wrong_reads() > 0) fails = "wrong word";
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
