// Random but repeatable traffic on all pins of a board: Port A cycles to every region and to none, host cycles to every
// address of the I/O block and the DPRAM window, both at random ticks and overlapping, resets in between. It holds the
// rules of both buses that the board relies on: one strobe at a time on each, address and data still around it.
#pragma once

#include <cstdint>
#include <random>

#include "systemc/core/board.h"

namespace brick {

// Out of reset with servo IC 0 as the source of PHASE and SERVO at reset values, by one write to X:$078004.
void start_clocks(Board& board, BoardInputs& inputs);
constexpr Tick kClocksStarted = 60;

class BoardTraffic {
 public:
  struct Options {
    unsigned reset_one_in = 400;  // accesses between two resets, on average; 0 = none but the first
    bool dense = true;            // short pauses between accesses
  };
  explicit BoardTraffic(std::uint64_t seed) : BoardTraffic(seed, Options{}) {}
  BoardTraffic(std::uint64_t seed, Options options);

  const BoardInputs& inputs() const { return inputs_; }
  Tick next() const;  // the inputs change so that the edge next()+1 is the first to see it
  void change();      // to be called when the board stands at next()

 private:
  struct Bus {
    Tick at = 0;
    int step = 0;
    bool write = false;
    bool memory = false;
  };
  std::uint32_t pick(std::uint32_t below);
  void cpu_step();
  void host_step();
  void choose_cpu_address();
  std::uint32_t choose_cpu_data();
  std::uint32_t choose_clock_data();
  void choose_host_address();

  std::mt19937_64 random_;
  Options options_;
  BoardInputs inputs_;
  Bus cpu_, host_;
  Tick reset_at_ = kNever;
  bool in_reset_ = true;
};

}  // namespace brick
