// All that judges the buses of one machine in a run, whatever the engine: the ledgers of the named rules, where a
// violation becomes text. `brick run` and `brick exec` fail on what stands here at the end; docs/timing.md.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "systemc/cpu/port_a.h"
#include "testbench/checkers/isa_checker.h"
#include "testbench/checkers/timing_port_a.h"
#include "testbench/checkers/timing_rules.h"

namespace brick {

class Machine;

class TimingBook {
 public:
  explicit TimingBook(Machine& machine);  // judges each bus cycle of CPU and host from now on
  ~TimingBook();
  TimingBook(const TimingBook&) = delete;
  TimingBook& operator=(const TimingBook&) = delete;

  PortATiming& port_a() { return port_a_; }
  IsaChecker& isa() { return isa_; }
  const PortATiming& port_a() const { return port_a_; }
  void add(TimingLedger& ledger);  // of another bus; not owned
  const std::vector<TimingLedger*>& ledgers() const { return ledgers_; }

  // One line: rule, address, region, required and measured, count, time, program counter and function.
  std::string text(const TimingLedger& ledger, const TimingViolation& violation) const;
  std::string place_text(const TimingPlace& where) const;  // time, program counter and function

  // At the first violation of a rule at an address, in the middle of the access.
  std::function<void(const TimingLedger&, const TimingViolation&)> on_violation;
  std::function<void(const PortACycle&)> on_cycle;  // each cycle of the CPU, on-chip ones too

 private:
  Machine& machine_;
  PinWatch pins_;
  PortATiming port_a_;
  IsaChecker isa_;
  std::vector<TimingLedger*> ledgers_;
};

}  // namespace brick
