// Where the axes of a system are at a moment (firmware/motion/position.h), by moves that the test makes, against the
// profiles of motion:5.2 and motion:5.4 in doubles.
#include <algorithm>
#include <array>

#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/position.h"
}

namespace {

using moving_motors::risen;

constexpr std::int64_t kMs = 8388608;

class PresentPosition : public ::testing::Test {
 protected:
  PresentPosition() {
    s.executing = 1;
    s.active = true;
    for (unsigned axis = 0; axis < AXIS_COUNT; ++axis) {
      s.position[axis] = 1000 + axis;
      now().start[axis] = 2000 + axis;
      next().start[axis] = 3000 + axis;
    }
  }
  move& now() { return s.moves[1]; }
  move& next() { return s.moves[0]; }
  std::array<double, AXIS_COUNT> all() const {
    std::array<double, AXIS_COUNT> position{};
    cs_present_position(&s, position.data());
    return position;
  }
  void stands_at(double first, const char* why) const {
    const auto position = all();
    for (unsigned axis = 0; axis < AXIS_COUNT; ++axis) EXPECT_EQ(position[axis], first + axis) << why;
  }
  coordinate_system s{};
};

// Where the move begins that executes, or waits; without one where the last has ended.
TEST_F(PresentPosition, WithoutAProfileAxesStand) {
  for (const bool waits : {false, true}) {
    s.next_valid = waits;
    for (const move_kind kind : {MOVE_DWELL, MOVE_OWN, MOVE_SEGMENTS}) {
      s.active = true;
      now().kind = kind;
      stands_at(2000, "the move that executes");
    }
    for (const move_kind kind : {MOVE_DWELL, MOVE_OWN, MOVE_LINEAR, MOVE_PVT, MOVE_SPLINE}) {
      s.active = false;
      now().kind = kind;
      stands_at(waits ? 3000 : 1000, "none executes");
    }
  }
}

// Changes of velocity about both corners of a move; before the first the way of the move before counts, if it blends.
// A next one that is in time and blends lets it go on.
TEST_F(PresentPosition, OfALine) {
  now().kind = MOVE_LINEAR;
  now().time = 300 * kMs;
  now().time_before = 50 * kMs;
  now().acceleration = 80 * kMs;
  now().delta[AXIS_X] = 60;
  now().delta[AXIS_Y] = -90;
  now().delta_before[AXIS_Y] = 25;
  now().delta_before[AXIS_Z] = 10;
  for (const double in : {80.0, 40.0, 0.0})
    for (const double out : {80.0, 120.0})
      for (const double s_curve : {0.0, 10.0, 40.0, 60.0})
        for (const bool blended : {false, true})
          for (int follows = 0; follows < 5; ++follows) {
            now().blend_in = static_cast<std::int64_t>(in) * kMs;
            now().stop_length = static_cast<std::int64_t>(out) * kMs;
            now().s_curve = static_cast<std::int64_t>(s_curve) * kMs;
            now().blended = blended;
            s.next_valid = follows != 1;
            s.placed = follows != 2;
            next().blended = follows != 3;
            next().kind = MOVE_LINEAR;
            if (follows == 4) next().blended = s.next_valid = s.placed = false;
            const double s_in = std::min(s_curve * in / 80, in / 2), s_out = std::min(s_curve * out / 80, out / 2);
            const double corner = in / 2 + 300;
            for (double t = 0; t <= corner + out / 2; t += 7.5) {
              s.elapsed = static_cast<std::int64_t>(t * kMs);
              const auto position = all();
              const auto at = [&](double start, double before, double way) {
                const double v0 = blended ? before / 50 : 0, v = way / 300;
                const double risen_in = in > 0 ? risen(t, in, s_in) : t;
                const double fallen = follows == 0 ? 0 : risen(t - corner + out / 2, out, s_out);
                return start + v0 * (t - in / 2 - risen_in) + v * (risen_in - fallen);
              };
              ASSERT_NEAR(position[AXIS_X], at(2000 + AXIS_X, 0, 60), 1e-9) << t << " " << in << " " << follows;
              ASSERT_NEAR(position[AXIS_Y], at(2000 + AXIS_Y, 25, -90), 1e-9) << t << " " << in << " " << follows;
              ASSERT_NEAR(position[AXIS_Z], at(2000 + AXIS_Z, 10, 0), 1e-9) << t << " " << in << " " << follows;
              ASSERT_EQ(position[AXIS_A], 2000 + AXIS_A);
            }
          }
}

struct Point {
  double position, velocity;
};

double hermite(Point from, Point to, double ms, double t) {
  const double u = std::min(t / ms, 1.0), way = to.position - from.position;
  return from.position + from.velocity * ms * u + (3 * way - (2 * from.velocity + to.velocity) * ms) * u * u +
         ((from.velocity + to.velocity) * ms - 2 * way) * u * u * u;
}

// Of cubics of 20, 30 and 50 ms, as many as there are, at each moment to behind the last.
void expect_cubics(coordinate_system& s, unsigned knots, unsigned axis, const std::array<Point, KNOTS>& points) {
  const double ms[] = {20, 30, 50};
  double begins = 0;
  for (unsigned i = 0; i + 1 < knots; begins += ms[i++]) {
    const double longest = ms[i] * (i + 2 == knots ? 1.5 : 1.0);
    for (double t = 0; t <= longest; t += 2.5) {
      s.elapsed = static_cast<std::int64_t>((begins + t) * kMs);
      double position[AXIS_COUNT];
      cs_present_position(&s, position);
      ASSERT_NEAR(position[axis], hermite(points[i], points[i + 1], ms[i], t), 1e-9) << knots << " " << i << " " << t;
      ASSERT_EQ(position[AXIS_B], 8);
    }
  }
}

TEST_F(PresentPosition, OfPvtMoves) {
  const std::array<Point, KNOTS> moves = {Point{5, 0.5}, {9, -1.25}, {-3, 0.75}, {4, 2}},
                                 stands_first = {Point{5, 0}, {5, 0}, {6, 0}, {6, 1}};
  now().kind = MOVE_PVT;
  now().knot_time[0] = 20 * kMs;
  now().knot_time[1] = 30 * kMs;
  now().knot_time[2] = 50 * kMs;
  for (const auto& points : {moves, stands_first})
    for (const unsigned knots : {2u, 3u, 4u}) {
      now().knot_count = knots;
      for (unsigned i = 0; i < KNOTS; ++i) {
        now().knots[i].position[AXIS_X] = points[i].position;
        now().knots[i].velocity[AXIS_X] = points[i].velocity;
        now().knots[i].position[AXIS_B] = 8;
      }
      expect_cubics(s, knots, AXIS_X, points);
    }
}

// motion:5.4/4: a point is passed at (before + 4 at + after) / 6 with (after - before) over the time of both; the last
// is where it ends.
TEST_F(PresentPosition, OfSplines) {
  const double p[] = {1, 7, -2, 4}, ahead = 10, last = 60;
  now().kind = MOVE_SPLINE;
  now().knot_count = 4;
  now().time = static_cast<std::int64_t>(last) * kMs;
  now().time_ahead = static_cast<std::int64_t>(ahead) * kMs;
  now().knot_time[0] = 20 * kMs;
  now().knot_time[1] = 30 * kMs;
  now().knot_time[2] = 50 * kMs;
  for (unsigned i = 0; i < KNOTS; ++i) {
    now().knots[i].position[AXIS_X] = p[i];
    now().knots[i].position[AXIS_B] = 8;
    now().knots[i].velocity[AXIS_X] = now().knots[i].velocity[AXIS_B] = 99;
  }
  const std::array<Point, KNOTS> points = {Point{(p[0] + 4 * p[1] + p[2]) / 6, (p[2] - p[0]) / (ahead + 20)},
                                           {(p[1] + 4 * p[2] + p[3]) / 6, (p[3] - p[1]) / (20 + last)},
                                           {(p[2] + 5 * p[3]) / 6, (p[3] - p[2]) / (30 + last)},
                                           {p[3], 0}};
  expect_cubics(s, 4, AXIS_X, points);
}

// TA0 TS0: a velocity is there at once. Where such moves are aborted their virtual axes stand.
TEST(AbortedMove, WithoutAcceleration) {
  const coordinate_system& s = coordinate_systems[0];
  for (const unsigned ticks : {1u, 100u, 300u}) {
    platform::power_up();
    for (const char* line : {"OPEN PROG 1 CLEAR", "TA0 TS0 TM100 X10", "X10 Y-5", "CLOSE", "&1B1R"})
      ASSERT_EQ(platform::host(line), "");
    for (int i = 0; i < 1000 && !s.active; ++i) platform::servo_ticks(1);
    platform::servo_ticks(ticks);
    ASSERT_TRUE(s.active);
    ASSERT_EQ(platform::host("A"), "");
    platform::servo_ticks(3);
    const double t = ticks * moving_motors::kTickMs;
    EXPECT_NEAR(s.position[AXIS_X], std::min(t, 100.0) / 10, 1e-6) << t << " ms";
    EXPECT_NEAR(s.position[AXIS_Y], -std::max(t - 100, 0.0) / 20, 1e-6) << t << " ms";
  }
}

}  // namespace
