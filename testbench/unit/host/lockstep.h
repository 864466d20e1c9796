// A model and its Verilated twin, driven with the same inputs and compared at every tick, outputs and combinational
// reads alike. It also holds the model to its promise: next_event() must not be later than the next change of an
// output.
#pragma once

#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "systemc/core/model_block.h"
#include "testbench/unit/host/rtl_blocks.h"
#include "testbench/unit/rtl/comparison.h"

namespace brick {

// A model with something that /RD acts on without a clock wants to know when it moves.
template <class Model>
auto rd_moved(Model& model, int) -> decltype(model.rd_moved()) {
  model.rd_moved();
}
template <class Model>
void rd_moved(Model&, long) {}

template <class Model>
class Lockstep {
 public:
  using Inputs = typename Model::Inputs;
  using Show = Outputs (*)(const Model&);

  Lockstep(RtlBlock<Inputs, Outputs> rtl, Model& model, Show show) : rtl_(std::move(rtl)), model_(model), show_(show) {
    model_.reset(0);
  }

  Inputs in;
  std::function<void(Inputs&)> mutate;  // negative controls: distorts what the model sees
  bool lazy = false;  // executes the model's edges only when it asks for them, or when its inputs change

  // `moved`: inputs may have. While the model is judged, it sleeps as long as they rest and it promises nothing.
  void tick(bool moved = true) {
    if (moved || !model_judged()) apply();
    const Outputs before = judged();
    const Tick promised = model_.next_event();
    ++now_;
    if (!model_judged()) rtl_.tick();
    if (!(lazy || model_judged()) || promised <= now()) model_.advance(now());
    compare();
    if (judged() != before && promised > now())
      note("outputs changed, but next_event() said tick " + std::to_string(promised));
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick(i == 0);
  }
  // Through the next edge of clk_ref, n times.
  void ref(int n = 1) {
    const Tick begin = now(), end = next_ref_edge(begin) + (n - 1) * kTicksPerRef;
    while (now() < end) tick(now() == begin);
  }
  void reset() {
    apply();
    if (!model_judged()) rtl_.reset();
    model_.reset(now());
    compare();
  }

  // An output as it stands with the present inputs.
  std::uint32_t get(std::string_view name) {
    apply();
    for (const auto& [key, value] : judged())
      if (key == name) return value;
    throw std::logic_error("no output " + std::string(name));
  }

  Tick now() const { return now_; }
  // First difference of the two, "" while they agree.
  const std::string& difference() const { return difference_; }

 private:
  void apply() {
    model_.advance(now());  // edges that were left out belong to the old inputs
    model_.in = in;
    if (mutate) mutate(model_.in);
    rd_moved(model_, 0);
    if (!model_judged()) {
      rtl_.in = in;
      rtl_.settle();
    }
    compare();
  }
  Outputs judged() const { return model_judged() ? show_(model_) : rtl_.outputs(); }
  void compare() {
    if (!difference_.empty() || !engines_compared()) return;
    const Outputs rtl = rtl_.outputs(), model = show_(model_);
    for (std::size_t i = 0; i < rtl.size(); ++i) {
      if (rtl[i].second == model[i].second) continue;
      std::ostringstream text;
      text << std::hex << rtl[i].first << ": RTL " << rtl[i].second << ", model " << model[i].second;
      return note(text.str());
    }
  }
  void note(const std::string& text) {
    if (difference_.empty() && (engines_compared() || model_judged()))
      difference_ = "tick " + std::to_string(now()) + ": " + text;
  }

  RtlBlock<Inputs, Outputs> rtl_;
  Model& model_;
  Show show_;
  Tick now_ = 0;
  std::string difference_;
};

// The engines agreed up to here.
#define EXPECT_LOCKSTEP(pair) EXPECT_EQ((pair).difference(), "")

}  // namespace brick
