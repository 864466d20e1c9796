// The dual-ported RAM as the bytes that Ethernet clients know (ethernet:7): any offset, any number of them. Beyond its
// end zeros are read and writes are lost.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "testbench/host/host_bus.h"

namespace brick {

class DpramBytes {
 public:
  DpramBytes(HostBus& bus, std::uint32_t words) : bus_(bus), size_(2 * words) {}

  std::string read(std::uint32_t offset, std::size_t count);
  void write(std::uint32_t offset, std::string_view bytes);  // others' bytes of a word are not touched
  void change_bits(std::uint32_t offset, std::uint32_t set, std::uint32_t clear);  // of the 32-bit item there

 private:
  HostBus& bus_;
  std::uint32_t size_;
};

// As the bytes lie in a client's memory: the low one first.
std::uint32_t little_endian(std::string_view four);

}  // namespace brick
