// Base of the ICs: what follows the clocks of the board at its own pace. Left alone an IC stays behind; asked, it runs
// through the edges of PHASE and SERVO that it has missed, and while those repeat and it repeats with them it jumps.
#pragma once

#include <algorithm>
#include <cstddef>

#include "systemc/core/model_block.h"
#include "systemc/servo_ic/clock_gen.h"
#include "systemc/servo_ic/clock_history.h"

namespace brick {

class ClockFollower : public ModelBlock {
 public:
  // Clock pins; seen by the edges to come.
  virtual void set_pins(bool phase, bool servo) = 0;
  virtual const ClockGen& clock_gen() const = 0;
  bool phase_oe() const { return clock_gen().phase_oe(); }
  bool servo_oe() const { return clock_gen().servo_oe(); }

  // Executes the edges up to t with the pins as `history` has them; it holds all edges up to t.
  void catch_up(const ClockHistory& history, Tick t) {
    while (next_ < history.size() && history[next_].tick <= t) {
      skip_periods(history, t);
      const ClockHistory::Edge& e = history[next_++];
      advance(e.tick);
      set_pins(e.phase, e.servo);
    }
    advance(t);
    at_ = std::max(at_, t);
  }
  // The history has been cleared; everything in it had been seen.
  void restart_history() {
    next_ = 0;
    marked_ = false;
  }

 protected:
  // Remembers the state that depends on the clocks, at the last executed edge.
  virtual void mark() = 0;
  // Whether that state is the same now and will be, as often as the clock pins repeat what they did since mark().
  virtual bool repeats() const = 0;
  // Takes the time `by` forward in such a state. What the clocks latch or start need not be right until one period
  // later.
  virtual void jump(Tick by) = 0;

 private:
  static constexpr Tick kCalm = 64;  // ticks without an edge of the clocks before a place to mark

  void skip_periods(const ClockHistory& history, Tick t) {
    const std::size_t length = history.length();
    if (marked_ && next_ > mark_at_ + length) marked_ = false;
    if (marked_ && next_ < mark_at_ + length) return;
    // Three periods or more to go: one to see that the state repeats, one to jump, one that is executed again.
    const std::size_t least = marked_ ? 2 : 3;
    if (!history.repeats_from(next_) || history.size() - next_ <= least * length || next_ == 0) return;
    if (history[next_].tick - history[next_ - 1].tick < kCalm) return;
    const Tick before = history[next_].tick - 1;
    if (before > t || before < at_) return;
    advance(before);
    if (marked_ && mark_at_ + length == next_ && mark_tick_ + history.period() == before && repeats()) {
      // The last edge of the history that is not beyond t, in whole periods.
      const auto left = static_cast<Tick>((history.size() - next_) / length);
      const Tick periods = std::min(left, (t - before) / history.period()) - 1;
      if (periods > 0) {
        jump(periods * history.period());
        next_ += static_cast<std::size_t>(periods) * length;
      }
      marked_ = false;
      return;
    }
    mark();
    marked_ = true;
    mark_at_ = next_;
    mark_tick_ = before;
  }

  std::size_t next_ = 0, mark_at_ = 0;  // edges of the history
  Tick mark_tick_ = 0, at_ = 0;
  bool marked_ = false;
};

}  // namespace brick
