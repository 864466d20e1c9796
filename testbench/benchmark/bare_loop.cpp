// The yardstick: a Verilated model in the plain loop of every Verilator example.
#include <Vboard_s2.h>

#include <memory>

#include "systemc/cosim/drive.h"
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
  BoardInputs in;
  in.rst_n = true;
  drive(model_->top, in);
  model_->top.eval();
  in.rst_n = false;
  drive(model_->top, in);
  for (int i = 0; i < 30; ++i) model_->tick();
  in.rst_n = true;
  drive(model_->top, in);
  for (int i = 0; i < 10; ++i) model_->tick();  // the reset has ended after the eighth
  in.pa_addr = 0x78004;
  in.pa_x = true;
  in.pa_aa = 2;
  in.pa_wdata = 0x3008D2;
  in.pa_wr_n = false;
  drive(model_->top, in);
  for (int i = 0; i < 20; ++i) model_->tick();
  in.pa_wr_n = true;
  drive(model_->top, in);
}

BareLoop::~BareLoop() { Verilated::threadContextp(&model_->context); }  // as in systemc/cosim/rtl_board.h

void BareLoop::run(Tick ticks) {
  for (Tick i = 0; i < ticks; ++i) model_->tick();
}

}  // namespace brick
