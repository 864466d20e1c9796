// Whoever makes cycles on the ISA pins of a board on behalf of somebody else: the bridge chip of a PCI board asks it
// for each of its local cycles (systemc/host/pci_bridge.h).
#pragma once

#include <cstdint>

namespace brick {

class LocalBus {
 public:
  virtual ~LocalBus() = default;
  virtual std::uint8_t read_io(std::uint32_t port) = 0;
  virtual void write_io(std::uint32_t port, std::uint8_t value) = 0;
  // 16 bits at an even address; bit 0 of `lanes` is the low byte, bit 1 the high one, one of them at least is 1.
  virtual std::uint16_t read_memory(std::uint32_t address, unsigned lanes) = 0;
  virtual void write_memory(std::uint32_t address, std::uint16_t value, unsigned lanes) = 0;
  virtual bool irq() const = 0;   // the board's interrupt pin
  virtual void bridge_reset() {}  // the bridge has forgotten its ranges, as at power-on: configure it
};

}  // namespace brick
