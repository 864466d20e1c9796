// The bus master of Port A behind the socket of our CPU. A cycle spans many clock edges at which others act, so
// b_transport() does not block: the response status stays TLM_INCOMPLETE_RESPONSE while the cycle runs, and the same
// payload is presented again for the answer. Its lines are the named signals bus.*.
#pragma once

#include <tlm_utils/simple_target_socket.h>
#include <tlm>

#include <systemc>

#include "systemc/core/signals.h"
#include "systemc/cpu/port_a_master.h"

namespace brick {

// CPU byte address of PMAC word X:a is kPmacBase + 8 a + 4, of Y:a kPmacBase + 8 a.
constexpr std::uint32_t kPmacBase = 0xC0000000;

// Travels with the payload: when the CPU asks, who asks, and when it may go on.
struct PortARequest : tlm::tlm_extension<PortARequest> {
  std::int64_t start = 0;  // CPU cycle
  std::int64_t done = 0;
  std::uint32_t pc = 0;
  tlm::tlm_extension_base* clone() const override { return std::make_unique<PortARequest>(*this).release(); }
  void copy_from(const tlm::tlm_extension_base& other) override { *this = static_cast<const PortARequest&>(other); }
};

class PortA : public sc_core::sc_module, private PortALines, public PortAMaster {
 public:
  PortA(sc_core::sc_module_name name, Signals& signals);

  tlm_utils::simple_target_socket<PortA> socket{"socket"};

 private:
  void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  bool ask(tlm::tlm_generic_payload& payload, PortARequest& request);
  void line_moved(PortALine line, TimeFs time, std::uint32_t value) override;

  Signals& signals_;
  Signals::Id lines_[6];  // by PortALine
};

}  // namespace brick
