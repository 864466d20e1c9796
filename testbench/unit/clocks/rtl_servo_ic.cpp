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
  settle();
  in.rst_n = in.sel = false;
  settle();
}

RtlServoIc::~RtlServoIc() { impl_->top.final(); }

void RtlServoIc::drive() {
  Vservo_ic& t = impl_->top;
  t.rst_ni = in.rst_n;
  t.trip_i = in.trip;
  t.sel_i = in.sel;
  t.x_i = in.x;
  t.addr_i = in.addr & 31;
  t.we_i = in.we;
  t.wdata_i = in.wdata & 0xFFFFFF;
  t.read_done_i = in.read_done;
  t.read_x_i = in.x;
  t.read_addr_i = in.addr & 31;
  t.phase_i = in.phase;
  t.servo_i = in.servo;
  t.pins_i = in.pins[0] | QData{in.pins[1]} << 12 | QData{in.pins[2]} << 24 | QData{in.pins[3]} << 36;
  t.adc_a_i = static_cast<CData>(in.adc_a);
  t.adc_b_i = static_cast<CData>(in.adc_b);
}

void RtlServoIc::settle() {
  drive();
  impl_->top.eval();
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
std::uint64_t RtlServoIc::motor() const { return impl_->top.motor_o; }

std::uint32_t RtlServoIc::rdata() {
  settle();
  return impl_->top.rdata_o;
}

}  // namespace brick
