#include "testbench/checkers/watchdog_scoreboard.h"

#include <fmt/format.h>

namespace brick {

namespace {
double ms(Tick t) { return static_cast<double>(t) / static_cast<double>(kPwmClockHz) * 1000.0; }
}  // namespace

void WatchdogScoreboard::reset(Tick now) {
  *this = WatchdogScoreboard();
  reset_ = last_strobe_ = now;
}

void WatchdogScoreboard::starved(Tick now, Tick servo_period, unsigned counter) {
  starved_ = now;
  period_ = servo_period;
  counter_ = counter;
  servo_ = strobes_ = servo_at_strobe_ = 0;
}

void WatchdogScoreboard::servo_fell(Tick) { ++servo_; }

void WatchdogScoreboard::strobe(Tick now) {
  if (trip_ >= 0) violate(fmt::format("strobe {:.3f} ms after the trip", ms(now - trip_)));
  last_strobe_ = now;
  ++strobes_;
  servo_at_strobe_ = servo_;
}

void WatchdogScoreboard::trip(Tick now) {
  if (trip_ >= 0) violate("tripped twice without a reset");
  trip_ = now;
}

// Counter at `starved_`: I40 less what passes between two passes of an idle background. The real-time task that finds
// it below zero began not later than one such task after that, and the one before it, which strobed last, not earlier
// than one before.
WatchdogScoreboard::Window WatchdogScoreboard::chain() const {
  const Tick least = static_cast<Tick>(counter_) - kIdlePasses - kRealTimeTask;
  const Tick from = starved_ + (least > 0 ? least : 0) * period_;
  const Tick to = starved_ + (static_cast<Tick>(counter_) + 2) * period_;
  return {after(from).from, after(to).to};
}

void WatchdogScoreboard::judge(bool real_time) {
  if (trip_ < 0) {
    violate("did not trip");
    return;
  }
  const auto inside = [this](const char* rule, Window w) {
    if (!w.holds(trip_))
      violate(fmt::format("{}: tripped at {:.4f} ms after reset, expected {:.4f} to {:.4f} ms", rule,
                          ms(trip_ - reset_), ms(w.from - reset_), ms(w.to - reset_)));
  };
  inside("25 ms from the last strobe", circuit());
  if (starved_ < 0) return;
  if (real_time) {
    inside("I40 and 25 ms", chain());
    const unsigned least = counter_ > kIdlePasses + kRealTimeTask ? counter_ - kIdlePasses - kRealTimeTask : 0;
    if (servo_at_strobe_ < least || servo_at_strobe_ > counter_ + 1)
      violate(fmt::format("last strobe after {} servo interrupts, expected {} to {}", servo_at_strobe_, least,
                          counter_ + 1));
    if (strobes_ < least / kRealTimeTask)
      violate(fmt::format("{} strobes, expected {} or more", strobes_, least / kRealTimeTask));
  } else if (servo_at_strobe_ > kIdlePasses) {
    violate(fmt::format("a strobe {} servo periods after the real-time task lost its CPU time", servo_at_strobe_));
  }
}

std::string WatchdogScoreboard::summary() const {
  if (starved_ < 0)
    return fmt::format("{:.3f} ms after reset, {:.3f} ms after the last strobe", ms(trip_ - reset_),
                       ms(trip_ - last_strobe_));
  return fmt::format("{} strobes in {} servo interrupts, then {:.3f} ms", strobes_, servo_at_strobe_,
                     ms(trip_ - last_strobe_));
}

}  // namespace brick
