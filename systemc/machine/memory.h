// What the CPU sees as memory (docs/architecture.md, memory map): code, private RAM, PMAC main memory, straps page, and
// the flash store with its file.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/cpu/cpu.h"
#include "systemc/machine/flash_file.h"

namespace brick {

class MachineMemory {
 public:
  static constexpr std::uint32_t kCode = 0x1000'0000, kCodeBytes = 1u << 20;
  static constexpr std::uint32_t kRam = 0x2000'0000, kRamBytes = 2u << 20;
  static constexpr std::uint32_t kFlash = 0x3000'0000, kFlashBytes = 1u << 20;
  static constexpr std::uint32_t kStraps = 0x3FFF'F000, kStrapsBytes = 4096;
  static constexpr std::uint32_t kMain = 0xC000'0000, kMainBytes = 8 * regs::kMainMemorySize;  // X and Y words

  // Maps everything; reads `flash_file` or makes it. Throws std::runtime_error with one clear line.
  // `ssi_page`: that page of main memory belongs to Port A (servo-ic:11.4).
  MachineMemory(Cpu& cpu, std::string flash_file, bool ssi_page = false);
  void set_main_wait(Cycle wait);

  // Words of the straps page.
  enum class Strap : std::uint32_t { kJumperE3 = 0, kFitted, kCard, kDpramWords, kPowerOn, kProduct };
  void set_strap(Strap strap, std::uint32_t value);

  void randomize(std::uint64_t seed);  // RAM content after power-on
  void save_flash();                   // to the file, if there is one; throws std::runtime_error
  // Called when a SAVE is complete: its last write says that the image before it is outdated (docs/save.md).
  std::function<void()> on_saved;

 private:
  // The firmware's store: two slots, of each the first word is its state.
  static constexpr std::uint32_t kSlotStates[] = {kFlash, kFlash + kFlashBytes / 2}, kOutdated = 0;

  struct Part {
    std::uint32_t base, bytes;
  };
  Cpu& cpu_;
  std::vector<Part> main_;  // of main memory, around what belongs to others
  FlashFile flash_file_;
};

}  // namespace brick
