// The host's side of the bus: the board's I/O block and the dual-ported RAM, the host port by polling or by interrupt,
// the interrupt controller. Cards are accessed at the addresses that their switches say, boards with a PCI connector
// through their bridge. Bus cycles and time are those of IsaHost.
#pragma once

#include <cstdint>
#include <optional>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/host/pci_bridge.h"
#include "testbench/host/isa_host.h"

namespace brick {

class HostBus : public IsaHost {
 public:
  static constexpr std::uint32_t kIoBase = regs::host_io::kBase;  // of the register descriptions, not of a card
  static constexpr std::uint8_t kRxdf = regs::host_io::isr::kRxdf.mask();  // a character waits to be read
  static constexpr std::uint8_t kTxde = regs::host_io::isr::kTxde.mask();  // the next character may be written

  static constexpr std::uint32_t kCommand8259 = 8, kMask8259 = 9, kAcknowledge8259 = 10;

  explicit HostBus(Machine& machine);
  ~HostBus() override;
  HostBus(const HostBus&) = delete;
  HostBus& operator=(const HostBus&) = delete;

  // Registers and memory ----------------------------------------------------------------------------------------------
  std::uint8_t io_read(std::uint32_t offset);  // offset 0..15 from the base
  void io_write(std::uint32_t offset, std::uint8_t value);
  std::uint8_t io_read(const regs::Register& byte) { return io_read(byte.address - kIoBase); }
  void io_write(const regs::Register& byte, std::uint8_t value) { io_write(byte.address - kIoBase, value); }
  std::uint16_t dpram_read(std::uint32_t byte_offset);  // even offsets; turns the page of a small window
  // `lanes`: 1 the byte at the offset alone, 2 the one behind it, 3 both.
  void dpram_write(std::uint32_t byte_offset, std::uint16_t value, unsigned lanes = 3);
  std::uint32_t io_base() const;  // of the card
  std::uint32_t window() const;   // address of the memory window

  // Host port, host-bus:3.1 "polling recipe" -------------------------------------------------------------------------
  std::uint8_t port_status() {  // 0 where nobody drives the bus, as while a reset holds: the register is never all ones
    const std::uint8_t status = io_read(regs::host_io::kIsr);
    return status == 0xFF ? 0 : status;
  }
  void pause_polling(Tick since, Tick limit);                  // after a look that found nothing, of a wait so long
  bool tripped() const { return pins().get(pin::kWdo) != 0; }  // line WDO: nobody will answer until a reset
  void open_port();                                            // once: high and middle byte zero
  bool put_char(std::uint8_t c, Tick timeout);                 // spins on TXDE; false at the time-out
  std::optional<std::uint8_t> get_char(Tick timeout);          // spins on RXDF

  // Interrupt controller, host-bus:4.1 -------------------------------------------------------------------------------
  struct Pic {
    std::uint8_t ist, sig, msk, elr;
  };
  Pic read_pic();
  std::uint8_t read_pic_status() { return io_read(regs::host_io::kPicStatus); }
  std::uint8_t read_pic_signals() { return io_read(regs::host_io::kPicSignal); }
  void write_pic_mask(std::uint8_t v);
  void write_pic_edge_level(std::uint8_t v);
  void clear_pic();

  // The 8259 in its place, host-bus:4.5.
  struct Pic8259 {
    std::uint8_t irr, isr, imr;
  };
  Pic8259 read_8259();
  std::uint8_t acknowledge_8259() { return io_read(kAcknowledge8259); }  // the vector
  void command_8259(std::uint8_t v) { io_write(kCommand8259, v); }       // ICW1, OCW2, OCW3
  void mask_8259(std::uint8_t v) { io_write(kMask8259, v); }             // OCW1; ICW2, ICW4 after ICW1

 private:
  // What the computer's start-up gives a PCI board.
  static constexpr std::uint32_t kPciIo = 0xE000, kPciMemory = 0xFEB0'0000;
  void bridge_reset() override;
  std::uint32_t pci(PciSpace space, std::uint32_t address, bool write, std::uint32_t value, unsigned bytes);
  std::uint32_t window_address(std::uint32_t byte_offset);

  PciBridge* bridge_;  // nullptr on a board without one
};

}  // namespace brick
