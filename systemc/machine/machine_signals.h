// The machine's named signals (docs/signals.md): board pins, host inputs, and what the CPU does.
#pragma once

#include <string>
#include <vector>

#include "systemc/core/board_pins.h"
#include "systemc/core/signals.h"
#include "systemc/cpu/elf_file.h"

namespace brick {

class MachineSignals {
 public:
  explicit MachineSignals(Signals& signals);

  void outputs(TimeFs time, const BoardOutputs& before, const BoardOutputs& after);
  void inputs(TimeFs time, const HostInputs& in, const BoardOutputs& board);
  bool traces_pc() const { return signals_.traced(pc_) || signals_.traced(symbol_); }
  void pc(TimeFs time, std::uint32_t pc, const ElfFile* elf);

  // cpu.task follows the nesting of traps.
  void trap(TimeFs time, std::uint32_t cause);
  void trap_return(TimeFs time);
  unsigned task() const { return static_cast<unsigned>(signals_.value(task_)); }
  void restart(TimeFs time);

 private:
  void data_bus(TimeFs time, const BoardOutputs& board);

  Signals& signals_;
  std::vector<Signals::Id> pin_;  // as pin::kAll
  std::vector<Signals::Id> in_;   // as kInputSignals
  Signals::Id source_, sd_ = 0, pc_, task_, symbol_;
  bool host_reads_ = false;
  std::uint16_t host_data_ = 0;
  std::vector<unsigned> interrupted_;  // tasks that wait for the present one
};

// Number of the clock-direction I-variable of a source as in BoardInputs::fitted; 0 for external and none.
constexpr unsigned clock_source_variable(unsigned source) {
  if (source < 10) return 7007 + 100 * source;        // servo IC m
  if (source < 18) return 7057 + 100 * (source - 8);  // servo IC m*, m = 2..9
  if (source < 22) return 6807 + 50 * (source - 18);  // MACRO IC
  return 0;
}

}  // namespace brick
