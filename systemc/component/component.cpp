#include <brick/component.h>

#include <algorithm>
#include <stdexcept>

#include "systemc/component/client.h"

namespace brick::component {

Pin::Pin(Component& owner, std::string_view name, unsigned width) : owner_(owner), info_(owner.add(*this, name)) {
  if (info_.width != width) throw std::logic_error("width of pin " + info_.name);
}

std::string pin_trace_name(const Component& owner, const PinInfo& info) {
  return std::string(owner.name()) + "." + info.name;
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

void Component::trace(sc_core::sc_trace_file* file) const {
  for (const Pin* pin : pins())
    if (pin->bound()) pin->trace(file);
}

void Component::end_of_elaboration() { client_->elaborate(); }

namespace {
bool check(tlm::tlm_generic_payload& payload, unsigned width, std::uint64_t addresses) {
  payload.set_dmi_allowed(false);
  if (payload.get_command() == tlm::TLM_IGNORE_COMMAND)
    payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
  else if (payload.get_address() % width != 0 || payload.get_address() >= addresses)
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
  else if (payload.get_byte_enable_ptr() != nullptr)
    payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  else if (payload.get_data_length() != width || payload.get_streaming_width() < width)
    payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
  else
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  return payload.is_response_ok();
}

// Bytes are in the order of their addresses, the least first, whatever the host's own order.
std::uint32_t value_of(const tlm::tlm_generic_payload& payload, unsigned width) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < width; ++i) value |= static_cast<std::uint32_t>(payload.get_data_ptr()[i]) << 8 * i;
  return value;
}
void set_value(tlm::tlm_generic_payload& payload, unsigned width, std::uint32_t value) {
  for (unsigned i = 0; i < width; ++i) payload.get_data_ptr()[i] = static_cast<unsigned char>(value >> 8 * i);
}
}  // namespace

void Component::transport(unsigned face, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  const RegisterFace& registers = faces_.at(face);
  if (!check(payload, registers.width, registers.addresses)) return;
  if (delay != sc_core::SC_ZERO_TIME) sc_core::wait(delay);
  delay = sc_core::SC_ZERO_TIME;
  const auto address = static_cast<unsigned>(payload.get_address());
  if (payload.is_write())
    client_->access(face, {true, address, value_of(payload, registers.width), ~0u});
  else
    set_value(payload, registers.width, client_->access(face, {false, address, 0, ~0u}));
}

// Command, address, data pointer and length are all that counts here; the status is left as it is.
unsigned Component::debug(unsigned face, tlm::tlm_generic_payload& payload) {
  const RegisterFace& registers = faces_.at(face);
  const std::uint64_t address = payload.get_address();
  if (!payload.is_read() || payload.get_data_ptr() == nullptr || payload.get_data_length() < registers.width ||
      address % registers.width != 0 || address >= registers.addresses)
    return 0;
  set_value(payload, registers.width, client_->peek(face, static_cast<unsigned>(address)));
  return registers.width;
}

}  // namespace brick::component
