// Model of rtl/host/dpram_memory.sv: 32768 words of 16 bits. Its two ports are whoever calls.
#pragma once

#include <cstdint>
#include <vector>

namespace brick {

class DpramMemory {
 public:
  static constexpr unsigned kWords = 32768;

  std::uint16_t read(unsigned index) const { return words_[index]; }
  void write(unsigned index, std::uint16_t value, unsigned bytes = 3) {  // bit 0 lower byte, bit 1 upper byte
    const unsigned mask = ((bytes & 1) != 0 ? 0x00FFu : 0u) | ((bytes & 2) != 0 ? 0xFF00u : 0u);
    words_[index] = static_cast<std::uint16_t>((words_[index] & ~mask) | (value & mask));
  }

 private:
  std::vector<std::uint16_t> words_ = std::vector<std::uint16_t>(kWords);
};

}  // namespace brick
