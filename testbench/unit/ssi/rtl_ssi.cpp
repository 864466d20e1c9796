#include "testbench/unit/ssi/rtl_ssi.h"

#include "Vssi.h"
#include "Vssi___024root.h"
#include "testbench/unit/rtl/verilated_shell.h"

namespace brick {
namespace {

void drive(Vssi& v, const SsiInputs& in) {
  v.rst_ni = in.rst_n;
  v.geo_i = in.geo;
  v.sel_i = in.sel;
  v.x_i = in.x;
  v.addr_i = in.addr & 63;
  v.we_i = in.we;
  v.rd_i = in.rd;
  v.wdata_i = in.wdata & 0xFFFFFF;
  v.phase_i = in.phase;
  v.servo_i = in.servo;
  v.data_i = static_cast<CData>(in.data);
}
SsiOutputs sample(const Vssi& v) { return {v.clk_o, v.rdata_o}; }

}  // namespace

RtlSsi::RtlSsi() : RtlBlock(verilated_shell(drive, sample)) {}

}  // namespace brick
