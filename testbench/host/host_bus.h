// The host's side of the bus: ISA / PC104 cycles with real edges (host-bus.md 3.4), the host port by polling or by
// interrupt, the interrupt controller and the dual-ported RAM window. Every call advances the machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "systemc/machine/machine.h"

namespace brick {

class HostBus {
 public:
  static constexpr std::uint32_t kIoBase = 0x210;          // host-bus.md 3.1
  static constexpr std::uint32_t kDpramWindow = 0xD0000;   // 64 KiB, docs/architecture.md "Host bus"

  explicit HostBus(Machine& machine) : machine_(machine) {}

  std::uint8_t io_read(std::uint32_t offset);              // offset 0..15 from kIoBase
  void io_write(std::uint32_t offset, std::uint8_t value);
  std::uint16_t dpram_read(std::uint32_t byte_offset);     // even offsets
  void dpram_write(std::uint32_t byte_offset, std::uint16_t value);

  bool put_char(std::uint8_t c, Tick timeout);             // spins on TXDE; false at the time-out
  std::optional<std::uint8_t> get_char(Tick timeout);      // spins on RXDF

  struct Pic { std::uint8_t ist, sig, msk, elr; };
  Pic read_pic();
  void write_pic_mask(std::uint8_t v);
  void write_pic_edge_level(std::uint8_t v);
  void clear_pic();

  Machine& machine() { return machine_; }

 private:
  Machine& machine_;
};

}  // namespace brick
