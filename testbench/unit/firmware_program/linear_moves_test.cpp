// LINEAR moves of motors (motion:4.2): where they are at each servo interrupt, blending, limits, exact ends.
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class LinearMoves : public MovingMotors {};

TEST_F(LinearMoves, OneMoveFollowsItsProfile) {
  struct Case {
    const char* rates;
    double time, acceleration, s;
  };
  const Case cases[] = {{"TM100 TA40 TS0", 100, 40, 0},   {"TM100 TA40 TS10", 100, 40, 10},
                        {"TM100 TA40 TS20", 100, 40, 20}, {"TM100 TA0 TS30", 100, 60, 30},
                        {"TM10 TA80 TS5", 80, 80, 5},     {"F100 TA20 TS0", 30, 20, 0}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.rates);
    platform::power_up();
    fit({"1000X", "-2.5X+7"});
    store({c.rates, "X3"});
    motors[1].trajectory = static_cast<std::int64_t>(7 * kUnit);  // the axis is at 0
    const std::vector<Move> x = {{3000, c.time, c.acceleration, c.s}}, second = {{-7.5, c.time, c.acceleration, c.s}};
    auto profiles = std::vector{changes_of(x, c.acceleration), changes_of(second, c.acceleration)};
    const double begin = at(2);
    double worst = 0.0;
    const double end = run([&](double t) {
      worst = std::max(worst, std::abs(at(1) - way(profiles[0], t)));
      worst = std::max(worst, std::abs(at(2) - begin - way(profiles[1], t)));
    });
    EXPECT_LT(worst * kUnit, 3.0);
    EXPECT_EQ(motors[0].trajectory, 3000 * 3072);
    EXPECT_EQ(motors[1].trajectory, -1536);  // half a count
    EXPECT_NEAR(end, c.time + c.acceleration, kTickMs);
  }
}

// Longer and shorter accelerations than that of the move before, corners, motors that stop and start in a blend.
TEST_F(LinearMoves, BlendedMovesFollowTheirProfile) {
  fit({"1000X", "500Y", "8660X-5000Y"});
  store({"TM100 TA40 TS10 X1", "TA80 X2 Y1", "TA20 TS5 Y3", "TM150 TA60 TS30 X-1 Y3", "DELAY70", "TA10 TS0 X0 Y0"});
  const double dx[] = {1, 1, 0, -3, 0, 1}, dy[] = {0, 1, 2, 0, 0, -3};
  const double time[] = {100, 100, 100, 150, 70, 150}, ta[] = {40, 80, 20, 60, 60, 10}, ts[] = {10, 10, 5, 30, 30, 0};
  std::vector<Move> moves[3];
  for (unsigned i = 0; i < 6; ++i) {
    moves[0].push_back({1000 * dx[i], time[i], ta[i], ts[i]});
    moves[1].push_back({500 * dy[i], time[i], ta[i], ts[i]});
    moves[2].push_back({8660 * dx[i] - 5000 * dy[i], time[i], ta[i], ts[i]});
  }
  const double end = follow({changes_of(moves[0], 10), changes_of(moves[1], 10), changes_of(moves[2], 10)});
  EXPECT_NEAR(end, 20 + 100 + 100 + 100 + 150 + 70 + 150 + 5, kTickMs);
  for (unsigned motor = 0; motor < 3; ++motor) EXPECT_EQ(motors[motor].trajectory, 0);
}

// At each stop the commanded position is the target, whatever came before.
TEST_F(LinearMoves, EndsAreExact) {
  fit({"1000X", "333.25Y"});
  Lines lines = {"TM20 TA7 TS2"};
  std::vector<std::int64_t> x, y;
  std::uint32_t seed = 1;
  const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) >> 8 & 0xFFFF; };
  for (int i = 0; i < 40; ++i) {
    const int a = static_cast<int>(random()) - 32768, b = static_cast<int>(random()) - 32768;
    lines.push_back("X" + std::to_string(a / 1000) + "Y" + std::to_string(b));
    if (i % 4 == 3) {
      lines.push_back("DWELL3");
      x.push_back(a / 1000 * 1000 * 3072);
      y.push_back(static_cast<std::int64_t>(b) * 1023744);
    }
  }
  store(lines);
  std::size_t stops = 0;
  bool dwelt = false;
  run([&](double) {
    const bool dwells = cs().active && cs().moves[cs().executing].kind == MOVE_DWELL;
    if (dwells && !dwelt) {
      ASSERT_LT(stops, x.size());
      EXPECT_EQ(motors[0].trajectory, x[stops]);
      EXPECT_EQ(motors[1].trajectory, y[stops]);
      ++stops;
    }
    dwelt = dwells;
  });
  EXPECT_EQ(stops, 10u);
}

TEST_F(LinearMoves, AMillionIncrementalMovesOfWholeCountsDriftByNothing) {
  fit({"1000X", "Y"});
  constexpr int kMoves = 1000000;
  ASSERT_EQ(host("I8=0"), "");  // real-time interrupts as often as servo interrupts
  store({"TM0 TA0 TS0 INC P1=0", "WHILE(P1<" + std::to_string(kMoves) + ")", "X0.001 Y3 P1=P1+1", "ENDWHILE"});
  run();
  EXPECT_EQ(motors[0].trajectory, std::int64_t{kMoves} * 3072);
  EXPECT_EQ(motors[1].trajectory, std::int64_t{kMoves} * 3 * 3072);
}

// Largest velocity and acceleration (counts a ms, a ms^2) of a motor, from differences over four servo interrupts.
struct Extremes {
  std::vector<double> last;
  double velocity = 0.0, acceleration = 0.0;
  void add(double position) {
    last.push_back(position);
    const std::size_t n = last.size();
    if (n < 9) return;
    const double time = 4 * kTickMs, now = (last[n - 1] - last[n - 5]) / time,
                 before = (last[n - 5] - last[n - 9]) / time;
    velocity = std::max(velocity, std::abs(now));
    acceleration = std::max(acceleration, std::abs(now - before) / time);
  }
};

// motion:4.2, its checks: 10,000 counts a unit, F10, TA200 TS0, Ixx17 = 0.25.
TEST_F(LinearMoves, AccelerationLimitStretchesTheCorner) {
  struct Case {
    const char *first, *second;
    double by1[2], by2[2], time, corner;
  };
  const double diagonal = std::sqrt(2.0);
  const Case cases[] = {{"X20", "X20 Y20", {200000, 0}, {0, 200000}, 2000, 400},
                        {"X20 Y20", "X0 Y40", {200000, 200000}, {-200000, 200000}, 2000 * diagonal, 400 * diagonal}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.second);
    platform::power_up();
    fit({"10000X", "10000Y"});
    ASSERT_EQ(host("I117=0.25 I217=0.25"), "");
    store({"F10 TA200 TS0", c.first, c.second});
    const double begin = std::abs(c.by1[0]) / c.time / 0.25, end = std::abs(c.by2[1]) / c.time / 0.25;
    std::vector<std::vector<Change>> profiles;
    for (int i = 0; i < 2; ++i)
      profiles.push_back(changes_of({{c.by1[i], c.time, begin, 0}, {c.by2[i], c.time, c.corner, 0}}, end));
    follow(profiles, 6.0);
  }
}

// Ixx16 makes the move longer, for all motors.
TEST_F(LinearMoves, VelocityLimitStretchesTheMove) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I216=5"), "");
  store({"TM100 TA40 TS0", "X4 Y2"});  // 20 counts a ms
  follow({changes_of({{4000, 400, 40, 0}}, 40), changes_of({{2000, 400, 40, 0}}, 40)});
}

// A short move is so slow that it could stop in itself: with v = d / Tm, Tm = v / Ixx17 + TS.
TEST_F(LinearMoves, EachMoveCanStopWithinItself) {
  fit({"1000X"});
  ASSERT_EQ(host("I117=0.1"), "");
  store({"TM10 TA10 TS5 INC", "X0.4", "X0.4", "X0.4"});
  const double time = (5 + std::sqrt(25 + 4 * 400 / 0.1)) / 2;
  follow({changes_of({{400, time, time, 5}, {400, time, 10, 5}, {400, time, 10, 5}}, time)});
}

TEST_F(LinearMoves, LimitsHoldInAnySequence) {
  std::uint32_t seed = 7;
  const auto random = [&](std::uint32_t below) { return (seed = seed * 1664525u + 1013904223u) / 65536 % below; };
  for (int round = 0; round < 6; ++round) {
    platform::power_up();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I116=20 I117=0.2 I216=30 I217=0.1"), "");
    Lines lines = {"F40 TS0 TA0"};
    for (int i = 0; i < 60; ++i) {
      if (random(5) == 0) lines.push_back("TA" + std::to_string(random(100)) + "TS" + std::to_string(random(40)));
      lines.push_back("X" + std::to_string(random(4)) + "Y" + std::to_string(random(3)));
    }
    store(lines);
    Extremes x, y;
    run([&](double) { x.add(at(1)), y.add(at(2)); });
    EXPECT_LE(x.velocity, 20 * 1.001) << round;
    EXPECT_LE(y.velocity, 30 * 1.001);
    EXPECT_LE(x.acceleration, 0.2 * 1.01);
    EXPECT_LE(y.acceleration, 0.1 * 1.01);
    EXPECT_GT(x.velocity, 10.0);
    EXPECT_GT(x.acceleration, 0.19);
  }
}

// firmware:1.10: the trajectory word is what the servo loop is asked to follow.
TEST_F(LinearMoves, ALineThatComesLateBlendsFromWhereItIs) {
  fit({"1000X"});
  ASSERT_EQ(host("&1 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("TM200 TA40 TS0 X1"), "");
  ASSERT_EQ(host("R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(170.0));
  ASSERT_EQ(host("TA100 X2"), "");  // its blend should have begun at 170 ms
  Extremes x;
  for (int i = 0; i < 2000 && cs().active; ++i) {
    x.add(at(1));
    platform::servo_ticks(1);
  }
  EXPECT_EQ(motors[0].trajectory, 2000 * 3072);
  EXPECT_LE(x.velocity, 5.001);
  EXPECT_LE(x.acceleration, 5.0 / 100.0 * 1.01) << "same velocity: only the stop accelerates";
}

}  // namespace
