// How the CPU's time is shared among its tasks, from the changes of cpu.task: what the tasks above the background take
// of a span, and the own time of each run of a task, which is its length less what interrupted it. The host port's
// handler keeps the number of what it interrupts (docs/signals.md): of a span it counts with that, of a run it does
// not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class TaskTimes {
 public:
  enum Task : unsigned { kBackground, kRealTime, kServo, kPhase };  // as cpu.task
  static constexpr unsigned kTasks = 4;

  // At each trap and each return from one: cpu.task from `time` on. Where it stays the same the host port's handler
  // begins or ends, which nothing interrupts.
  void changed(TimeFs time, unsigned task);

  // What real-time, servo and phase task took from `from` to `to`. Only as far back as the last forget_changes().
  TimeFs above_background(TimeFs from, TimeFs to) const;
  void forget_changes();

  struct Runs {
    std::uint64_t count = 0;
    TimeFs longest = 0;  // of their own times
  };
  const Runs& runs(unsigned task) const { return runs_[task]; }  // since forget_runs(), those that have ended
  void forget_runs() { runs_ = {}; }

 private:
  struct Change {
    TimeFs time;
    unsigned task;
  };
  std::vector<Change> changes_{{0, kBackground}};
  std::array<TimeFs, kTasks> own_{};  // of the run of each that is under way
  std::array<Runs, kTasks> runs_{};
  bool in_handler_ = false;  // of the host port
};

}  // namespace brick
