// The bridge chip of a PCI board as a TLM-2.0 target: a DWORD or a part of one a transaction, turned into cycles on the
// local bus, which is the board's ISA pins (host-bus:3.6). Each payload says by its extension which space it is for.
// BAR0: 16 bytes of I/O; BAR1: the window of the dual-ported RAM, not prefetchable. INTA# is low while the board's IRQ
// is high. The pins of PCI itself are not modelled. docs/pci_bridge.md.
#pragma once

#include <cstdint>

#include <tlm_utils/simple_target_socket.h>
#include <systemc>
#include <tlm>

#include "systemc/host/local_bus.h"

namespace brick {

enum class PciSpace { kConfiguration, kIo, kMemory };

// The command on C/BE# of the address phase.
struct PciCommand : tlm::tlm_extension<PciCommand> {
  explicit PciCommand(PciSpace s = PciSpace::kMemory) : space(s) {}
  tlm_extension_base* clone() const override { return new PciCommand(space); }
  void copy_from(const tlm_extension_base& other) override { space = static_cast<const PciCommand&>(other).space; }
  PciSpace space;
};

class PciBridge final : public sc_core::sc_module {
 public:
  struct Identity {
    std::uint16_t vendor = 0xD17A, device = 0x0001;  // not published: any that is nobody's
    std::uint16_t subsystem_vendor = 0xD17A, subsystem = 0x0001;
    std::uint8_t revision = 0;
  };
  // Bytes in BAR1 are 0x4000 or 0x10000; `io_base` and `window` are where the board answers on its local bus.
  struct Local {
    std::uint32_t io_base, window, window_bytes;
  };
  PciBridge(const sc_core::sc_module_name& name, const Local& local, const Identity& identity);
  PciBridge(const sc_core::sc_module_name& name, const Local& local) : PciBridge(name, local, Identity()) {}

  tlm_utils::simple_target_socket_optional<PciBridge> socket;

  // Makes the local cycles and lets the time pass. Not owned; detach() it before it goes.
  void attach(LocalBus& bus) { bus_ = &bus; }
  void detach(const LocalBus& bus) {
    if (bus_ == &bus) bus_ = nullptr;  // another one may have come since
  }
  void reset();  // power-on: no ranges, nothing enabled
  bool inta_n() const { return bus_ == nullptr || !bus_->irq(); }

  void transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);

  // Configuration space: byte addresses.
  enum Register : std::uint32_t {
    kId = 0x00,
    kCommand = 0x04,
    kClass = 0x08,
    kBar0 = 0x10,
    kBar1 = 0x14,
    kSubsystem = 0x2C,
    kInterrupt = 0x3C
  };
  static constexpr std::uint32_t kIoEnable = 1, kMemoryEnable = 2;  // of the command
  static constexpr std::uint32_t kIoBytes = 16;

 private:
  static tlm::tlm_response_status malformed(const tlm::tlm_generic_payload& payload);
  std::uint32_t read_configuration(std::uint32_t address) const;
  void write_configuration(std::uint32_t address, std::uint32_t value, unsigned bytes);
  std::uint32_t read_io(std::uint32_t offset, unsigned bytes);
  void write_io(std::uint32_t offset, std::uint32_t value, unsigned bytes);
  std::uint32_t read_memory(std::uint32_t offset, unsigned bytes);
  void write_memory(std::uint32_t offset, std::uint32_t value, unsigned bytes);

  Local local_;
  Identity identity_;
  LocalBus* bus_ = nullptr;
  std::uint32_t command_ = 0, bar0_ = 0, bar1_ = 0;
  std::uint8_t interrupt_line_ = 0;
};

}  // namespace brick
