// Random but repeatable traffic on all pins of a board but the motors': Port A cycles to every region and to none, host
// cycles to every address of the I/O block and the DPRAM window, clocks from outside and straps, each at random ticks
// and overlapping, resets in between. Cycles of both sides are legal, back to back, too short or quite wrong.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "systemc/core/board.h"

namespace brick {

// Out of reset with servo IC 0 as the source of PHASE and SERVO at reset values, by one write to X:$078004.
void start_clocks(Board& board, BoardInputs& inputs);
constexpr Tick kClocksStarted = 60;

class BoardTraffic {
 public:
  struct Options {
    unsigned reset_one_in = 400;  // accesses between two resets, on average; 0 = none but the first
    bool dense = true;            // without long pauses of everybody
    std::uint32_t ics = 0x3;      // that take part, as in BoardInputs::fitted
    Tick silent_at = kNever;      // Port A rests from there until the watchdog has tripped, and a reset follows
    // Accesses of the CPU between two failures of 5 V, each followed by 60 more, every fifth a write of the control
    // outputs, and a reset; 0 = none.
    unsigned fail_every = 0;
  };
  explicit BoardTraffic(std::uint64_t seed) : BoardTraffic(seed, Options{}) {}
  BoardTraffic(std::uint64_t seed, Options options);

  const BoardInputs& inputs() const { return inputs_; }
  Tick next() const;  // the inputs change so that the edge next()+1 is the first to see it
  void change();      // to be called when the board stands at next()
  void run(Board& board, Tick end);

  // What was made, on both buses, and how often what.
  struct Seen {
    unsigned too_short = 0, back_to_back = 0, both_strobes = 0, address_moved = 0, reset_in_cycle = 0,
             writes_tripped = 0;
  };
  const Seen& seen() const { return seen_; }
  unsigned accesses() const { return cpu_.accesses + host_.accesses; }
  unsigned dpram_accesses_of_cpu() const { return cpu_.dpram_accesses; }
  unsigned dpram_accesses_of_host() const { return host_.dpram_accesses; }

 private:
  struct Bus {
    Tick at = 0;
    int step = 0;
    bool write = false;
    bool memory = false;
    unsigned accesses = 0, dpram_accesses = 0;
    Tick fell = 0;
  };
  std::uint32_t pick(std::uint32_t below);
  unsigned one_of_ics();
  void cpu_step();
  void host_step();
  void outside_step();
  void pause();
  void choose_cpu_address();
  void fail_or_recover();
  void choose_clock_address();
  std::uint32_t choose_cpu_data();
  std::uint32_t choose_clock_data(bool drives);
  void choose_host_address();
  void choose_host_set_up();

  void choose_ssi();

  std::mt19937_64 random_, ssi_random_;  // of all, of the serial encoder inputs
  Options options_;
  BoardInputs inputs_;
  Bus cpu_, host_;
  std::vector<unsigned> ics_;  // indices
  unsigned driver_ = 0;        // of the clocks, mostly
  Tick outside_at_ = 0, reset_at_ = kNever;
  Tick rests_until_ = kNever;  // the CPU, so that the watchdog trips
  bool in_reset_ = true;
  bool hurries_ = false;           // the CPU's next cycle follows at once
  unsigned tripped_accesses_ = 0;  // still to be made before the reset
  Seen seen_;
};

}  // namespace brick
