// Axis matrices (motion:8.2): programmed = R base + D. What the test expects is solved for base in doubles.
#include "testbench/unit/firmware_kinematics/arm.h"

namespace {

using namespace moving_motors;

constexpr double kDegree = 3.14159265358979323846 / 180;

class AxisMatrix : public MovingMotors {
 protected:
  void SetUp() override {
    MovingMotors::SetUp();
    fit({"1000X", "1000Y", "1000Z"});
    ASSERT_EQ(host("DELETE GATHER I15=0"), "");
    ASSERT_EQ(host("DEFINE TBUF 4"), "");
  }
  static Lines with(const Lines& lines) {
    Lines all = {"TM20 TA10 TS0",
                 // 30 degrees about Z in Q40, a scale of 2 in Q50, a mirror in Q60, a shift in Q70
                 "Q40=COS(30) Q41=SIN(30) Q42=0 Q43=-SIN(30) Q44=COS(30) Q45=0 Q46=0 Q47=0 Q48=1",
                 "Q50=2 Q51=0 Q52=0 Q53=0 Q54=2 Q55=0 Q56=0 Q57=0 Q58=2",
                 "Q60=-1 Q61=0 Q62=0 Q63=0 Q64=1 Q65=0 Q66=0 Q67=0 Q68=1", "Q70=1 Q71=2 Q72=3"};
    all.insert(all.end(), lines.begin(), lines.end());
    return all;
  }
  static void go(const Lines& lines) {
    store(with(lines));
    run();
    EXPECT_EQ(cs().error, RUN_TIME_NONE);
  }
  static void stands_at(double x, double y, double z) {
    EXPECT_NEAR(at(1), x * 1000, 1e-3);
    EXPECT_NEAR(at(2), y * 1000, 1e-3);
    EXPECT_NEAR(at(3), z * 1000, 1e-3);
  }
};

const double c30 = std::cos(30 * kDegree), s30 = std::sin(30 * kDegree);

TEST_F(AxisMatrix, ARotationTurnsPoints) {
  go({"TSEL1 AROT40", "X10", "Y5 Z2"});
  stands_at(10 * c30 - 5 * s30, 10 * s30 + 5 * c30, 2);  // counterclockwise, as the base sees them
}

TEST_F(AxisMatrix, WhatIsNotNamedStaysAsTheProgramSeesIt) {
  go({"X10 Y4", "TSEL1 AROT40", "X3"});  // programmed (10 c + 4 s, -10 s + 4 c): its Y stays
  const double y = -10 * s30 + 4 * c30;
  stands_at(3 * c30 - y * s30, 3 * s30 + y * c30, 0);
}

TEST_F(AxisMatrix, NothingMovesByItself) {
  store(with({"X10 Y4", "TSEL1 AROT40 ADIS70", "DWELL20"}));
  run();
  stands_at(10, 4, 0);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
}

TEST_F(AxisMatrix, ADisplacement) {
  go({"TSEL2 ADIS70", "X10 Y10 Z10"});
  stands_at(9, 8, 7);
}

TEST_F(AxisMatrix, DisplacementsAddUp) {
  go({"TSEL2 ADIS70 IDIS70", "X10 Y10 Z10"});
  stands_at(8, 6, 4);
}

TEST_F(AxisMatrix, RotationsMultiply) {
  go({"TSEL1 AROT40 IROT50", "X10"});  // programmed = 2 R30 base
  stands_at(5 * c30, 5 * s30, 0);
}

// IROT stands left of what there is: a mirror of X after a turn is that of the turned X.
TEST_F(AxisMatrix, TheLaterOneActsOnWhatTheEarlierOneGives) {
  go({"TSEL1 AROT40 IROT60", "X10"});  // programmed = mirror R30 base: base = R30^-1 (-10, 0)
  stands_at(-10 * c30, -10 * s30, 0);
}

TEST_F(AxisMatrix, ADisplacementIsBehindTheRotation) {
  go({"TSEL1 AROT40 ADIS70", "X10 Y10"});  // base = R^-1 (10 - 1, 10 - 2)
  stands_at(9 * c30 - 8 * s30, 9 * s30 + 8 * c30, -3 + 3);
}

// About the point (P1, P2): that one stays where it is.
TEST_F(AxisMatrix, ARotationAboutAPoint) {
  go({"P1=7 P2=3 Q80=P1*(1-COS(30))-P2*SIN(30) Q81=P1*SIN(30)+P2*(1-COS(30)) Q82=0", "TSEL1 AROT40 ADIS80", "X7 Y3"});
  stands_at(7, 3, 0);
  go({"TSEL1", "X8 Y3"});
  stands_at(7 + c30, 3 + s30, 0);
}

TEST_F(AxisMatrix, IncrementalMovesAreAlongItsAxes) {
  go({"TSEL1 AROT40 INC", "X10", "X10", "Y1"});
  stands_at(20 * c30 - s30, 20 * s30 + c30, 0);
}

TEST_F(AxisMatrix, OtherAxesAreNotTouched) {
  ASSERT_EQ(host("#3->1000A"), "");
  go({"TSEL1 AROT40 ADIS70", "A5"});
  EXPECT_EQ(at(3), 5000);
  stands_at(0, 0, 5);
}

// A scale: the feedrate is that of base.
TEST_F(AxisMatrix, AScale) {
  ASSERT_EQ(host("I5190=1000"), "");
  store(with({"TSEL1 AROT50 F100 TA10", "X20"}));
  EXPECT_NEAR(run(), 100 + 10, 2 * kTickMs);  // 10 units of base
  stands_at(10, 0, 0);
}

TEST_F(AxisMatrix, SelectionsAndUnitMatrices) {
  go({"TSEL1 AROT40", "TSEL2 ADIS70", "TSEL3", "X4 Y4 Z4"});
  stands_at(4, 4, 4);  // a new one is a unit matrix
  go({"TSEL2 X4 Y4 Z4"});
  stands_at(3, 2, 1);
  go({"TSEL1", "X10 Y0 Z0"});
  stands_at(10 * c30, 10 * s30, 0);
  go({"TSEL0", "X1 Y1"});
  stands_at(1, 1, 0);
  go({"TSEL1 TINIT", "X5 Y5"});
  stands_at(5, 5, 0);
  go({"P3=2 TSELECT(P3) X4"});
  EXPECT_NEAR(at(1), 3000, 1e-3);
}

TEST_F(AxisMatrix, VariablesCountWhenTheyAreRead) {
  go({"TSEL2 ADIS70", "Q70=100", "X10"});
  EXPECT_NEAR(at(1), 9000, 1e-3);
}

TEST_F(AxisMatrix, AxesOfItsLineMoveFirst) {
  go({"X10 TSEL2 ADIS70", "Y10"});
  stands_at(10, 8, 0);
}

// Moves go on blending: the second line is calculated while the first one executes.
TEST_F(AxisMatrix, BlendingGoesOn) {
  store(with({"TSEL2 TM100 TA40", "X2", "ADIS70", "X5"}));  // 2, then 4 of base
  EXPECT_NEAR(run(), 240, 2 * kTickMs);
  stands_at(4, 0, 0);
}

// A quarter of a circle in the turned plane; R is that of base.
TEST_F(AxisMatrix, ArcsByTheirCentre) {
  ASSERT_EQ(host("I5113=2"), "");
  for (const char* circle : {"X10 Y10 I10 J0", "X10 Y10 J0 I10", "X10 Y10 I10", "X10 Y10 R10"}) {
    SCOPED_TRACE(circle);
    motors[0].trajectory = motors[1].trajectory = motors[2].trajectory = 0;
    store(with({"TSEL1 AROT40 TM300 TA20", std::string("CIRCLE1 ") + circle}));
    double worst = 0;
    run([&](double) {
      const double x = at(1) / 1000, y = at(2) / 1000;
      worst = std::max(worst, std::abs(std::hypot(x - 10 * c30, y - 10 * s30) - 10));
    });
    EXPECT_LT(worst, 1e-3);
    stands_at(10 * c30 - 10 * s30, 10 * s30 + 10 * c30, 0);
  }
}

// A centre on the second axis: clockwise from south to west.
TEST_F(AxisMatrix, ArcsByJ) {
  ASSERT_EQ(host("I5113=2"), "");
  for (const char* circle : {"X-10 Y10 J10", "X-10 Y10 I0 J10"}) {
    motors[0].trajectory = motors[1].trajectory = 0;
    store(with({"TSEL1 AROT40 TM300 TA20", std::string("CIRCLE1 ") + circle}));
    double worst = 0;
    run([&](double) {
      worst = std::max(worst, std::abs(std::hypot(at(1) / 1000 + 10 * s30, at(2) / 1000 - 10 * c30) - 10));
    });
    EXPECT_LT(worst, 1e-3) << circle;
    stands_at(-10 * c30 - 10 * s30, -10 * s30 + 10 * c30, 0);
  }
}

// The way to a centre is none between points: from base (0, 0) about (10, 0) to (10, 10).
TEST_F(AxisMatrix, TheWayToACentreIsNotDisplaced) {
  ASSERT_EQ(host("I5113=2"), "");
  store(with({"TSEL2 ADIS70 TM300 TA20", "CIRCLE1 X11 Y12 I10"}));
  double worst = 0;
  run([&](double) { worst = std::max(worst, std::abs(std::hypot(at(1) / 1000 - 10, at(2) / 1000) - 10)); });
  EXPECT_LT(worst, 1e-3);
  stands_at(10, 10, 0);
}

TEST_F(AxisMatrix, AMirrorTurnsArcs) {
  ASSERT_EQ(host("I5113=2"), "");
  store(with({"TSEL1 AROT60 TM300 TA20", "CIRCLE1 X10 Y10 I10 J0"}));
  bool inside = true;
  run([&](double) { inside = inside && std::abs(std::hypot(at(1) / 1000 + 10, at(2) / 1000) - 10) < 1e-3; });
  EXPECT_TRUE(inside) << "about (-10, 0)";
  stands_at(-10, 10, 0);
  store(with({"TSEL1 TM300 TA20", "CIRCLE1 X20 Y0 R10"}));
  double highest = 0;
  run([&](double) { highest = std::max(highest, at(2)); });
  EXPECT_LT(highest, 10001) << "a quarter, not three";
  stands_at(-20, 0, 0);
}

TEST_F(AxisMatrix, AbsoluteCentresAreDisplaced) {
  ASSERT_EQ(host("I5113=2"), "");
  store(with({"TSEL1 AROT40 ADIS70 TM20", "X0 Y0 Z0", "ABS(R) TM300 TA20 CIRCLE1 X10 Y10 I10", "INC(R)"}));
  double worst = 0;
  const auto base = [](double x, double y) {
    return std::make_pair(c30 * (x - 1) - s30 * (y - 2), s30 * (x - 1) + c30 * (y - 2));
  };
  const auto centre = base(10, 0), end = base(10, 10);
  run([&](double t) {
    if (t < 45) return;
    worst = std::max(worst, std::abs(std::hypot(at(1) / 1000 - centre.first, at(2) / 1000 - centre.second) - 10));
  });
  EXPECT_LT(worst, 0.2);  // the corner with the line before is rounded
  stands_at(end.first, end.second, -3);
}

// motion:7.2/2: what ABS(R) does not give of a centre is as at the start, as the program sees that.
TEST_F(AxisMatrix, ACentreThatIsNotGivenIsThatOfTheStart) {
  ASSERT_EQ(host("I5113=2"), "");
  store(with({"TSEL1 AROT40 TM20", "X0 Y4 Z0", "DWELL10", "ABS(R) TM300 TA20 CIRCLE1 X20 Y4 I10", "INC(R)"}));
  const double x = c30 * 10 - s30 * 4, y = s30 * 10 + c30 * 4;
  double worst = 0;
  run([&](double t) {
    if (t > 60) worst = std::max(worst, std::abs(std::hypot(at(1) / 1000 - x, at(2) / 1000 - y) - 10));
  });
  EXPECT_LT(worst, 0.01);
  stands_at(c30 * 20 - s30 * 4, s30 * 20 + c30 * 4, 0);
}

// Z of the program lies along -Y of base: arcs of its XY-plane are in the XZ-plane.
TEST_F(AxisMatrix, PlanesTiltWithIt) {
  ASSERT_EQ(host("I5113=2"), "");
  store(with(
      {"Q80=1 Q81=0 Q82=0 Q83=0 Q84=0 Q85=1 Q86=0 Q87=-1 Q88=0", "TSEL1 AROT80 TM300 TA20", "CIRCLE1 X10 Y10 I10 J0"}));
  double worst = 0;
  run([&](double) { worst = std::max(worst, std::abs(std::hypot(at(1) / 1000 - 10, at(3) / 1000) - 10)); });
  EXPECT_LT(worst, 1e-3);
  stands_at(10, 0, 10);
}

TEST_F(AxisMatrix, VelocitiesOfPvtTurn) {
  ASSERT_EQ(host("I5190=1000"), "");
  store(with({"TSEL1 AROT40 PVT100", "X1:20", "X3:0"}));
  double vx = 0, vy = 0, before_x = 0, before_y = 0;
  run([&](double t) {
    if (t < 100) before_x = at(1), before_y = at(2);
    if (t < 100 + kTickMs) vx = (at(1) - before_x) / kTickMs, vy = (at(2) - before_y) / kTickMs;
  });
  stands_at(3 * c30, 3 * s30, 0);
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(vx, 20 * c30, 0.5);
  EXPECT_NEAR(vy, 20 * s30, 0.5);
}

TEST_F(AxisMatrix, PsetIsOfTheProgram) {
  go({"TSEL2 ADIS70", "X10 Y10 Z10", "PSET X5", "X6 Y10"});  // base X 4, then 5: its motor goes from 9 by 1
  EXPECT_NEAR(at(1), 10000, 1e-3);
  EXPECT_NEAR(at(1) + static_cast<double>(motors[0].bias) / kUnit, 5000, 1e-3);
  EXPECT_NEAR(at(2), 8000, 1e-3);
  EXPECT_EQ(motors[1].bias, 0);
}

TEST_F(AxisMatrix, WhatCannotBeIsARunTimeError) {
  const Lines programs[] = {{"TSEL5 X1"},
                            {"TSEL(-1) X1"},
                            {"AROT40 X1"},
                            {"TINIT X1"},
                            {"ADIS70 X1"},
                            {"TSEL1 AROT100 X1"},
                            {"TSEL1 AROT(8192) X1"},
                            {"TSEL1 AROT(-1) X1"},
                            {"TSEL1 ADIS(8192) X1"},
                            {"TSEL1 IDIS(8192) X1"},
                            {"TSEL1 IDIS(-1) X1"}};
  for (const Lines& lines : programs) {
    SCOPED_TRACE(lines.front());
    store(lines);
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(100);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(cs().error, RUN_TIME_STATEMENT);
    EXPECT_EQ(motors[0].trajectory, 0);
    store({"TSEL0"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(30);
  }
}

// What lies beside TBUF is none of it, whatever it looks like.
TEST_F(AxisMatrix, WordsBesideTbufAreNoMatrix) {
  ASSERT_EQ(host("DELETE TBUF"), "");
  ASSERT_EQ(host("DEFINE UBUFFER 24"), "");
  ASSERT_EQ(host("DEFINE TBUF 4"), "");
  ASSERT_EQ(host("WL:$107E8,1,0,0,0,1,0,0,0,1,7,7,7"), "");  // the first of its words
  store({"TSEL5 X1"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(100);
  EXPECT_EQ(cs().error, RUN_TIME_STATEMENT);
}

// One that leads nowhere leaves the one before, and so does one that is not there.
TEST_F(AxisMatrix, ASingularOneIsNotTaken) {
  store(with({"TSEL1 AROT40", "AROT100"}));
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(100);
  EXPECT_EQ(cs().error, RUN_TIME_STATEMENT);
  go({"X10"});
  stands_at(10 * c30, 10 * s30, 0);
  store({"TSEL5"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(100);
  EXPECT_EQ(cs().error, RUN_TIME_STATEMENT);
  go({"X20"});
  stands_at(20 * c30, 20 * s30, 0);
}

TEST_F(AxisMatrix, ATriggerAndAMatrixAreARunTimeError) {
  store(with({"TSEL1 AROT40 RAPID X10^1"}));
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(100);
  EXPECT_EQ(cs().error, RUN_TIME_STATEMENT);
}

TEST_F(AxisMatrix, WithoutTbufThereIsNone) {
  go({"TSEL2 ADIS70 DWELL1"});
  ASSERT_EQ(host("DELETE TBUF"), "");
  go({"X10"});
  EXPECT_EQ(at(1), 10000);
  ASSERT_EQ(host("DEFINE TBUF 2"), "");
  go({"X11"});
  EXPECT_EQ(at(1), 11000) << "one that was selected is not selected again";
  go({"TSEL2", "X12"});
  EXPECT_EQ(at(1), 12000) << "and is a unit matrix";
}

TEST_F(AxisMatrix, AResetSelectsNone) {
  go({"TSEL2 ADIS70 DWELL1"});
  platform::power_up();
  fit({"1000X", "1000Y", "1000Z"});
  ASSERT_EQ(host("DELETE GATHER"), "");
  ASSERT_EQ(host("DEFINE TBUF 4"), "");
  go({"X10"});
  EXPECT_EQ(at(1), 10000);
}

// Twelve words: rows of R, then D; a user may look at them.
TEST_F(AxisMatrix, WordsOfTbuf) {
  go({"TSEL2 AROT40 ADIS70 DWELL1"});
  const unsigned base = 0xA000 + 26624 - 48 + 12;
  char line[32];
  std::snprintf(line, sizeof line, "RL$%X,12", base);
  EXPECT_EQ(host(line), "0.8660254038 0.5 0 -0.5 0.8660254038 0 0 0 1 1 2 3");
}

// Their words are those of TBUF, whatever lies below it.
TEST_F(AxisMatrix, BuffersBelowTbufAreNoMatrices) {
  ASSERT_EQ(host("&16DEFINE CCBUF 30 &1DEFINE CCBUF 30"), "");
  go({"TSEL2 ADIS70 DWELL1"});
  EXPECT_EQ(host("RL$107E5,3"), "1 2 3");  // the last of the second's twelve: $A000 + 26624 - 48 + 21
  go({"TSEL1 X0 Y0 Z0", "TSEL2 X10 Y10 Z10"});
  stands_at(9, 8, 7);
}

TEST_F(AxisMatrix, SystemsShareThem) {
  ASSERT_EQ(host("&1#3->0"), "");
  ASSERT_EQ(host("I68=1"), "");
  ASSERT_EQ(host("&2#3->1000X"), "");
  motors[2].cs = 1;
  go({"TSEL2 ADIS70 DWELL1"});
  store({"TM20 TA10 TS0 TSEL2 X10"}, 2);
  ASSERT_EQ(host("&2B2R"), "");
  platform::servo_ticks(200);
  EXPECT_EQ(at(3), 9000);
  go({"IDIS70 DWELL1"});
  ASSERT_EQ(host("OPEN PROG 2 CLEAR TM20 TA10 TS0 X0 CLOSE &2B2R"), "");
  platform::servo_ticks(200);
  EXPECT_EQ(at(3), -1000) << "it goes on with the one that it has taken";
}

// What the axes of kinematic programs are is base.
class MatrixOfAnArm : public arm::Arm {};

TEST_F(MatrixOfAnArm, TheInverseProgramGetsBase) {
  fit_arm({400, 0});
  ASSERT_EQ(host("DELETE GATHER"), "");
  ASSERT_EQ(host("DEFINE TBUF 1 I5113=10"), "");
  store({"TM100 TA50 TS0", "Q40=COS(30) Q41=SIN(30) Q42=0 Q43=-SIN(30) Q44=COS(30) Q45=0 Q46=0 Q47=0 Q48=1",
         "TSEL1 AROT40", "X350 Y0"});
  run();
  EXPECT_NEAR(hand().x, 350 * c30, 1e-3);
  EXPECT_NEAR(hand().y, 350 * s30, 1e-3);
}

}  // namespace
