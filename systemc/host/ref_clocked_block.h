// Base of the blocks that run on clk_ref alone and sleep most of the time. A block says when it is idle (one more edge
// would change nothing, its inputs staying as they are) and what an edge does; idle edges are skipped, not executed.
#pragma once

#include "systemc/core/model_block.h"

namespace brick {

class RefClockedBlock : public ModelBlock {
 public:
  Tick next_event() const final { return idle() ? kNever : next_ref_edge(now_); }

  void advance(Tick t) final {
    for (Tick edge = next_ref_edge(now_); edge <= t && !idle(); edge += kTicksPerRef) {
      step();
      stepped_ = edge;
    }
    now_ = t;
  }

  void reset(Tick t) final {
    reset_registers();
    now_ = t;
  }

  Tick now() const { return now_; }
  bool stepped() const { return stepped_ == now_; }  // the last edge was not idle

 protected:
  virtual bool idle() const = 0;
  virtual void step() = 0;  // one rising edge of clk_ref
  virtual void reset_registers() = 0;

 private:
  Tick now_{}, stepped_{};
};

}  // namespace brick
