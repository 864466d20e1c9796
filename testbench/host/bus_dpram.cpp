#include "testbench/host/dpram_port.h"
#include "testbench/host/host_bus.h"

namespace brick {

std::uint16_t BusDpram::read(std::uint32_t offset) { return bus_.dpram_read(offset); }
void BusDpram::write(std::uint32_t offset, std::uint16_t word) { bus_.dpram_write(offset, word); }
Tick BusDpram::now() { return bus_.now(); }
void BusDpram::pause(Tick since, Tick limit) { bus_.pause_polling(since, limit); }

}  // namespace brick
