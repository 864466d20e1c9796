#include <brick/component.h>

#include <algorithm>
#include <stdexcept>

#include "systemc/component/client.h"
#include "systemc/component/error.h"

namespace brick::component {

Pin::Pin(Component& owner, std::string_view name, unsigned width) : info_(owner.add(*this, name)) {
  if (info_.width != width) throw std::logic_error("width of pin " + info_.name);
}

Component::Component(const sc_core::sc_module_name& name, TimeBase& time, const std::vector<PinInfo>& table,
                     std::vector<RegisterFace> faces)
    : sc_module(name),
      table_(table),
      faces_(std::move(faces)),
      client_(std::make_unique<Client>(time.scheduler(), table, faces_.size())) {}
Component::~Component() = default;

void Component::set_chip(std::unique_ptr<Chip> chip) { client_->set_chip(std::move(chip)); }

const PinInfo& Component::add(Pin& pin, std::string_view name) {
  const auto row =
      std::find_if(table_.begin(), table_.end(), [name](const PinInfo& info) { return info.name == name; });
  if (row == table_.end()) throw std::logic_error("no row in the pin table: " + std::string(name));
  client_->add(pin);
  return *row;
}

const std::vector<Pin*>& Component::pins() const { return client_->pins(); }

void sc_trace(sc_core::sc_trace_file* file, const Component& component, const std::string& name) {
  if (sc_core::sc_get_status() != sc_core::SC_ELABORATION)
    raise_error("/brick/trace", std::string(component.name()) + ": trace it before the simulation begins");
  component.traces_.push_back({file, name});
}

void Component::before_end_of_elaboration() {
  for (Pin* pin : pins())
    if (!traces_.empty()) pin->prepare_trace();
}

void Component::end_of_elaboration() {
  client_->elaborate();
  for (const Trace& trace : traces_)
    for (const Pin* pin : pins()) pin->trace(trace.file, trace.name + "." + pin->info().name);
}

namespace {
bool valid_enables(const tlm::tlm_generic_payload& payload) {
  const unsigned char* enables = payload.get_byte_enable_ptr();
  return enables == nullptr || (payload.get_byte_enable_length() != 0 &&
                                std::all_of(enables, enables + payload.get_byte_enable_length(), [](unsigned char e) {
                                  return e == TLM_BYTE_DISABLED || e == TLM_BYTE_ENABLED;
                                }));
}

tlm::tlm_response_status answer_of(const tlm::tlm_generic_payload& payload, unsigned width, std::uint64_t addresses,
                                   bool bytes) {
  const std::uint64_t address = payload.get_address();
  const unsigned length = payload.get_data_length();
  if (!payload.is_read() && !payload.is_write()) return tlm::TLM_COMMAND_ERROR_RESPONSE;
  if (address >= addresses || (bytes ? length > addresses - address : address % width != 0))
    return tlm::TLM_ADDRESS_ERROR_RESPONSE;
  if (bytes ? !valid_enables(payload) : payload.get_byte_enable_ptr() != nullptr)
    return tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE;
  if ((bytes ? length == 0 : length != width) || payload.get_streaming_width() < length)
    return tlm::TLM_BURST_ERROR_RESPONSE;
  if (payload.get_data_ptr() == nullptr) return tlm::TLM_GENERIC_ERROR_RESPONSE;
  return tlm::TLM_OK_RESPONSE;
}

// The byte at `address` of those that a payload moves; nullptr if it moves none there.
unsigned char* byte_at(tlm::tlm_generic_payload& payload, std::uint64_t address) {
  const std::uint64_t i = address - payload.get_address();
  if (address < payload.get_address() || i >= payload.get_data_length()) return nullptr;
  const unsigned char* enables = payload.get_byte_enable_ptr();
  const bool off = enables != nullptr && enables[i % payload.get_byte_enable_length()] == TLM_BYTE_DISABLED;
  return off ? nullptr : payload.get_data_ptr() + i;
}

// Bytes are in the order of their addresses, the least first, whatever the host's own order.
Cycle cycle_of(tlm::tlm_generic_payload& payload, std::uint64_t address, unsigned width) {
  Cycle cycle{payload.is_write(), static_cast<unsigned>(address), 0, 0, 0};
  for (unsigned i = 0; i < width; ++i)
    if (const unsigned char* byte = byte_at(payload, address + i)) {
      cycle.lanes |= 1u << i;
      if (cycle.write) cycle.value |= static_cast<std::uint32_t>(*byte) << 8 * i;
    }
  return cycle;
}
void set_value(tlm::tlm_generic_payload& payload, std::uint64_t address, unsigned width, std::uint32_t value) {
  for (unsigned i = 0; i < width; ++i)
    if (unsigned char* byte = byte_at(payload, address + i)) *byte = static_cast<unsigned char>(value >> 8 * i);
}
}  // namespace

void Component::transport(unsigned number, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  const RegisterFace& face = faces_.at(number);
  payload.set_dmi_allowed(false);
  payload.set_response_status(answer_of(payload, face.width, face.addresses, face.access == Access::kBytes));
  if (!payload.is_response_ok()) return;
  if (delay != sc_core::SC_ZERO_TIME) sc_core::wait(delay);
  delay = sc_core::SC_ZERO_TIME;
  const std::uint64_t end = payload.get_address() + payload.get_data_length();
  for (std::uint64_t at = payload.get_address() / face.width * face.width; at < end; at += face.width) {
    const Cycle cycle = cycle_of(payload, at, face.width);
    if (cycle.lanes == 0) continue;
    const Client::Answer answer = client_->access(number, cycle);
    if (!answer.made) return payload.set_response_status(tlm::TLM_GENERIC_ERROR_RESPONSE);
    if (!cycle.write) set_value(payload, at, face.width, answer.value);
  }
}

Component::BusAnswer Component::access(unsigned face, bool write, unsigned address, std::uint32_t value,
                                       unsigned lanes) {
  const Client::Answer answer = client_->access(face, {write, address, value, lanes, 0});
  return {answer.value, answer.made};
}

std::optional<std::uint32_t> Component::peek(unsigned face, unsigned address) { return client_->peek(face, address); }

// Command, address, data pointer and length are all that counts here; the status is left as it is.
unsigned Component::debug(unsigned number, tlm::tlm_generic_payload& payload) {
  const RegisterFace& face = faces_.at(number);
  const bool bytes = face.access == Access::kBytes;
  const std::uint64_t address = payload.get_address();
  const unsigned length = payload.get_data_length();
  if (!payload.is_read() || payload.get_data_ptr() == nullptr || address >= face.addresses) return 0;
  if (!bytes && (length < face.width || address % face.width != 0)) return 0;
  const auto count =
      bytes ? static_cast<unsigned>(std::min<std::uint64_t>(length, face.addresses - address)) : face.width;
  std::uint32_t word = 0;
  for (unsigned i = 0; i < count; ++i) {
    const auto at = static_cast<unsigned>(address + i), lane = at % face.width;
    if (i == 0 || lane == 0) {
      const std::optional<std::uint32_t> seen = peek(number, at - lane);
      if (!seen) return i;
      word = *seen;
    }
    payload.get_data_ptr()[i] = static_cast<unsigned char>(word >> 8 * lane);
  }
  return count;
}

}  // namespace brick::component
