// A board (either engine) with a Port A master of the simplest kind: accesses at given ticks, long enough for the
// synchroniser, and helpers that find edges of a pin. For tests that look at the board through its pins only.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "systemc/core/board.h"
#include "systemc/core/clock_delays.h"

namespace brick {

constexpr std::uint32_t kServoIcBase[] = {0x78000, 0x78100, 0x78200};
constexpr std::uint32_t kWatchdogStrobe = 0x70011, kHostSignals = 0x70010;

class BoardRig {
 public:
  // The pin is let go after tick 7. Two flip-flops on clk_ref take it at 9 and 12, two on clk_pwm at 13 and 14.
  static constexpr Tick kResetEnd = 14;

  explicit BoardRig(std::unique_ptr<Board> board, std::uint32_t fitted) : board_(std::move(board)) {
    in.fitted = fitted;
    apply();
    run(7);
    in.rst_n = true;
    apply();
    run(kResetEnd - now());
  }

  Board& board() { return *board_; }
  Tick now() const { return board_->now(); }
  void apply() { board_->set_inputs(in); }
  void run(Tick ticks) { board_->run_until(board_->now() + ticks); }
  std::uint32_t get(const PinField& pin) const { return board_->outputs().get(pin); }

  void write(bool x, std::uint32_t address, std::uint32_t value) {
    select(x, address);
    in.pa_wdata = value;
    apply();
    run(2);
    in.pa_wr_n = false;
    apply();
    run(9);
    in.pa_wr_n = true;
    apply();
    run(2);
    deselect();
  }
  std::uint32_t read(bool x, std::uint32_t address) {
    select(x, address);
    apply();
    run(1);
    in.pa_rd_n = false;
    apply();
    run(10);
    const std::uint32_t value = get(pin::kPaData);
    in.pa_rd_n = true;
    apply();
    run(2);
    deselect();
    return value;
  }

  // Runs until the pin changes to `level`; returns the tick.
  Tick edge(const PinField& pin, std::uint32_t level, Tick limit = 100'000'000) {
    const Tick end = now() + limit;
    BoardOutputs stop;
    stop.set(pin, ~0u);
    while (now() < end) {
      const std::uint32_t last = get(pin);
      board_->run_until(end, stop);
      if (get(pin) != last && get(pin) == level) return now();
    }
    ADD_FAILURE() << pin.name << " did not become " << level << " within " << limit << " ticks";
    return kNever;
  }

  BoardInputs in;

 private:
  void select(bool x, std::uint32_t address) {
    in.pa_addr = address & 0x7FFFF;
    in.pa_x = x;
    const bool registers = (address >= 0x78000 && address < 0x7C000) || (address >= 0xFF00 && address < 0x10000);
    in.pa_aa = registers ? 2 : address >= 0x60000 && address < 0x64000 ? 4 : 0;
  }
  void deselect() {
    in.pa_aa = 0;
    in.pa_addr = 0;
    apply();
    run(6);
  }

  std::unique_ptr<Board> board_;
};

}  // namespace brick
