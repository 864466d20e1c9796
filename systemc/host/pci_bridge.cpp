#include "systemc/host/pci_bridge.h"

#include <cstring>

namespace brick {
namespace {

constexpr std::uint32_t kBarIsIo = 1;
constexpr std::uint32_t kMediumDevsel = 0x0200'0000;  // status, in the upper half of the command's DWORD
constexpr std::uint32_t kOtherBridge = 0x06'80'00;    // class code
constexpr std::uint32_t kIntA = 1;

std::uint32_t enabled(unsigned bytes) {
  std::uint32_t mask = 0;
  for (unsigned n = 0; bytes >> n != 0; ++n) mask |= (bytes >> n & 1) != 0 ? 0xFFu << 8 * n : 0;
  return mask;
}

// Byte enables of the DWORD that a payload touches, 0 when they say nothing.
unsigned byte_enables(const tlm::tlm_generic_payload& payload) {
  const auto first = static_cast<unsigned>(payload.get_address() % 4);
  unsigned bytes = 0;
  for (unsigned n = 0; n < payload.get_data_length(); ++n) {
    const unsigned char* enable = payload.get_byte_enable_ptr();
    const bool on = enable == nullptr || enable[n % payload.get_byte_enable_length()] == TLM_BYTE_ENABLED;
    bytes |= on ? 1u << (first + n) : 0;
  }
  return bytes;
}

}  // namespace

PciBridge::PciBridge(const sc_core::sc_module_name& name, const Local& local, const Identity& identity)
    : sc_module(name), socket("socket"), local_(local), identity_(identity) {
  socket.register_b_transport(this, &PciBridge::transport);
}

void PciBridge::reset() {
  command_ = bar0_ = bar1_ = 0;
  interrupt_line_ = 0;
  if (bus_ != nullptr) bus_->bridge_reset();
}

// What TLM-2.0 asks of a target before it looks at the address; TLM_OK_RESPONSE if there is nothing to refuse.
tlm::tlm_response_status PciBridge::malformed(const tlm::tlm_generic_payload& payload) {
  const unsigned length = payload.get_data_length();
  if (payload.get_extension<PciCommand>() == nullptr || payload.get_command() == tlm::TLM_IGNORE_COMMAND)
    return tlm::TLM_COMMAND_ERROR_RESPONSE;
  if (length == 0 || payload.get_address() % 4 + length > 4 || payload.get_streaming_width() < length)  // no bursts
    return tlm::TLM_BURST_ERROR_RESPONSE;
  if (payload.get_byte_enable_ptr() != nullptr && payload.get_byte_enable_length() == 0)
    return tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE;
  return payload.get_data_ptr() == nullptr ? tlm::TLM_GENERIC_ERROR_RESPONSE : tlm::TLM_OK_RESPONSE;
}

// Local cycles let the machine's time pass while this call lasts, so nothing is added to the delay.
void PciBridge::transport(tlm::tlm_generic_payload& payload, sc_core::sc_time&) {
  const std::uint64_t address = payload.get_address();
  const unsigned length = payload.get_data_length();
  if (const tlm::tlm_response_status status = malformed(payload); status != tlm::TLM_OK_RESPONSE) {
    payload.set_response_status(status);
    return;
  }
  const PciSpace space = payload.get_extension<PciCommand>()->space;
  const std::uint32_t io = bar0_, memory = bar1_, io_size = kIoBytes, memory_size = local_.window_bytes;
  const bool hit = space == PciSpace::kConfiguration ? address < 256
                   : space == PciSpace::kIo
                       ? (command_ & kIoEnable) != 0 && address >= io && address - io < io_size
                       : (command_ & kMemoryEnable) != 0 && address >= memory && address - memory < memory_size;
  if (!hit || (space != PciSpace::kConfiguration && bus_ == nullptr)) {  // nobody answers: master abort
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return;
  }
  const std::uint32_t base = space == PciSpace::kConfiguration ? 0 : space == PciSpace::kIo ? io : memory;
  const auto offset = (static_cast<std::uint32_t>(address) - base) & ~3u;
  const unsigned bytes = byte_enables(payload), shift = 8 * (address % 4);
  if (payload.is_read()) {
    const std::uint32_t value = (space == PciSpace::kConfiguration ? read_configuration(offset)
                                 : space == PciSpace::kIo          ? read_io(offset, bytes)
                                                                   : read_memory(offset, bytes)) >>
                                shift;
    for (unsigned n = 0; n < length; ++n)
      if ((bytes >> (address % 4 + n) & 1) != 0) payload.get_data_ptr()[n] = static_cast<unsigned char>(value >> 8 * n);
  } else {
    std::uint32_t value = 0;
    for (unsigned n = 0; n < length; ++n)
      value |= static_cast<std::uint32_t>(payload.get_data_ptr()[n]) << (8 * n + shift);
    if (space == PciSpace::kConfiguration) write_configuration(offset, value, bytes);
    if (space == PciSpace::kIo) write_io(offset, value, bytes);
    if (space == PciSpace::kMemory) write_memory(offset, value, bytes);
  }
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
}

// --------------------------------------------------------------------------------------------------- configuration

std::uint32_t PciBridge::read_configuration(std::uint32_t address) const {
  switch (address) {
    case kId:
      return static_cast<std::uint32_t>(identity_.device) << 16 | identity_.vendor;
    case kCommand:
      return kMediumDevsel | command_;
    case kClass:
      return kOtherBridge << 8 | identity_.revision;
    case kBar0:
      return bar0_ | kBarIsIo;
    case kBar1:
      return bar1_;
    case kSubsystem:
      return static_cast<std::uint32_t>(identity_.subsystem) << 16 | identity_.subsystem_vendor;
    case kInterrupt:
      return kIntA << 8 | interrupt_line_;
    default:
      return 0;
  }
}

// Ones written to a BAR leave those that count: software learns the size.
void PciBridge::write_configuration(std::uint32_t address, std::uint32_t value, unsigned bytes) {
  const std::uint32_t mask = enabled(bytes);
  const auto merged = [&](std::uint32_t old) { return (old & ~mask) | (value & mask); };
  if (address == kCommand) command_ = merged(command_) & (kIoEnable | kMemoryEnable);
  if (address == kBar0) bar0_ = merged(bar0_) & ~(kIoBytes - 1);
  if (address == kBar1) bar1_ = merged(bar1_) & ~(local_.window_bytes - 1);
  if (address == kInterrupt) interrupt_line_ = static_cast<std::uint8_t>(merged(interrupt_line_));
}

// ---------------------------------------------------------------------------------------------------- local cycles

std::uint32_t PciBridge::read_io(std::uint32_t offset, unsigned bytes) {
  std::uint32_t value = 0;
  for (unsigned n = 0; bytes >> n != 0; ++n)
    if ((bytes >> n & 1) != 0) value |= static_cast<std::uint32_t>(bus_->read_io(local_.io_base + offset + n)) << 8 * n;
  return value;
}

void PciBridge::write_io(std::uint32_t offset, std::uint32_t value, unsigned bytes) {
  for (unsigned n = 0; bytes >> n != 0; ++n)
    if ((bytes >> n & 1) != 0) bus_->write_io(local_.io_base + offset + n, static_cast<std::uint8_t>(value >> 8 * n));
}

// The low half first.
std::uint32_t PciBridge::read_memory(std::uint32_t offset, unsigned bytes) {
  std::uint32_t value = 0;
  for (unsigned half = 0; bytes >> half != 0; half += 2)
    if ((bytes >> half & 3) != 0)
      value |= static_cast<std::uint32_t>(bus_->read_memory(local_.window + offset + half, bytes >> half & 3))
               << 8 * half;
  return value;
}

void PciBridge::write_memory(std::uint32_t offset, std::uint32_t value, unsigned bytes) {
  for (unsigned half = 0; bytes >> half != 0; half += 2)
    if ((bytes >> half & 3) != 0)
      bus_->write_memory(local_.window + offset + half, static_cast<std::uint16_t>(value >> 8 * half),
                         bytes >> half & 3);
}

}  // namespace brick
