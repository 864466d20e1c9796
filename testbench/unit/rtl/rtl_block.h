// A Verilated module under test, for whoever may not see Verilator's headers (they and SystemC's cannot be included in
// one file): inputs as a struct of levels, outputs as a struct of what the ports show. What a module's ports are called
// stands in two small functions beside its Verilated header, see verilated_shell.h. Construction is power-on:
// flip-flops at random by the seed, then a pulse of rst_n.
#pragma once

#include <cstdlib>
#include <memory>
#include <utility>

#include "systemc/core/ticks.h"

namespace brick {

// Flip-flops and memories start at random, the same in every run; 0: all start as zero.
inline int shell_seed() {
  const char* text = std::getenv("BRICK_RTL_SEED");
  return text == nullptr ? 1 : std::atoi(text);
}

template <class Inputs, class Outputs>
class VerilatedTop {
 public:
  virtual ~VerilatedTop() = default;
  virtual void settle(const Inputs& in) = 0;                     // combinational outputs follow at once
  virtual void clock(const Inputs& in, bool pwm, bool ref) = 0;  // a rising edge of these clocks
  virtual void reset() = 0;                                      // a pulse of rst_n
  virtual Outputs outputs() const = 0;
};

template <class Inputs, class Outputs>
class RtlBlock {
 public:
  RtlBlock(std::unique_ptr<VerilatedTop<Inputs, Outputs>> top) : top_(std::move(top)) {}

  Inputs in;

  void settle() { top_->settle(in); }  // what the inputs change without an edge
  void tick() {                        // the next clk_pwm edge, and clk_ref with every third
    ++now_;
    top_->clock(in, true, now_ % kTicksPerRef == 0);
  }
  void ref_edge() { top_->clock(in, false, true); }  // clk_ref alone, for a block whose clk_pwm may rest; no tick
  void reset() {
    settle();
    top_->reset();
  }
  Outputs outputs() const { return top_->outputs(); }  // since the last of these calls
  Tick now() const { return now_; }

 private:
  std::unique_ptr<VerilatedTop<Inputs, Outputs>> top_;
  Tick now_ = 0;
};

}  // namespace brick
