#include "systemc/machine/cpu_faults.h"

#include <fmt/format.h>

#include "systemc/cpu/elf_file.h"

namespace brick {

namespace {

constexpr std::uint32_t kFetch = 1, kIllegal = 2, kBreakpoint = 3;

// RISC-V privileged architecture, table of mcause.
const char* name_of(std::uint32_t cause) {
  switch (cause) {
    case kFetch:
      return "instruction access fault";
    case kIllegal:
      return "illegal instruction";
    case kBreakpoint:
      return "breakpoint";
    case 4:
      return "misaligned load";
    case 5:
      return "load access fault";
    case 6:
      return "misaligned store";
    case 7:
      return "store access fault";
    case 11:
      return "environment call";
    default:
      return "unknown cause";
  }
}

std::string what(const CpuFault& fault) {
  if (fault.cause == kIllegal) return fmt::format("{} {:#010x}", name_of(fault.cause), fault.value);
  if (fault.cause >= 4 && fault.cause <= 7) return fmt::format("{} at {:#010x}", name_of(fault.cause), fault.value);
  return name_of(fault.cause);
}

}  // namespace

std::string place_in_code(const ElfFile* elf, std::uint32_t pc) {
  const std::string name = elf != nullptr ? elf->symbol_at(pc) : "";
  return fmt::format("{:#010x}{}", pc, name.empty() ? "" : " (" + name + ")");
}

std::string fault_text(const CpuFault& fault, const ElfFile* elf) {
  std::string text = fmt::format("{}, pc {}", what(fault), place_in_code(elf, fault.pc));
  const bool lost = elf == nullptr || elf->symbol_at(fault.pc).empty();
  if (lost) text += ", return address " + place_in_code(elf, fault.return_address);
  return text + fmt::format(", at {:.6f} ms", static_cast<double>(fault.time) * 1e-12);
}

void CpuFaults::add(const CpuFault& fault) {
  if (count_++ == 0) first_ = fault;
  last_ = fault;
}

std::string CpuFaults::last(const ElfFile* elf) const { return count_ > 0 ? fault_text(last_, elf) : ""; }

std::vector<std::string> CpuFaults::texts(const ElfFile* elf) const {
  std::vector<std::string> texts;
  if (count_ > 0)
    texts.push_back(
        fmt::format("exception of the CPU: {}; expected none, see docs/firmware.md, Traps", fault_text(first_, elf)));
  if (count_ > 1)
    texts.push_back(fmt::format("exceptions of the CPU: {} more, the last: {}", count_ - 1, fault_text(last_, elf)));
  return texts;
}

}  // namespace brick
