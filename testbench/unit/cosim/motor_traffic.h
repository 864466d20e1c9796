// Random but repeatable life on the motor side: encoders that turn, reverse and stop, flags and other lines that
// toggle, ADC data, and Port A cycles that write and read every register of the channels and of MACRO ICs; resets in
// between. What happens at which tick follows from the seed alone, however a run is cut into calls.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "systemc/core/board.h"

namespace brick {

struct MotorTrafficOptions {
  std::uint32_t ics = 1;         // that take part, as in BoardInputs::fitted; the lowest drives the clocks
  Tick bus_pause = 300;          // between two accesses at most, but for long_pause
  Tick pins_pause = 750;         // between two changes of the pins of an IC, about at most
  bool moving_clocks = true;     // short periods, changed now and then; else as after a reset, and left alone
  unsigned reset_one_in = 2000;  // accesses between two resets, on average; 0 = none
  bool may_trip = true;          // once, in ten times as many, Port A rests for 3,000,000 ticks: the watchdog trips
  bool macro_drives = false;     // the first MACRO IC drives the clocks
  Tick silent_at = kNever;       // Port A rests from there until the watchdog has tripped, and a reset follows
  // Accesses between two failures of 5 V, each followed by 60 more, every fifth a write of a channel's control word,
  // and a reset; 0 = none.
  unsigned fail_every = 0;
  Tick long_pause = 20'000;  // of one in ten accesses, at most
};

class MotorTraffic {
 public:
  MotorTraffic(std::uint64_t seed, MotorTrafficOptions options);

  // Lives on the board until its tick `end`, in calls of at most `batch` ticks.
  void run(Board& board, Tick end, Tick batch = kNever);
  unsigned writes_tripped() const { return writes_tripped_; }  // of control words

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
  Tick up_to(Tick n) { return static_cast<Tick>(below(static_cast<std::uint32_t>(n))); }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  void pins_step(Ic& ic, Board& board);
  void move(Channel& c, std::uint16_t& pins);
  void bus_step();
  void fail_or_recover();
  bool start_access();  // false when everything has been started
  void choose_access();
  void choose_macro_access();
  void write(const Ic& ic, bool x, unsigned offset, std::uint32_t word) { write_at(ic.address + offset, x, word); }
  void read(const Ic& ic, bool x, unsigned offset) { read_at(ic.address + offset, x); }
  void write_at(std::uint32_t address, bool x, std::uint32_t word);
  void read_at(std::uint32_t address, bool x);
  std::uint32_t clock_word(bool drives);
  std::uint32_t first_clock_word(const Ic& ic);
  std::uint32_t pwm_word();
  void control(Ic& ic, unsigned channel, bool in_use);
  std::uint32_t output_word();

  std::mt19937_64 random_;
  MotorTrafficOptions options_;
  std::vector<Ic> ics_;
  std::vector<std::uint32_t> macro_ics_;  // addresses
  BoardInputs inputs_;
  Tick bus_at_, reset_at_, awake_at_ = 0;
  unsigned bus_step_ = 0, started_ = 0;
  unsigned accesses_ = 0, writes_tripped_ = 0, tripped_accesses_ = 0;  // the last: still to be made before the reset
  bool writing_ = false;
};

}  // namespace brick
