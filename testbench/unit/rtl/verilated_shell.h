// The one shell around a Verilated module under test: context, start values, clocks, reset and coverage. A module adds
// what its ports are called, as two functions beside its Verilated header:
//   void drive(Vservo_ic& v, const ServoIcInputs& in)   sets every input port but the clocks, rst_ni where tests move
//   it IcOutputs sample(const Vservo_ic& v)                shows the outputs that tests look at
// and its constructor is RtlBlock(verilated_shell(drive, sample)). To be included in such a .cpp only, see rtl_block.h.
#pragma once

#include <verilated.h>

#include "systemc/cosim/rtl_coverage.h"
#include "testbench/unit/rtl/rtl_block.h"

namespace brick {

// Most modules work with clk_ref alone.
template <class V>
auto set_pwm(V& v, bool level, int) -> decltype(v.clk_pwm_i = level, void()) {
  v.clk_pwm_i = level;
}
template <class V>
void set_pwm(V&, bool, long) {}

template <class V, class Inputs, class Outputs>
class VerilatedShell : public VerilatedTop<Inputs, Outputs> {
 public:
  using Drive = void (*)(V&, const Inputs&);
  using Sample = Outputs (*)(const V&);

  VerilatedShell(Drive drive, Sample sample, int seed) : drive_(drive), sample_(sample) {
    context_.randReset(seed == 0 ? 0 : 2);
    context_.randSeed(seed);
    top_ = std::make_unique<V>(&context_, "");
    set_pwm(*top_, false, 0);
    top_->clk_ref_i = false;
    drive_(*top_, Inputs{});
    top_->rst_ni = true;
    top_->eval();
    start_coverage(context_);
    reset();
  }
  ~VerilatedShell() override {
    write_coverage(context_);
    top_->final();
    Verilated::threadContextp(&context_);  // its scopes leave the context last used, which may be long gone
    top_.reset();
  }

  void settle(const Inputs& in) override {
    drive_(*top_, in);
    top_->eval();
  }
  void clock(const Inputs& in, bool pwm, bool ref) override {
    drive_(*top_, in);
    set_pwm(*top_, pwm, 0);
    top_->clk_ref_i = ref;
    top_->eval();
    set_pwm(*top_, false, 0);
    top_->clk_ref_i = false;
    top_->eval();
  }
  void reset() override {
    for (const bool level : {true, false, true}) {  // the asynchronous reset acts on its falling edge
      top_->rst_ni = level;
      top_->eval();
    }
  }
  Outputs outputs() const override { return sample_(*top_); }

 private:
  VerilatedContext context_;
  std::unique_ptr<V> top_;
  Drive drive_;
  Sample sample_;
};

template <class V, class Inputs, class Outputs>
std::unique_ptr<VerilatedTop<Inputs, Outputs>> verilated_shell(void (*drive)(V&, const Inputs&),
                                                               Outputs (*sample)(const V&), int seed = shell_seed()) {
  return std::make_unique<VerilatedShell<V, Inputs, Outputs>>(drive, sample, seed);
}

}  // namespace brick
