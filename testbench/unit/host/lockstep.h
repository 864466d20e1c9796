// A model and its Verilated twin, driven with the same inputs and compared at every tick, outputs and combinational
// reads alike. It also holds the model to its promise: next_event() must not be later than the next change of an
// output, nor an edge that has passed. While the model is judged it is asleep as long as its inputs rest and it
// promises nothing, and its twin is a second one that is awake at every edge.
#pragma once

#include <functional>
#include <memory>
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
    if (model_judged()) {
      awake_ = std::make_unique<Model>(sc_core::sc_gen_unique_name("awake"));
      awake_->reset(0);
    }
  }

  Inputs in = Inputs();                 // with zeros between the fields
  std::function<void(Inputs&)> mutate;  // negative controls: distorts what the model sees
  bool lazy = false;  // executes the model's edges only when it asks for them, or when its inputs change

  void tick() {
    apply();
    const Outputs before = judged();
    const Tick promised = model_.next_event();
    if (promised <= now()) note("next_event() said tick " + std::to_string(promised) + ", which has passed");
    ++now_;
    if (promised <= now()) ++events_;
    if (awake_)
      awake_->advance(now());
    else
      rtl_.tick();
    if (!(lazy || awake_) || promised <= now()) model_.advance(now());
    compare();
    if (judged() != before && promised > now())
      note("outputs changed, but next_event() said tick " + std::to_string(promised));
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  // Through the next edge of clk_ref, n times.
  void ref(int n = 1) {
    const Tick end = next_ref_edge(now()) + (n - 1) * kTicksPerRef;
    while (now() < end) tick();
  }
  void reset() {
    apply();
    if (awake_)
      awake_->reset(now());
    else
      rtl_.reset();
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
  bool asleep() const { return model_.next_event() == kNever; }  // the model, until an input moves
  std::size_t events() const { return events_; }                 // edges that the model has asked for
  // First difference of the two, "" while they agree.
  const std::string& difference() const { return difference_; }

 private:
  void apply() {
    if (awake_ && same_bytes(in, applied_)) return;
    model_.advance(now());  // edges that were left out belong to the old inputs
    model_.in = applied_ = in;
    if (mutate) mutate(model_.in);
    rd_moved(model_, 0);
    if (awake_) {
      awake_->in = in;
      rd_moved(*awake_, 0);
    } else {
      rtl_.in = in;
      rtl_.settle();
    }
    compare();
  }
  Outputs judged() const { return awake_ ? show_(model_) : rtl_.outputs(); }
  void compare() {
    if (!difference_.empty() || !(engines_compared() || awake_)) return;
    const Outputs twin = awake_ ? show_(*awake_) : rtl_.outputs(), model = show_(model_);
    for (std::size_t i = 0; i < twin.size(); ++i) {
      if (twin[i].second == model[i].second) continue;
      std::ostringstream text;
      text << std::hex << twin[i].first << ": " << (awake_ ? "awake " : "RTL ") << twin[i].second << ", model "
           << model[i].second;
      return note(text.str());
    }
  }
  void note(const std::string& text) {
    if (difference_.empty() && (engines_compared() || awake_))
      difference_ = "tick " + std::to_string(now()) + ": " + text;
  }

  RtlBlock<Inputs, Outputs> rtl_;
  Model& model_;
  std::unique_ptr<Model> awake_;  // while the model is judged
  Inputs applied_ = Inputs();
  Show show_;
  Tick now_ = 0;
  std::size_t events_ = 0;
  std::string difference_;
};

// The engines agreed up to here.
#define EXPECT_LOCKSTEP(pair) EXPECT_EQ((pair).difference(), "")

}  // namespace brick
