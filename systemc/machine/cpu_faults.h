// Exceptions that the firmware has raised: traps that are no interrupts. None is meant to come (docs/firmware.md). One
// that traps in its own handler takes millions, so the first and the last are kept, and how many there were.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class ElfFile;

struct CpuFault {
  std::uint32_t cause = 0, value = 0, pc = 0;  // mcause, mtval, mepc
  std::uint32_t return_address = 0;            // who jumped to where no code is
  TimeFs time = 0;
};

// `0x10000000 (_start)`, without a name where the image has no function there; elf may be nullptr.
std::string place_in_code(const ElfFile* elf, std::uint32_t pc);

// Cause by name, address, pc, function, time.
std::string fault_text(const CpuFault& fault, const ElfFile* elf);

class CpuFaults {
 public:
  void add(const CpuFault& fault);
  void clear() { count_ = 0; }
  std::string last(const ElfFile* elf) const;                // "" = there was none
  std::vector<std::string> texts(const ElfFile* elf) const;  // a line for the first, one for the others

 private:
  std::uint64_t count_ = 0;
  CpuFault first_, last_;
};

}  // namespace brick
