// A host that feeds rotary buffers and tells the scoreboard everything it does and sees: lines, selections, PR, ??, the
// interrupt controller, and every edge of BREQ at its tick.
#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>

#include "app/bench.h"
#include "testbench/checkers/breq_scoreboard.h"
#include "testbench/checkers/task_times.h"

namespace brick {

class BreqHost {
 public:
  BreqHost(BenchContext& context, Tick line_time);
  ~BreqHost();

  void open();  // OPEN ROTARY with the buffers empty
  // Empties the buffers and sets I16 and I17, for both sides. With the negative control the controller is given I17
  // + 1.
  void set_limits(unsigned i16, unsigned i17);
  void select(unsigned cs);            // &n, cs 0..15; waits until the pin has settled
  void clear();                        // CLEAR of the addressed buffer
  void run();                          // R
  void stop();                         // A; nothing more is taken
  bool line(const std::string& text);  // one program line; false when refused
  // T_FALL of the last line (host-bus:5.7/5): from the rise of the write strobe of its CR, or from the moment the
  // controller takes that out of the port, to the fall of BREQ; net of the tasks that came between. None: it did not
  // fall, because it was low already.
  struct FallTime {
    TimeFs whole, net;
  };
  std::optional<FallTime> fall_time() const { return fall_time_; }
  void measure_from_port(bool from_port) { from_port_ = from_port; }
  TaskTimes& tasks() { return tasks_; }
  void settle();           // waits until BREQ shows its final state, and checks it
  unsigned lines_ahead();  // PR
  bool full();             // ??
  bool signal();           // SIG bit 1
  void check();            // PR, ?? and SIG

  // A host program's loop: waits for the interrupt line, reads and clears the interrupt controller; false at the
  // time-out.
  bool wait_interrupt(Tick timeout);
  void enable_interrupt();

  // Any command that must be accepted; a refusal is a failed step.
  Reply must(const std::string& command);
  std::string ask(const std::string& command);  // first data line
  std::string motion_line();                    // a line with one short move, content by seed
  unsigned random(unsigned below) { return static_cast<unsigned>(random_() % below); }

  BreqScoreboard& scoreboard() { return scoreboard_; }
  // One step: no violation since the last call of this kind, and as much of each kind as `least` says.
  bool verdict(const std::string& step, const BreqScoreboard::Counts& least);
  unsigned interrupts() const { return interrupts_; }

 private:
  BenchContext& context_;
  BreqScoreboard scoreboard_;
  std::mt19937_64 random_;
  unsigned selected_ = 0;
  std::size_t reported_ = 0;
  BreqScoreboard::Counts counted_;
  unsigned interrupts_ = 0;
  TimeFs strobe_ = 0;  // the last rise of IOW#
  TimeFs taken_ = 0;   // the last CR, out of the port
  bool strobe_low_ = false, from_port_ = false;
  std::optional<FallTime> fall_time_;
  TaskTimes tasks_;
  std::function<void(TimeFs, const BoardInputs&, const BoardOutputs&)> judge_;  // who sees the host bus beside us
  std::function<void(TimeFs)> profile_;                                         // and the tasks
  std::function<void(const PortACycle&)> cycle_;                                // and the CPU's bus
};

}  // namespace brick
