// Port A bus master: turns one device access of a CPU into one bus cycle with the edges of the DSP563xx, in
// femtoseconds (docs/port_a.md). It also holds the two on-chip registers that shape the cycles: BCR (wait states) and
// PCTL (CPU clock). A cycle spans many clock edges at which others act: whoever advances the board moves it along. It
// knows no SystemC; the socket of our CPU is in port_a.h, that of the board's component in systemc/component.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "systemc/core/board_pins.h"
#include "systemc/core/cpu_clock.h"
#include "systemc/cpu/port_a_timing.h"
#include "systemc/cpu/port_a_watch.h"
#include "systemc/cpu/port_a_wires.h"

namespace brick {

struct PortAAccess {
  std::uint32_t address = 0;  // PMAC word
  bool x = false;
  bool write = false;
  std::uint32_t data = 0;
  std::int64_t start = 0;  // CPU cycle at which the CPU asks
  std::uint32_t pc = 0;
};

// A finished cycle as the bus master made it, for scoreboards and reports; what the lines did: port_a_watch.h.
struct PortACycle {
  std::uint32_t address = 0;  // PMAC word address
  bool x = false;
  std::uint8_t aa = 0;
  bool on_chip = false;
  bool write = false;
  std::uint32_t data = 0;  // read: as the CPU took it
  std::uint32_t pc = 0;
  unsigned wait_states = 0;  // programmed
  unsigned stretched = 0;    // clocks added by /TA
  unsigned multiplier = 0;   // of the CPU clock
  TimeFs start = 0;          // address and AA valid
  TimeFs strobe_low = 0;
  TimeFs data_time = 0;  // write: data driven; read: data sampled
  TimeFs ta_time = 0;    // last sample of /TA
  TimeFs strobe_high = 0;
  TimeFs end = 0;  // address and AA no longer valid; write: data no longer driven
};

// Who writes a waveform: the lines as a bus analyser shows them, not those of accesses to on-chip peripherals.
enum class PortALine { kAddr, kData, kAa, kX, kRdN, kWrN };
class PortALines {
 public:
  virtual ~PortALines() = default;
  virtual void line_moved(PortALine line, TimeFs time, std::uint32_t value) = 0;
};

class PortAMaster {
 public:
  explicit PortAMaster(PortALines* lines = nullptr) : lines_(lines) {}  // not owned; nullptr: nobody
  PortAMaster(const PortAMaster&) = delete;                             // its hooks know where it is
  PortAMaster& operator=(const PortAMaster&) = delete;

  // Registers to their reset values, no cycle under way; CPU cycle `cycle` begins with edge `edge`. Pins go idle.
  void reset(Tick edge, std::int64_t cycle, PortAPins& pins);
  void set_aperture(Aperture* aperture) { wires_.set_aperture(aperture); }  // not owned
  void set_skew(const PinSkew& skew) { wires_.set_skew(skew); }
  const PinSkew& skew() const { return wires_.skew(); }
  const CpuClock& clock() const { return clock_; }
  std::int64_t free_at() const { return next_start_; }  // CPU cycle at which the next access may begin
  unsigned wait_states(unsigned area) const;            // AA0..AA2, 3 = default area

  // Wait states of all areas as in BCR, whatever the program writes there. They act when it has left what a reset gives
  // it: another CPU clock, or other wait states of a device; until then it may not know yet what clock it will have.
  void force_wait_states(std::uint32_t bcr) { forced_bcr_ = bcr; }
  bool forced_wait_states_acted() const { return forced_acted_; }  // in a cycle at least
  void set_watch(PortAWatch* watch) { watch_ = watch; }            // not owned; nullptr = none
  // Of what a read takes from a bus that moves, and of whether a moving /TA is seen: the same on every engine.
  void seed(std::uint64_t seed) { random_ = seed; }
  // Of the next cycle: a moving /TA is taken as it stands after its move, or before; none: by the seed.
  void take_moving_ta(std::optional<bool> after) { moving_ta_ = after; }

  static bool maps(std::uint32_t address, bool x);  // a PMAC word that is on this bus or on chip
  // Of a word that maps(), with no access under way. BCR and PCTL are answered without a cycle: done() then.
  void begin(const PortAAccess& access);
  bool under_way() const { return state_ != State::kIdle; }
  bool done() const { return state_ == State::kDone; }
  void take_answer() { state_ = State::kIdle; }  // done: the next access may begin
  // Of the access that is done, until the next begins.
  const PortACycle& answer() const { return cycle_; }
  std::int64_t done_at() const { return start_ + shape_.clocks + cycle_.stretched; }  // CPU cycle
  std::uint32_t control(bool bcr) const { return bcr ? bcr_ : pctl_; }

  // A cycle under way is moved along by whoever advances the board: run the board to exactly stands_at(), then step().
  // Lines may still be on their way to the board when it is over.
  bool running() const { return state_ == State::kRunning; }
  bool moving() const { return running() || wires_.next() != kNever; }
  Tick stands_at() const { return running() ? std::min(stand_, wires_.next()) : wires_.next(); }
  Tick stood_at() const { return stand_; }                       // for the last step
  TimeFs started_at() const { return clock_.time(origin_, 0); }  // the cycle under way, or not before then
  void step(PortAPins& pins, const BoardOutputs& board);         // pins are seen first by the edge after stands_at()
  // That step moved a strobe at the board: what of the board follows without a clock does so at its time.
  bool strobe_moved() const { return strobe_moved_; }
  void board_follows(const BoardOutputs& board);
  void board_changed(Tick tick, const BoardOutputs& board);  // after each edge that changes D, its enable or /TA

  std::function<void(const PortACycle&)> on_cycle;  // at the end of each cycle
  std::function<void()> on_control;                 // BCR or PCTL was written

 private:
  enum class State { kIdle, kRunning, kDone };
  enum class Step { kAddress, kDriveData, kStrobeLow, kStrobeHigh, kEnd };
  struct Seen {  // what the board drives, from `time` on
    TimeFs time;
    std::uint32_t data;
    bool driven, busy;
    bool same_data(const Seen& o) const { return data == o.data && driven == o.driven; }
  };

  void control_register();
  void show(PortALine line, TimeFs time, std::uint32_t value) const {
    if (lines_ != nullptr) lines_->line_moved(line, time, value);
  }
  void next(Step step);
  void move(PortAPins& pins);  // the lines of this step
  bool end_strobe();
  bool forces_wait_states() const;
  TimeFs time_of(Step step) const;
  void see(TimeFs time, const BoardOutputs& board);
  void arrive(TimeFs time, const BoardOutputs& board);
  void arrive_until(TimeFs time);
  std::size_t seen_at(TimeFs time) const;
  bool acknowledged();
  void take_data();
  std::uint32_t random();
  std::uint32_t address_pins() const;
  void tell_watch();

  PortALines* lines_;
  CpuClock clock_;
  std::uint32_t bcr_ = 0, pctl_ = 0;
  std::optional<std::uint32_t> forced_bcr_;
  bool forced_acted_ = false;
  std::optional<bool> moving_ta_;
  PortAWatch* watch_ = nullptr;
  PortALevels levels_;
  std::uint64_t random_ = 1;

  State state_ = State::kIdle;
  Step step_ = Step::kAddress;
  Tick stand_ = 0;
  PortAWires wires_;
  PortAPins driven_;  // as the CPU drives the lines
  bool strobe_moved_ = false;
  TimeFs follows_at_ = 0;  // what of the board has no clock
  struct Shown {           // by the board, not yet at the CPU
    TimeFs time;
    BoardOutputs board;
  };
  std::vector<Shown> shown_;  // oldest first
  BoardOutputs arrived_;      // the last that was
  TimeFs time_ = 0;           // of step_
  PortAShape shape_{};
  PortACycle cycle_;
  std::int64_t start_ = 0;       // CPU cycle at which the cycle begins
  CpuClock::Origin origin_;      // of that cycle, later by the clocks that /TA has added
  std::int64_t next_start_ = 0;  // earliest next one
  std::vector<Seen> seen_;       // of the cycle under way, oldest first
};

}  // namespace brick
