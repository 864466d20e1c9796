// Port A without a CPU: cycles at the limits of host-bus:2.2 on a machine that has no firmware, at any time to the
// femtosecond. Every time is the least that a row allows, all at once: addresses late and gone early, write data late
// and gone early, the shortest lows and highs. In between the lines show random levels. Each line that moves within a
// nanosecond of a clock edge is taken early or late (systemc/core/aperture.h); with --skew each has its delay, too, and
// what the board shows comes later (systemc/cpu/port_a_wires.h).
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <random>
#include <utility>

#include "systemc/cpu/port_a_wires.h"
#include "systemc/machine/machine.h"
#include "testbench/checkers/port_a_drive.h"

namespace brick {

struct PortALimits {  // femtoseconds; what a row puts below zero is zero
  TimeFs clock;       // TC
  TimeFs setup;       // address and AA before the strobe falls: row 101, 115
  TimeFs low;         // the strobe: row 102, 116
  TimeFs hold;        // address and AA after it rises: row 103, 117
  TimeFs data;        // write data after /WR falls: rows 102 and 108
  TimeFs data_hold;   // write data after /WR rises: row 109
  TimeFs sample;      // read data after /RD falls: row 105
  TimeFs ready;       // /TA before the strobe rises: row 118
};
PortALimits port_a_limits(unsigned i52, unsigned wait_states, bool write);

class PortADriver {
 public:
  static constexpr TimeFs kAperture = kFsPerNs;
  static constexpr unsigned kWholeAperture = 11;  // I52: with skew row 115 leaves the RAM less than twice that above
  static constexpr unsigned kBins = 64;           // of the phase of a strobe's fall to clk_ref, 0.4 ns each

  struct Place {
    std::uint32_t address = 0;
    bool x = false;
    std::uint8_t aa = 0;
    bool on_chip = false;
    unsigned wait_states = 0;
  };

  PortADriver(Machine& machine, std::uint64_t seed);
  ~PortADriver();

  void set_skew(const PinSkew& skew) { wires_.set_skew(skew); }

  void set_clock(unsigned i52);
  TimeFs aperture() const { return aperture_.width(); }
  void spoil_data(TimeFs before) { spoiled_ = before; }  // write data gone so long before /WR rises: against row 109

  // The next address is not shown before `time`; else cycles follow each other at once.
  void wait_until(TimeFs time) { free_at_ = std::max(free_at_, time); }
  TimeFs free_at() const { return free_at_; }
  void write(const Place& place, std::uint32_t data) { cycle(place, own(place), true, data); }
  std::uint32_t read(const Place& place) { return cycle(place, own(place), false, 0); }
  void foreign(const Place& place, bool write, std::uint32_t data);  // of another device, whose data are nobody's here
  void rest();                                                       // the board stands at the end of the last cycle
  void at(Tick tick, std::function<void()> then) { then_at_ = tick, then_ = std::move(then); }  // on the way there

  std::uint32_t random() { return static_cast<std::uint32_t>(random_()); }
  const Aperture::Counts& moves() const { return aperture_.counts(); }
  const PortADrive& drive() const { return drive_; }
  unsigned floating() const { return floating_; }    // reads whose sample came before the board drove the pins
  unsigned stretched() const { return stretched_; }  // clocks that /TA added
  unsigned least_phase(bool write) const;            // how often the rarest phase of that strobe was seen
  void forget_phases() { phases_ = {}; }

 private:
  std::uint32_t cycle(const Place& place, PortADrive::Cycle of, bool write, std::uint32_t data);
  static PortADrive::Cycle own(const Place& place);
  void move(TimeFs time, const std::function<void(PortAPins&)>& edit);
  void run_to(Tick tick);
  void board_to(Tick tick);
  bool acknowledged(TimeFs time);
  TimeFs output_delay() const { return wires_.skew().on() ? PinSkew::kOutput : 0; }
  const BoardOutputs& at_cpu(TimeFs time, TimeFs way);
  void show(TimeFs time);  // the pins in the waveform

  Machine& machine_;
  Aperture aperture_;
  PortAWires wires_;
  PortAPins driven_;  // as the master drives the lines
  PortADrive drive_;
  decltype(Machine::on_outputs) others_;             // who else is told
  std::deque<std::pair<Tick, BoardOutputs>> shown_;  // by the board, at these edges; oldest first
  std::mt19937_64 random_;
  unsigned i52_ = 7;
  TimeFs free_at_ = 0, spoiled_ = 0;
  Tick then_at_ = kNever;
  std::function<void()> then_;
  unsigned floating_ = 0, stretched_ = 0;
  std::array<std::array<unsigned, kBins>, 2> phases_{};  // by direction
};

}  // namespace brick
