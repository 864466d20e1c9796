// Segments (motion:7.1) at each servo interrupt against a B-spline that the test evaluates in doubles, of points that
// it takes from the formulas of motion:5.2 and of circles.
#include <set>

#include "testbench/unit/firmware_paths/pi.h"
#include "testbench/unit/firmware_paths/spline_path.h"
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/path.h"
#include "firmware/motion/path_motors.h"
#include "firmware/motion/segment.h"
#include "firmware/motion/system_path.h"
}

namespace {

using namespace moving_motors;
using spline_path::Spline;

class Segments : public MovingMotors {
 protected:
  static double follow(const std::vector<Spline>& motors, double tolerance = 4.0) {
    double worst = 0.0;
    const double end = run([&](double t) {
      for (unsigned i = 0; i < motors.size(); ++i) {
        const double error = (at(i + 1) - motors[i].at(t)) * kUnit;
        if (std::abs(error) > std::max(worst, tolerance))
          ADD_FAILURE() << "#" << i + 1 << " at " << t << " ms is " << at(i + 1) << ", " << error << " units off";
        worst = std::max(worst, std::abs(error));
      }
    });
    return end;
  }
};

TEST_F(Segments, OneMoveIsTheSplineOfItsPoints) {
  for (const int isx13 : {1, 7, 10, 100, 255}) {
    SCOPED_TRACE(isx13);
    platform::power_up();
    fit({"1000X", "-2.5X"});
    ASSERT_EQ(host("I5113=" + std::to_string(isx13)), "");
    store({"TM100 TA40 TS10", "X3"});
    const auto changes = changes_of({{3000, 100, 40, 10}}, 40);
    const Spline x([&](double t) { return way(changes, t); }, 140, isx13);
    const Spline second([&](double t) { return -2.5e-3 * way(changes, t); }, 140, isx13);
    const double end = follow({x, second});
    EXPECT_NEAR(end, x.length(), kTickMs);
    EXPECT_NEAR(end, std::ceil(140.0 / isx13) * isx13 + 2 * isx13, kTickMs) << "2 Isx13 longer than motion:5.2 says";
    EXPECT_EQ(motors[0].trajectory, 3000 * 3072);
    EXPECT_EQ(motors[1].trajectory, -7.5 * 3072);
  }
}

TEST_F(Segments, BlendedMovesKeepTheirTrajectory) {
  fit({"1000X", "500Y", "8660X-5000Y"});
  ASSERT_EQ(host("I5113=5"), "");
  store({"TM100 TA40 TS10 X1", "TA80 X2 Y1", "TA20 TS5 Y3", "TM150 TA60 TS30 X-1 Y3", "DELAY70", "TA10 TS0 X0 Y0"});
  const double dx[] = {1, 1, 0, -3, 0, 1}, dy[] = {0, 1, 2, 0, 0, -3};
  const double time[] = {100, 100, 100, 150, 70, 150}, ta[] = {40, 80, 20, 60, 60, 10}, ts[] = {10, 10, 5, 30, 30, 0};
  std::vector<Move> moves[3];
  for (unsigned i = 0; i < 6; ++i) {
    moves[0].push_back({1000 * dx[i], time[i], ta[i], ts[i]});
    moves[1].push_back({500 * dy[i], time[i], ta[i], ts[i]});
    moves[2].push_back({8660 * dx[i] - 5000 * dy[i], time[i], ta[i], ts[i]});
  }
  std::vector<Spline> splines;
  const double length = 20 + 100 + 100 + 100 + 150 + 70 + 150 + 5;
  for (const auto& m : moves) {
    const auto changes = changes_of(m, 10);
    splines.emplace_back([=](double t) { return way(changes, t); }, length, 5);
  }
  EXPECT_NEAR(follow(splines), length + 10, kTickMs);
  for (unsigned motor = 0; motor < 3; ++motor) EXPECT_EQ(motors[motor].trajectory, 0);
}

// motion:7.1/1: taken when the sequence begins.
TEST_F(Segments, AnotherIsx13IsForTheNextSequence) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM100 TA40 TS10", "X3"});
  const auto changes = changes_of({{3000, 100, 40, 10}}, 40);
  const Spline x([&](double t) { return way(changes, t); }, 140, 10);
  const double end = run([&](double t) {
    if (t < kTickMs) { EXPECT_EQ(host("I5113=25"), ""); }
    ASSERT_NEAR(at(1), x.at(t), 4 / kUnit) << t;
  });
  EXPECT_NEAR(end, 140 + 2 * 10, kTickMs);
  store({"X0"});
  EXPECT_NEAR(run(), 150 + 2 * 25, kTickMs);
}

// motion:7.1/1: no segments, arcs are straight.
TEST_F(Segments, VirtualAxesHaveNone) {
  ASSERT_EQ(host("I5113=10"), "");
  store({"CIRCLE1 TM100 TA20 TS0 X2 Y2 I2 J0"});
  ASSERT_EQ(host("&1B1R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(60));
  ASSERT_EQ(host("A"), "");
  platform::real_time();
  EXPECT_NEAR(cs().position[AXIS_X], 1, 0.02);
  EXPECT_NEAR(cs().position[AXIS_Y], cs().position[AXIS_X], 1e-9);
}

// motion:7.1/9: the line that calls, and the one that has been called.
TEST_F(Segments, PeShowsTheLineFromWhichItWasCalledToo) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5"), "");
  store({"X1", "X2"}, 2);
  store({"TM100 TA20 TS0", "CALL2", "X3"});
  std::vector<std::string> seen;
  run([&](double) {
    const std::string line = host("&1PE");
    if (seen.empty() || seen.back() != line) seen.push_back(line);
  });
  const std::vector<std::string> lines = {"P1:3>P2.0", "P1:3>P2.1", "P1:4"};  // statements: TM, TA, TS, CALL, X
  EXPECT_EQ(seen, lines);
}

// A change of velocity that is longer than what the move before has left of its own: that much of it, and of its
// S-curve the share that stays of the change.
TEST_F(Segments, ABlendHasTheRoomOfTheMoveBefore) {
  for (const double s : {0, 20}) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5"), "");
    store({"TM50 TA50 TS" + std::to_string(static_cast<int>(s)), "X1",
           "TA100 TS" + std::to_string(static_cast<int>(2 * s)) + " X2"});
    const std::vector<Change> changes = {{25, 50, s, 20}, {75, 50, s, 10 - 20}, {175, 100, 2 * s, -10}};
    follow({Spline([&](double t) { return way(changes, t); }, 225, 5)});
  }
}

// A next move that comes late: its change of velocity is about the corner, with what is left before that.
TEST_F(Segments, ALateMoveBlendsInWhatIsLeft) {
  path p = {};
  p.count = 2;
  for (path_move& m : p.moves) path_set_times(&m, 100, 40, 0);
  const auto change = [&](double now) {
    path_blend(&p, 1, path_time(now));
    return static_cast<double>(p.moves[1].change) / 4294967296.0;
  };
  EXPECT_EQ(change(0), 40);
  EXPECT_EQ(change(80), 40) << "it begins there";
  EXPECT_EQ(change(81), 2 * 19);
  EXPECT_EQ(change(99), 2);
  EXPECT_EQ(change(100), 0);
  EXPECT_EQ(change(101), 0);
}

// motion:7.1/10: the real-time task does not come for 60 ms, the servo task comes to the end of what is made.
TEST_F(Segments, TheEndOfWhatIsMadeIsARunTimeError) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5"), "");
  store({"TM300 TA20 TS0", "X10"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(100));
  for (unsigned n = ticks_of(60); n > 0; --n) system_path_servo();
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  platform::servo_ticks(10);
  EXPECT_EQ(cs().error, RUN_TIME_LATE);
  EXPECT_FALSE(run_is_running(0));
}

// Behind one for which the sequence has gone straight on, nothing is made beyond the corner until it is needed: the
// next move has all of its blend, 50 ms about 135 for 50 counts/ms.
TEST_F(Segments, BehindALateMoveTheNextOneIsWaitedFor) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=2"), "");
  ASSERT_EQ(host("DELETE GATHER"), "");
  ASSERT_EQ(host("&1DEFINE ROTARY 100 B0 OPEN ROTARY"), "");
  ASSERT_EQ(host("INC TM100 TA10 TS0 X10"), "");
  ASSERT_EQ(host("&1R"), "");
  for (int i = 0; i < 100 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(50));  // the first one already goes straight on
  ASSERT_EQ(host("TM30 X3"), "");
  platform::servo_ticks(ticks_of(95 - 50));
  ASSERT_EQ(host("TM100 TA50 X15"), "");
  double sharpest = 0, last[2] = {at(1), at(1)};
  for (unsigned n = 0; n < ticks_of(100); ++n) {
    platform::servo_ticks(1);
    if (n > 1) sharpest = std::max(sharpest, std::abs(at(1) - 2 * last[1] + last[0]) / (kTickMs * kTickMs));
    last[0] = last[1], last[1] = at(1);
  }
  EXPECT_NEAR(sharpest, 50.0 / 50, 0.02);
  platform::servo_ticks(ticks_of(200));
  EXPECT_EQ(motors[0].trajectory, 28000 * 3072);
}

// motion:7.1/7: what is not there 12 ms before it is needed is not waited for; 4 more for what is made meanwhile.
TEST_F(Segments, ANextMoveIsWaitedForUntilTwelveMsBeforeItsBlend) {
  for (const double before : {16.5, 9.5}) {
    SCOPED_TRACE(before);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=2"), "");
    ASSERT_EQ(host("DELETE GATHER"), "");
    ASSERT_EQ(host("&1DEFINE ROTARY 100 B0 OPEN ROTARY"), "");
    ASSERT_EQ(host("TM100 TA10 TS0 X10"), "");
    ASSERT_EQ(host("&1R"), "");
    for (int i = 0; i < 100 && !cs().active; ++i) platform::servo_ticks(1);
    platform::servo_ticks(ticks_of(100 - before));  // the change of velocity begins at 100
    ASSERT_EQ(host("X20"), "");
    double slowest = 1000, last = at(1);
    for (unsigned n = ticks_of(60); n > 0; --n) {
      platform::servo_ticks(1);
      slowest = std::min(slowest, (at(1) - last) / kTickMs);
      last = at(1);
    }
    EXPECT_NEAR(slowest, before > 12 ? 100 : 0, 1);
    platform::servo_ticks(ticks_of(120));
    EXPECT_EQ(motors[0].trajectory, 20000 * 3072);
  }
}

// A line, half a circle and a helix that blend: what each has of its own way adds up.
TEST_F(Segments, ArcsBlendWithLines) {
  fit({"1000X", "1000Y", "100Z"});
  ASSERT_EQ(host("I5113=8"), "");
  store({"F100 TA100 TS20 INC", "X10", "CIRCLE2 X0 Y20 I0 J10", "CIRCLE1 X10 Y10 Z5 R10", "LINEAR Y4 TM200"});
  ASSERT_EQ(host("I5190=1000"), "");
  const double t0 = 100, t1 = kPi * 10 / 100 * 1000, t2 = std::hypot(kPi / 2 * 10, 5) / 100 * 1000, t3 = 40;
  const double times[] = {t0, t1, t2, std::max(t3, 200.0)};
  double corners[5] = {50};
  for (int i = 0; i < 4; ++i) corners[i + 1] = corners[i] + times[i];
  const auto progress = [&](int i, double t) {  // of move i, 0..1
    return (risen(t - corners[i] + 50, 100, 20) - risen(t - corners[i + 1] + 50, 100, 20)) / times[i];
  };
  const auto x = [&](double t) {
    return 10 * progress(0, t) + 10 * std::sin(kPi * progress(1, t)) + 10 * (1 - std::cos(kPi / 2 * progress(2, t)));
  };
  const auto y = [&](double t) {
    return 10 * (1 - std::cos(kPi * progress(1, t))) + 10 * std::sin(kPi / 2 * progress(2, t)) + 4 * progress(3, t);
  };
  const auto z = [&](double t) { return 5 * progress(2, t); };
  const double length = corners[4] + 50;
  const auto scaled = [](auto axis, double by) { return [=](double t) { return by * axis(t); }; };
  follow({Spline(scaled(x, 1000), length, 8), Spline(scaled(y, 1000), length, 8), Spline(scaled(z, 100), length, 8)});
  EXPECT_EQ(motors[0].trajectory, 20000 * 3072);
  EXPECT_EQ(motors[1].trajectory, 34000 * 3072);
  EXPECT_EQ(motors[2].trajectory, 500 * 3072);
}

// The same place in axes and in motors, of a line, a spiral and its way out of the plane.
TEST_F(Segments, AxesAndMotorsOfAPointAgree) {
  fit({"1000X+5", "-250Y+300X", "100Z", "40A"});
  ASSERT_EQ(host("I5113=8"), "");
  store({"F100 TA40 TS10 INC", "X10 A3", "CIRCLE2 X0 Y21 Z4 A-5 I0 J10"});
  double widest = 0;
  run([&](double t) {
    path& queue = paths[0];
    if (t < 80 || queue.count < 2) return;  // both have joined by then
    for (int i = 0; i <= 10; ++i) {
      const std::int64_t part = (std::int64_t{1} << 62) / 10 * i;
      const path_point point = {2, {i == 0 ? part : PATH_WHOLE, part}};
      double axes[AXIS_COUNT];
      path_axes_at(&queue, &point, axes);
      path_motors_look(0, &point);
      const double x = axes[AXIS_X], y = axes[AXIS_Y];
      widest = std::max(widest, x);
      ASSERT_NEAR(static_cast<double>(path_motor_at(0)), (1000 * x + 5) * kUnit, 3);
      ASSERT_NEAR(static_cast<double>(path_motor_at(1)), (300 * x - 250 * y) * kUnit, 3);
      ASSERT_NEAR(static_cast<double>(path_motor_at(2)), 100 * axes[AXIS_Z] * kUnit, 3);
      ASSERT_NEAR(static_cast<double>(path_motor_at(3)), 40 * axes[AXIS_A] * kUnit, 3);
    }
  });
  EXPECT_GT(widest, 20) << "the spiral has not been looked at";
}

// Nearly straight: 990 units of way on a radius of 10^8, which is 2^48 units of position.
TEST_F(Segments, AnArcOfLargeRadiusEndsAtItsEnd) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=10 I5190=1000"), "");
  store({"F1000 TA100 TS0", "CIRCLE1 X700 Y700 R100000000"});
  const double radius = 1e8, chord = std::hypot(700, 700), half = std::asin(chord / 2 / radius);
  const double time = 2 * half * radius;  // ms, at one a ms
  const auto part = [=](double t) { return (risen(t, 100, 0) - risen(t - time, 100, 0)) / time; };
  const auto along = [=](double t) {  // from the middle: sin(a) is a
    return chord / 2 + radius * half * (2 * part(t) - 1);
  };
  const auto beside = [=](double t) {  // cos(a) - cos(b) = 2 sin((b + a) / 2) sin((b - a) / 2)
    return 2 * radius * half * part(t) * half * (1 - part(t));
  };
  const auto x = [=](double t) { return 1000 * std::sqrt(0.5) * (along(t) - beside(t)); };
  const auto y = [=](double t) { return 1000 * std::sqrt(0.5) * (along(t) + beside(t)); };
  EXPECT_NEAR(beside(time / 2 + 50), 1.225e-3, 1e-6) << "a count and a quarter";
  const double tolerance = 2 * 512;  // directions are good to 2^-39
  follow({Spline(x, time + 100, 10), Spline(y, time + 100, 10)}, tolerance);
  EXPECT_EQ(motors[0].trajectory, 700000LL * 3072);
  EXPECT_EQ(motors[1].trajectory, 700000LL * 3072);
}

// motion:7.2/9. A radius of 2^61 units of position: a way of 2^31 has no bend.
TEST_F(Segments, AnArcBeyondAllRadiiIsStraight) {
  fit({"10000000X", "10000000Y"});
  ASSERT_EQ(host("I5113=10 I5190=1000 I5197=.0000000001"), "");
  store({"F.1 TA100 TS0", "CIRCLE1 X.07 Y.07 R100000000"});
  const double time = 10000 * std::hypot(.07, .07);  // ms
  const Spline each([=](double t) { return 700000 * (risen(t, 100, 0) - risen(t - time, 100, 0)) / time; }, time + 100,
                    10);
  follow({each, each}, 2 * 512);
  EXPECT_EQ(motors[0].trajectory, 700000LL * 3072);
  EXPECT_EQ(motors[1].trajectory, 700000LL * 3072);
}

// motion:7.2/4: half a turn is pi, and an angle below Isx97 pi has a turn more.
TEST_F(Segments, AnArcBelowIsx97HasATurnMore) {
  for (const auto& [least, halves] : {std::pair{".9", 1}, std::pair{"1.1", 3}}) {
    platform::power_up();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I5113=5 I5190=1000 I5197=" + std::string(least)), "");
    store({"F100 TA50 TS0", "CIRCLE1 X20 Y0 I10 J0"});
    const double time = halves * kPi * 10 / 100 * 1000 + 50;
    EXPECT_NEAR(run([](double) {}), std::ceil(time / 5) * 5 + 2 * 5, kTickMs) << least;
  }
}

// On the way (2, 1) X has twice the radius along it that it has across, Y the other way round: both bend while the
// larger is a tenth below 2^58, and none does when it is above.
TEST_F(Segments, TheBoundOfTheRadiusHoldsInBothDirections) {
  constexpr double kCounts = 1e7, kX = 10, kY = 5, kMost = 0x1p58 / 3072 / kCounts;
  const double chord = std::hypot(kX, kY), time = 100 * chord;
  for (const double larger : {0.9, 1.1, 1.9}) {
    platform::power_up();
    fit({"10000000X", "10000000Y"});
    const double radius = larger * kMost * chord / kX;
    ASSERT_EQ(host("I5113=10 I5190=1000 I5197=.0000000001"), "");
    store({"F10 TA100 TS0", "CIRCLE1 X10 Y5 R" + std::to_string(radius)});
    const auto part = [=](double t) { return (risen(t, 100, 0) - risen(t - time, 100, 0)) / time; };
    const auto beside = [=](double t) {
      return larger < 1 ? chord * chord / (2 * radius) * part(t) * (1 - part(t)) : 0;
    };
    const auto x = [=](double t) { return kCounts * (kX * part(t) - beside(t) * kY / chord); };
    const auto y = [=](double t) { return kCounts * (kY * part(t) + beside(t) * kX / chord); };
    follow({Spline(x, time + 100, 10), Spline(y, time + 100, 10)}, 2 * 512);
    EXPECT_EQ(motors[0].trajectory, 100000000LL * 3072);
    EXPECT_EQ(motors[1].trajectory, 50000000LL * 3072);
    if (HasFailure()) FAIL() << larger;
  }
}

// A motor of an axis of the arc that does not stand where that is comes along evenly.
TEST_F(Segments, AMotorBesideItsAxisComesAlongWithAnArc) {
  fit({"1000X", "1000X", "1000Y"});
  motors[1].trajectory = 100 * 3072;
  ASSERT_EQ(host("I5113=5 I5190=1000"), "");
  store({"F100 TA50 TS0", "CIRCLE1 X20 Y0 I10 J0"});
  const double time = kPi * 10 / 100 * 1000;
  const Spline beside([&](double t) { return 100 * (1 - (risen(t, 50, 0) - risen(t - time, 50, 0)) / time); },
                      time + 50, 5);
  run([&](double t) { ASSERT_NEAR((at(2) - at(1) - beside.at(t)) * kUnit, 0, 6) << t; });
  EXPECT_EQ(motors[0].trajectory, 20000 * 3072);
  EXPECT_EQ(motors[1].trajectory, 20000 * 3072);
}

// motion:7.2/8: half a turn on a radius of 10 and 15 out of the plane. An arc counts once, as an axis that F counts;
// what goes out of the plane counts where its axis does.
TEST_F(Segments, AnArcAndTheWayOutOfItsPlaneCountAsTheirAxesDo) {
  const double arc = 10 * kPi, both = std::hypot(arc, 15);
  const std::pair<const char*, double> cases[] = {
      {"FRAX(X,Y,Z)", both}, {"FRAX(Z)", both}, {"FRAX(X)", arc}, {"FRAX(X,Y)", arc}};
  for (const auto& [axes, length] : cases) {
    platform::power_up();
    fit({"1000X", "1000Y", "1000Z"});
    ASSERT_EQ(host("I5113=5 I5190=1000"), "");
    store({axes, "F100 TA50 TS0", "CIRCLE1 X20 Y0 Z15 I10 J0"});
    const double time = length / 100 * 1000 + 50;
    EXPECT_NEAR(run([](double) {}), std::ceil(time / 5) * 5 + 2 * 5, kTickMs) << axes;
    EXPECT_EQ(motors[2].trajectory, 15000 * 3072);
  }
}

// 5000 mm/min on a radius of 50 mm, points every 10 ms: V^2 T^2 / (6 R) = 2.3 um (motion:7.1/4).
TEST_F(Segments, InsideAnArcThePublishedErrorIsMet) {
  fit({"1000X", "1000Y"});  // um
  ASSERT_EQ(host("I5113=10 I5190=60000"), "");
  store({"F5000 TA50 TS0", "CIRCLE1 X0 Y0 I50 J0"});
  const double v = 5000.0 / 60, expected = std::pow(v * 0.01, 2) / (6 * 50) * 1000;
  EXPECT_NEAR(expected, 2.3, 0.02);
  double least = 1e9, most = 0;
  run([&](double t) {
    if (t < 200 || t > 3500) return;  // 3770 ms of constant speed
    const double inside = 50000 - std::hypot(at(1) - 50000, at(2));
    least = std::min(least, inside);
    most = std::max(most, inside);
  });
  EXPECT_NEAR(most, expected, 0.02 * expected);
  EXPECT_NEAR(least, expected, 0.02 * expected);
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_EQ(motors[1].trajectory, 0);
}

TEST_F(Segments, ShortBlocksAreSkippedOver) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=10"), "");
  Lines lines = {"TM1 TA0 TS0"};
  std::vector<Move> moves;
  for (int i = 1; i <= 60; ++i) {
    lines.push_back("X" + std::to_string(i * i));
    moves.push_back({1000.0 * (i * i - (i - 1) * (i - 1)), 1, 1e-9, 0});
  }
  store(lines);
  const auto changes = changes_of(moves, 1e-9);
  EXPECT_NEAR(follow({Spline([&](double t) { return way(changes, t); }, 60, 10)}), 80, kTickMs);
  EXPECT_EQ(motors[0].trajectory, 3600000LL * 3072);
}

TEST_F(Segments, StopsBetweenSequencesAreExact) {
  fit({"1000X", "333.25Y"});
  ASSERT_EQ(host("I5113=4"), "");
  store({"TM20 TA8 TS2", "X1 Y1", "X2", "DWELL5 X5 Y3", "RAPID X7", "LINEAR X9 Y-1", "I5113=0 X8", "Y7"});
  std::set<std::int64_t> passed;
  run([&](double) { passed.insert(motors[0].trajectory); });
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_EQ(motors[0].trajectory, 8000 * 3072);
  EXPECT_EQ(motors[1].trajectory, 7 * 1023744);
  for (const int x : {2, 5, 7, 9}) EXPECT_EQ(passed.count(x * 3072000LL), 1u) << x;
}

TEST_F(Segments, ARadiusThatCannotBeEndsTheProgramAtItsStart) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5196=0.01"), "");
  store({"TM20 TA10 TS0", "X1", "CIRCLE1 X4 R1"});
  run();
  EXPECT_EQ(cs().error, RUN_TIME_RADIUS);
  EXPECT_EQ(motors[0].trajectory, 1000 * 3072);
}

// Isx78: F at most the root of Isx78 R.
TEST_F(Segments, CentripetalLimit) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5178=40"), "");
  store({"F1000 TA0 TS0", "CIRCLE1 X0 Y0 I10 J0"});
  EXPECT_NEAR(run(), std::ceil(2 * kPi * 10 / 20 * 200) * 5 + 10, kTickMs);  // sqrt(40 x 10) = 20 a s
  store({"F1000 TA0 TS0", "CIRCLE1 X15 Y0 I10 J0"});                         // half a turn from 10 to 5
  EXPECT_NEAR(run(), std::ceil(std::hypot(kPi * 7.5, 5) / std::sqrt(40 * 5) * 200) * 5 + 10, kTickMs);
}

// motion:7.2/8: the way out of the plane counts, whichever axis goes it.
TEST_F(Segments, AHelixTakesTheTimeOfItsWayInEachPlane) {
  fit({"1000X", "1000Y", "1000Z"});
  ASSERT_EQ(host("I5113=5 I5190=1000"), "");
  const double time = std::hypot(kPi * 10, 8) / 100 * 1000;
  for (const char* arc : {"NORMAL K-1 CIRCLE1 X0 Y20 Z8 I0 J10 K0", "NORMAL I1 CIRCLE1 Y0 Z20 X8 I0 J0 K10",
                          "NORMAL J1 CIRCLE1 Z0 X20 Y8 I10 J0 K0"}) {
    store({"F100 TA0 TS0 INC", arc});
    EXPECT_NEAR(run(), std::ceil(time / 5) * 5 + 10, kTickMs) << arc;
  }
}

// Q and `/`: the end of the executing move; R goes on with the next.
TEST_F(Segments, QuitStopsAtTheEndOfTheExecutingMove) {
  for (const char* command : {"&1Q", "&1/"}) {
    SCOPED_TRACE(command);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5"), "");
    Lines lines = {"TM100 TA20 TS0 INC"};
    for (int i = 0; i < 12; ++i) lines.emplace_back("X1");
    store(lines);
    bool asked = false;
    run([&](double t) {
      if (t <= 150 || asked) return;
      EXPECT_EQ(host(command), "");
      asked = true;
    });
    EXPECT_EQ(motors[0].trajectory, 2000 * 3072);
    double before = at(1);
    run(
        [&](double) {
          ASSERT_LE(std::abs(at(1) - before), 10.01 * kTickMs) << "10 counts/ms";
          before = at(1);
        },
        "&1R");
    EXPECT_EQ(motors[0].trajectory, 12000 * 3072) << "those that waited are made";
  }
}

// Home where Q has stopped: the moves that wait, an arc among them, begin there and go the ways that they were to go.
TEST_F(Segments, MovesThatWaitBeginWhereTheMotorsAre) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5"), "");
  store({"TM100 TA20 TS0 INC", "X1", "X1", "CIRCLE1 X1 Y1 I1 J0", "LINEAR X1", "X1", "X1", "X1", "X1"});
  bool asked = false;
  run([&](double t) {
    if (t <= 150 || asked) return;
    EXPECT_EQ(host("&1Q"), "");
    asked = true;
  });
  ASSERT_EQ(at(1), 2000);
  ASSERT_EQ(host("#1HMZ#2HMZ"), "");
  platform::servo_ticks(5);
  ASSERT_EQ(at(1), 0);
  double x = 0, y = 0;
  run(
      [&](double) {
        ASSERT_LE(std::hypot(at(1) - x, at(2) - y), 16 * kTickMs) << "10 counts/ms; the arc has 15.7";
        x = at(1), y = at(2);
      },
      "&1R");
  EXPECT_EQ(motors[0].trajectory, 6000 * 3072);
  EXPECT_EQ(motors[1].trajectory, 1000 * 3072);
}

// A move that Q leaves out joins again, from where the one before it ends.
TEST_F(Segments, RunWhileAMoveThatWasQuitStillBegins) {
  for (const char* command : {"&1Q", "&1/"}) {
    SCOPED_TRACE(command);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5"), "");
    store({"TM200 TA200 TS0", "X1", "X2", "X3", "X4"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(ticks_of(20));
    ASSERT_EQ(host(command), "");
    platform::servo_ticks(ticks_of(5));
    ASSERT_EQ(host("&1R"), "");
    platform::servo_ticks(ticks_of(2000));
    EXPECT_EQ(motors[0].trajectory, 4000 * 3072);
  }
}

TEST_F(Segments, AnAbortForgetsThem) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I115=1"), "");
  store({"TM100 TA20 TS0", "X1", "X2", "X3", "X4"});
  bool asked = false;
  run([&](double t) {
    if (t <= 150 || asked) return;
    EXPECT_EQ(host("&1A"), "");
    asked = true;
  });
  platform::servo_ticks(300);
  EXPECT_LT(motors[0].trajectory, 3000 * 3072);
  EXPECT_FALSE(segment_is_left(0));
  EXPECT_EQ(host("&1B1R"), "");
  platform::servo_ticks(3000);
  EXPECT_EQ(motors[0].trajectory, 4000 * 3072);
}

TEST_F(Segments, SynchronousAssignmentsComeWithTheirMove) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 M1->*"), "");
  store({"TM100 TA20 TS0 M1=0", "M1==1 X1", "M1==2 X2", "X3", "M1==4"});
  std::vector<double> times(5, -1);
  run([&](double t) {
    const auto value = static_cast<unsigned>(m_variable_read(1));
    if (value < 5 && times[value] < 0) times[value] = t;
  });
  EXPECT_LE(times[1], 3 * kTickMs);
  EXPECT_NEAR(times[2], 100, 10);  // the blend begins there
  platform::servo_ticks(3);
  EXPECT_EQ(m_variable_read(1), 4) << "behind the last move";
  ASSERT_EQ(host("I5113=20"), "");
  store({"TM110 TA20 TS0 M1=0", "M1==1 X1", "M1==2 X2"});
  double last = 0;
  run([&](double t) {
    if (m_variable_read(1) < 2) last = t;
  });
  EXPECT_NEAR(last, 120, 3) << "its blend begins at 110, in the segment from 100, which begins 20 ms later";
}

// motion:7.3/4: without lookahead 32 wait, the calculation of others waits for room.
TEST_F(Segments, AssignmentsWaitForRoom) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 M1..60->* M1..60=0"), "");
  Lines lines = {"TM100 TA20 TS0"};
  for (int move = 0; move < 3; ++move) {
    std::string line;
    for (int i = 1; i <= 20; ++i) line += "M" + std::to_string(20 * move + i) + "==1 ";
    lines.push_back(line);
    lines.push_back("X" + std::to_string(move + 1));
  }
  store(lines);
  run();
  platform::servo_ticks(5);
  for (int i = 1; i <= 60; ++i) EXPECT_EQ(m_variable_read(i), 1) << i;
  EXPECT_EQ(std::stoul(host("??").substr(12, 6), nullptr, 16) >> 19 & 1, 0u) << "none is lost";
}

// The servo task gets a sequence when 12 ms of it are made, in lookahead too, however slowly that goes.
TEST_F(Segments, BeginWhenTwelveMillisecondsAreMade) {
  for (const char* isx20 : {"0", "1", "40"})
    for (const int isx13 : {1, 5}) {
      SCOPED_TRACE(std::string(isx20) + " " + std::to_string(isx13));
      platform::power_up();
      fit({"1000X"});
      ASSERT_EQ(host("I5113=" + std::to_string(isx13) + " I5120=" + isx20), "");
      ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,10"), "");
      store({"TM500 TA20 TS0", "X5"});
      ASSERT_EQ(host("&1B1R"), "");
      const piece_ring& ring = cs().ring;
      platform::real_time_in_slices([&] {
        if (ring.added != ring.executing) { EXPECT_GE((ring.added - ring.executing) * isx13, 12u); }
      });
      EXPECT_NE(ring.added, ring.executing);
    }
}

}  // namespace
