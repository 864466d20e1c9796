#include "testbench/unit/macro_ic/rtl_macro_ic.h"

#include "Vmacro_ic.h"
#include "Vmacro_ic___024root.h"
#include "testbench/unit/rtl/verilated_shell.h"

namespace brick {
namespace {

void drive(Vmacro_ic& v, const MacroIcInputs& in) {
  v.rst_ni = in.rst_n;
  v.gate_i = in.gate;
  v.sel_i = in.sel;
  v.x_i = in.x;
  v.addr_i = in.addr & 63;
  v.we_i = in.we;
  v.wdata_i = in.wdata & 0xFFFFFF;
  v.phase_i = in.phase;
  v.servo_i = in.servo;
}
IcOutputs sample(const Vmacro_ic& v) {
  return {v.phase_o != 0, v.servo_o != 0, v.phase_oe_o != 0, v.servo_oe_o != 0, v.rdata_o};
}

}  // namespace

RtlMacroIc::RtlMacroIc() : RtlIc(verilated_shell(drive, sample)) {}

}  // namespace brick
