#include "testbench/unit/clocks/rtl_servo_ic.h"

#include "Vservo_ic.h"
#include "verilated.h"

namespace brick {

struct RtlServoIc::Impl {
  VerilatedContext context;
  Vservo_ic top{&context};
};

RtlServoIc::RtlServoIc() : impl_(std::make_unique<Impl>()) {
  // The asynchronous reset acts on its falling edge, so it must have been high once.
  impl_->top.rst_ni = 1;
  impl_->top.eval();
  drive();
  impl_->top.eval();
}

RtlServoIc::~RtlServoIc() { impl_->top.final(); }

void RtlServoIc::drive() {
  Vservo_ic& t = impl_->top;
  t.rst_ni = in.rst_n;
  t.sel_i = in.sel;
  t.x_i = in.x;
  t.addr_i = in.addr & 31;
  t.we_i = in.we;
  t.wdata_i = in.wdata & 0xFFFFFF;
  t.phase_i = in.phase;
  t.servo_i = in.servo;
  t.pins_i = 0;
}

void RtlServoIc::tick() {
  Vservo_ic& t = impl_->top;
  ++now_;
  drive();
  t.clk_pwm_i = 1;
  if (now_ % kTicksPerRef == 0) t.clk_ref_i = 1;
  t.eval();
  t.clk_pwm_i = 0;
  t.clk_ref_i = 0;
  t.eval();
}

bool RtlServoIc::phase() const { return impl_->top.phase_o; }
bool RtlServoIc::servo() const { return impl_->top.servo_o; }
bool RtlServoIc::phase_oe() const { return impl_->top.phase_oe_o; }
bool RtlServoIc::servo_oe() const { return impl_->top.servo_oe_o; }

std::uint32_t RtlServoIc::rdata() {
  drive();
  impl_->top.eval();
  return impl_->top.rdata_o;
}

}  // namespace brick
