// The one shell around a Verilated module under test (systemc/cosim/verilated_module.h). A module adds what its ports
// are called, as two functions beside its Verilated headers:
//   void drive(Vservo_ic& v, const ServoIcInputs& in)   sets every input port but the clocks, rst_ni where tests move
//   it IcOutputs sample(const Vservo_ic& v)                shows the outputs that tests look at
// and its constructor is RtlBlock(verilated_shell(drive, sample)). To be included in such a .cpp only, see rtl_block.h.
#pragma once

#include "systemc/cosim/verilated_module.h"
#include "testbench/unit/rtl/rtl_block.h"

namespace brick {

template <class V, class Inputs, class Outputs>
class VerilatedShell : public VerilatedTop<Inputs, Outputs> {
 public:
  using Drive = void (*)(V&, const Inputs&);
  using Sample = Outputs (*)(const V&);

  VerilatedShell(Drive drive, Sample sample, int seed)
      : top_(static_cast<std::uint64_t>(seed)), drive_(drive), sample_(sample) {
    set_pwm(*top_, false, 0);
    top_->clk_ref_i = false;
    drive_(*top_, Inputs{});
    top_->rst_ni = true;
    top_->eval();
    reset();
    top_.count_coverage();
  }

  void settle(const Inputs& in) override {
    drive_(*top_, in);
    top_->eval();
  }
  void clock(const Inputs& in, bool pwm, bool ref) override {
    drive_(*top_, in);
    top_.edge(pwm, ref);
  }
  void reset() override { top_.pulse_reset(); }
  Outputs outputs() const override { return sample_(*top_); }

 private:
  VerilatedModule<V> top_;
  Drive drive_;
  Sample sample_;
};

template <class V, class Inputs, class Outputs>
std::unique_ptr<VerilatedTop<Inputs, Outputs>> verilated_shell(void (*drive)(V&, const Inputs&),
                                                               Outputs (*sample)(const V&), int seed = shell_seed()) {
  return std::make_unique<VerilatedShell<V, Inputs, Outputs>>(drive, sample, seed);
}

}  // namespace brick
