#include "testbench/unit/register_bits/rtl_servo_channel.h"

#include "Vservo_channel.h"
#include "verilated.h"

namespace brick {

struct RtlServoChannel::Impl {
  VerilatedContext context;
  Vservo_channel top{&context};
};

RtlServoChannel::RtlServoChannel() : impl_(std::make_unique<Impl>()) {
  Vservo_channel& t = impl_->top;
  t.sclk_ce_i = t.pfm_ce_i = t.sel_i = 1;
  for (bool level : {true, false, true}) {  // the asynchronous reset acts on its falling edge
    t.rst_ni = level;
    t.eval();
  }
}
RtlServoChannel::~RtlServoChannel() { impl_->top.final(); }

void RtlServoChannel::step(std::int64_t periods) {
  Vservo_channel& t = impl_->top;
  while (periods-- > 0) {
    t.clk_ref_i = 1;
    t.eval();
    t.clk_ref_i = 0;
    t.eval();
  }
}
void RtlServoChannel::pins(unsigned levels) { impl_->top.pins_i = static_cast<SData>(levels); }

void RtlServoChannel::latch() {
  Vservo_channel& t = impl_->top;
  t.phase_fall_i = t.servo_fall_i = 1;
  step();
  t.phase_fall_i = t.servo_fall_i = 0;
}

void RtlServoChannel::write(bool x, unsigned offset, std::uint32_t word) {
  Vservo_channel& t = impl_->top;
  t.x_i = x;
  t.addr_i = static_cast<CData>(offset);
  t.wdata_i = word;
  t.we_i = 1;
  step();
  t.we_i = 0;
}

std::uint32_t RtlServoChannel::read(bool x, unsigned offset) {
  Vservo_channel& t = impl_->top;
  t.x_i = x;
  t.addr_i = static_cast<CData>(offset);
  t.eval();
  return t.rdata_o;
}

void RtlServoChannel::read_capture() {
  impl_->top.read_capture_i = 1;
  step();
  impl_->top.read_capture_i = 0;
}

}  // namespace brick
