#include "systemc/macro_ic/macro_ic.h"

#include "systemc/core/register_access.h"

namespace brick {

MacroIc::MacroIc(const sc_core::sc_module_name& name)
    : sc_module(name), socket("socket"), regs_("regs"), clock_gen_("clock_gen") {
  socket.register_b_transport(this, &MacroIc::b_transport);
  apply_registers();
}

void MacroIc::reset(Tick t) {
  regs_.reset();
  clock_gen_.reset(t);
  apply_registers();
}

void MacroIc::write(bool x, unsigned offset, std::uint32_t value) {
  regs_.write(x, offset, value);
  apply_registers();
}

void MacroIc::set_gate(bool gate) {
  if (regs_.gate == gate) return;
  regs_.gate = gate;
  apply_registers();
}

void MacroIc::apply_registers() {
  clock_gen_.in.max_count = regs_.max_count();
  clock_gen_.in.phase_div = regs_.phase_div();
  clock_gen_.in.servo_div = regs_.servo_div();
  clock_gen_.in.phase_ext = regs_.phase_ext();
  clock_gen_.in.servo_ext = regs_.servo_ext();
}

void MacroIc::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time&) {
  if (!check_payload(payload, 4, 64 * 8)) return;
  const bool x = (payload.get_address() & 4) != 0;
  const auto offset = static_cast<unsigned>(payload.get_address() / 8);
  if (payload.is_write())
    write(x, offset, payload_value<std::uint32_t>(payload) & 0xFFFFFF);
  else
    set_payload_value(payload, read(x, offset));
}

}  // namespace brick
