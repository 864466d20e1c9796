#include "testbench/unit/macro_ic/rtl_macro_ic.h"

#include "Vmacro_ic.h"
#include "verilated.h"

namespace brick {

struct RtlMacroIc::Impl {
  VerilatedContext context;
  Vmacro_ic top{&context};
};

RtlMacroIc::RtlMacroIc() : impl_(std::make_unique<Impl>()) {
  // The asynchronous reset acts on its falling edge, so it must have been high once.
  impl_->top.rst_ni = 1;
  impl_->top.eval();
  drive();
  impl_->top.eval();
}

RtlMacroIc::~RtlMacroIc() { impl_->top.final(); }

void RtlMacroIc::drive() {
  Vmacro_ic& t = impl_->top;
  t.rst_ni = in.rst_n;
  t.gate_i = in.gate;
  t.sel_i = in.sel;
  t.x_i = in.x;
  t.addr_i = in.addr & 63;
  t.we_i = in.we;
  t.wdata_i = in.wdata & 0xFFFFFF;
  t.phase_i = in.phase;
  t.servo_i = in.servo;
}

void RtlMacroIc::tick() {
  Vmacro_ic& t = impl_->top;
  ++now_;
  drive();
  t.clk_pwm_i = 1;
  if (now_ % kTicksPerRef == 0) t.clk_ref_i = 1;
  t.eval();
  t.clk_pwm_i = 0;
  t.clk_ref_i = 0;
  t.eval();
}

void RtlMacroIc::settle() {
  drive();
  impl_->top.eval();
}

bool RtlMacroIc::phase() const { return impl_->top.phase_o; }
bool RtlMacroIc::servo() const { return impl_->top.servo_o; }
bool RtlMacroIc::phase_oe() const { return impl_->top.phase_oe_o; }
bool RtlMacroIc::servo_oe() const { return impl_->top.servo_oe_o; }

std::uint32_t RtlMacroIc::rdata() {
  settle();
  return impl_->top.rdata_o;
}

}  // namespace brick
