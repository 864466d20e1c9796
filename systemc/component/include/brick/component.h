// What all components have in common: pins, the register socket, the time base, the engine. Everything happens through
// events. While bound outputs stand still the model wakes seldom; RTL executes each edge and wakes once per
// TimeOptions::grid. With nothing bound both rest.
//
// Register sockets (TLM-2.0, generic payload, blocking). An access waits for the delay that is annotated, then for the
// first edge of clk_ref after it, which takes the sample of the read or executes the write; it returns in the instant
// of that edge with the delay 0, so its result and its time do not depend on the initiator's quantum. Accesses that
// meet take one edge each, in the order of their times; those of one instant in the order of their processes' names,
// because that of the calls would depend on the quantum. In reset an access takes its edge too: a read takes what the
// registers have then, a write is lost. Debug transport reads what a read would take now and changes nothing, or is the
// error /brick/ahead (brick/time_base.h); it writes nothing and leaves the status. No DMI: reads have side effects.
// A socket of bytes (that of the host of the dual-ported RAM) takes any address and length; each word that the bytes
// touch is an access of its own. A socket on clk_pwm says so.
//   TLM_ADDRESS_ERROR_RESPONSE      not aligned to the width of the register, or beyond the last
//   TLM_BURST_ERROR_RESPONSE        another length than one register, or a streaming width below it
//   TLM_BYTE_ENABLE_ERROR_RESPONSE  byte enables: a register is read and written as a whole; in a socket of bytes: of
//                                   no length, or with other values than TLM defines
//   TLM_COMMAND_ERROR_RESPONSE      neither read nor write
//   TLM_GENERIC_ERROR_RESPONSE      no data pointer
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <systemc>
#include <tlm>

#include <brick/engine.h>
#include <brick/pins.h>
#include <brick/time_base.h>

namespace brick::component {

class Chip;
class Client;
class Component;

// All pins as NAME.PIN, each with its width. An output that is not bound gets a signal of its own, and costs what a
// bound one does; an input that is not shows its idle level. Before the simulation begins, else the error /brick/trace.
void sc_trace(sc_core::sc_trace_file* file, const Component& component, const std::string& name);

class Component : public sc_core::sc_module {
 public:
  ~Component() override;

  const std::vector<Pin*>& pins() const;  // in the order of the table
  friend void sc_trace(sc_core::sc_trace_file* file, const Component& component, const std::string& name);

 protected:
  enum class Access { kWords, kBytes };
  struct RegisterFace {
    unsigned width;           // bytes of a register
    std::uint64_t addresses;  // bytes of all
    Access access = Access::kWords;
  };
  // Faces are numbered as here; `registers` of a component with one socket is face 0.
  Component(const sc_core::sc_module_name& name, TimeBase& time, const std::vector<PinInfo>& table,
            std::vector<RegisterFace> faces = {});
  void set_chip(std::unique_ptr<Chip> chip);  // once, at the end of the construction
  void transport(unsigned face, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned debug(unsigned face, tlm::tlm_generic_payload& payload);
  // To be registered with the socket of a face.
  template <unsigned kFace>
  void transport_at(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
    transport(kFace, payload, delay);
  }
  template <unsigned kFace>
  unsigned debug_at(tlm::tlm_generic_payload& payload) {
    return debug(kFace, payload);
  }
  void transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) { transport(0, payload, delay); }
  unsigned debug(tlm::tlm_generic_payload& payload) { return debug(0, payload); }

  struct BusAnswer {
    std::uint32_t value;
    bool made;  // false: the bus could not
  };
  BusAnswer access(unsigned face, bool write, unsigned address, std::uint32_t value, unsigned lanes);  // waits
  std::optional<std::uint32_t> peek(unsigned face, unsigned address);
  void before_end_of_elaboration() override;
  void end_of_elaboration() override;

 private:
  friend class Pin;
  const PinInfo& add(Pin& pin, std::string_view name);

  const std::vector<PinInfo>& table_;
  std::vector<RegisterFace> faces_;
  std::unique_ptr<Client> client_;
  struct Trace {
    sc_core::sc_trace_file* file;
    std::string name;
  };
  mutable std::vector<Trace> traces_;
};

}  // namespace brick::component
