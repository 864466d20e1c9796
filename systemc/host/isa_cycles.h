// Bytes and words by cycles of the bus: a word of memory that does not answer with 16 bits takes a cycle for each byte
// (host-bus:3.4).
#pragma once

#include "systemc/host/isa_master.h"
#include "systemc/host/local_bus.h"

namespace brick {

class IsaCycles : public LocalBus {
 public:
  std::uint8_t read_io(std::uint32_t port) override;
  void write_io(std::uint32_t port, std::uint8_t value) override;
  std::uint16_t read_memory(std::uint32_t address, unsigned lanes) override;
  void write_memory(std::uint32_t address, std::uint16_t value, unsigned lanes) override;

 protected:
  virtual IsaResult cycle(const IsaCycle& c) = 0;
  virtual unsigned width() const = 0;  // of the slot: 16 or 8

 private:
  std::uint8_t cycle8(IsaCommand command, std::uint32_t address, std::uint8_t data);
};

}  // namespace brick
