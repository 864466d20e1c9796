#include "testbench/unit/channel_choices/rtl_choices.h"

#include "Vchoices_bench.h"
#include "verilated.h"

namespace brick {

struct RtlChoices::Impl {
  VerilatedContext context;
  Vchoices_bench top{&context};
};

RtlChoices::RtlChoices() : impl_(std::make_unique<Impl>()) {
  for (bool level : {true, false, true}) {  // the asynchronous reset acts on its falling edge
    impl_->top.rst_ni = level;
    impl_->top.eval();
  }
}
RtlChoices::~RtlChoices() { impl_->top.final(); }

void RtlChoices::edge() {
  Vchoices_bench& t = impl_->top;
  t.ce_i = in.ce;
  t.fine_i = in.fine;
  t.other_i = in.other;
  t.count_i = in.position.count;
  t.down_i = in.position.down;
  t.hold_i = in.position.hold;
  t.counter_i = in.position.counter;
  t.fraction_i = static_cast<SData>(in.position.fraction);
  t.we_i = static_cast<CData>(in.we);
  t.wdata_i = in.wdata;
  t.ready_i = in.ready;
  t.mode_i = static_cast<CData>(in.mode);
  t.abc_i = static_cast<CData>(in.abc);
  t.pulse_i = in.pulse;
  t.pulse_down_i = in.pulse_down;
  t.sample_i = in.sample;
  t.bit_i = static_cast<CData>(in.bit);
  t.phase_fall_i = in.phase_fall;
  t.data_i = in.data;
  t.eval();
  for (unsigned i = 0; i < 2; ++i) {
    const bool count = (t.count_o >> i & 1) != 0;
    decode_[i] = {count, count && (t.down_o >> i & 1) != 0, (t.error_o >> i & 1) != 0};
  }
  t.clk_ref_i = 1;
  t.eval();
  t.clk_ref_i = 0;
  t.eval();
}

RtlChoices::Compare RtlChoices::compare(unsigned value) const {
  const Vchoices_bench& t = impl_->top;
  return {(t.equ_o >> value & 1) != 0, t.a_o[value], t.b_o[value]};
}
std::uint32_t RtlChoices::adc(unsigned latency) const {
  return impl_->top.value_o[latency == 0 ? 0 : latency == 4 ? 1 : 2] << 6;
}

}  // namespace brick
