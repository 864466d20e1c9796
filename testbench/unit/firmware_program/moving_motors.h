// Motors of &1 that a program moves, with closed loops that nothing is behind: where the servo task has each at every
// servo interrupt, and the profile that motion:5.2 asks for, in doubles, as a sum of changes of velocity.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/motor.h"
}

namespace moving_motors {

using platform::host;
using Lines = std::vector<std::string>;

constexpr double kTickMs = platform::kDefaultI10 / 8388608.0;
constexpr double kUnit = 32 * 96;  // of a position in a count, Ixx08 = 96

// X words of channel 1, as Ixx25 = $78000 has it.
constexpr std::uint32_t kStatus = 0x78000, kCaptured = 0x78003, kCaptureFlag = 1u << 11;

inline unsigned ticks_of(double ms) { return static_cast<unsigned>(std::ceil(ms / kTickMs)); }

// Way after `t` ms of a velocity that rises from 0 to 1 in `length` ms, S-shaped for `s` ms at both ends.
inline double risen(double t, double length, double s) {
  if (t <= 0.0) return 0.0;
  if (t >= length) return t - length / 2.0;
  const double peak = 1.0 / (length - s);
  if (s <= 0.0) return peak * t * t / 2.0;
  if (t <= s) return peak * t * t * t / (6.0 * s);
  if (t >= length - s) return t - length / 2.0 + risen(length - t, length, s);
  return peak * (s * s / 6.0 + s * (t - s) / 2.0 + (t - s) * (t - s) / 2.0);
}

// Changes of velocity (counts a ms) about a time.
struct Change {
  double centre, length, s, by;
};

inline double way(const std::vector<Change>& changes, double t) {
  double sum = 0.0;
  for (const Change& c : changes) sum += c.by * risen(t - (c.centre - c.length / 2.0), c.length, c.s);
  return sum;
}

// Moves of one motor from `start` that blend: displacement (counts) and time of each, acceleration at its beginning.
struct Move {
  double by, time, acceleration, s;
};

inline std::vector<Change> changes_of(const std::vector<Move>& moves, double last_stop) {
  std::vector<Change> changes;
  double velocity = 0.0, corner = moves.front().acceleration / 2.0;
  for (const Move& m : moves) {
    changes.push_back({corner, m.acceleration, m.s, m.by / m.time - velocity});
    velocity = m.by / m.time;
    corner += m.time;
  }
  changes.push_back({corner, last_stop, moves.back().s, -velocity});
  return changes;
}

class MovingMotors : public FirmwareTest {
 protected:
  static coordinate_system& cs() { return coordinate_systems[0]; }
  // `#n->` definitions of motors 1, 2 ... of &1, loops closed, limits that nothing reaches.
  static void fit(const Lines& definitions) {
    unsigned n = 0;
    for (const std::string& definition : definitions) {
      const std::string motor = std::to_string(++n);
      ASSERT_EQ(host("I" + motor + "00=1 I" + motor + "16=1000000 I" + motor + "17=1000000"), "");
      ASSERT_EQ(host("I" + motor + "11=0 I" + motor + "12=0"), "") << "nothing follows";
      ASSERT_EQ(host("&1#" + motor + "->" + definition), "") << definition;
      motors[n - 1] = {};
      motors[n - 1].loop = LOOP_CLOSED;
      motors[n - 1].position_scale = 96;
    }
  }
  static void store(const Lines& lines, unsigned program = 1) {
    ASSERT_EQ(host("OPEN PROG " + std::to_string(program) + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
  }
  static double at(unsigned motor) { return static_cast<double>(motors[motor - 1].trajectory) / kUnit; }
  // From the interrupt that begins the first move: `look` at each, with the ms since then, until the program has ended.
  static double run(
      const std::function<void(double)>& look = [](double) {}, const std::string& start = "&1B1R") {
    EXPECT_EQ(host(start), "");
    for (int i = 0; i < 1000 && !cs().active; ++i) platform::servo_ticks(1);
    EXPECT_TRUE(cs().active);
    double t = 0.0, end = 0.0;
    for (unsigned tick = 0; run_is_running(0) && tick < 2000000; ++tick, t = tick * kTickMs) {
      look(t);
      if (cs().active) end = t + kTickMs;
      platform::servo_ticks(1);
    }
    EXPECT_FALSE(run_is_running(0)) << "it does not end";
    return end;
  }
  // Each of the motors is where its profile has it, within `tolerance` units of position.
  static double follow(const std::vector<std::vector<Change>>& profiles, double tolerance = 3.0) {
    double worst = 0.0;
    unsigned looks = 0;
    const double end = run([&](double t) {
      ++looks;
      for (unsigned motor = 1; motor <= profiles.size(); ++motor) {
        const double error = (at(motor) - way(profiles[motor - 1], t)) * kUnit;
        if (std::abs(error) > worst && std::abs(error) > tolerance)
          ADD_FAILURE() << "#" << motor << " at " << t << " ms is " << at(motor) << ", " << error << " units off";
        worst = std::max(worst, std::abs(error));
      }
    });
    EXPECT_GT(looks, 20u);
    return end;
  }
};

}  // namespace moving_motors
