// Scoreboard of the watchdog rules (servo-ic:10/2, servo-ic:10/4, servo-ic:10/5; firmware:8.3). It is told what a logic
// analyser sees: falling edges of SERVO, strobes (writes to X:$070011 on Port A) and the trip; and from when on the
// background has no CPU time. It knows neither the circuit nor the firmware: the counter is I40 at its last reload and
// falls by one a servo interrupt, real-time tasks strobe while it is not below zero, and the circuit trips 960 periods
// of 38.4 kHz after the last strobe.
#pragma once

#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class WatchdogScoreboard {
 public:
  static constexpr Tick kPeriod = 1024 * kTicksPerRef;  // 39.3216 MHz / 2^10
  static constexpr Tick kTimeout = 960 * kPeriod;       // 25 ms: the first of these periods may be cut short
  static constexpr Tick kSync = 4 * kTicksPerRef;       // from the strobe's pins into the timer
  static constexpr unsigned kIdlePasses = 4;  // a background with CPU time reloads at least so often, servo interrupts
  static constexpr unsigned kRealTimeTask = 64;  // a starved real-time task ends at least so often, servo interrupts

  struct Window {
    Tick from, to;
    bool holds(Tick t) const { return t >= from && t <= to; }
  };

  // What is seen
  // --------------------------------------------------------------------------------------------------------
  void reset(Tick now);  // the reset line was released: both timers run
  void starved(Tick now, Tick servo_period,
               unsigned counter);  // from this edge of SERVO on the background does not run; I40 in force
  void servo_fell(Tick now);
  void strobe(Tick now);
  void trip(Tick now);

  // What follows
  // ---------------------------------------------------------------------------------------------------------
  static unsigned counter_of(unsigned i40) { return i40 == 0 ? 4095 : i40; }
  Window circuit() const { return after(last_strobe_); }  // from the strobes alone
  Window chain() const;                                   // from I40 and the servo period alone: needs starved()

  // Judges a trip that came; `violations()` says in words what is wrong. `real_time` false: the real-time task had no
  // CPU time either.
  void judge(bool real_time);
  const std::vector<std::string>& violations() const { return violations_; }
  Tick tripped_at() const { return trip_; }
  unsigned strobes() const { return strobes_; }  // since starved() or reset()
  unsigned servo_at_last_strobe() const { return servo_at_strobe_; }
  std::string summary() const;

 private:
  static Window after(Tick strobe) { return {strobe + kTimeout - kPeriod, strobe + kTimeout + kSync}; }
  void violate(const std::string& text) { violations_.push_back(text); }

  Tick reset_ = 0, last_strobe_ = 0, starved_ = -1, period_ = 0, trip_ = -1;
  unsigned counter_ = 0, servo_ = 0, strobes_ = 0, servo_at_strobe_ = 0;
  std::vector<std::string> violations_;
};

}  // namespace brick
