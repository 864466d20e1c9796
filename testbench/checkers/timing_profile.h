// What a timing report tells beside the rules, measured in the same run at the pins: who loads the CPU's bus, and the
// times of BREQ and of the interrupt line (host-bus:5.7, host-bus:4.1/8).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "systemc/core/board_pins.h"
#include "systemc/cpu/port_a.h"

namespace brick {

class Machine;

class TimingProfile {
 public:
  explicit TimingProfile(Machine& machine);  // takes Machine::on_outputs and on_task
  ~TimingProfile();
  TimingProfile(const TimingProfile&) = delete;
  TimingProfile& operator=(const TimingProfile&) = delete;

  void cycle(const PortACycle& c);

  struct Load {
    std::uint64_t cycles = 0;
    TimeFs time = 0;  // that the bus is taken
  };
  // As cpu.task; behind them the cycles that a bench makes in the CPU's place.
  static constexpr unsigned kBench = 4, kTasks = 5;
  const std::array<Load, kTasks>& tasks() const { return tasks_; }
  std::map<std::pair<unsigned, std::string>, Load> functions() const;  // by task and function

  struct Span {
    std::uint64_t count = 0;
    TimeFs least = 0, most = 0;
    TimeFs most_at = 0;  // when the longest ended
    void enter(TimeFs length, TimeFs end);
  };
  const Span& fall() const { return fall_; }            // CR read by the CPU to BREQ low, for lines that pulse it
  const Span& pulse() const { return pulse_; }          // BREQ low, for those lines
  const Span& longer() const { return longer_; }        // lows within a line that are longer than a pulse may be
  const Span& rise() const { return rise_; }            // start of the real-time interrupt that raises BREQ to its rise
  const Span& interrupt() const { return interrupt_; }  // enabled line high to IRQ high

 private:
  void outputs(Tick tick, const BoardOutputs& before, const BoardOutputs& after);
  void breq_edge(TimeFs now, bool level);

  Machine& machine_;
  std::array<Load, kTasks> tasks_{};
  std::map<std::pair<unsigned, std::uint32_t>, Load> by_pc_;
  Span fall_, pulse_, longer_, rise_, interrupt_;
  std::optional<TimeFs> line_end_;         // a CR whose line has not moved BREQ yet
  std::optional<TimeFs> fell_, fell_for_;  // BREQ is low since, and the CR that it fell for
  std::optional<TimeFs> line_rose_;        // the last rise of an interrupt line, as long as the mask has not changed
  TimeFs real_time_ = 0;                   // the real-time interrupt began or went on
  unsigned task_ = 0;
};

}  // namespace brick
