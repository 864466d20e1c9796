#include "testbench/host/dpram_bytes.h"

namespace brick {

std::uint32_t little_endian(std::string_view four) {
  std::uint32_t value = 0;
  for (std::size_t n = 0; n < 4 && n < four.size(); ++n)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(four[n])) << 8 * n;
  return value;
}

std::string DpramBytes::read(std::uint32_t offset, std::size_t count) {
  std::string bytes;
  std::uint16_t word = 0;
  for (std::uint32_t at = offset; bytes.size() < count; ++at) {
    if (at >= size_) {
      bytes.resize(count, '\0');
      break;
    }
    if (bytes.empty() || at % 2 == 0) word = bus_.dpram_read(at & ~1u);
    bytes.push_back(static_cast<char>(at % 2 == 0 ? word : word >> 8));
  }
  return bytes;
}

void DpramBytes::write(std::uint32_t offset, std::string_view bytes) {
  for (std::size_t n = 0; n < bytes.size() && offset + n < size_;) {
    const auto at = static_cast<std::uint32_t>(offset + n);
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i])); };
    if (at % 2 == 0 && n + 1 < bytes.size()) {
      bus_.dpram_write(at, static_cast<std::uint16_t>(byte(n) | byte(n + 1) << 8));
      n += 2;
    } else {
      const unsigned shift = at % 2 == 0 ? 0 : 8;
      bus_.dpram_write(at & ~1u, static_cast<std::uint16_t>(byte(n) << shift), at % 2 == 0 ? 1 : 2);
      ++n;
    }
  }
}

// A byte in which no bit changes is not written: the controller may be writing it.
void DpramBytes::change_bits(std::uint32_t offset, std::uint32_t set, std::uint32_t clear) {
  const std::uint32_t before = little_endian(read(offset, 4)), after = (before | set) & ~clear;
  for (std::uint32_t n = 0; n < 4; ++n) {
    const std::uint32_t changed = (before ^ after) >> 8 * n & 0xFF;
    const char byte = static_cast<char>(after >> 8 * n & 0xFF);
    if (changed != 0) write(offset + n, std::string_view(&byte, 1));
  }
}

}  // namespace brick
