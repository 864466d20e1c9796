// A board that is wired wrongly: what it gets is changed on the way. For negative controls of what compares boards. Or
// one that is switched on late, for what keeps times.
#pragma once

#include <memory>
#include <utility>

#include "systemc/core/board.h"

namespace brick {

class DistortedBoard : public Board {
 public:
  // `later`: the tick at which it is switched on, on the machine's clock.
  explicit DistortedBoard(std::unique_ptr<Board> board, Tick later = 0) : later_(later), board_(std::move(board)) {
    board_->on_change = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
      if (on_change) on_change(t + later_, before, after);
    };
    board_->on_motor_change = [this](Tick t, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
      if (on_motor_change) on_motor_change(t + later_, ic, before, after);
    };
  }

  bool at_once = true;  // false: flip-flops where the enable of D and /TA have none
  std::function<void(BoardInputs&)> distort = [](BoardInputs&) {};
  std::function<void(unsigned ic, MotorInputs&)> distort_motor = [](unsigned, MotorInputs&) {};

  Tick now() const override { return board_->now() + later_; }
  void set_inputs(const BoardInputs& inputs) override {
    BoardInputs changed = inputs;
    distort(changed);
    board_->set_inputs(changed);
  }
  const BoardOutputs& outputs() const override { return board_->outputs(); }
  BoardOutputs port_a_at_once() const override { return at_once ? board_->port_a_at_once() : outputs(); }
  Tick run_until(Tick limit, const BoardOutputs& stop_on) override {
    return board_->run_until(limit - later_, stop_on) + later_;
  }
  void set_motor_inputs(unsigned ic, const MotorInputs& inputs) override {
    MotorInputs changed = inputs;
    distort_motor(ic, changed);
    board_->set_motor_inputs(ic, changed);
  }
  MotorOutputs motor_outputs(unsigned ic) const override { return board_->motor_outputs(ic); }
  void watch_motor(unsigned ic, const MotorOutputs& select) override { board_->watch_motor(ic, select); }
  void stop_on_motor(unsigned ic, const MotorOutputs& select) override { board_->stop_on_motor(ic, select); }

 private:
  const Tick later_;
  std::unique_ptr<Board> board_;
};

}  // namespace brick
