// Random but repeatable life on the motor side: encoders that turn, reverse and stop, flags and other lines that toggle, ADC
// data, and Port A cycles that write and read every register of the channels; resets in between. What happens at which tick
// follows from the seed alone, however a run is cut into calls.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "systemc/core/board.h"

namespace brick {

class MotorTraffic {
 public:
  // Bit i of `ics`: servo IC i takes part, as in BoardInputs::fitted.
  MotorTraffic(std::uint64_t seed, std::uint32_t ics);

  // Lives on the board until its tick `end`, in calls of at most `batch` ticks.
  void run(Board& board, Tick end, Tick batch = kNever);

 private:
  struct Channel {
    Tick speed = 100;
    unsigned place = 0;
    bool up = true, hall = false;
  };
  struct Ic {
    unsigned index = 0;
    std::uint32_t address = 0;
    Tick at = 0;  // of the next change of a pin
    MotorInputs pins;
    std::array<Channel, kChannels> channels;
  };

  Tick next() const;
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  void pins_step(Ic& ic, Board& board);
  void bus_step();
  void choose_access();
  void write(const Ic& ic, bool x, unsigned offset, std::uint32_t word);
  void read(const Ic& ic, bool x, unsigned offset);
  std::uint32_t clock_word(const Ic& ic);

  std::mt19937_64 random_;
  std::vector<Ic> ics_;
  BoardInputs inputs_;
  Tick bus_at_, reset_at_;
  unsigned bus_step_ = 0, started_ = 0;
  bool writing_ = false;
};

}  // namespace brick
