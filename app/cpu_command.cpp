#include "app/cpu_command.h"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "systemc/cpu/cpu.h"
#include "systemc/cpu/elf_file.h"

namespace brick {
namespace {

constexpr std::uint64_t kRamBase = 0x8000'0000, kRamBytes = 128ull << 20;
constexpr std::uint64_t kGranule = 16ull << 20;        // room for a stack behind what the ELF file names
constexpr double kClockMHz = 117.9648 * (7 + 1) / 12;  // I52 at its default of 7
constexpr Cycle kSlice = 10'000'000;                   // cycles between looks at the progress
constexpr Cycle kStuck = 10'000;  // cycles without a retired instruction: a trap whose handler traps

struct Area {
  std::uint64_t first, last;
};

// The RAM of the contract, and what the program's segments need elsewhere, in whole granules.
std::vector<Area> areas_for(const ElfFile& elf) {
  std::vector<Area> areas{{kRamBase, kRamBase + kRamBytes - 1}};
  for (const ElfFile::Range& range : elf.ranges()) {
    const std::uint64_t last = std::uint64_t{range.address} + range.bytes - 1;
    areas.push_back({range.address / kGranule * kGranule,
                     std::min<std::uint64_t>(last / kGranule * kGranule + kGranule - 1, UINT32_MAX)});
  }
  std::sort(areas.begin(), areas.end(), [](const Area& a, const Area& b) { return a.first < b.first; });
  std::vector<Area> merged;
  for (const Area& area : areas) {
    if (!merged.empty() && area.first <= merged.back().last + 1) {
      merged.back().last = std::max(merged.back().last, area.last);
    } else {
      merged.push_back(area);
    }
  }
  return merged;
}

std::string hex(std::uint32_t v) {
  std::ostringstream text;
  text << "0x" << std::hex << v;
  return text.str();
}

std::string place(const ElfFile& elf, std::uint32_t address) {
  const std::string& name = elf.symbol_at(address);
  return hex(address) + (name.empty() ? "" : " (" + name + ")");
}

// What a value stored to tohost says.
std::string verdict(std::uint32_t tohost) {
  if (tohost == 1) return "passed";
  if (tohost % 2 == 1) return "failed with code " + std::to_string(tohost >> 1);
  return "failed: wrote " + hex(tohost) + " to tohost, which asks for a host service; there is none";
}

// Runs to the end and says how it ended.
std::string run_program(Cpu& cpu, const ElfFile& elf, std::uint64_t max_instructions) {
  std::uint32_t tohost = 0, cause = 0, trap_pc = 0;
  cpu.on_store_watch = [&](std::uint32_t, std::uint32_t value) {
    tohost = value;
    return value != 0;
  };
  cpu.on_trap = [&](std::uint32_t trap_cause, std::uint32_t pc, Cycle) {
    if (pc == (cpu.csr(0x305) & ~3u)) return;  // the handler itself: what led there says more
    cause = trap_cause;
    trap_pc = pc;
  };
  Cycle stuck = 0;  // cycles in which no instruction has retired
  while (cpu.instructions() < max_instructions) {
    // An instruction takes at least one cycle, so this many cycles cannot pass the limit of instructions.
    const std::uint64_t before = cpu.instructions();
    const Cycle slice = static_cast<Cycle>(std::min<std::uint64_t>(max_instructions - before, kSlice));
    const Cpu::Stop stop = cpu.run(cpu.cycle() + slice);
    if (stop == Cpu::Stop::kHalt) return verdict(tohost);
    if (stop == Cpu::Stop::kSleep) return "failed: sleeps at " + place(elf, cpu.pc()) + " and nothing can wake it";
    stuck = cpu.instructions() == before ? stuck + slice : 0;
    if (stuck > kStuck) {
      return "failed: trap " + std::to_string(cause) + " at " + place(elf, trap_pc) + " and its handler at " +
             hex(cpu.csr(0x305) & ~3u) + " traps again";
    }
  }
  return "failed: " + std::to_string(max_instructions) + " instructions without a write to tohost, at " +
         place(elf, cpu.pc());
}

}  // namespace

int cpu_command(const std::string& file, std::uint64_t max_instructions) {
  const ElfFile elf(file);
  const auto tohost = elf.symbol("tohost");
  if (!tohost)
    throw std::runtime_error(file + ": has no symbol `tohost`; expected a program that stores its result there");

  Cpu cpu;
  for (const Area& area : areas_for(elf)) {
    // A region's size is a 32-bit number: the whole address space takes two.
    for (std::uint64_t first = area.first; first <= area.last; first += 1ull << 31) {
      const std::uint64_t bytes = std::min<std::uint64_t>(area.last - first + 1, 1ull << 31);
      cpu.map(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(bytes), {});
    }
  }
  elf.load(cpu);
  cpu.reset(elf.entry());
  cpu.watch_store(*tohost);

  const auto start = std::chrono::steady_clock::now();
  const std::string result = run_program(cpu, elf, max_instructions);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const double instructions = static_cast<double>(cpu.instructions()), cycles = static_cast<double>(cpu.cycle());
  std::cout << file << ": " << result << '\n'
            << "instructions    " << cpu.instructions() << '\n'
            << "cycles          " << cpu.cycle() << '\n'
            << std::fixed << std::setprecision(3)  //
            << "simulated time  " << cycles / kClockMHz / 1000.0 << " ms at " << kClockMHz << " MHz\n"
            << std::setprecision(1)  //
            << "rate            " << (wall > 0 ? instructions / wall / 1e6 : 0.0) << " M instructions/s" << std::endl;
  return result == "passed" ? 0 : 1;
}

}  // namespace brick
