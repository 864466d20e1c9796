// What every Verilated module of ours needs, whoever drives it: context, start values by seed, clocks, reset, coverage,
// the right order at the end. Include the module's root header (Vx___024root.h) before.
#pragma once

#include <verilated.h>

#include <cstdint>
#include <memory>

#include "systemc/cosim/rtl_coverage.h"

namespace brick {

// A clock must be seen low before its next rising edge, which costs a second evaluation that does nothing, since no
// flip-flop works on falling edges. Verilator remembers the level of each clock in a public member of its root object:
// clearing that member does the same for nothing. Its name differs between versions; where none fits we evaluate.
template <class Root>
auto forget_clocks(Root& root, int)
    -> decltype(root.__Vtrigrprev__TOP__clk_pwm_i = 0, root.__Vtrigrprev__TOP__clk_ref_i = 0, true) {
  root.__Vtrigrprev__TOP__clk_pwm_i = root.__Vtrigrprev__TOP__clk_ref_i = 0;
  return true;
}
template <class Root>
auto forget_clocks(Root& root, long)
    -> decltype(root.__Vtrigprevexpr___TOP__clk_pwm_i__0 = 0, root.__Vtrigprevexpr___TOP__clk_ref_i__0 = 0, true) {
  root.__Vtrigprevexpr___TOP__clk_pwm_i__0 = root.__Vtrigprevexpr___TOP__clk_ref_i__0 = 0;
  return true;
}
template <class Root>
bool forget_clocks(Root&, ...) {
  return false;
}

// Many modules work with clk_ref alone.
template <class V>
auto set_pwm(V& v, bool level, int) -> decltype(v.clk_pwm_i = level, true) {
  v.clk_pwm_i = level;
  return true;
}
template <class V>
bool set_pwm(V&, bool, long) {
  return false;
}

template <class V>
class VerilatedModule {
 public:
  // Flip-flops and memories start at random by the seed; 0: as zero. Nothing is evaluated yet.
  explicit VerilatedModule(std::uint64_t seed) {
    context_.randReset(seed == 0 ? 0 : 2);
    context_.randSeed(static_cast<int>(1 + seed % 0x7FFFFFFE));  // 0 would be the time of day
    top_ = std::make_unique<V>(&context_, "");
  }
  ~VerilatedModule() {
    write_coverage(context_);
    top_->final();
    Verilated::threadContextp(&context_);  // its scopes leave the context last used, which may be long gone
    top_.reset();
  }

  V& operator*() const { return *top_; }
  V* operator->() const { return top_.get(); }

  void count_coverage() { start_coverage(context_); }
  void pulse_reset() {  // asynchronous, it acts on its falling edge
    for (const bool level : {true, false, true}) {
      top_->rst_ni = level;
      top_->eval();
    }
  }
  void edge(bool pwm, bool ref) {  // a rising edge of these clocks
    V& v = *top_;
    set_pwm(v, pwm, 0);
    v.clk_ref_i = ref;
    v.eval();
    lower_clocks();
  }
  void lower_clocks() {
    V& v = *top_;
    set_pwm(v, false, 0);
    v.clk_ref_i = false;
    if (!forget_clocks(*v.rootp, 0)) v.eval();
  }

 private:
  VerilatedContext context_;
  std::unique_ptr<V> top_;
};

}  // namespace brick
