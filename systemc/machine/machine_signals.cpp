// Named signals of the machine, see machine_signals.h.
#include "systemc/machine/machine_signals.h"

#include "systemc/cpu/cpu.h"

namespace brick {

MachineSignals::MachineSignals(Signals& signals) : signals_(signals) {
  for (const PinField& f : pin::kAll)
    pin_.push_back(signals.add(std::string(f.name), f.width, f.hex ? Radix::kHex : Radix::kBinary));
  source_ = signals.add("clock.source", 13, Radix::kDecimal);
  la_ = signals.add("host.isa.la", 7, Radix::kHex);
  sa_ = signals.add("host.isa.sa", 20, Radix::kHex);
  sbhe_n_ = signals.add("host.isa.sbhe_n", 1, Radix::kBinary, 1);
  sd_ = signals.add("host.isa.sd", 16, Radix::kHex);
  ior_n_ = signals.add("host.isa.ior_n", 1, Radix::kBinary, 1);
  iow_n_ = signals.add("host.isa.iow_n", 1, Radix::kBinary, 1);
  memr_n_ = signals.add("host.isa.memr_n", 1, Radix::kBinary, 1);
  memw_n_ = signals.add("host.isa.memw_n", 1, Radix::kBinary, 1);
  aen_ = signals.add("host.isa.aen", 1, Radix::kBinary);
  resetdrv_ = signals.add("host.isa.resetdrv", 1, Radix::kBinary);
  jpan_ = signals.add("host.jpan", 16, Radix::kHex, 0xFFFF);
  init_n_ = signals.add("host.init_n", 1, Radix::kBinary, 1);
  mi1_ = signals.add("host.mi1", 1, Radix::kBinary);
  mi2_ = signals.add("host.mi2", 1, Radix::kBinary);
  axexp0_ = signals.add("host.axexp0", 1, Radix::kBinary);
  axexp1_ = signals.add("host.axexp1", 1, Radix::kBinary);
  pwr_good_ = signals.add("watchdog.pwr_good", 1, Radix::kBinary, 1);
  pc_ = signals.add("cpu.pc", 32, Radix::kHex);
  task_ = signals.add("cpu.task", 2, Radix::kDecimal);
  symbol_ = signals.add("cpu.symbol", 1, Radix::kText);
}

void MachineSignals::outputs(TimeFs time, const BoardOutputs& before, const BoardOutputs& after) {
  BoardOutputs moved;
  for (unsigned i = 0; i < kBoardOutputWords; ++i) moved.w[i] = before.w[i] ^ after.w[i];
  for (std::size_t i = 0; i < pin::kAll.size(); ++i)
    if (moved.get(pin::kAll[i]) != 0) signals_.set(pin_[i], time, after.get(pin::kAll[i]));
  if (before.get(pin::kPhaseSource) != after.get(pin::kPhaseSource))
    signals_.set(source_, time, clock_source_variable(after.get(pin::kPhaseSource)));
  static constexpr BoardOutputs kData = select_pins(pin::kIsaSd, pin::kIsaSdOe);
  if (before.differs(after, kData)) data_bus(time, after);
}

void MachineSignals::inputs(TimeFs time, const HostInputs& in, const BoardOutputs& board) {
  signals_.set(la_, time, in.isa_la);
  signals_.set(sa_, time, in.isa_sa);
  signals_.set(sbhe_n_, time, in.isa_sbhe_n);
  signals_.set(ior_n_, time, in.isa_ior_n);
  signals_.set(iow_n_, time, in.isa_iow_n);
  signals_.set(memr_n_, time, in.isa_memr_n);
  signals_.set(memw_n_, time, in.isa_memw_n);
  signals_.set(aen_, time, in.isa_aen);
  signals_.set(resetdrv_, time, in.isa_resetdrv);
  signals_.set(jpan_, time, in.jpan);
  signals_.set(init_n_, time, in.jpan_init_n);
  signals_.set(mi1_, time, in.mi1);
  signals_.set(mi2_, time, in.mi2);
  signals_.set(axexp0_, time, in.axexp0);
  signals_.set(axexp1_, time, in.axexp1);
  signals_.set(pwr_good_, time, in.pwr_good);
  host_reads_ = !in.isa_ior_n || !in.isa_memr_n;
  host_data_ = in.isa_sd;
  data_bus(time, board);
}

// SD belongs to the board during a read command, pulled up where it drives nothing, else to the host.
void MachineSignals::data_bus(TimeFs time, const BoardOutputs& board) {
  const unsigned driven = board.get(pin::kIsaSdOe);
  const unsigned floats = ((driven & 1) != 0 ? 0u : 0x00FFu) | ((driven & 2) != 0 ? 0u : 0xFF00u);
  signals_.set(sd_, time, host_reads_ ? board.get(pin::kIsaSd) | floats : host_data_);
}

void MachineSignals::pc(TimeFs time, std::uint32_t pc, const ElfFile* elf) {
  signals_.set(pc_, time, pc);
  if (elf != nullptr) signals_.set_text(symbol_, time, elf->symbol_at(pc));
}

void MachineSignals::trap(TimeFs time, std::uint32_t cause) {
  unsigned task = this->task();
  interrupted_.push_back(task);
  constexpr std::uint32_t kInterrupt = 0x8000'0000;
  if (cause == (kInterrupt | kIrqPhase)) task = 3;
  if (cause == (kInterrupt | kIrqServo)) task = 2;
  if (cause == (kInterrupt | kIrqRealTime)) task = 1;
  signals_.set(task_, time, task);
}

void MachineSignals::trap_return(TimeFs time) {
  if (interrupted_.empty()) return;
  signals_.set(task_, time, interrupted_.back());
  interrupted_.pop_back();
}

void MachineSignals::restart(TimeFs time) {
  interrupted_.clear();
  signals_.set(task_, time, 0);
}

}  // namespace brick
