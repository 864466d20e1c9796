#include "systemc/servo_ic/clock_gen.h"

#include <algorithm>

namespace brick {
namespace {

constexpr int kWindow = 8;          // ticks in which a turnaround follows the external edge at once
constexpr unsigned kMissLimit = 3;  // the fourth edge in a row outside the window forces it

// Edge at which a register behind the two-flop synchroniser takes a new level, counted from the last executed edge.
Tick edges_until_change(bool level, bool stage2, bool stage1, bool pin) {
  if (stage2 != level) return 1;
  if (stage1 != level) return 2;
  return pin != level ? 3 : kNever;
}

}  // namespace

void ClockGen::reset(Tick t) {
  s_ = State{};
  now_ = t;
}

Tick ClockGen::next_special_edge() const {
  Tick next = next_turn();
  if (s_.ramp < 0) next = std::min(next, now_ - s_.ramp);  // half way: ramp == -1 before the edge
  if (phase_release() || servo_release() || settings_move()) return now_ + 1;
  if (phase_ext()) next = std::min(next, now_ + edges_until_change(s_.phase, s_.phase2, s_.phase1, in.phase));
  if (servo_ext()) next = std::min(next, now_ + edges_until_change(s_.servo, s_.servo2, s_.servo1, in.servo));
  return next;
}

void ClockGen::skip(Tick edges) {
  if (edges <= 0) return;
  now_ += edges;
  s_.ramp += static_cast<int>(edges);
  s_.phase2 = edges > 1 ? in.phase : s_.phase1;
  s_.servo2 = edges > 1 ? in.servo : s_.servo1;
  s_.phase1 = in.phase;
  s_.servo1 = in.servo;
  if (phase_ext()) s_.phase_cnt = s_.set.phase_div, s_.fall_cnt = 0, s_.odd = false;  // kept ready for a full period
  if (servo_ext()) s_.servo_cnt = s_.set.servo_div;
}

// At a rising edge of the external phase clock. Returns true when the coming turnaround is moved here; `retard` is set
// when the last one is moved back to here. In the first half of the way the last one is the nearest.
bool ClockGen::align(bool& retard) {
  const bool first_half = s_.ramp < 0;
  const int distance = first_half ? s_.top + s_.ramp + 1 : s_.top - s_.ramp;
  if (distance > kWindow && s_.miss != kMissLimit) {
    ++s_.miss;
    return false;
  }
  s_.miss = 0;
  retard = first_half;
  return !retard;
}

// One clock edge, as the RTL describes it.
void ClockGen::step() {
  const bool middle = s_.ramp == -1;
  const bool last_phase = s_.phase, last_servo = s_.servo;
  const bool phase_follows = phase_ext(), servo_follows = servo_ext();
  const bool phase_goes = phase_release(), servo_goes = servo_release();
  bool turn = s_.ramp == s_.top;
  bool retard = false;
  if (phase_follows && s_.phase2 && !s_.phase) turn |= align(retard);

  if (phase_follows) {
    s_.phase = s_.phase2;
    s_.phase_cnt = s_.set.phase_div;
    s_.fall_cnt = 0;
    s_.odd = false;
  } else if (turn) {
    if (s_.phase_cnt == 0) {
      s_.phase = true;
      s_.phase_cnt = s_.set.phase_div;
      s_.fall_cnt = (s_.set.phase_div + 1) / 2;
      s_.odd = s_.set.phase_div % 2 == 0;
    } else {
      --s_.phase_cnt;
      if (s_.fall_cnt == 1 && !s_.odd) s_.phase = false;
      if (s_.fall_cnt != 0) --s_.fall_cnt;
    }
  } else if (middle && s_.odd && s_.fall_cnt == 0) {
    s_.phase = false;
  }
  if (phase_goes) s_.phase = true;  // a fall at this edge stays away from the net, so no latch may see it

  if (servo_follows) {
    s_.servo = s_.servo2;
    s_.servo_cnt = s_.set.servo_div;
  } else if (s_.phase && !last_phase) {
    if (s_.servo_cnt == 0) s_.servo = true;
  } else if (!s_.phase && last_phase) {
    if (s_.servo_cnt == 0) {
      s_.servo = false;
      s_.servo_cnt = s_.set.servo_div;
    } else {
      s_.servo = true;
      --s_.servo_cnt;
    }
  }

  if (servo_goes) s_.servo = true;

  if (phase_goes) s_.phase_oe = false;
  if (servo_goes) s_.servo_oe = false;
  if (!s_.set.phase_ext && !last_phase && s_.phase && s_.phase2) s_.phase_oe = true;
  if (!s_.set.servo_ext && !last_servo && s_.servo && s_.servo2) s_.servo_oe = true;

  s_.ramp = turn || retard ? -s_.top : s_.ramp + 1;
  if (turn) {
    s_.up = !s_.up;
    if (s_.up) s_.top = static_cast<int>(s_.set.max_count) + 1;  // that was the bottom
  }
  s_.phase2 = s_.phase1;
  s_.servo2 = s_.servo1;
  s_.phase1 = in.phase;
  s_.servo1 = in.servo;
  s_.set = in;
  ++now_;
}

void ClockGen::advance(Tick t) {
  while (now_ < t) {
    const Tick edge = next_special_edge();
    if (edge > t) {
      skip(t - now_);
    } else {
      skip(edge - 1 - now_);
      step();
    }
  }
}

// Tick of the turnaround that is `turns` turnarounds ahead, 1 being the next.
Tick ClockGen::turn_after(unsigned turns) const {
  Tick at = next_turn();
  int top = s_.top;
  bool up = s_.up;
  for (unsigned i = 1; i < turns; ++i) {
    const int last = top;
    if (!up) top = static_cast<int>(s_.set.max_count) + 1;
    up = !up;
    at += last + top + 1;
  }
  return at;
}

Tick ClockGen::next_event() const {
  if (!active()) return kNever;
  if (phase_release() || servo_release() || settings_move()) return now_ + 1;
  Tick next = kNever;
  if (phase_ext()) {
    next = now_ + edges_until_change(s_.phase, s_.phase2, s_.phase1, in.phase);
  } else if (s_.phase && s_.odd) {
    // Falls half way to the turnaround after the fall_cnt-th one; `top` before that turnaround is the length of the way
    // up.
    if (s_.fall_cnt == 0) {
      next = s_.ramp < 0 ? now_ - s_.ramp : next_turn();
    } else {
      const Tick turn = turn_after(s_.fall_cnt);
      int top = s_.top;
      bool up = s_.up;
      for (unsigned i = 1; i < s_.fall_cnt; ++i, up = !up)
        if (!up) top = static_cast<int>(s_.set.max_count) + 1;
      next = turn + top;
    }
  } else if (s_.phase && s_.fall_cnt != 0) {
    next = turn_after(s_.fall_cnt);
  } else {
    next = turn_after(s_.phase_cnt + 1);
  }
  return next;
}

}  // namespace brick
