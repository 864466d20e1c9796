// The socket of Port A and the signals of its lines, see port_a.h.
#include "systemc/cpu/port_a.h"

#include <cstring>

namespace brick {

PortA::PortA(sc_core::sc_module_name name, Signals& signals)
    : sc_core::sc_module(name),
      PortAMaster(this),
      signals_(signals),
      lines_{signals.add("bus.addr", 19, Radix::kHex),      signals.add("bus.data", 24, Radix::kHex),
             signals.add("bus.aa", 4, Radix::kBinary),      signals.add("bus.x", 1, Radix::kBinary),
             signals.add("bus.rd_n", 1, Radix::kBinary, 1), signals.add("bus.wr_n", 1, Radix::kBinary, 1)} {
  socket.register_b_transport(this, &PortA::b_transport);
}

void PortA::line_moved(PortALine line, TimeFs time, std::uint32_t value) {
  signals_.set(lines_[static_cast<unsigned>(line)], time, value);
}

void PortA::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  auto* request = payload.get_extension<PortARequest>();
  if (!under_way() && !ask(payload, *request)) return;
  if (!done()) return;  // the status stays incomplete
  take_answer();
  const PortACycle& cycle = answer();
  if (!cycle.write) std::memcpy(payload.get_data_ptr(), &cycle.data, sizeof cycle.data);
  request->done = done_at();
  delay += sc_core::sc_time(static_cast<double>(cycle.end - cycle.start), sc_core::SC_FS);
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
}

bool PortA::ask(tlm::tlm_generic_payload& payload, PortARequest& request) {
  const std::uint32_t offset = static_cast<std::uint32_t>(payload.get_address()) - kPmacBase;
  request.done = request.start + 1;
  if (payload.get_data_length() != 4 || offset % 4 != 0) {
    payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);  // the bus knows whole words only
    return false;
  }
  PortAAccess access{offset / 8, (offset & 4) != 0, payload.is_write(), 0, request.start, request.pc};
  if (!maps(access.address, access.x)) {
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return false;
  }
  if (access.write) std::memcpy(&access.data, payload.get_data_ptr(), sizeof access.data);
  begin(access);
  return true;
}

}  // namespace brick
