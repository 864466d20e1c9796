// The board of chips beside the board that has everything in one, tick by tick: all pins but those that tell of sources
// of PHASE and SERVO, of which the board's chip knows its own alone, and D where nobody drives it. What is outside sees
// the one board.
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "systemc/core/board.h"
#include "testbench/unit/chips/chips.h"

namespace brick {

class ChipLockstep : public Board {
 public:
  // `board`: Verilated, with the same fitted ICs and seed.
  ChipLockstep(std::unique_ptr<Board> board, std::uint32_t fitted, std::uint64_t seed = 0,
               ChipFault fault = ChipFault::kNone);

  std::function<void(BoardInputs&)> filter = [](BoardInputs&) {};  // what both get is changed so

  struct Counts {
    Tick ticks = 0;
    unsigned reads = 0;         // in which D was driven, at the tick before /RD rises
    unsigned reads_by_ics = 0;  // of these by a servo IC's chip
    unsigned shared = 0;        // ticks at which two chips drove D: cycles that no bus master makes
  };
  const Counts& counts() const { return counts_; }
  Chips& chips() { return chips_; }

  Tick now() const override { return board_->now(); }
  void set_inputs(const BoardInputs& inputs) override;
  const BoardOutputs& outputs() const override { return board_->outputs(); }
  BoardOutputs port_a_at_once() const override;
  Tick run_until(Tick limit, const BoardOutputs& stop_on) override;
  std::optional<std::uint16_t> dpram_word(unsigned index) const override { return board_->dpram_word(index); }
  void set_motor_inputs(unsigned ic, const MotorInputs& inputs) override;
  MotorOutputs motor_outputs(unsigned ic) const override { return board_->motor_outputs(ic); }
  void watch_motor(unsigned ic, const MotorOutputs& select) override { board_->watch_motor(ic, select); }
  void stop_on_motor(unsigned ic, const MotorOutputs& select) override {
    if (ic < kMaxServoIcs) stop_[ic] = select;
  }

 private:
  void compare(const BoardOutputs& one, const BoardOutputs& chips) const;

  std::unique_ptr<Board> board_;
  mutable Chips chips_;
  BoardInputs in_;
  std::array<MotorOutputs, kMaxServoIcs> stop_{};
  bool stopped_ = false;  // by a pin of a motor
  Counts counts_;
};

}  // namespace brick
