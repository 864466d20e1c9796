#include "testbench/unit/channel_choices/rtl_choices.h"

#include "Vchoices_bench.h"
#include "Vchoices_bench___024root.h"
#include "testbench/unit/rtl/verilated_shell.h"

namespace brick {
namespace {

void drive(Vchoices_bench& v, const ChoicesInputs& in) {
  v.ce_i = in.ce;
  v.fine_i = in.fine;
  v.other_i = in.other;
  v.count_i = in.position.count;
  v.down_i = in.position.down;
  v.still_i = in.position.still;
  v.counter_i = in.position.counter;
  v.fraction_i = static_cast<SData>(in.position.fraction);
  v.we_i = static_cast<CData>(in.we);
  v.wdata_i = in.wdata;
  v.ready_i = in.ready;
  v.mode_i = static_cast<CData>(in.mode);
  v.hold_i = in.hold;
  v.abc_i = static_cast<CData>(in.abc);
  v.pulse_i = in.pulse;
  v.pulse_down_i = in.pulse_down;
  v.sample_i = in.sample;
  v.bit_i = static_cast<CData>(in.bit);
  v.phase_fall_i = in.phase_fall;
  v.data_i = in.data;
}
ChoicesOutputs sample(const Vchoices_bench& v) {
  ChoicesOutputs out;
  for (unsigned i = 0; i < 2; ++i) {
    const bool count = (v.count_o >> i & 1) != 0;
    out.compare[i] = {(v.equ_o >> i & 1) != 0, v.a_o[i], v.b_o[i]};
    out.decode[i] = {count, count && (v.down_o >> i & 1) != 0, (v.error_o >> i & 1) != 0};
  }
  for (unsigned i = 0; i < 3; ++i) out.adc[i] = v.value_o[i] << 6;
  return out;
}

}  // namespace

RtlChoices::RtlChoices() : RtlBlock(verilated_shell(drive, sample)) {}

void RtlChoices::edge() {
  settle();
  decode_ = outputs().decode;
  ref_edge();
}

}  // namespace brick
