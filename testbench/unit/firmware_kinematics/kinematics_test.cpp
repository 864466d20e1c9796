// Kinematic programs executed (motion:8.1): at each servo interrupt against the geometry of an arm in doubles.
#include "testbench/unit/firmware_kinematics/arm.h"
#include "testbench/unit/firmware_paths/spline_path.h"

namespace {

using namespace moving_motors;
using arm::Arm;
using arm::joints;
using arm::Joints;
using arm::Point;
using spline_path::Spline;

class Kinematics : public Arm {
 protected:
  // Both joints against splines through the joints at points of a path.
  static double follow_path(const std::function<Point(double)>& path, double length, double period) {
    const Spline shoulder([&](double t) { return joints(path(t)).shoulder; }, length, period);
    const Spline elbow([&](double t) { return joints(path(t)).elbow; }, length, period);
    double worst = 0;
    const double end = run([&](double t) {
      worst = std::max({worst, std::abs(at(1) - shoulder.at(t)), std::abs(at(2) - elbow.at(t))});
    });
    EXPECT_LE(worst * kUnit, 4.0) << "units of position";
    return end;
  }
};

// Each segment's point by the inverse program: straight in X and Y, not in the joints.
TEST_F(Kinematics, ALineInSegments) {
  fit_arm();
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM400 TA100 TS20", "X300 Y-200"});
  const auto part = changes_of({{1, 400, 100, 20}}, 100);
  const auto path = [&](double t) { return Point{400 - 100 * way(part, t), 100 - 300 * way(part, t)}; };
  EXPECT_NEAR(follow_path(path, 500, 10), 520, kTickMs);
  EXPECT_NEAR(hand().x, 300, 1e-3);
  EXPECT_NEAR(hand().y, -200, 1e-3);
  EXPECT_EQ(p(4), 1) << "the forward program runs once at R";
  EXPECT_NEAR(p(5), 50, 2) << "the inverse one once a segment";
}

TEST_F(Kinematics, ACircleThatBlendsWithALine) {
  fit_arm({450, 0});
  ASSERT_EQ(host("I5113=5 I5190=1000"), "");
  store({"F300 TA60 TS0", "X400", "CIRCLE1 X400 Y0 I-40 J0"});
  const double t0 = 50 / 0.3, t1 = 2 * arm::kPi * 40 / 0.3, ta = 60, c0 = ta / 2, c1 = c0 + std::max(t0, ta),
               c2 = c1 + t1;
  const auto path = [&](double t) {
    const double line = (risen(t - c0 + 30, 60, 0) - risen(t - c1 + 30, 60, 0)) / t0;
    const double turn = (risen(t - c1 + 30, 60, 0) - risen(t - c2 + 30, 60, 0)) / t1 * 2 * arm::kPi;
    return Point{450 - 50 * line + 40 * (std::cos(turn) - 1), -40 * std::sin(turn)};
  };
  follow_path(path, c2 + 30, 5);
  EXPECT_NEAR(hand().x, 400, 1e-3);
  EXPECT_NEAR(hand().y, 0, 1e-3);
}

// Without segments the ends of moves are by the program, between them motors go straight.
TEST_F(Kinematics, WithoutSegmentsMotorsGoStraight) {
  fit_arm();
  store({"TM100 TA40 TS10", "X350 Y50", "X380 Y-50"});
  const Joints a = joints({400, 100}), b = joints({350, 50}), c = joints({380, -50});
  const auto profile = [](double from, double middle, double to) {
    return changes_of({{middle - from, 100, 40, 10}, {to - middle, 100, 40, 10}}, 40);
  };
  const auto shoulder = profile(a.shoulder, b.shoulder, c.shoulder), elbow = profile(a.elbow, b.elbow, c.elbow);
  double worst = 0;
  run([&](double t) {
    worst =
        std::max({worst, std::abs(at(1) - a.shoulder - way(shoulder, t)), std::abs(at(2) - a.elbow - way(elbow, t))});
  });
  EXPECT_LE(worst * kUnit, 4.0);
  EXPECT_EQ(p(5), 2) << "once a move";
}

// Ixx16 holds for the motors that the program moves.
TEST_F(Kinematics, LimitsAreThoseOfTheMotors) {
  fit_arm();
  ASSERT_EQ(host("I116=50 I216=50"), "");
  store({"TM10 TA10 TS0", "X300 Y-200"});
  const Joints a = joints({400, 100}), b = joints({300, -200});
  const double longest = std::max(std::abs(b.shoulder - a.shoulder), std::abs(b.elbow - a.elbow)) / 50;
  EXPECT_NEAR(run(), longest + 10, 2 * kTickMs);
}

// PVT: Q10 = 1 and velocities of axes in Q11 to Q19, of motors in P101 to P132, a Isx90.
TEST_F(Kinematics, PvtByVelocitiesOfTheProgram) {
  fit_arm();
  ASSERT_EQ(host("I5190=1000"), "");
  Lines with = arm::inverse();
  with.insert(
      with.end(),
      {"P6=P6+Q10", "IF(Q10>0)",
       // the Jacobian solved: J (s', e') = (x', y')
       "Q30=P1/1000 Q31=(P1+P2)/1000", "Q32=-Q8 Q33=-250*SIN(Q31) Q34=Q7 Q35=250*COS(Q31)", "Q36=Q32*Q35-Q33*Q34",
       "P101=(Q17*Q35-Q33*Q18)/Q36*57295.779513082 P102=(Q32*Q18-Q34*Q17)/Q36*57295.779513082", "ENDIF"});
  program("INVERSE", with);
  store({"PVT100", "X390:-200 Y80:-400", "X370:0 Y60:0"});
  const auto jacobian = [](Point at, double vx, double vy) {  // by differences
    const double h = 1e-6;
    const Joints before = joints({at.x - vx * h, at.y - vy * h}), behind = joints({at.x + vx * h, at.y + vy * h});
    return Joints{(behind.shoulder - before.shoulder) / (2 * h), (behind.elbow - before.elbow) / (2 * h)};
  };
  const Joints a = joints({400, 100}), b = joints({390, 80}), c = joints({370, 60}),
               v = jacobian({390, 80}, -0.2, -0.4);
  const auto cubic = [](double from, double to, double v0, double v1, double t) {
    const double u = t / 100, d = to - from;
    return from + v0 * 100 * u + (3 * d - (2 * v0 + v1) * 100) * u * u + ((v0 + v1) * 100 - 2 * d) * u * u * u;
  };
  double worst = 0;
  run([&](double t) {
    if (t > 200) return;
    const Joints expected =
        t < 100 ? Joints{cubic(a.shoulder, b.shoulder, 0, v.shoulder, t), cubic(a.elbow, b.elbow, 0, v.elbow, t)}
                : Joints{cubic(b.shoulder, c.shoulder, v.shoulder, 0, t - 100),
                         cubic(b.elbow, c.elbow, v.elbow, 0, t - 100)};
    worst = std::max({worst, std::abs(at(1) - expected.shoulder), std::abs(at(2) - expected.elbow)});
  });
  EXPECT_LE(worst * kUnit, 6.0);
  EXPECT_GT(p(6), 0);
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
}

// SPLINE: Q10 stays 0; cubics through way points of the joints, with their velocities there (motion:5.4/4).
TEST_F(Kinematics, SplinesAreThoseOfTheJoints) {
  fit_arm();
  Lines with = arm::inverse();
  with.push_back("P6=P6+Q10");
  program("INVERSE", with);
  store({"SPLINE1 TM100", "X390 Y80", "X340 Y20", "X330 Y70"});
  const std::vector<Point> points = {{400, 100}, {400, 100}, {390, 80}, {340, 20}, {330, 70}, {330, 70}};
  std::vector<Joints> knots = {joints(points[0])}, speeds = {{0, 0}};
  for (std::size_t n = 1; n + 1 < points.size(); ++n) {
    const Joints before = joints(points[n - 1]), at = joints(points[n]), after = joints(points[n + 1]);
    knots.push_back(
        {(before.shoulder + 4 * at.shoulder + after.shoulder) / 6, (before.elbow + 4 * at.elbow + after.elbow) / 6});
    speeds.push_back({(after.shoulder - before.shoulder) / 200, (after.elbow - before.elbow) / 200});
  }
  knots.push_back(joints(points.back()));
  speeds.push_back({0, 0});
  double worst = 0;
  run([&](double t) {
    const auto n = std::min<std::size_t>(static_cast<std::size_t>(t / 100), knots.size() - 2);
    const double u = std::min(t / 100 - static_cast<double>(n), 1.0);
    const auto cubic = [&](double from, double to, double v0, double v1) {
      const double d = to - from;
      return from + v0 * 100 * u + (3 * d - (2 * v0 + v1) * 100) * u * u + ((v0 + v1) * 100 - 2 * d) * u * u * u;
    };
    const Joints &a = knots[n], &b = knots[n + 1], &va = speeds[n], &vb = speeds[n + 1];
    worst = std::max({worst, std::abs(at(1) - cubic(a.shoulder, b.shoulder, va.shoulder, vb.shoulder)),
                      std::abs(at(2) - cubic(a.elbow, b.elbow, va.elbow, vb.elbow))});
  });
  EXPECT_LE(worst * kUnit, 6.0);
  EXPECT_EQ(p(6), 0);
  EXPECT_NEAR(hand().x, 330, 1e-3);
  EXPECT_NEAR(hand().y, 70, 1e-3);
}

// The inverse program has the elbow on the other side: from rest a move begins where the joints are all the same.
TEST_F(Kinematics, PvtBeginsWhereTheMotorsAre) {
  fit({"I"});
  program("FORWARD", {"Q7=ABS(P1)/1000"});
  program("INVERSE", {"P1=Q7*1000 P101=Q17*1000 P6=P6+1"});
  ASSERT_EQ(host("I5150=1 I5190=1000"), "");
  store({"PVT100", "X2:10"});  // the last solution is one in motion
  run();
  platform::servo_ticks(1500);  // ramps to rest
  motors[0].trajectory = std::llround(-1000 * kUnit);
  store({"PVT100", "X2:10", "X3:0"});
  double worst = 0;
  run([&](double t) {  // 3000 counts from rest to 10 counts a ms
    const double u = t / 100;
    if (u < 1) worst = std::max(worst, std::abs(at(1) - (-1000 + 8000 * u * u - 5000 * u * u * u)));
  });
  EXPECT_LE(worst * kUnit, 4.0) << "units of position";
  EXPECT_NEAR(at(1), 3000, 1e-3);
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
}

// The way on of a PVT move without a next one leads out of what the arm reaches; nobody asks the program there.
TEST_F(Kinematics, PvtRunsOnInTheJoints) {
  fit_arm({460, 0});
  ASSERT_EQ(host("I5190=1000"), "");
  store({"PVT100", "X500:400", "X530:0"});
  run();
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(hand().x, 530, 1e-3);
}

// Both at the velocity that they have at the end, until each stops by its Ixx15, 0.25 counts/ms^2: from 10 and 20
// counts/ms in 10^2 / (2 * 0.25) and 20^2 / (2 * 0.25) counts.
TEST_F(Kinematics, PvtRunsOnWithEachJoint) {
  fit({"I", "I"});
  program("FORWARD", {"Q7=P1/1000 Q8=P2/1000"});
  program("INVERSE", {"P1=Q7*1000 P2=Q8*1000 P101=Q17*1000 P102=Q18*1000"});
  ASSERT_EQ(host("I5150=1 I5190=1000"), "");
  store({"PVT100", "X1:10 Y2:20"});
  run();
  platform::servo_ticks(400);
  const double first = (at(1) - 1000 - 200) / 10, second = (at(2) - 2000 - 800) / 20;  // ms at that velocity
  EXPECT_GE(first, kTickMs);
  EXPECT_NEAR(second, first, kTickMs);
}

TEST_F(Kinematics, RapidGoesToWhereTheProgramHasTheTarget) {
  fit_arm();
  ASSERT_EQ(host("I122=100 I222=100 I119=10 I219=10"), "");
  store({"RAPID X300 Y-200", "LINEAR TM100 TA50 X310"});
  run();
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(hand().x, 310, 1e-3);
  EXPECT_NEAR(hand().y, -200, 1e-3);
  EXPECT_EQ(p(4), 2) << "behind RAPID the forward program tells where the axes are";
}

// Motors that are defined by axes go by those, in the same system; what the forward program does not tell is as the
// definitions have it.
TEST_F(Kinematics, OtherMotorsGoByTheirDefinitions) {
  fit_arm({400, 100}, {"1000Z", "100X"});
  motors[2].trajectory = 7000 * 3072;
  ASSERT_EQ(host("I5113=10"), "");
  ASSERT_EQ(host("PMATCH"), "");
  platform::servo_ticks(3);
  EXPECT_EQ(axis(AXIS_Z), 7);
  EXPECT_EQ(p(3), 7000) << "the forward program has the motors of other axes too";
  store({"TM100 TA50 TS0", "X350 INC(Z) Z-2"});
  run();
  EXPECT_NEAR(hand().x, 350, 1e-3);
  EXPECT_NEAR(hand().y, 100, 1e-3);
  EXPECT_EQ(at(3), 5000);
  EXPECT_EQ(at(4), 35000);
}

TEST_F(Kinematics, PositionsAreWhatPReports) {
  fit_arm();
  motors[0].bias = 5000 * 3072;  // as behind PSET or a home offset
  motors[0].trajectory -= motors[0].bias;
  ASSERT_EQ(host("PMATCH"), "");
  platform::servo_ticks(3);
  EXPECT_NEAR(axis(AXIS_X), 400, 1e-5);
  EXPECT_NEAR(p(1), joints({400, 100}).shoulder, 1e-3);
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM100 TA50 TS0", "X350"});
  run();
  EXPECT_NEAR(at(1) + 5000, joints({350, 100}).shoulder, 0.01);
}

// PMATCH while nothing runs: the axes are where the motors are; motors stay with whom they are.
TEST_F(Kinematics, PmatchRunsTheForwardProgram) {
  fit_arm();
  ASSERT_EQ(host("&1PMATCH"), "");
  platform::servo_ticks(3);
  EXPECT_NEAR(axis(AXIS_X), 400, 1e-5);
  EXPECT_NEAR(axis(AXIS_Y), 100, 1e-5);
  EXPECT_EQ(p(4), 1);
  EXPECT_EQ(p(5), 0);
  EXPECT_NEAR(std::stod(host("RL$2047")), 400, 1e-5);
  EXPECT_FALSE(run_is_running(0));
  put(joints({380, 20}));
  ASSERT_EQ(host("PMATCH"), "");
  platform::servo_ticks(3);
  EXPECT_NEAR(axis(AXIS_X), 380, 1e-5);
}

TEST_F(Kinematics, PmatchSolvesDefinitionsToo) {
  fit({"1000X", "500Y"});
  motors[0].trajectory = 2500 * 3072;
  motors[1].trajectory = -500 * 3072;
  ASSERT_EQ(host("&2PMATCH &1"), "");
  platform::servo_ticks(3);
  EXPECT_EQ(axis(AXIS_X), 0) << "another system was told";
  ASSERT_EQ(host("PMATCH"), "");
  platform::servo_ticks(3);
  EXPECT_EQ(axis(AXIS_X), 2.5);
  EXPECT_EQ(axis(AXIS_Y), -1);
}

// In a program, between DWELLs, when another tool makes another forward program: the next move begins there.
TEST_F(Kinematics, PmatchInAProgram) {
  fit_arm();
  Lines tool = arm::forward();
  tool.push_back("Q7=Q7+P10");
  program("FORWARD", tool);
  Lines back = arm::inverse();
  back.insert(back.begin(), "Q7=Q7-P10");
  program("INVERSE", back);
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM100 TA50 TS0", "X350", "DWELL20 P10=50 CMD\"&1PMATCH\" DWELL20", "INC X10"});
  unsigned shown = 0;
  ASSERT_EQ(host("&1B1R"), "");
  for (int i = 0; i < 1000 && run_is_running(0); ++i) {
    platform::background(1);
    if (p(10) == 50) shown |= motion_cs_status(0, 2) & 1u;  // the match of R is over
    platform::servo_ticks(1);
  }
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_EQ(shown, 1u) << "bit 0 of word 3";
  EXPECT_NEAR(axis(AXIS_X), 410, 1e-4);
  EXPECT_NEAR(hand().x, 360, 1e-3);
}

// While X10 is calculated, PMATCH waits until it is over: X20 then goes from there, and not before.
TEST_F(Kinematics, PmatchWhileAMoveIsCalculated) {
  for (const char* isx13 : {"0", "10"}) {
    unsigned accepted = 0, behind = 0;
    for (unsigned at_pause = 1; at_pause < 400; ++at_pause) {
      SCOPED_TRACE(testing::Message() << "Isx13=" << isx13 << ", pause " << at_pause);
      platform::power_up();
      fit({"1000X"});
      ASSERT_EQ(host(std::string("I5113=") + isx13), "");
      store({"TM30 TA20 TS0", "X10 Y0", "X20"});
      ASSERT_EQ(host("&1B1R"), "");
      unsigned pauses = 0;
      bool waits = false, within = false;
      double place = -1;
      const auto look = [&] {
        if (!waits || cs().matching) return;
        waits = false;
        within = cs().pending_axes != 0;
        place = at(1);
      };
      for (int i = 0; i < 3 && pauses < at_pause; ++i)
        platform::real_time_in_slices([&] {
          look();
          if (++pauses == at_pause && run_match(0) == ERR_NONE) waits = true, ++accepted;
        });
      double before = at(1), fastest = 0;
      for (int i = 0; i < 1000 && run_is_running(0); ++i) {
        platform::servo_ticks(1);
        fastest = std::max(fastest, std::abs(at(1) - before));
        before = at(1);
        look();
      }
      ASSERT_FALSE(within) << "in the middle of a line";
      ASSERT_TRUE(place == -1 || place == 0 || place == 10000) << place;
      behind += place == 10000 ? 1u : 0u;
      ASSERT_EQ(at(1), 20000);
      ASSERT_EQ(axis(AXIS_X), 20);
      ASSERT_LE(fastest, 10000 / 30.0 * kTickMs + 1);
      ASSERT_EQ(cs().error, RUN_TIME_NONE);
      if (pauses < at_pause) break;
    }
    EXPECT_GT(accepted, 10u) << isx13;
    EXPECT_GT(behind, 5u) << isx13;
  }
}

TEST_F(Kinematics, HomezFindsTheAxesAnew) {
  fit_arm();
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM50 TA20 TS0", "X390 Y100", "HOMEZ1,2", "P10=P4"});
  run();
  EXPECT_EQ(p(4), 2);
  EXPECT_NEAR(axis(AXIS_X), 550, 1e-6) << "both joints at 0: the arm is straight";
  EXPECT_NEAR(axis(AXIS_Y), 0, 1e-6);
}

// PSET: the axes are there from now on, no motor moves.
TEST_F(Kinematics, PsetIsTheBiasOfTheMotors) {
  fit_arm();
  const std::int64_t stands[] = {motors[0].trajectory, motors[1].trajectory};
  store({"PSET X420 Y50"});
  EXPECT_EQ(host("&1B1R"), "");
  platform::servo_ticks(30);
  EXPECT_EQ(motors[0].trajectory, stands[0]);
  EXPECT_EQ(motors[1].trajectory, stands[1]);
  EXPECT_NEAR(at(1) + static_cast<double>(motors[0].bias) / kUnit, joints({420, 50}).shoulder, 0.01);
  EXPECT_NEAR(at(2) + static_cast<double>(motors[1].bias) / kUnit, joints({420, 50}).elbow, 0.01);
  store({"TM50 TA20 TS0 X400"});
  run();
  EXPECT_NEAR(at(1) + static_cast<double>(motors[0].bias) / kUnit, joints({400, 50}).shoulder, 0.01);
}

// motion:1.2/4: in normal mode a program takes back what has been followed, from where the motor is.
TEST_F(Kinematics, AMotorThatHasFollowed) {
  const Lines programs[] = {
      {"TM100 TA20 TS0 X1"}, {"INC TM100 TA20 TS0 X1"}, {"RAPID X1"}, {"SPLINE1 TM50 X1"}, {"PVT100 X1:0"}};
  const double normal[] = {1000, 1500, 1000, 1000, 1000};
  for (unsigned i = 0; i < 5; ++i) {
    for (const unsigned mode : {1u, 3u}) {
      SCOPED_TRACE(testing::Message() << programs[i].front() << ", Ixx06=" << mode);
      platform::power_up();
      fit({"I"});
      program("FORWARD", {"Q7=P1/1000"});
      program("INVERSE", {"P1=Q7*1000"});
      ASSERT_EQ(host("I5150=1 I119=1 I120=20 I121=0 I122=20 I105=$10F0 I107=96 I106=" + std::to_string(mode)), "");
      platform::servo_ticks(3);
      *hal_x(0x10F0) = 500 * 32;  // the master
      platform::servo_ticks(1);
      const auto commanded = [] { return static_cast<double>(motors[0].commanded) / kUnit; };
      ASSERT_EQ(commanded(), 500);
      store(programs[i]);
      ASSERT_EQ(host("&1B1R"), "");
      double before = commanded(), fastest = 0;
      for (int tick = 0; tick < 3000 && run_is_running(0); ++tick) {
        platform::servo_ticks(1);
        fastest = std::max(fastest, std::abs(commanded() - before));
        before = commanded();
      }
      EXPECT_NEAR(commanded(), mode == 1 ? normal[i] : 1500, 1e-3);
      EXPECT_LT(fastest, 1500 / 50.0 * kTickMs) << "no leap";
      EXPECT_EQ(motors[0].bias, 0);
      EXPECT_EQ(cs().error, RUN_TIME_NONE);
    }
  }
}

// Isx50 is taken at the start of a program.
TEST_F(Kinematics, IsxFiftyCountsFromTheNextStartOn) {
  fit_arm();
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM100 TA50 TS0", "X350", "X300"});
  run([](double t) {
    if (t > 50) platform::set_i(5150, 0);
  });
  EXPECT_NEAR(hand().x, 300, 1e-3);
  const std::int64_t stands = motors[0].trajectory;
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(300);
  EXPECT_EQ(motors[0].trajectory, stands) << "motors by I stay";
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
}

// Jogs are those of motors; R behind them begins where they are.
TEST_F(Kinematics, JogsGoByMotors) {
  fit_arm();
  ASSERT_EQ(host("I122=100 I119=10"), "");
  ASSERT_EQ(host("#1J:1000"), "");
  platform::servo_ticks(500);
  EXPECT_NEAR(at(1), joints({400, 100}).shoulder + 1000, 0.01);
  ASSERT_EQ(host("I5113=10"), "");
  const Point from = hand();
  store({"TM100 TA50 TS0 INC", "Y-20"});
  run();
  EXPECT_NEAR(hand().x, from.x, 1e-3);
  EXPECT_NEAR(hand().y, from.y - 20, 1e-3);
}

TEST_F(Kinematics, AStepIsAMove) {
  fit_arm();
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM100 TA50 TS0", "X350", "Y50"});
  run([](double) {}, "&1B1S");
  EXPECT_NEAR(hand().x, 350, 1e-3);
  EXPECT_NEAR(hand().y, 100, 1e-3);
  run([](double) {}, "&1S");
  EXPECT_NEAR(hand().y, 50, 1e-3);
  EXPECT_EQ(p(4), 2) << "S runs the forward program, as R";
}

// P(xx) is the solution before when the program begins: iterations start there.
TEST_F(Kinematics, AnIteratingProgram) {
  fit_arm();
  // Newton steps from the last joints
  program("INVERSE", {"Q30=100 Q39=0", "WHILE(Q30>0.00001)", "Q31=P1/1000 Q32=(P1+P2)/1000",
                      "Q33=300*COS(Q31)+250*COS(Q32) Q34=300*SIN(Q31)+250*SIN(Q32)",
                      "Q35=-250*SIN(Q32) Q36=250*COS(Q32) Q37=Q7-Q33 Q38=Q8-Q34", "Q40=-Q34*Q36-Q35*Q33",
                      "P1=P1+(Q37*Q36-Q35*Q38)/Q40*57295.779513082 P2=P2+(-Q34*Q38-Q33*Q37)/Q40*57295.779513082",
                      "Q30=ABS(Q37)+ABS(Q38) Q39=Q39+1", "ENDWHILE", "P6=P6+Q39 P7=P7+1"});
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM400 TA100 TS0", "X300 Y-200"});
  run();
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(hand().x, 300, 1e-3);
  EXPECT_NEAR(hand().y, -200, 1e-3);
  EXPECT_LT(p(6) / p(7), 5) << "iterations a segment";
}

// What executes in the middle of a program sees the motion of another system all the same.
TEST_F(Kinematics, EverySystemHasItsOwnPrograms) {
  fit_arm();
  ASSERT_EQ(host("I300=1 I311=0 I312=0 I316=1000000 I317=1000000 I68=1 I5250=1 I5213=5 I5113=10"), "");
  ASSERT_EQ(host("&2#3->I"), "");
  motors[2] = {};
  motors[2].loop = LOOP_CLOSED;
  motors[2].position_scale = 96;
  motors[2].cs = 1;
  ASSERT_EQ(host("OPEN FORWARD CLEAR Q7=P3/100 CLOSE OPEN INVERSE CLEAR P3=Q7*100 CLOSE"), "");
  store({"TM200 TA50 TS0", "X300"});
  store({"TM100 TA50 TS0", "X20", "X-20"}, 2);
  ASSERT_EQ(host("&1B1R&2B2R"), "");
  platform::servo_ticks(ticks_of(400));
  EXPECT_FALSE(run_is_running(0) || run_is_running(1));
  EXPECT_NEAR(hand().x, 300, 1e-3);
  EXPECT_EQ(at(3), -2000);
}

// Through the lookahead buffer: limits of the joints hold, and `<` goes back by the same ones.
TEST_F(Kinematics, LookaheadKeepsTheLimitsOfTheJoints) {
  fit_arm();
  ASSERT_EQ(host("I5113=5 I5120=60 I116=100 I216=100 I117=1 I217=1 DELETE GATHER"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,0"), "");
  store({"F5000 TA10 TS0", "X300 Y-200"});
  double fastest = 0, most = 0;
  std::vector<Joints> seen;
  run([&](double) { seen.push_back(now()); });
  const double tick = kTickMs;
  for (std::size_t i = 0; i + 16 < seen.size(); i += 4) {
    const auto look = [&](double a, double b, double c) {
      fastest = std::max(fastest, std::abs(b - a) / (8 * tick));
      most = std::max(most, std::abs(c - 2 * b + a) / (64 * tick * tick));
    };
    look(seen[i].shoulder, seen[i + 8].shoulder, seen[i + 16].shoulder);
    look(seen[i].elbow, seen[i + 8].elbow, seen[i + 16].elbow);
  }
  EXPECT_LE(fastest, 100 * 1.005);
  EXPECT_GT(fastest, 60);
  EXPECT_LE(most, 1.03);
  EXPECT_NEAR(hand().x, 300, 1e-3);
  EXPECT_NEAR(hand().y, -200, 1e-3);
}

// The work of a program is left wherever it pauses, and gone on with.
TEST_F(Kinematics, InSlices) {
  fit_arm();
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM400 TA100 TS20", "X300 Y-200"});
  ASSERT_EQ(host("&1B1R"), "");
  unsigned pauses = 0;
  for (int i = 0; i < 1200; ++i) {
    platform::real_time_in_slices([&] { ++pauses; });
    platform::servo_ticks(1);
  }
  EXPECT_NEAR(hand().x, 300, 1e-3);
  EXPECT_NEAR(hand().y, -200, 1e-3);
  EXPECT_GT(pauses, 52 * 60u) << "behind each word";
}

TEST_F(Kinematics, Status) {
  fit_arm();
  EXPECT_EQ(host("#1?").substr(7, 1), "5") << "the axis of the second word";
  EXPECT_EQ(motion_global_status2() >> 14 & 3u, 0u);
  ASSERT_EQ(host("OPEN FORWARD"), "");
  EXPECT_EQ(motion_global_status2() >> 14 & 3u, 2u);
  ASSERT_EQ(host("CLOSE OPEN INVERSE"), "");
  EXPECT_EQ(motion_global_status2() >> 14 & 3u, 1u);
  EXPECT_EQ(host("CLOSE #1->"), "I");
}

}  // namespace
