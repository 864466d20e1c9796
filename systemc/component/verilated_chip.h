// A Verilated module behind the pins of a component: context, start values, clocks, reset, one evaluation an edge. A
// module adds a struct with what its ports are called, beside its Verilated header:
//   static constexpr unsigned kOutputWords
//   static void drive(V& v, const PinWords& in)            every input port but the clocks and the register bus
//   static void sample(const V& v, PinWords& out)
//   static void access(V& v, bool on, bool write, unsigned address, std::uint32_t value)   strobes of the register bus
//   static std::uint32_t read(const V& v, unsigned address)   the word that it shows
#pragma once

#include <verilated.h>

#include <memory>

#include "systemc/component/chip.h"
#include "systemc/core/model_block.h"
#include "systemc/cosim/rtl_board.h"

namespace brick::component {

// Most modules of the host side work with clk_ref alone.
template <class V>
auto set_pwm(V& v, bool level, int) -> decltype(v.clk_pwm_i = level, true) {
  v.clk_pwm_i = level;
  return true;
}
template <class V>
bool set_pwm(V&, bool, long) {
  return false;
}

template <class V, class Ports>
class VerilatedChip final : public Chip {
 public:
  explicit VerilatedChip(std::uint64_t seed)
      : outputs_(Ports::kOutputWords), sampled_(Ports::kOutputWords), watched_(Ports::kOutputWords) {
    context_.randReset(seed == 0 ? 0 : 2);
    context_.randSeed(static_cast<int>(1 + seed % 0x7FFFFFFE));  // 0 would be the time of day
    top_ = std::make_unique<V>(&context_, "");
    every_edge_ = set_pwm(*top_, false, 0);
    top_->clk_ref_i = false;
    Ports::access(*top_, false, false, 0, 0);
    for (const bool level : {true, false, true}) {  // the asynchronous reset acts on its falling edge
      top_->rst_ni = level;
      top_->eval();
    }
    start_coverage(context_);
    Ports::sample(*top_, outputs_);
  }
  ~VerilatedChip() override {
    write_coverage(context_);
    top_->final();
    Verilated::threadContextp(&context_);  // its scopes leave the context last used, which may be long gone
    top_.reset();
  }

  Tick now() const override { return now_; }
  const PinWords& outputs() const override { return outputs_; }
  void watch(const PinWords& outputs) override { watched_ = outputs; }
  void set_inputs(const PinWords& inputs) override {
    const bool before = top_->rst_ni;
    Ports::drive(*top_, inputs);
    if (top_->rst_ni != before) {
      top_->eval();
      reset_moved_ = true;
    }
  }
  bool run_until(Tick limit) override {
    while (now_ < limit) {
      if (!every_edge_ && !reset_moved_) {  // nothing happens between the edges of clk_ref
        now_ = std::min(limit, next_ref_edge(now_));
        if (!is_ref_edge(now_)) break;
      } else {
        ++now_;
      }
      if (edge()) return true;
    }
    return false;
  }
  std::uint32_t read(unsigned address) override {
    Ports::access(*top_, true, false, address, 0);
    top_->eval();
    const std::uint32_t value = Ports::read(*top_, address);
    finish_access();
    return value;
  }
  void write(unsigned address, std::uint32_t value) override {
    Ports::access(*top_, true, true, address, value);
    finish_access();
  }
  std::uint32_t peek(unsigned address) override {
    Ports::access(*top_, true, false, address, 0);
    top_->eval();
    const std::uint32_t value = Ports::read(*top_, address);
    Ports::access(*top_, false, false, 0, 0);
    top_->eval();
    return value;
  }

 private:
  bool edge() {
    V& v = *top_;
    set_pwm(v, true, 0);
    v.clk_ref_i = is_ref_edge(now_);
    v.eval();
    set_pwm(v, false, 0);
    v.clk_ref_i = false;
    if (!forget_clocks(*v.rootp, 0)) v.eval();
    reset_moved_ = false;
    Ports::sample(v, sampled_);
    if (sampled_ == outputs_) return false;
    sampled_.swap(outputs_);
    return differ(sampled_, outputs_, watched_);
  }
  void finish_access() {
    ++now_;
    edge();
    Ports::access(*top_, false, false, 0, 0);
  }

  VerilatedContext context_;
  std::unique_ptr<V> top_;
  PinWords outputs_, sampled_, watched_;
  bool every_edge_ = true, reset_moved_ = false;
  Tick now_ = 0;
};

}  // namespace brick::component
