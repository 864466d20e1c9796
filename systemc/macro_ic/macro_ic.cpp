#include "systemc/macro_ic/macro_ic.h"

namespace brick {

MacroIc::MacroIc(const sc_core::sc_module_name& name) : sc_module(name), regs_("regs"), clock_gen_("clock_gen") {}

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

}  // namespace brick
