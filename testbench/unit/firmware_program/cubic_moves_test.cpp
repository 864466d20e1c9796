// PVT and SPLINE moves of motors (motion:5.4) against their formulas: Hermite cubics, uniform cubic B-splines.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/system_path.h"
}

namespace {

using namespace moving_motors;

class CubicMoves : public MovingMotors {
 protected:
  // Motor 1 is where `at_time` has it, in counts; at least so many looks.
  static double compare(const std::function<double(double)>& at_time, unsigned least, double tolerance = 3.0) {
    unsigned looks = 0, failures = 0;
    const double end = run([&](double t) {
      ++looks;
      const double error = (at(1) - at_time(t)) * kUnit;
      if (std::abs(error) > tolerance && failures++ < 3)
        ADD_FAILURE() << "at " << t << " ms it is " << at(1) << ", " << error << " units off";
    });
    EXPECT_GT(looks, least);
    return end;
  }
};

// p = p0 + v0 T u + (3 D - (2 v0 + v1) T) u^2 + ((v0 + v1) T - 2 D) u^3
double pvt(double p0, double v0, double p1, double v1, double time, double t) {
  const double u = std::min(t / time, 1.0), d = p1 - p0;
  return p0 + v0 * time * u + (3 * d - (2 * v0 + v1) * time) * u * u + ((v0 + v1) * time - 2 * d) * u * u * u;
}

TEST_F(CubicMoves, PvtFollowsItsCubics) {
  fit({"1000X"});
  ASSERT_EQ(host("I5190=60000"), "");  // velocities a minute
  store({"PVT100", "X2:1800", "PVT250 X7:-600", "X6.5:0", "PVT60.25 X6"});
  const double minute = 1000.0 / 60000.0;  // counts a ms
  const double end = compare(
      [&](double t) {
        if (t < 100) return pvt(0, 0, 2000, 1800 * minute, 100, t);
        if (t < 350) return pvt(2000, 1800 * minute, 7000, -600 * minute, 250, t - 100);
        if (t < 600) return pvt(7000, -600 * minute, 6500, 0, 250, t - 350);
        return pvt(6500, 0, 6000, 0, 60.25, t - 600);
      },
      1400);
  EXPECT_NEAR(end, 660.25, kTickMs);
  EXPECT_EQ(motors[0].trajectory, 6000 * 3072);
  EXPECT_EQ(host("I5189"), "60.25");
}

TEST_F(CubicMoves, PvtTimeIsTheAccelerationTimeWithI42) {
  fit({"1000X"});
  ASSERT_EQ(host("I42=1"), "");
  store({"PVT80", "X1:10", "X2"});
  const double end =
      compare([](double t) { return t < 80 ? pvt(0, 0, 1000, 10, 80, t) : pvt(1000, 10, 2000, 0, 80, t - 80); }, 300);
  EXPECT_NEAR(end, 160, kTickMs);
  EXPECT_EQ(host("I5187"), "80");
}

// Motors of two axes, from rest behind a LINEAR move, and a LINEAR move behind it.
TEST_F(CubicMoves, PvtBetweenLinearMoves) {
  fit({"600X+800Y"});
  store({"TM50 TA20 TS0 X1 Y1", "PVT100 X2 Y1:5", "X3:0 Y2:0", "LINEAR TM50 X0 Y0"});
  const double end = run();
  EXPECT_NEAR(end, 70 + 200 + 70, 3 * kTickMs) << "each begins with an interrupt";
  EXPECT_EQ(motors[0].trajectory, 0);
}

// A PVT move that ends in motion and has no next one is stopped, with an error; at the end of a program without one.
TEST_F(CubicMoves, PvtThatEndsInMotionIsStopped) {
  for (const bool ends : {false, true}) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I115=1 &1 DEF ROT 100 B0 OPEN ROT"), "");
    ASSERT_EQ(host("PVT100 X1:20"), "");  // 20 counts a ms
    ASSERT_EQ(host("R"), "");
    platform::servo_ticks(30);
    if (ends) { ASSERT_EQ(host("Q"), ""); }
    double last = at(1), fastest_change = 0.0, velocity = 0.0;
    for (int i = 0; i < 600; ++i) {
      platform::servo_ticks(1);
      const double now = (at(1) - last) / kTickMs;
      if (i > 250) fastest_change = std::max(fastest_change, std::abs(now - velocity) / kTickMs);
      velocity = now;
      last = at(1);
    }
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(velocity, 0.0);
    EXPECT_LE(fastest_change, 1.2) << "Ixx15, no jump to rest";
    EXPECT_GT(at(1), 1000.0 + 20.0 * 20.0 / 2.0) << "the ramp begins behind the move";
    EXPECT_LT(at(1), 1000.0 + 20.0 * 20.0 / 2.0 + 20.0 * 15.0);
    EXPECT_EQ(host("RY$2014"), ends ? "0" : "9");
  }
}

// motion:5.6/4: behind Q its ramp leaves the path, and R goes on from there, or from where a jog has taken it.
TEST_F(CubicMoves, RunGoesOnBehindTheRampOfAPvtMove) {
  for (const char* prepare : {"I5113=0", "I5113=5"})
    for (const char* stop : {"Q", "/", "S"})
      for (const char* jog : {"", "#1J:-50"}) {
        SCOPED_TRACE(std::string(prepare) + " " + stop + jog);
        platform::power_up();
        fit({"1000X"});
        ASSERT_EQ(host("I115=1 I119=1 I120=20 I121=0 I192=1"), "");
        ASSERT_EQ(host(prepare), "");
        store({"PVT150 X1:5", "X2:10", "X3:5", "X3.5:0", "LINEAR TM100 X4"});
        ASSERT_EQ(host("&1B1R"), "");
        platform::servo_ticks(ticks_of(200));
        ASSERT_EQ(host(stop), "");
        platform::servo_ticks(ticks_of(600));
        EXPECT_FALSE(run_is_running(0));
        EXPECT_EQ(host("RY$2014"), "0");
        EXPECT_GT(at(1), 3000.0 + 5.0 * 5.0 / 2.0) << "X3 is calculated; 5 counts a ms, Ixx15 = 1";
        EXPECT_LT(at(1), 3000.0 + 5.0 * 5.0 / 2.0 + 5.0 * 5.0);
        ASSERT_EQ(host(jog), "");
        platform::servo_ticks(ticks_of(150));
        ASSERT_EQ(host("R"), "");
        platform::servo_ticks(ticks_of(500));
        EXPECT_FALSE(run_is_running(0));
        EXPECT_EQ(motors[0].trajectory, 4000 * 3072);
      }
}

// What comes behind it is an error that was met ahead of its end: it is told, though the program has ended for it.
TEST_F(CubicMoves, ARunTimeErrorBehindAPvtMoveInMotionIsShown) {
  fit({"1000X"});
  ASSERT_EQ(host("I115=1"), "");
  store({"PVT100 X1:20", "CC1", "X2:0"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(300));
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(host("RY$2014"), "1");
}

// Without the real-time task it goes on at its last velocity.
TEST_F(CubicMoves, PvtRunsOnUntilItIsStopped) {
  fit({"1000X"});
  store({"PVT100 X1:20", "WHILE(P1=0) WAIT"});
  ASSERT_EQ(host("B1R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  double t = 0.0;
  for (; t < 250.0; t += kTickMs) {
    ASSERT_NEAR(at(1), t < 100 ? pvt(0, 0, 1000, 20, 100, t) : 1000 + 20 * (t - 100), 3 / kUnit) << t;
    system_path_servo();
  }
}

// Another mode takes the place of what it would run on for.
TEST_F(CubicMoves, LinearMoveBehindPvtInMotion) {
  fit({"1000X"});
  store({"PVT100 X1:2", "LINEAR TM100 TA20 TS0 X3"});
  EXPECT_NEAR(run(), 100 + 120, 2 * kTickMs);
  EXPECT_EQ(motors[0].trajectory, 3000 * 3072);
}

// The control points of a sequence stand twice at its ends: a zero-distance segment before and behind it.
double b_spline(const std::vector<double>& points, double time, double t) {
  const auto point = [&](int i) {
    return points[static_cast<std::size_t>(std::clamp(i, 0, static_cast<int>(points.size()) - 1))];
  };
  const int segment = static_cast<int>(std::floor(t / time));  // the first one is the one that was added
  const double u = t / time - segment, v = 1 - u;
  const int i = segment - 1;
  return (v * v * v * point(i - 1) + (3 * u * u * u - 6 * u * u + 4) * point(i) +
          (-3 * u * u * u + 3 * u * u + 3 * u + 1) * point(i + 1) + u * u * u * point(i + 2)) /
         6;
}

TEST_F(CubicMoves, SplineIsAUniformBSpline) {
  fit({"1000X"});
  store({"SPLINE1 TM40", "X1", "X3", "X2.5", "X2.5", "X-4", "X-3"});
  const std::vector<double> points = {0, 1000, 3000, 2500, 2500, -4000, -3000};
  const double end = compare([&](double t) { return b_spline(points, 40, t); }, 600);
  EXPECT_NEAR(end, 8 * 40, kTickMs) << "six segments and two that are added";
  EXPECT_EQ(motors[0].trajectory, -3000 * 3072);
}

// motion:5.4/5: those of point n with the way to way point n - 1.
TEST_F(CubicMoves, AssignmentsOfAPointComeWithTheWayToThePointBefore) {
  fit({"1000X"});
  ASSERT_EQ(host("M1->X:$10F0,0,24 M1=0"), "");
  store({"SPLINE1 TM40", "M1==1 X1", "M1==2 X3", "M1==3 X2"});
  double last[3] = {};  // before the first, the second, the third
  run([&](double t) {
    for (int n = 0; n < 3; ++n)
      if (m_variable_read(1) <= n) last[n] = t;
  });
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(last[n], 40 * n, 5 * kTickMs) << n;
}

TEST_F(CubicMoves, SplineOfOnePoint) {
  fit({"1000X"});
  store({"SPLINE1 TM50 X1"});
  const double end = compare([&](double t) { return b_spline({0, 1000}, 50, t); }, 300);
  EXPECT_NEAR(end, 150, kTickMs);
}

// Another time: SPLINE1 stops and begins anew, SPLINE2 goes on.
TEST_F(CubicMoves, AnotherTimeEndsASequenceOfSpline1) {
  fit({"1000X"});
  store({"SPLINE1 TM40 X1", "X2", "TM60 X3", "X5"});
  const double end = compare(
      [&](double t) {
        return t < 160 ? b_spline({0, 1000, 2000}, 40, t)
                       : b_spline({2000, 3000, 5000}, 60, t - std::ceil(160 / kTickMs) * kTickMs);
      },
      800);
  EXPECT_NEAR(end, 160 + 240, 2 * kTickMs);
}

TEST_F(CubicMoves, Spline2GoesOnWithAnotherTime) {
  fit({"1000X"});
  store({"SPLINE2 TM40 X1", "X2", "TM60 X4", "X6"});
  double last = 0.0, least = 1e9;
  const double end = run([&](double t) {
    if (t > 60 && t < 200) least = std::min(least, (at(1) - last) / kTickMs);
    last = at(1);
  });
  EXPECT_NEAR(end, 40 + 40 + 40 + 60 + 60 + 60, kTickMs);
  EXPECT_GT(least, 15.0) << "no stop between them";
  EXPECT_EQ(motors[0].trajectory, 6000 * 3072);
}

// Way points, velocities over the times before and behind them, cubics between: motion:5.4/4 for times that change.
TEST_F(CubicMoves, Spline2FollowsItsCubics) {
  fit({"1000X"});
  store({"SPLINE2 TM40 X1", "X3", "TM70 X2.5", "TM30 X4", "X4.5"});
  const std::vector<double> x = {0, 0, 1000, 3000, 2500, 4000, 4500, 4500}, time = {40, 40, 40, 70, 30, 30, 30};
  std::vector<double> place = {0}, velocity = {0}, length = {40};  // time[n] is the way from x[n] to x[n + 1]
  for (std::size_t n = 1; n + 1 < x.size(); ++n) {
    place.push_back((x[n - 1] + 4 * x[n] + x[n + 1]) / 6);
    velocity.push_back((x[n + 1] - x[n - 1]) / (time[n - 1] + time[n]));
    length.push_back(time[n]);
  }
  place.push_back(x.back());
  velocity.push_back(0);
  const double end = compare(
      [&](double t) {
        std::size_t i = 0;
        while (i + 1 < length.size() && t >= length[i]) t -= length[i++];
        return pvt(place[i], velocity[i], place[i + 1], velocity[i + 1], length[i], t);
      },
      500);
  EXPECT_NEAR(end, 40 + 40 + 40 + 70 + 30 + 30 + 30, kTickMs);
}

// motion:5.4/1: quarters of a us, half a ms to 4095.9998 ms.
TEST_F(CubicMoves, TimesAreQuartersOfAMicrosecond) {
  for (const auto& [text, ms] : {std::pair{"PVT4096", 4095.99975}, {"PVT100.00045", 100.0005}, {"PVT0.1", 0.5}}) {
    platform::power_up();
    store({std::string(text) + " X1"});
    ASSERT_EQ(host("&1B1R"), "");
    for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
    EXPECT_EQ(cs().moves[cs().executing].time, std::llround(ms * 8388608.0)) << text;
  }
}

// Behind an abort there is nothing to go on with.
TEST_F(CubicMoves, PvtBehindAnAbortBeginsAtRest) {
  fit({"1000X"});
  ASSERT_EQ(host("I115=10"), "");
  store({"PVT100 X1:20", "X3:20", "X5:0"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(150));
  ASSERT_EQ(host("A"), "");
  platform::servo_ticks(ticks_of(50));
  const double from = at(1);
  store({"PVT80 INC X1"}, 2);
  double worst = 0;
  run([&](double t) { worst = std::max(worst, std::abs(at(1) - pvt(from, 0, from + 1000, 0, 80, t))); }, "&1B2R");
  EXPECT_LT(worst * kUnit, 6.0);
}

// A point that comes when the sequence is ending begins a new one.
TEST_F(CubicMoves, SplinePointThatComesLate) {
  fit({"1000X"});
  ASSERT_EQ(host("&1 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("SPLINE1 TM50 X1"), "");
  ASSERT_EQ(host("R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(70));  // the first segment is over
  ASSERT_EQ(host("X2"), "");
  unsigned ticks = ticks_of(70);
  for (; cs().active; ++ticks) {
    const double t = ticks * kTickMs, begin = ticks_of(150) * kTickMs;
    const double expected = t < 150 ? b_spline({0, 1000}, 50, t) : b_spline({1000, 2000}, 50, t - begin);
    ASSERT_NEAR(at(1), expected, 3 / kUnit) << t;
    platform::servo_ticks(1);
  }
  EXPECT_EQ(motors[0].trajectory, 2000 * 3072);
  EXPECT_EQ(ticks, 2 * ticks_of(150));
}

// motion:5.4/6: one whose line was there all the time is an error, as for PVT.
TEST_F(CubicMoves, SplinePointThatTakesTooLongToCalculate) {
  for (const bool too_long : {false, true}) {
    platform::power_up();
    fit({"1000X"});
    Lines lines = {"SPLINE1 TM20 X1", "X2"};
    lines.insert(lines.end() - 1, too_long ? 700 : 200, "P1=P1+1");  // 32 lines a real-time interrupt of 1.33 ms
    lines.push_back("P2=1");
    store(lines);
    run();
    EXPECT_EQ(host("RY$2014"), too_long ? "9" : "0");
    if (!too_long) { EXPECT_EQ(motors[0].trajectory, 2000 * 3072); }
    platform::servo_ticks(ticks_of(300));
    const std::int64_t stands = motors[0].trajectory;
    platform::servo_ticks(ticks_of(20));
    EXPECT_EQ(motors[0].trajectory, stands);
    EXPECT_EQ(host("P2"), too_long ? "0" : "1");
  }
}

// A stop in between is a wait for R, not a calculation that took too long.
TEST_F(CubicMoves, SplinePointsGoOnBehindAStop) {
  for (const char* stop : {"Q", "/", "S"}) {
    for (const bool motors_move : {true, false}) {
      platform::power_up();
      if (motors_move) fit({"1000X"});
      store({"SPLINE1 TM20 X1", "X2", "X3", "X4"});
      ASSERT_EQ(host("&1B1R"), "");
      platform::servo_ticks(ticks_of(45));
      ASSERT_EQ(host(stop), "") << stop;
      platform::servo_ticks(ticks_of(200));
      for (int i = 0; i < 8 && cs().position[AXIS_X] != 4.0; ++i) {
        ASSERT_EQ(host(*stop == 'S' ? "S" : "R"), "") << stop;
        platform::servo_ticks(ticks_of(200));
      }
      EXPECT_EQ(cs().position[AXIS_X], 4.0) << stop;
      EXPECT_EQ(host("RY$2014"), "0") << stop;
    }
  }
}

// Virtual axes: an abort finds them on the curve.
TEST_F(CubicMoves, AbortOfVirtualAxesIsOnTheCurve) {
  store({"SPLINE1 TM40", "X1", "X3", "X2.5", "PVT100 X5:10", "X7"});
  const std::vector<double> points = {0, 1, 3, 2.5};
  for (const double when : {30.0, 95.0, 130.0, 190.0, 260.0, 380.0}) {
    platform::power_up();
    store({"SPLINE1 TM40", "X1", "X3", "X2.5", "PVT100 X5:10", "X7"});
    ASSERT_EQ(host("B1R"), "");
    for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
    platform::servo_ticks(ticks_of(when));
    ASSERT_EQ(host("A"), "");
    platform::real_time();
    const double t = ticks_of(when) * kTickMs, begin = ticks_of(200) * kTickMs;
    const double expected = t < begin         ? b_spline(points, 40, t)
                            : t < begin + 100 ? pvt(2.5, 0, 5, 0.01, 100, t - begin)
                                              : pvt(5, 0.01, 7, 0, 100, t - begin - 100);
    EXPECT_NEAR(cs().position[AXIS_X], expected, 1e-9) << when;
    EXPECT_EQ(cs().position[AXIS_Y], 0.0) << "which stands";
  }
}

// An axis that no motor carries goes as the motor beside it would have; the abort may act some interrupts later. What
// an earlier program of PVT moves has left is not taken for it.
TEST_F(CubicMoves, AbortFindsAnAxisWithoutMotorOnTheCurve) {
  constexpr unsigned kLater = 6;  // two real-time interrupts
  const Lines even = {"SPLINE1 TM100", "X1 Y2", "X2 Y4", "X3 Y6"};
  const Lines uneven = {"SPLINE2 TM40", "X1 Y2", "TM100 X4 Y8", "TM70 X2 Y4", "TM150 X3 Y6"};
  const Lines behind_pvt = {"PVT60 X3:10 Y6:20", "X0 Y0", "SPLINE1 TM100", "X1 Y2", "X2 Y4", "X3 Y6"};
  for (const Lines& lines : {even, uneven, behind_pvt}) {
    const auto begin = [&] {
      platform::power_up();
      fit({"1000X"});
      ASSERT_EQ(host("I115=10"), "");
      store({"PVT50 X9 Y20", "X0 Y0"}, 2);
      run([](double) {}, "&1B2R");
      store(lines);
    };
    begin();
    std::vector<double> way;  // where the motor is at each interrupt
    run([&](double) { way.push_back(at(1) / 1000); });
    for (double when = 30; when < 400; when += 61) {
      begin();
      ASSERT_EQ(host("&1B1R"), "");
      for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
      platform::servo_ticks(ticks_of(when));
      ASSERT_EQ(host("A"), "");
      platform::servo_ticks(2 * kLater);
      ASSERT_FALSE(cs().settling);
      double nearest = 1e9;
      for (unsigned i = 0; i <= kLater; ++i)
        nearest = std::min(nearest, std::abs(cs().position[AXIS_Y] - 2 * way.at(ticks_of(when) + i)));
      EXPECT_LT(nearest, 0.002) << lines.front() << " at " << when << ": Y is " << cs().position[AXIS_Y];
    }
  }
}

// Each axis of a motor's definition counts, with its velocity, and no axis of the definition before.
TEST_F(CubicMoves, PvtOfAMotorOfThreeAxes) {
  const Lines program = {"PVT100", "X1:10 Y2:-10 Z3:20", "X0:0 Y0:0 Z0:0"};
  const struct {
    const char* definition;
    double place, velocity;  // counts, counts a ms
  } cases[] = {{"100X+50Y-20Z", 100 + 100 - 60, (100 * 10 - 50 * 10 - 20 * 20) / 1000.0},
               {"50Y-20Z", 100 - 60, (-50 * 10 - 20 * 20) / 1000.0},
               {"-20Z", -60, -20 * 20 / 1000.0}};
  platform::power_up();
  for (const auto& c : cases) {
    SCOPED_TRACE(c.definition);
    fit({c.definition});
    ASSERT_EQ(host("I5190=1000"), "");
    store(program);
    compare(
        [&](double t) {
          return t < 100 ? pvt(0, 0, c.place, c.velocity, 100, t) : pvt(c.place, c.velocity, 0, 0, 100, t - 100);
        },
        400);
  }
}

}  // namespace
