#include "systemc/host/isa_cycles.h"

namespace brick {

std::uint8_t IsaCycles::cycle8(IsaCommand command, std::uint32_t address, std::uint8_t data) {
  return cycle({command, address, static_cast<std::uint16_t>(0xFF00 | data), false}).data & 0xFF;
}

std::uint8_t IsaCycles::read_io(std::uint32_t port) { return cycle8(IsaCommand::kIoRead, port, 0xFF); }
void IsaCycles::write_io(std::uint32_t port, std::uint8_t value) { cycle8(IsaCommand::kIoWrite, port, value); }

std::uint16_t IsaCycles::read_memory(std::uint32_t address, unsigned lanes) {
  if (width() == 16) {
    const IsaResult wide =
        cycle({IsaCommand::kMemoryRead, address + ((lanes & 1) != 0 ? 0 : 1), 0xFFFF, (lanes & 2) != 0});
    if (!wide.narrow) return wide.data;
  }
  const unsigned low = (lanes & 1) != 0 ? cycle8(IsaCommand::kMemoryRead, address, 0xFF) : 0xFFu;
  const unsigned high = (lanes & 2) != 0 ? cycle8(IsaCommand::kMemoryRead, address + 1, 0xFF) : 0xFFu;
  return static_cast<std::uint16_t>(high << 8 | low);
}

void IsaCycles::write_memory(std::uint32_t address, std::uint16_t value, unsigned lanes) {
  if (width() == 16 &&
      !cycle({IsaCommand::kMemoryWrite, address + ((lanes & 1) != 0 ? 0 : 1), value, (lanes & 2) != 0}).narrow)
    return;
  if ((lanes & 1) != 0) cycle8(IsaCommand::kMemoryWrite, address, static_cast<std::uint8_t>(value));
  if ((lanes & 2) != 0) cycle8(IsaCommand::kMemoryWrite, address + 1, static_cast<std::uint8_t>(value >> 8));
}

}  // namespace brick
