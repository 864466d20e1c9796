// Which coordinate system the pin BREQ has to show, by host-bus:5.3, host-bus:5.6 and host-bus:5.7 alone: told what
// host and panel select and what state each buffer is in, it expects one edge where the level differs and none where it
// does not, within the time of the cause, and the lamp BRLD/ as the inverse. Judges edges by their ticks.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class SelectionScoreboard {
 public:
  static constexpr unsigned kSystems = 16;
  static constexpr Tick kHostLimit = ns_to_ticks(10'000);   // T_CS
  static constexpr Tick kTasks = ns_to_ticks(20'000);       // what the tasks that interrupt it add to T_CS
  static constexpr Tick kPanelBase = ns_to_ticks(100'000);  // T_FPD beyond one real-time interrupt period
  enum class Buffer { kIdle, kReady, kFull };

  SelectionScoreboard(bool panel_fitted, unsigned selected_by_host) : fitted_(panel_fitted), host_(selected_by_host) {}

  void buffer(unsigned cs, Buffer state) { buffers_[cs] = state; }

  // Causes. Each ends with settled(); `executed`: the controller begins to execute the command that is the cause.
  void host(unsigned cs, Tick now) { begin(now, kHostLimit), host_ = cs; }
  void i2(unsigned value, Tick now) { begin(now, real_time_ + kPanelBase), i2_ = value; }
  void i59(unsigned value, Tick now) { begin(now, real_time_ + kPanelBase), i59_ = value; }
  void panel(unsigned number, Tick now) { begin(now, real_time_ + kPanelBase), number_ = number; }
  void nothing(Tick now) { begin(now, 0); }
  void executed(Tick now) { start_ = now; }
  void phase_fell(Tick now) { phases_.push_back(now); }           // phase and servo task may interrupt the command
  void real_time_began(Tick now) { real_times_.push_back(now); }  // or a slice of it goes on
  void real_time_period(Tick period) { real_time_ = period; }
  void calculation(Tick longest) { calculation_ = longest; }  // of a real-time task, where programs run
  Tick limit() const { return limit_ + kTasks + calculation_; }

  // What is seen. settled(): nothing more is expected of the last cause.
  void edge(Tick now, bool breq, bool lamp_n);
  void settled(Tick now, bool breq, bool sig);

  static constexpr unsigned kNone = kSystems;
  unsigned selected() const;
  unsigned i2() const { return i2_; }
  Tick execution() const { return start_; }  // of the last cause
  bool expected() const { return selected() != kNone && buffers_[selected()] == Buffer::kReady; }

  const std::vector<std::string>& violations() const { return violations_; }
  Tick longest_host() const { return longest_host_; }  // of those that no task interrupted
  Tick longest_interrupted() const { return longest_interrupted_; }
  unsigned interrupted() const { return interrupted_; }  // edges that show their longest time
  unsigned undisturbed() const { return undisturbed_; }  // edges judged by T_CS itself
  Tick longest_panel() const { return longest_panel_; }  // beyond the real-time interrupt's period
  struct Counts {
    unsigned causes = 0, edges = 0, idle = 0, ready = 0, full = 0, none = 0;
    Counts& operator+=(const Counts& o) {
      causes += o.causes, edges += o.edges;
      idle += o.idle, ready += o.ready, full += o.full, none += o.none;
      return *this;
    }
  };
  Counts take_counts() { return std::exchange(counts_, {}); }

 private:
  void begin(Tick now, Tick limit);
  void violate(Tick now, const std::string& text);

  bool fitted_;
  unsigned host_, i2_ = 1, i59_ = 0, number_ = 0;
  std::array<Buffer, kSystems> buffers_{};
  bool level_ = false;  // of the pin at the last settled()
  unsigned edges_ = 0;  // since then
  Tick start_ = 0, limit_ = 0, last_ = 0, real_time_ = 0;
  std::vector<Tick> phases_, real_times_;  // since the cause
  Tick calculation_ = 0, longest_host_ = 0, longest_interrupted_ = 0, longest_panel_ = -kPanelBase;
  unsigned interrupted_ = 0, undisturbed_ = 0;
  Counts counts_;
  std::vector<std::string> violations_;
};

}  // namespace brick
