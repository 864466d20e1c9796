// Model of rtl/servo_ic/channel_pwm.sv. Between two special edges of the clock chain the triangle is a straight line,
// so the edge at which the comparison changes is computed, not searched for; the switches follow one edge later.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/model_block.h"

namespace brick {

// The triangle as the next edges see it: cnt, cnt + slope, ...
struct TriangleLine {
  int cnt = 0;
  int slope = 1;

  TriangleLine after(Tick edges) const { return {cnt + slope * static_cast<int>(edges), slope}; }
  bool operator!=(const TriangleLine& o) const { return cnt != o.cnt || slope != o.slope; }
};

class ChannelPwm {
 public:
  void reset(Tick t) {
    account(t);
    const ChannelPwm old = *this;
    *this = ChannelPwm{};
    on_at_ = t + kWaitReset;
    since_ = t;
    balance_ = old.balance_;
    dead_times_ = old.dead_times_;
  }
  void load(int command) { command_ = command; }

  // Executes the edges now + 1 .. t along the line.
  void run(Tick now, Tick t, TriangleLine line, unsigned deadtime) {
    const Tick crossing = next_change(now, line);
    if (crossing <= t) {
      compare(crossing, deadtime);
      line.cnt += line.slope * static_cast<int>(crossing - now - 1);
      const Tick second = crossing + distance(line);
      if (second <= t) compare(second, deadtime);
    }
    if (follow_at_ <= t) follow(deadtime);
    settle(t);
  }

  Tick next_event(Tick now, TriangleLine line) const {
    return std::min(on_at_, std::min(follow_at_, next_change(now, line) + 1));
  }

  // The same state as that of `o`, `by` ticks later.
  bool repeats(const ChannelPwm& o, Tick by) const {
    return command_ == o.command_ && raw_ == o.raw_ && last_ == o.last_ && on_ == o.on_ &&
           on_at_ == later(o.on_at_, by) && follow_at_ == later(o.follow_at_, by);
  }
  // `periods` times what has come to pass since it was `o`, in `by` ticks from `now` on.
  void jump(Tick now, Tick by, const ChannelPwm& o, Tick periods) {
    account(now);
    balance_ += periods * (balance_ - o.balance_);
    dead_times_ += static_cast<std::uint64_t>(periods) * (dead_times_ - o.dead_times_);
    since_ = now + by;
    on_at_ = later(on_at_, by);
    follow_at_ = later(follow_at_, by);
  }

  // After the edge `now`, the last executed: how long the upper switch has been on, less how long the lower one has,
  // and the dead times begun so far.
  Tick balance(Tick now) {
    account(now);
    return balance_;
  }
  std::uint64_t dead_times() const { return dead_times_; }

  bool top() const { return on_ && last_; }
  bool bot() const { return on_ && !last_; }

 private:
  // Edges from that of line.cnt to the one that compares differently.
  int distance(TriangleLine line) const {
    const bool raw = command_ > line.cnt;
    if (line.slope > 0) return raw ? command_ - line.cnt : kFar;
    return raw ? kFar : line.cnt - command_ + 1;
  }
  Tick next_change(Tick now, TriangleLine line) const {
    return now + 1 + ((command_ > line.cnt) != raw_ ? 0 : distance(line));
  }
  // The comparison changes at this edge.
  void compare(Tick edge, unsigned deadtime) {
    if (follow_at_ <= edge) follow(deadtime);
    raw_ = !raw_;
    follow_at_ = edge + 1;
  }
  void follow(unsigned deadtime) {
    settle(follow_at_ - 1);
    account(follow_at_);
    if (deadtime != 0) ++dead_times_;
    last_ = !last_;
    on_ = deadtime == 0;
    on_at_ = on_ ? kNever : follow_at_ + kDeadtimeUnit * static_cast<Tick>(deadtime);
    follow_at_ = kNever;
  }
  void settle(Tick t) {
    if (on_at_ > t) return;
    account(on_at_);
    on_ = true;
    on_at_ = kNever;
  }

  void account(Tick t) {
    if (on_) balance_ += last_ ? t - since_ : since_ - t;
    since_ = t;
  }

  static Tick later(Tick edge, Tick by) { return edge == kNever ? kNever : edge + by; }

  static constexpr Tick kDeadtimeUnit = 16;  // ticks
  static constexpr Tick kWaitReset =
      kDeadtimeUnit * Tick{regs::servo_ic::pwm_control::kDeadtime.get(regs::servo_ic::kPwmControl.reset)};
  static constexpr int kFar = 1 << 24;  // beyond the end of any line
  int command_ = 0;
  bool raw_ = false, last_ = false;  // comparison, and what the switches follow
  bool on_ = false;                  // one of the two switches is on
  Tick follow_at_ = kNever;          // edge at which they take the comparison
  Tick on_at_ = kWaitReset;
  Tick balance_ = 0, since_ = 0;  // accounted up to `since`
  std::uint64_t dead_times_ = 0;
};

}  // namespace brick
