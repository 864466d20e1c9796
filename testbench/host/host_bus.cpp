#include "testbench/host/host_bus.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

namespace brick {

namespace {

struct ExtensionTaker {
  PciCommand* command;
  void operator()(tlm::tlm_generic_payload* payload) const { payload->clear_extension(command); }
};

}  // namespace

HostBus::HostBus(Machine& machine) : IsaHost(machine), bridge_(machine.pci()) {
  if (bridge_ == nullptr) return;
  bridge_->attach(*this);
  HostBus::bridge_reset();
}

HostBus::~HostBus() {
  if (bridge_ != nullptr) bridge_->detach(*this);
}

std::uint32_t HostBus::io_base() const { return std::uint32_t{switches().io_base} << 4; }
std::uint32_t HostBus::window() const { return std::uint32_t{switches().window} << 14; }

// ---------------------------------------------------------------------------------------------- registers and memory

std::uint8_t HostBus::io_read(std::uint32_t offset) {
  if (bridge_ != nullptr) return static_cast<std::uint8_t>(pci(PciSpace::kIo, kPciIo + offset, false, 0, 1));
  return read_io(io_base() + offset);
}

void HostBus::io_write(std::uint32_t offset, std::uint8_t value) {
  if (bridge_ != nullptr)
    pci(PciSpace::kIo, kPciIo + offset, true, value, 1);
  else
    write_io(io_base() + offset, value);
}

// A window of 16 KiB shows one of four pages. The page is set each time: nobody knows who has been here since.
std::uint32_t HostBus::window_address(std::uint32_t byte_offset) {
  if (switches().window_flat) return window() + byte_offset;
  io_write(regs::host_io::kPage, static_cast<std::uint8_t>(byte_offset >> 14));
  return window() + (byte_offset & 0x3FFF);
}

std::uint16_t HostBus::dpram_read(std::uint32_t byte_offset) {
  if (bridge_ != nullptr)
    return static_cast<std::uint16_t>(pci(PciSpace::kMemory, kPciMemory + byte_offset, false, 0, 2));
  return read_memory(window_address(byte_offset), 3);
}

void HostBus::dpram_write(std::uint32_t byte_offset, std::uint16_t value, unsigned lanes) {
  if (bridge_ == nullptr) return write_memory(window_address(byte_offset), value, lanes);
  const bool high = lanes == 2;
  pci(PciSpace::kMemory, kPciMemory + byte_offset + (high ? 1 : 0), true, high ? value >> 8u : value,
      lanes == 3 ? 2 : 1);
}

// ----------------------------------------------------------------------------------------------------------------- PCI

void HostBus::bridge_reset() {
  pci(PciSpace::kConfiguration, PciBridge::kBar0, true, kPciIo, 4);
  pci(PciSpace::kConfiguration, PciBridge::kBar1, true, kPciMemory, 4);
  pci(PciSpace::kConfiguration, PciBridge::kCommand, true, PciBridge::kIoEnable | PciBridge::kMemoryEnable, 4);
}

// Little-endian, as PCI is. Beyond a window nobody answers, and a PC reads ones.
std::uint32_t HostBus::pci(PciSpace space, std::uint32_t address, bool write, std::uint32_t value, unsigned bytes) {
  unsigned char data[4];
  for (unsigned n = 0; n < 4; ++n) data[n] = write ? static_cast<unsigned char>(value >> 8 * n) : 0xFF;
  PciCommand command(space);
  tlm::tlm_generic_payload payload;
  payload.set_command(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
  payload.set_address(address);
  payload.set_data_ptr(data);
  payload.set_data_length(bytes);
  payload.set_streaming_width(bytes);
  // The payload would free what it still has when a signal ends the run inside the transport.
  const std::unique_ptr<tlm::tlm_generic_payload, ExtensionTaker> taker(&payload, {&command});
  payload.set_extension(&command);
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  bridge_->transport(payload, delay);
  std::uint32_t result = 0;
  for (unsigned n = 0; n < bytes; ++n) result |= static_cast<std::uint32_t>(data[n]) << 8 * n;
  return result;
}

// ----------------------------------------------------------------------------------------------------------- host port

void HostBus::open_port() {
  io_write(regs::host_io::kData5, 0);
  io_write(regs::host_io::kData6, 0);
}

// A short wait is lengthened by little, a long one costs few looks.
void HostBus::pause_polling(Tick since, Tick limit) {
  const Tick longest =
      std::clamp<Tick>(limit - now(), 0, fs_to_tick(isa::kLongestPollPause));  // a limit may be far off
  pause(std::max(isa::kPollPause, tick_to_fs(std::min((now() - since) / isa::kLooksAWait, longest))));
}

bool HostBus::put_char(std::uint8_t c, Tick timeout) {
  const Tick begin = now(), limit = begin + timeout;
  while (!(port_status() & kTxde)) {
    if (now() >= limit || tripped()) return false;
    pause_polling(begin, limit);
  }
  io_write(regs::host_io::kData7, c);
  return true;
}

std::optional<std::uint8_t> HostBus::get_char(Tick timeout) {
  const Tick begin = now(), limit = begin + timeout;
  while (!(port_status() & kRxdf)) {
    if (now() >= limit || tripped()) return std::nullopt;
    pause_polling(begin, limit);
  }
  return io_read(regs::host_io::kData7);
}

// ------------------------------------------------------------------------------------------------ interrupt controller

HostBus::Pic HostBus::read_pic() {
  Pic pic{};
  pic.ist = read_pic_status();
  pic.sig = read_pic_signals();
  pic.msk = io_read(regs::host_io::kPicMask);
  pic.elr = io_read(regs::host_io::kPicEdgeLevel);
  return pic;
}

void HostBus::write_pic_mask(std::uint8_t v) { io_write(regs::host_io::kPicMask, v); }
void HostBus::write_pic_edge_level(std::uint8_t v) { io_write(regs::host_io::kPicEdgeLevel, v); }
void HostBus::clear_pic() { io_write(regs::host_io::kPicStatus, 0); }

HostBus::Pic8259 HostBus::read_8259() {
  constexpr std::uint8_t kSelectIrr = 0x0A, kSelectIsr = 0x0B;  // OCW3
  Pic8259 pic{};
  command_8259(kSelectIrr);
  pic.irr = io_read(kCommand8259);
  command_8259(kSelectIsr);
  pic.isr = io_read(kCommand8259);
  pic.imr = io_read(kMask8259);
  return pic;
}

}  // namespace brick
