// What lookahead keeps of control points (firmware/motion/lookahead.h): x' and x'' of motors at knots in units of their
// limits and the caps of segments by velocities (motion:7.4), against doubles; and how far it looks.
#include <algorithm>
#include <cmath>
#include <random>

#include "testbench/unit/firmware_program/moving_motors.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/motion/lookahead.h"
#include "firmware/motion/lookahead_limits.h"
#include "firmware/motion/lookahead_state.h"
#include "firmware/motion/system_motors.h"
}

namespace {

using moving_motors::host;
using moving_motors::kUnit;
using moving_motors::MovingMotors;

class LookaheadPoints : public MovingMotors {
 protected:
  static constexpr unsigned kMotors = 2;
  void SetUp() override {
    MovingMotors::SetUp();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 100,10 I5120=40"), "");
  }
  // Counts a ms, counts a ms^2; 0: none.
  static void limits(unsigned motor, double velocity, double acceleration) {
    const std::string i = "I" + std::to_string(motor);
    ASSERT_EQ(host(i + "16=" + std::to_string(velocity) + " " + i + "17=" + std::to_string(acceleration)), "");
  }
  static look& begin(unsigned period) {
    system_motors_resolve(0);
    EXPECT_TRUE(lookahead_begin(0, period));
    return looks[0];
  }
  static void add(std::int64_t x, std::int64_t y, std::uint32_t number) {
    static std::int64_t control[MOTORS][SPLINE_POINTS];
    path_line line = {};
    line.first.offset = static_cast<std::uint16_t>(number + 1);
    control[0][SPLINE_POINTS - 1] = x;
    control[1][SPLINE_POINTS - 1] = y;
    lookahead_add(0, control, number, &line);
  }
};

// Of P[k], P[k+1], P[k+2] at knot k: x' = (P[k+2] - P[k]) / 2 and x'' = P[k+2] - 2 P[k+1] + P[k], 2^14 for A T^2. The
// cap of a segment is (V T / w)^2 with w the largest of its x' coefficients.
TEST_F(LookaheadPoints, KnotsAndCapsOfAPath) {
  std::mt19937_64 random(brick::random_seed(3));
  const auto real = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  const struct {
    double velocity[kMotors], acceleration[kMotors];
    unsigned period;
  } cases[] = {{{50, 3}, {1, 0.02}, 5},      {{0, 20}, {0.5, 0}, 10},     {{100, 0}, {0, 0}, 1},
               {{0.01, 0}, {0, 0.0001}, 20}, {{2e4, 1e3}, {1e3, 1e4}, 3}, {{30, 30}, {0.001, 10}, 50},
               {{10, 7}, {1e6, 3e6}, 3}};
  unsigned capped = 0, bent = 0;
  for (const auto& c : cases) {
    SCOPED_TRACE(::testing::Message() << c.velocity[0] << ", " << c.acceleration[0] << " and " << c.velocity[1] << ", "
                                      << c.acceleration[1] << ", " << c.period << " ms");
    for (unsigned m = 0; m < kMotors; ++m) limits(m + 1, c.velocity[m], c.acceleration[m]);
    look& l = begin(c.period);
    constexpr unsigned kPoints = 60;
    std::vector<std::int64_t> p[kMotors];
    double at[kMotors] = {}, step[kMotors] = {}, vt[kMotors], att[kMotors];
    for (unsigned m = 0; m < kMotors; ++m) {
      vt[m] = c.velocity[m] * kUnit * c.period;
      att[m] = c.acceleration[m] * kUnit * c.period * c.period;
    }
    for (unsigned n = 0; n < kPoints; ++n) {
      for (unsigned m = 0; m < kMotors; ++m) {
        p[m].push_back(std::llround(at[m]));
        const double turn = vt[m] > 0 ? vt[m] : att[m] > 0 ? 4 * att[m] : 1000;
        const double most = vt[m] > 0 ? 3 * vt[m] : 20 * turn;
        step[m] = std::max(-most, std::min(most, step[m] + real(-turn, turn)));
        if (n % 10 > 7) step[m] = 0;
        at[m] += step[m];
      }
      add(p[0].back(), p[1].back(), n);
    }
    for (unsigned k = 0; k + 3 < kPoints; ++k) {
      SCOPED_TRACE(k);
      lookahead_record* record = lookahead_at(&l.buffer, k);
      double cap = 1;
      for (unsigned m = 0; m < kMotors; ++m) {
        const auto d = [&](unsigned i) { return static_cast<double>(p[m][i + 1] - p[m][i]); };
        const lookahead_motor& knot = lookahead_of(record)[m];
        EXPECT_EQ(knot.point, p[m][k]);
        const double pace = att[m] > 0 ? (d(k) + d(k + 1)) / 2 / att[m] : 0,
                     bend = att[m] > 0 ? (d(k + 1) - d(k)) / att[m] : 0;
        // each step is rounded to 2^-15 of the smaller limit, or to a unit
        const double step_error =
            att[m] > 0 ? 2 * 16384 * std::max(1.0, std::min(vt[m] > 0 ? vt[m] : att[m], att[m]) / 32768) / att[m] : 0;
        EXPECT_NEAR(knot.pace, pace * 16384, step_error + 2 + std::abs(pace) * 0.5);
        EXPECT_NEAR(knot.bend, bend * 16384, step_error + 2 + std::abs(bend) * 0.5);
        bent += std::abs(bend) > 1;
        if (vt[m] == 0) continue;
        const double most =
            std::max({std::abs(d(k + 1)), std::abs(d(k) + d(k + 1)) / 2, std::abs(d(k + 1) + d(k + 2)) / 2});
        if (most > vt[m]) cap = std::min(cap, vt[m] * vt[m] / (most * most));
      }
      capped += cap < 1;
      EXPECT_NEAR(record->cap / static_cast<double>(RATE_FULL), cap, 0.001 * cap);
      EXPECT_EQ(record->number, k);
      EXPECT_EQ(record->line.first.offset, k + 1);
      EXPECT_FALSE(record->stops);
    }
  }
  EXPECT_GT(capped, 50u);
  EXPECT_GT(bent, 50u);
}

// motion:7.3/2: Isx20 segments, four at least, as far as the buffer has room behind the eight that are kept.
TEST_F(LookaheadPoints, ItsLengthIsIsx20OrTheRoomThatThereIs) {
  const struct {
    unsigned records, isx20, length;
    bool looks, limits;
  } cases[] = {{100, 0, 0, false, false},    {100, 1, 4, true, false},  {100, 2, 4, true, true},
               {100, 5, 5, true, true},      {100, 92, 92, true, true}, {100, 93, 92, true, true},
               {100, 65535, 92, true, true}, {12, 40, 4, true, true},   {11, 40, 0, false, false},
               {13, 40, 5, true, true}};
  for (const auto& c : cases) {
    SCOPED_TRACE(::testing::Message() << c.records << ", " << c.isx20);
    ASSERT_EQ(host("DELETE LOOKAHEAD DEFINE LOOKAHEAD " + std::to_string(c.records) + ",0"), "");
    ASSERT_EQ(host("I5120=" + std::to_string(c.isx20)), "");
    system_motors_resolve(0);
    ASSERT_EQ(lookahead_begin(0, 5), c.looks);
    if (!c.looks) continue;
    EXPECT_EQ(looks[0].length, c.length);
    EXPECT_EQ(looks[0].limits, c.limits);
    EXPECT_EQ(looks[0].buffer.records, c.records);
    EXPECT_EQ(looks[0].motor_count, kMotors);
  }
}

// It is full with its length between the front and the last knot, or with all but four of the records in use ahead.
TEST_F(LookaheadPoints, ItIsFullWithItsLengthAheadOfTheFront) {
  look& l = begin(5);
  for (const unsigned length : {10u, 90u})
    for (const unsigned records : {60u, 100u})
      for (const unsigned front : {0u, 7u})
        for (unsigned added = front + 3; added < front + records; ++added) {
          l.length = length;
          l.buffer.records = records;
          l.front = front;
          l.added = added;
          l.backward = false;
          ASSERT_EQ(lookahead_is_full(0), added - 3 - front >= length || added - front >= records - 4)
              << length << " " << records << " " << front << " " << added;
          l.backward = true;
          ASSERT_TRUE(lookahead_is_full(0));
        }
  l.backward = false;
}

// Of the four points of a segment the slots of all motors, round the end of the records.
TEST_F(LookaheadPoints, PointsOfASegmentGoRound) {
  ASSERT_EQ(host("DELETE LOOKAHEAD DEFINE LOOKAHEAD 20,3"), "");
  const look& l = begin(5);
  ASSERT_EQ(l.buffer.records, 20u);
  for (int n = 0; n < 50; ++n) {
    add(100 * n, -70 * n, static_cast<std::uint32_t>(n));
    for (int segment = std::max(0, n - 19); segment + 3 <= n; ++segment) {
      const lookahead_motor* points[SPLINE_POINTS];
      lookahead_points(0, static_cast<std::uint32_t>(segment), points);
      for (int i = 0; i < SPLINE_POINTS; ++i) {
        EXPECT_EQ(points[i][0].point, 100 * (segment + i));
        EXPECT_EQ(points[i][1].point, -70 * (segment + i));
      }
    }
  }
}

// motion:7.5/6, motion:7.5/7: Ixx24 bit 15, Ixx13 and Ixx14 nearer by Ixx41: what lies beyond is the limit, and with
// bit 14 = 0 the sequence stops before the first segment that this changes. One that begins further out may stay there.
TEST_F(LookaheadPoints, PointsBeyondALimitAreHeldThere) {
  constexpr std::int64_t kCount = 3072;
  ASSERT_EQ(host("I113=100 I114=-50 I141=10"), "");  // 90 and -40
  for (const bool saturates : {false, true})
    for (const bool guarded : {true, false})
      for (const std::int64_t begins : {0, 95, -70}) {
        SCOPED_TRACE(::testing::Message() << saturates << guarded << " from " << begins);
        ASSERT_EQ(host(std::string("I124=$") + (saturates ? guarded ? "2C001" : "24001"
                                                : guarded ? "28001"
                                                          : "20001")),
                  "");
        const look& l = begin(5);
        EXPECT_EQ(l.guarded, guarded ? 1u : 0u);
        const std::int64_t highest = std::max<std::int64_t>(90, begins), lowest = std::min<std::int64_t>(-40, begins);
        const std::int64_t path[] = {begins, 80, 90, 91, 96, 60, -40, -41, -75, 0, 20, 200};
        std::vector<bool> stops(std::size(path), false);
        std::uint32_t n = 0;
        for (const std::int64_t to : path) {
          add(to * kCount, 500 * kCount, n);
          const bool out = guarded && (to > highest || to < lowest);
          const std::int64_t is = !guarded ? to : std::max(lowest, std::min(highest, to));
          EXPECT_EQ(lookahead_motors(&l.buffer, n)[0].point, is * kCount) << to;
          EXPECT_EQ(lookahead_motors(&l.buffer, n)[1].point, 500 * kCount) << "it has no limits";
          if (out && !saturates) stops[n < 3 ? n : n - 3] = true;
          ++n;
        }
        for (n = 0; n < std::size(path); ++n) EXPECT_EQ(lookahead_at(&l.buffer, n)->stops, stops[n]) << n;
        system_motors_come_along(0);
        lookahead_close(0);
        EXPECT_TRUE(l.closed);
        EXPECT_EQ(system_motor_aside(0), guarded ? static_cast<double>((highest - 200) * kCount) : 0.0);
        EXPECT_EQ(system_motor_aside(1), 0.0);
      }
  for (const char* isx20 : {"1", "2"}) {
    ASSERT_EQ(host(std::string("I124=$28001 I5120=") + isx20), "");
    EXPECT_EQ(begin(5).guarded, *isx20 == '2' ? 1u : 0u) << "limits are those of Isx20 above 1";
  }
}

}  // namespace
