// The levels of the board's PHASE and SERVO nets over time, so that an IC which follows them need not run along with
// them: it catches up when somebody wants to know something about it. The list also finds out on its own whether the
// clocks repeat.
#pragma once

#include <cstddef>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class ClockHistory {
 public:
  struct Edge {
    Tick tick;  // the levels are those after this edge, seen by the edges after it
    bool phase, servo;
  };

  std::size_t size() const { return edges_.size(); }
  const Edge& operator[](std::size_t i) const { return edges_[i]; }

  // From edge number `i` on each edge is as the one `length()` before it, `period()` ticks later.
  bool repeats_from(std::size_t i) const { return length_ != 0 && i >= steady_ && i >= length_; }
  std::size_t length() const { return length_; }
  Tick period() const { return period_; }

  // Everybody should catch up before `e` comes: the list is full, or a long regular stretch would end with it.
  bool should_end(const Edge& e) const {
    const std::size_t n = edges_.size();
    return n >= kLongest || (n > 9 * length_ && repeats_from(n - 8 * length_) && !fits(e));
  }

  void push(const Edge& e) {
    const std::size_t n = edges_.size();
    if (!fits(e)) steady_ = n + 1;
    const bool servo_falls = n != 0 && edges_[n - 1].servo && !e.servo;
    const bool phase_falls = n != 0 && edges_[n - 1].phase && !e.phase;
    if (servo_falls) servo_fall_ = n;
    // Without SERVO the clocks may repeat with PHASE.
    if (servo_falls || (phase_falls && n - servo_fall_ > kLongestServo)) {
      const std::size_t length = n - last_fall_;
      if (length != 0 && (length != length_ || e.tick - edges_[last_fall_].tick != period_)) {
        length_ = length;
        period_ = e.tick - edges_[last_fall_].tick;
        steady_ = n + 1;
      }
      last_fall_ = n;
    }
    edges_.push_back(e);
  }
  void clear() {
    edges_.clear();
    length_ = steady_ = last_fall_ = servo_fall_ = 0;
    period_ = 0;
  }

 private:
  static constexpr std::size_t kLongest = 32768;
  static constexpr std::size_t kLongestServo = 2 * 16 + 2;  // edges in a period of SERVO

  bool fits(const Edge& e) const {
    const std::size_t n = edges_.size();
    if (length_ == 0 || n < length_) return false;
    const Edge& o = edges_[n - length_];
    return e.tick == o.tick + period_ && e.phase == o.phase && e.servo == o.servo;
  }

  std::vector<Edge> edges_;
  std::size_t length_ = 0, steady_ = 0, last_fall_ = 0, servo_fall_ = 0;
  Tick period_ = 0;
};

}  // namespace brick
