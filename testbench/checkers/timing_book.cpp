#include "testbench/checkers/timing_book.h"

#include <fmt/format.h>

#include "systemc/machine/machine.h"

namespace brick {

TimingBook::TimingBook(Machine& machine) : machine_(machine) {
  add(port_a_.ledger());
  machine.check_bus_cycle = [this](const PortACycle& c) {
    if (on_cycle) on_cycle(c);
  };
  pins_.on_cycle = [this](const PinCycle& c) { port_a_.cycle(c); };
  pins_.board_moved(machine.now_fs(), machine.outputs());
  pins_.set_pin_delay(machine.skew().of_strobe(false));
  machine.attach_port_a_watch(&pins_);
  add(isa_.ledger());
  isa_.set_cpu_period([&machine] { return machine.cpu_period(); });
  machine.on_host_bus = [this](TimeFs time, const BoardInputs& in, const BoardOutputs& out) {
    isa_.pins(time, in, out);
  };
  machine.apply();  // tells it of the pins as they stand
}

TimingBook::~TimingBook() {
  machine_.attach_port_a_watch(nullptr);
  machine_.check_bus_cycle = nullptr;
  machine_.on_host_bus = nullptr;
}

void TimingBook::add(TimingLedger& ledger) {
  ledgers_.push_back(&ledger);
  ledger.on_violation = [this, &ledger](const TimingViolation& v) {
    if (on_violation) on_violation(ledger, v);
  };
}

std::string TimingBook::place_text(const TimingPlace& where) const {
  std::string text = fmt::format("{}.{:06} ms", where.time / 1'000'000'000'000, where.time / 1'000'000 % 1'000'000);
  if (!where.has_pc) return text;
  const std::string function = machine_.function_at(where.pc);
  return text + fmt::format(", pc 0x{:08X}{}", where.pc, function.empty() ? "" : " in " + function);
}

std::string TimingBook::text(const TimingLedger& ledger, const TimingViolation& v) const {
  const TimingRule& rule = ledger.rules()[v.rule];
  const bool most = rule.kind == TimingRule::Kind::kMost;
  const std::string times = rule.kind == TimingRule::Kind::kHolds
                                ? "did not hold"
                                : fmt::format("{}, {} {} required", timing_text(v.measured),
                                              most ? "at most" : "at least", timing_text(v.required));
  std::string text =
      fmt::format("{} rule {} ({}, {}) at {}, {} of {}: {}; ", ledger.bus(), rule.id, rule.text, rule.source,
                  timing_address(v.where), v.where.write ? "write" : "read", ledger.regions()[v.region], times);
  text += v.count == 1 ? "once" : fmt::format("{} times", v.count);
  text += fmt::format(", first at {}", place_text(v.where));
  if (v.where.space == 'X' || v.where.space == 'Y')
    text += fmt::format(", {} wait states, I52 = {}", v.where.wait_states, v.where.i52);
  return text;
}

}  // namespace brick
