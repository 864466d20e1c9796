// Named signals of the machine, see machine_signals.h.
#include "systemc/machine/machine_signals.h"

#include <array>

#include "rtl/pins/board_inputs.hpp"
#include "systemc/cpu/cpu.h"

namespace brick {

namespace {

// Place in pin::kAll of the field that holds each bit of the output words.
using Places = std::array<std::array<std::uint8_t, 32>, kBoardOutputWords>;
constexpr Places kPlaces = [] {
  Places places{};
  for (std::size_t i = 0; i < pin::kAll.size(); ++i)
    for (unsigned bit = 0; bit < pin::kAll[i].width; ++bit)
      places[pin::kAll[i].word][pin::kAll[i].lsb + bit] = static_cast<std::uint8_t>(i);
  return places;
}();

}  // namespace

MachineSignals::MachineSignals(Signals& signals) : signals_(signals) {
  for (const PinField& f : pin::kAll)
    pin_.push_back(signals.add(std::string(f.name), f.width, f.hex ? Radix::kHex : Radix::kBinary));
  source_ = signals.add("clock.source", 13, Radix::kDecimal);
  static constexpr HostInputs kIdle;
  const auto add = [&](const auto& f) {
    in_.push_back(signals.add(std::string(f.name), f.width, f.hex ? Radix::kHex : Radix::kBinary, kIdle.*f.pin));
    if (f.name == "host.isa.sd") sd_ = in_.back();
  };
  std::apply([&](const auto&... f) { (add(f), ...); }, kInputSignals);
  pc_ = signals.add("cpu.pc", 32, Radix::kHex);
  task_ = signals.add("cpu.task", 2, Radix::kDecimal);
  symbol_ = signals.add("cpu.symbol", 1, Radix::kText);
}

void MachineSignals::outputs(TimeFs time, const BoardOutputs& before, const BoardOutputs& after) {
  for (unsigned word = 0; word < kBoardOutputWords; ++word) {
    for (std::uint32_t moved = before.w[word] ^ after.w[word]; moved != 0;) {
      const std::size_t i = kPlaces[word][static_cast<unsigned>(__builtin_ctz(moved))];
      const PinField& field = pin::kAll[i];
      signals_.set(pin_[i], time, after.get(field));
      moved &= ~(pin_mask(field.width) << field.lsb);
    }
  }
  if (before.get(pin::kPhaseSource) != after.get(pin::kPhaseSource))
    signals_.set(source_, time, clock_source_variable(after.get(pin::kPhaseSource)));
  static constexpr BoardOutputs kData = select_pins(pin::kIsaSd, pin::kIsaSdOe);
  if (before.differs(after, kData)) data_bus(time, after);
}

void MachineSignals::inputs(TimeFs time, const HostInputs& in, const BoardOutputs& board) {
  auto id = in_.begin();
  const auto show = [&](const auto& f) {
    if (*id != sd_) signals_.set(*id, time, in.*f.pin);  // SD is everybody's: data_bus()
    ++id;
  };
  std::apply([&](const auto&... f) { (show(f), ...); }, kInputSignals);
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
