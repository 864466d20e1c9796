// The board's sockets: from payloads to cycles of its two buses.
#include <algorithm>

#include <brick/board.h>

#include "systemc/component/board/board_buses.h"
#include "systemc/component/error.h"
#include "systemc/host/isa_cycles.h"

namespace brick::component {
namespace {

constexpr std::uint64_t kIoBytes = 1 << 16, kMemoryBytes = 1 << 24;

struct WordOnPortA {
  explicit WordOnPortA(std::uint64_t byte) : address(static_cast<std::uint32_t>(byte / 8)), x((byte & 4) != 0) {}
  std::uint32_t address;
  bool x;
};

bool check(tlm::tlm_generic_payload& payload, std::uint64_t bytes) {
  payload.set_dmi_allowed(false);
  const std::uint64_t address = payload.get_address(), width = payload.get_streaming_width();
  const std::uint64_t length = std::min<std::uint64_t>(payload.get_data_length(), width);
  if (!payload.is_read() && !payload.is_write())
    payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
  else if (address >= bytes || length > bytes - address)
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
  else if (payload.get_byte_enable_ptr() != nullptr && payload.get_byte_enable_length() == 0)
    payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  else if (length == 0)
    payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
  else if (payload.get_data_ptr() == nullptr)
    payload.set_response_status(tlm::TLM_GENERIC_ERROR_RESPONSE);
  else
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  return payload.is_response_ok();
}

// The bytes of a payload, as the bus sees them one after the other.
class Bytes {
 public:
  explicit Bytes(tlm::tlm_generic_payload& payload) : payload_(payload) {}
  unsigned count() const { return payload_.get_data_length(); }
  std::uint32_t address(unsigned i) const {
    return static_cast<std::uint32_t>(payload_.get_address() + i % payload_.get_streaming_width());
  }
  bool enabled(unsigned i) const {
    const unsigned char* const enables = payload_.get_byte_enable_ptr();
    return enables == nullptr || enables[i % payload_.get_byte_enable_length()] != TLM_BYTE_DISABLED;
  }
  bool word(unsigned i) const {  // with the next one, at an even address
    return i + 1 < count() && address(i) % 2 == 0 && address(i + 1) == address(i) + 1;
  }
  unsigned char& operator[](unsigned i) { return payload_.get_data_ptr()[i]; }

 private:
  tlm::tlm_generic_payload& payload_;
};

}  // namespace

// ISA, a cycle being an access to the face of the bus.
class Board::IsaBus final : public IsaCycles {
 public:
  IsaBus(Board& board, bool write) : board_(board), write_(write) {}
  bool good() const { return good_; }
  bool irq() const override { return false; }  // nobody asks here: a pin shows it

  void io(Bytes& bytes, unsigned i) {
    if (!bytes.enabled(i)) return;
    if (write_)
      write_io(bytes.address(i), bytes[i]);
    else
      bytes[i] = read_io(bytes.address(i));
  }
  // One byte, or two; the number.
  unsigned memory(Bytes& bytes, unsigned i) {
    const unsigned count = bytes.word(i) ? 2 : 1, first = bytes.address(i) % 2, address = bytes.address(i) - first;
    unsigned lanes = 0, value = 0xFFFF;
    for (unsigned k = 0; k < count; ++k)
      if (bytes.enabled(i + k)) {
        lanes |= 1u << (first + k);
        value ^= (bytes[i + k] ^ 0xFFu) << 8 * (first + k);
      }
    if (lanes == 0) return count;
    if (write_) {
      write_memory(address, static_cast<std::uint16_t>(value), lanes);
      return count;
    }
    value = read_memory(address, lanes);
    for (unsigned k = 0; k < count; ++k)
      if (bytes.enabled(i + k)) bytes[i + k] = static_cast<unsigned char>(value >> 8 * (first + k));
    return count;
  }

 private:
  IsaResult cycle(const IsaCycle& c) override {
    const unsigned address = (c.address & (kIsaMemory - 1)) | (c.memory() ? kIsaMemory : 0);
    const BusAnswer answer = board_.access(kIsaFace, c.write(), address, c.data, c.sbhe ? 3 : 1);
    good_ = good_ && answer.made;
    return {static_cast<std::uint16_t>(answer.value), (answer.value & kIsaNarrow) != 0, !answer.made};
  }
  unsigned width() const override { return board_.slot8.bound() && board_.slot8.read() != 0 ? 8 : 16; }

  Board& board_;
  const bool write_;
  bool good_ = true;
};

void Board::transport_port_a(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  const WordOnPortA word(payload.get_address());
  if (payload.get_address() < 8 * kMemoryBytes && !PortAMaster::maps(word.address, word.x)) {
    payload.set_dmi_allowed(false);
    return payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
  }
  transport(kPortAFace, payload, delay);
}

void Board::transport_io(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  transport_isa(false, payload, delay);
}
void Board::transport_memory(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  transport_isa(true, payload, delay);
}
void Board::transport_isa(bool memory, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  if (!check(payload, memory ? kMemoryBytes : kIoBytes)) return;
  if (delay != sc_core::SC_ZERO_TIME) wait(delay);
  delay = sc_core::SC_ZERO_TIME;
  IsaBus bus(*this, payload.is_write());
  Bytes bytes(payload);
  for (unsigned i = 0; i < bytes.count() && bus.good();) {
    if (memory)
      i += bus.memory(bytes, i);
    else
      bus.io(bytes, i++);
  }
  if (!bus.good()) payload.set_response_status(tlm::TLM_GENERIC_ERROR_RESPONSE);
}

unsigned Board::debug_port_a(tlm::tlm_generic_payload& payload) { return debug(kPortAFace, payload); }

// As many bytes from the first one on as are memory that can be looked at.
unsigned Board::debug_memory(tlm::tlm_generic_payload& payload) {
  unsigned char* const data = payload.get_data_ptr();
  if (!payload.is_read() || data == nullptr) return 0;
  for (unsigned i = 0; i < payload.get_data_length(); ++i) {
    const std::uint64_t address = payload.get_address() + i;
    const auto word =
        address < kMemoryBytes ? peek(kIsaFace, kIsaMemory | static_cast<unsigned>(address)) : std::nullopt;
    if (!word) return i;
    data[i] = static_cast<unsigned char>(*word >> 8 * (address % 2));
  }
  return payload.get_data_length();
}

void Board::end_of_elaboration() {
  const auto one_master = [this](const std::string& bus, bool socket, std::initializer_list<const Pin*> pins) {
    for (const Pin* pin : pins)
      if (socket && pin->bound())
        raise_error("/brick/two_masters", std::string(name()) + ": a socket of " + bus + " and the input pin " +
                                              pin->info().name + " are bound; expected: the one or the other");
  };
  const auto bound = [](auto& socket) { return socket.get_base_port().size() > 0; };
  one_master("Port A", bound(port_a), {&pa_addr, &pa_aa, &pa_x, &pa_int, &pa_rd_n, &pa_wr_n, &pa_data_i});
  one_master("ISA", bound(isa_io) || bound(isa_memory),
             {&isa_la, &isa_sa, &isa_sd_i, &isa_ior_n, &isa_iow_n, &isa_memr_n, &isa_memw_n, &isa_aen, &isa_sbhe_n});
  Component::end_of_elaboration();
}

}  // namespace brick::component
