#include "testbench/unit/clocks/rtl_board.h"

#include "Vclocks_board.h"
#include "systemc/cosim/drive.h"
#include "verilated.h"

namespace brick {

struct RtlBoard::Impl {
  VerilatedContext context;
  Vclocks_board top{&context};
};

RtlBoard::RtlBoard(bool seeded_bug) : impl_(std::make_unique<Impl>()) {
  // The asynchronous reset acts on its falling edge, so it must have been high once.
  impl_->top.seeded_bug_i = seeded_bug;
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) drive_motor(impl_->top, ic, {});
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

void RtlBoard::drive() { brick::drive(impl_->top, inputs_); }

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
