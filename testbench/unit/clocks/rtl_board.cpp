#include "testbench/unit/clocks/rtl_board.h"

#include "Vclocks_board.h"
#include "verilated.h"

namespace brick {

struct RtlBoard::Impl {
  VerilatedContext context;
  Vclocks_board top{&context};
};

RtlBoard::RtlBoard(bool seeded_bug) : impl_(std::make_unique<Impl>()) {
  // The asynchronous reset acts on its falling edge, so it must have been high once.
  impl_->top.seeded_bug_i = seeded_bug;
  // Nothing connected on the motor side.
  std::uint64_t idle = 0;
  for (unsigned n = 0; n < kChannels; ++n) idle |= std::uint64_t{kIdleChannelPins} << 12 * n;
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) impl_->top.motor_i[ic] = idle;
  impl_->top.rst_ni = 1;
  impl_->top.eval();
  inputs_.fitted = kTestIcs;
  drive();
  impl_->top.eval();
  sample();
}

RtlBoard::~RtlBoard() {
  impl_->top.final();
  Verilated::threadContextp(&impl_->context);  // as in systemc/cosim/rtl_board.h
}

void RtlBoard::drive() {
  Vclocks_board& t = impl_->top;
  const BoardInputs& i = inputs_;
  t.rst_ni = i.rst_n;
  t.pa_addr_i = i.pa_addr & 0x7FFFF;
  t.pa_x_i = i.pa_x;
  t.pa_aa_i = i.pa_aa & 0xF;
  t.pa_int_i = i.pa_int;
  t.pa_rd_ni = i.pa_rd_n;
  t.pa_wr_ni = i.pa_wr_n;
  t.pa_wdata_i = i.pa_wdata & 0xFFFFFF;
  t.isa_sa_i = i.isa_sa & 0xFFFFF;
  t.isa_sd_i = i.isa_sd;
  t.isa_ior_ni = i.isa_ior_n;
  t.isa_iow_ni = i.isa_iow_n;
  t.isa_memr_ni = i.isa_memr_n;
  t.isa_memw_ni = i.isa_memw_n;
  t.isa_aen_i = i.isa_aen;
  t.isa_sbhe_ni = i.isa_sbhe_n;
  t.fitted_i = i.fitted & 0x3FFFFF;
  t.macro_gate_i = i.macro_gate & 0xF;
  t.dpram_small_i = i.dpram_small;
  t.jpan_fitted_i = i.jpan_fitted;
  t.line_select_i = i.line_select & 0xFFF;
  t.jpan_i = i.jpan;
  t.ext_clock_i = i.ext_clock;
  t.ext_phase_i = i.ext_phase;
  t.ext_servo_i = i.ext_servo;
}

void RtlBoard::sample() {
  for (unsigned i = 0; i < kBoardOutputWords; ++i) outputs_.w[i] = impl_->top.pins_o[i];
}

Tick RtlBoard::run_until(Tick limit, const BoardOutputs& stop_on) {
  Vclocks_board& t = impl_->top;
  while (now_ < limit) {
    ++now_;
    drive();
    t.clk_pwm_i = 1;
    t.clk_ref_i = now_ % kTicksPerRef == 0;
    t.eval();
    t.clk_pwm_i = 0;
    t.clk_ref_i = 0;
    t.eval();
    const BoardOutputs before = outputs_;
    sample();
    if (before != outputs_) {
      if (on_change) on_change(now_, before, outputs_);
      if (before.differs(outputs_, stop_on)) break;
    }
  }
  return now_;
}

}  // namespace brick
