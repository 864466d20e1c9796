// The motion of a jogging motor in double precision, from motion:4.1 and motion:4.2 alone: counts and milliseconds.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace jog_model {

struct Limits {
  double ixx19, ixx20, ixx21, ixx22;
};

struct State {
  double position, speed;
};

inline double change_time(const Limits& l, double change) {
  if (change == 0) return 0;
  return std::max({l.ixx20, 2 * l.ixx21, 1.0, std::abs(change) / l.ixx19 + l.ixx21});
}

// Acceleration as it goes on: parts of constant jerk, integrated one behind the other.
class Motion {
 public:
  explicit Motion(State begin) : begin_(begin), now_(begin) {}

  void change(const Limits& l, double to) {
    const double time = change_time(l, to - now_.speed), s = l.ixx21;
    if (time == 0) return;
    const double peak = (to - now_.speed) / (time - s);
    if (s > 0) add(s, 0, peak / s);
    add(time - 2 * s, peak, 0);
    if (s > 0) add(s, peak, -peak / s);
    now_.speed = to;
  }
  void stay(double time) { add(time, 0, 0); }
  void ramp(double deceleration) {
    if (now_.speed != 0) add(std::abs(now_.speed) / deceleration, now_.speed > 0 ? -deceleration : deceleration, 0);
    now_.speed = 0;
  }

  State at(double t) const {
    State s = begin_;
    for (const Part& part : parts_) {
      if (t <= 0) return s;
      s = after(s, part, std::min(t, part.time));
      t -= part.time;
    }
    if (t > 0) s.position += s.speed * t;
    return s;
  }
  State end() const { return now_; }
  double time() const {
    double sum = 0;
    for (const Part& part : parts_) sum += part.time;
    return sum;
  }

 private:
  struct Part {
    double time, acceleration, jerk;
  };
  static State after(State s, const Part& p, double t) {
    return {s.position + s.speed * t + p.acceleration * t * t / 2 + p.jerk * t * t * t / 6,
            s.speed + p.acceleration * t + p.jerk * t * t / 2};
  }
  void add(double time, double acceleration, double jerk) {
    if (time <= 0) return;
    parts_.push_back({time, acceleration, jerk});
    now_ = after(now_, parts_.back(), time);
  }
  State begin_, now_;
  std::vector<Part> parts_;
};

inline Motion at_speed(const Limits& l, State from, double speed) {
  Motion m(from);
  m.change(l, speed);
  return m;
}

inline Motion to_rest_over(const Limits& l, State from, double speed, double stay) {
  Motion m(from);
  m.change(l, speed);
  m.stay(stay);
  m.change(l, 0);
  return m;
}

// To rest at `target`: at Ixx22 if there is room, else at the speed for which there is just enough, found by halving.
inline Motion to_target(const Limits& l, State from, double target) {
  const auto miss = [&](double speed) { return target - to_rest_over(l, from, speed, 0).end().position; };
  const double stop = target - to_rest_over(l, from, from.speed, 0).end().position;
  if (std::abs(stop) < 1e-4) return at_speed(l, from, 0);
  const double way = stop > 0 ? 1 : -1, along = from.speed * way;
  const double top = l.ixx22 * way;
  if (miss(top) * way >= 0) return to_rest_over(l, from, top, miss(top) / top);
  const bool keeps = along > 0 && (along >= l.ixx22 || stop * way < along * change_time(l, 1e-12));
  if (keeps) return to_rest_over(l, from, from.speed, stop / from.speed);
  double low = std::max(along, 0.0), high = l.ixx22;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (miss(middle * way) * way >= 0 ? low : high) = middle;
  }
  return to_rest_over(l, from, low * way, 0);
}

}  // namespace jog_model
