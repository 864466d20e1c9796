// Named timing rules and what a run did to them. Each bus has a TimingLedger with the rules and regions of its part of
// the data sheet (Port A: host-bus:2.2; ISA: host-bus:3.4); its checker measures at the pins and enters each evaluation
// with the time that the formula asks for at that moment. The ledger keeps the least margin of each rule in each
// region, and a violation once per rule and address with its count. Reports, waivers and the debugger read ledgers
// alone, so a further bus adds a table of rules, a checker, and nothing else.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

struct TimingRule {
  enum class Kind {
    kLeast,  // measured may not be less than required
    kMost,   // nor more
    kHolds   // a condition without a time
  };
  std::string id;      // as reports and waivers name it, one word: "104"
  std::string text;    // what is measured: "address, AA valid to read data valid"
  std::string source;  // rule of the data sheet: "host-bus:2.2/104"
  Kind kind = Kind::kLeast;
};

// Where in time, in the address space and in the program something was measured.
struct TimingPlace {
  TimeFs time = 0;
  std::uint32_t address = 0;
  char space = ' ';  // 'X', 'Y'; the ISA bus: 'I' for I/O, 'M' for memory
  bool write = false;
  bool has_pc = false;                // false: a host's cycle
  std::uint32_t pc = 0;               // of the load or store
  unsigned wait_states = 0, i52 = 0;  // Port A: of the cycle
};

// One rule in one region.
struct TimingRow {
  std::uint64_t evaluations = 0, violations = 0;
  TimeFs margin = kForever;  // the least one; below zero is a violation
  TimeFs required = 0, measured = 0;
  TimingPlace where;  // of the least margin
};

// One rule at one address.
struct TimingViolation {
  unsigned rule = 0, region = 0;
  std::uint64_t count = 0;
  TimeFs required = 0, measured = 0;  // of the first
  TimingPlace where;                  // the first
};

class TimingLedger {
 public:
  // `spaces`: those of TimingPlace that the bus has.
  TimingLedger(std::string bus, std::string spaces, std::vector<TimingRule> rules, std::vector<std::string> regions);

  // One evaluation; `rule` and `region` are indices. For kHolds measured is 0 when the condition held.
  void enter(unsigned rule, unsigned region, TimeFs required, TimeFs measured, const TimingPlace& where) {
    TimingRow& row = rows_[region * rules_.size() + rule];
    ++row.evaluations;
    const TimeFs margin = rules_[rule].kind == TimingRule::Kind::kLeast ? measured - required : required - measured;
    if (margin < row.margin) set_worst(row, margin, required, measured, where);
    if (margin < 0) violated(rule, region, required, measured, where);
  }
  void holds(unsigned rule, unsigned region, bool held, const TimingPlace& where) {
    enter(rule, region, 0, held ? 0 : 1, where);
  }

  const std::string& bus() const { return bus_; }
  const std::string& spaces() const { return spaces_; }
  const std::vector<TimingRule>& rules() const { return rules_; }
  const std::vector<std::string>& regions() const { return regions_; }
  const TimingRow& row(unsigned rule, unsigned region) const { return rows_[region * rules_.size() + rule]; }
  const std::vector<TimingViolation>& violations() const { return violations_; }  // in order of their first time
  void forget();                                                                  // all evaluations and violations

  // At the first violation of a rule at an address.
  std::function<void(const TimingViolation&)> on_violation;

 private:
  static void set_worst(TimingRow& row, TimeFs margin, TimeFs required, TimeFs measured, const TimingPlace& where) {
    row.margin = margin;
    row.required = required;
    row.measured = measured;
    row.where = where;
  }
  void violated(unsigned rule, unsigned region, TimeFs required, TimeFs measured, const TimingPlace& where);

  std::string bus_, spaces_;
  std::vector<TimingRule> rules_;
  std::vector<std::string> regions_;
  std::vector<TimingRow> rows_;  // region by region
  std::vector<TimingViolation> violations_;
  std::map<std::pair<unsigned, std::uint64_t>, std::size_t> found_;  // rule, space and address -> index
};

// "45.123 ns"
std::string timing_text(TimeFs time);
// "X:$078000", "I/O 0x213", "memory 0xD0000"
std::string timing_address(const TimingPlace& where);

}  // namespace brick
