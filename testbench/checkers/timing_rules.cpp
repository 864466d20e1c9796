#include "testbench/checkers/timing_rules.h"

#include <fmt/format.h>

namespace brick {

TimingLedger::TimingLedger(std::string bus, std::string spaces, std::vector<TimingRule> rules,
                           std::vector<std::string> regions)
    : bus_(std::move(bus)),
      spaces_(std::move(spaces)),
      rules_(std::move(rules)),
      regions_(std::move(regions)),
      rows_(rules_.size() * regions_.size()) {}

void TimingLedger::violated(unsigned rule, unsigned region, TimeFs required, TimeFs measured,
                            const TimingPlace& where) {
  ++rows_[region * rules_.size() + rule].violations;
  const std::uint64_t address = where.address | static_cast<std::uint64_t>(where.space) << 32;
  const auto [entry, first] = found_.emplace(std::make_pair(rule, address), violations_.size());
  if (first) violations_.push_back({rule, region, 0, required, measured, where});
  TimingViolation& violation = violations_[entry->second];
  ++violation.count;
  if (first && on_violation) on_violation(violation);
}

void TimingLedger::forget() {
  rows_.assign(rows_.size(), {});
  violations_.clear();
  found_.clear();
}

std::string timing_text(TimeFs time) { return fmt::format("{:.3f} ns", static_cast<double>(time) / kFsPerNs); }

std::string timing_address(const TimingPlace& where) {
  switch (where.space) {
    case 'I':
      return fmt::format("I/O 0x{:03X}", where.address);
    case 'M':
      return fmt::format("memory 0x{:06X}", where.address);
    default:
      return fmt::format("{}:${:06X}", where.space, where.address);
  }
}

}  // namespace brick
