#include "testbench/unit/servo_channel/rtl_channels.h"

#include "Vchannels_bench.h"
#include "verilated.h"

namespace brick {

struct RtlChannels::Impl {
  VerilatedContext context;
  Vchannels_bench top{&context};
};

RtlChannels::RtlChannels() : impl_(std::make_unique<Impl>()) {
  for (bool level : {true, false, true}) {  // the asynchronous reset acts on its falling edge
    ChannelInputs in;
    in.rst_n = level;
    drive(in);
  }
}
RtlChannels::~RtlChannels() { impl_->top.final(); }

void RtlChannels::drive(const ChannelInputs& in) {
  Vchannels_bench& t = impl_->top;
  t.rst_ni = in.rst_n;
  t.trip_i = in.trip;
  t.phase_i = in.phase;
  t.servo_i = in.servo;
  t.x_i = in.x;
  t.addr_i = static_cast<CData>(in.addr);
  t.we_i = in.we;
  t.read_done_i = in.read_done;
  t.wdata_i = in.wdata;
  t.pins_i = in.pins[0] | QData{in.pins[1]} << 12 | QData{in.pins[2]} << 24 | QData{in.pins[3]} << 36;
  t.adc_a_i = static_cast<CData>(in.adc_a);
  t.adc_b_i = static_cast<CData>(in.adc_b);
  t.eval();
}

void RtlChannels::tick(bool ref) {
  Vchannels_bench& t = impl_->top;
  t.clk_pwm_i = 1;
  t.clk_ref_i = ref;
  t.eval();
  t.clk_pwm_i = 0;
  t.clk_ref_i = 0;
  t.eval();
}

ChannelPins RtlChannels::pins() const {
  const Vchannels_bench& t = impl_->top;
  return {t.pwm_o, t.pins_o, t.serial_o, t.phase_o != 0, t.servo_o != 0};
}
std::uint32_t RtlChannels::rdata() const { return impl_->top.rdata_o; }

}  // namespace brick
