// The yardstick: a Verilated model in the plain loop of every Verilator example.
#include <Vboard_s2.h>

#include <memory>

#include "testbench/benchmark/benchmark.h"

namespace brick {

struct BareLoop::Model {
  VerilatedContext context;
  Vboard_s2 top{&context, ""};
  Tick now = 0;

  void tick() {
    ++now;
    top.clk_pwm_i = 1;
    top.clk_ref_i = now % kTicksPerRef == 0;
    top.eval();
    top.clk_pwm_i = 0;
    top.clk_ref_i = 0;
    top.eval();
  }
};

BareLoop::BareLoop() : model_(std::make_unique<Model>()) {
  Vboard_s2& t = model_->top;
  t.rst_ni = 1;
  t.fitted_i = 3;
  t.pa_rd_ni = t.pa_wr_ni = t.isa_ior_ni = t.isa_iow_ni = t.isa_memr_ni = t.isa_memw_ni = t.isa_sbhe_ni = 1;
  t.ext_phase_i = t.ext_servo_i = 1;
  t.eval();
  t.rst_ni = 0;
  for (int i = 0; i < 30; ++i) model_->tick();
  t.rst_ni = 1;
  t.pa_addr_i = 0x78004;
  t.pa_x_i = 1;
  t.pa_aa_i = 2;
  t.pa_wdata_i = 0x3008D2;
  t.pa_wr_ni = 0;
  for (int i = 0; i < 20; ++i) model_->tick();
  t.pa_wr_ni = 1;
}

BareLoop::~BareLoop() { Verilated::threadContextp(&model_->context); }  // as in systemc/cosim/rtl_board.h

void BareLoop::run(Tick ticks) {
  for (Tick i = 0; i < ticks; ++i) model_->tick();
}

}  // namespace brick
