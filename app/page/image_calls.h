// Functions of the firmware image, called by the back door: on a CPU of its own that sees the controller's memory and
// cannot write to it. So whoever looks at status words, I-variables or program lines gets what the controller would
// answer, made by the same code, and the controller does not notice.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "systemc/cpu/cpu.h"
#include "systemc/cpu/elf_file.h"
#include "systemc/machine/machine.h"

namespace brick {

class ImageCalls {
 public:
  // `firmware`: the ELF that `machine` runs; both live longer.
  ImageCalls(Machine& machine, const std::string& firmware);

  void refresh();  // the controller has gone on: its private memory is taken anew

  // What the function returns in a0 and a1; nothing if the image has no such function, or if it does what no function
  // that only looks would do: writes to the main memory, reaches for a device, takes a trap or too long.
  std::optional<std::uint64_t> call(const std::string& function, std::initializer_list<std::uint32_t> arguments);

  // Words that a function can be given a pointer to.
  static constexpr std::uint32_t kWords = 0x4000'1000;
  std::uint32_t word(unsigned index);
  void set_word(unsigned index, std::uint32_t value);

  // A function `void put(char)` that a function can be given, and what it has been told since.
  static constexpr std::uint32_t kPut = 0x4000'0010;
  std::string take_text();

 private:
  Machine& machine_;
  ElfFile image_;
  Cpu cpu_;
  std::uint8_t* ram_ = nullptr;  // a copy of what the image uses
  std::uint32_t ram_bytes_ = 0;
  std::string text_;
  bool trapped_ = false;
};

}  // namespace brick
