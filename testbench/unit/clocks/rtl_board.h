// The Verilated board of these tests: servo ICs 0, 1, 2, 2* and MACRO ICs 0, 1 are built, so that clocks can come from
// any of six.
#pragma once

#include <memory>

#include "systemc/core/board.h"

namespace brick {

constexpr std::uint32_t kTestIcs = 0xC0407;  // as in the verilate() call of the CMakeLists.txt here

class RtlBoard : public Board {
 public:
  explicit RtlBoard(bool seeded_bug = false);
  ~RtlBoard() override;

  Tick now() const override { return now_; }
  void set_inputs(const BoardInputs& inputs) override { inputs_ = inputs; }
  const BoardOutputs& outputs() const override { return outputs_; }
  Tick run_until(Tick limit, const BoardOutputs& stop_on = {}) override;

 private:
  void drive();
  void sample();
  struct Impl;
  std::unique_ptr<Impl> impl_;
  BoardInputs inputs_;
  BoardOutputs outputs_;
  Tick now_ = 0;
};

}  // namespace brick
