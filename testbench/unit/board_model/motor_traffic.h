// Random but repeatable life on the motor side of a board: Port A writes and reads channel registers and clock registers of some
// servo ICs, encoders turn, flags and ADC lines toggle. What is applied when depends on the seed only, not on the board.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "systemc/core/board.h"

namespace brick {

struct MotorTrafficOptions {
  std::vector<unsigned> ics{0, 1, 2};
  Tick bus_pause = 3000;      // between two accesses at most
  Tick pins_pause = 400;      // between two changes of the pins of an IC at most
  bool moving_clocks = true;  // now and then a write that changes PHASE and SERVO
};

class MotorTraffic {
 public:
  explicit MotorTraffic(std::uint64_t seed, MotorTrafficOptions options = {});

  Tick next() const;          // the inputs change so that the edge next()+1 is the first to see it
  void change(Board& board);  // to be called when the board stands at next()

 private:
  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  void bus_step(Board& board);
  void choose_access();
  std::uint32_t control_word();
  void move(unsigned i);

  struct Ic {
    Tick at = 0;
    MotorInputs inputs;
    std::array<unsigned, kChannels> place{};
    bool up = true;
  };
  std::mt19937_64 random_;
  MotorTrafficOptions options_;
  std::vector<Ic> ic_;
  BoardInputs inputs_;
  Tick bus_at_ = 20;
  int bus_step_ = -1;
  bool write_ = false;
  unsigned starts_ = 0;
};

// Runs the board to `end`; `stretch` says how far each run_until() may go.
template <class Stretch>
void play(Board& board, MotorTraffic& traffic, Tick end, Stretch stretch) {
  while (board.now() < end) {
    const Tick stop = std::min(traffic.next(), end);
    while (board.now() < stop) board.run_until(std::min(stop, board.now() + stretch()));
    if (board.now() == traffic.next()) traffic.change(board);
  }
}

}  // namespace brick
