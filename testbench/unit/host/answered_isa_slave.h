// The model of the ISA slave with the flip-flop of the RAM that says BUSY: the RTL is told of it an edge of clk_ref
// before the model, since its IOCHRDY is a flip-flop too.
#pragma once

#include <algorithm>

#include "systemc/host/isa_slave.h"
#include "testbench/unit/host/rtl_blocks.h"

namespace brick {

class AnsweredIsaSlave final : public ModelBlock {
 public:
  using Inputs = AnsweredInputs;
  Inputs in;

  explicit AnsweredIsaSlave(const sc_core::sc_module_name& name) : slave_(name) {}

  // With the present inputs.
  const IsaSlave& slave() const {
    const bool busy = slave_.in.mem_busy;
    slave_.in = in;
    slave_.in.mem_busy = busy;
    return slave_;
  }
  void leave_ends_out() { slave_.leave_ends_out(); }

  Tick next_event() const override {
    const Tick answer = in.mem_busy_d == slave_.in.mem_busy ? kNever : next_ref_edge(now_);
    return std::min(slave().next_event(), answer);
  }
  void advance(Tick t) override {
    slave();
    const Tick answer = next_ref_edge(now_);
    if (answer <= t) {
      slave_.advance(answer);
      slave_.in.mem_busy = in.mem_busy_d;
    }
    slave_.advance(t);
    now_ = t;
  }
  void reset(Tick t) override {
    slave();
    slave_.in.mem_busy = false;
    slave_.reset(t);
    now_ = t;
  }

 private:
  mutable IsaSlave slave_;  // its inputs follow
  Tick now_ = 0;
};

}  // namespace brick
