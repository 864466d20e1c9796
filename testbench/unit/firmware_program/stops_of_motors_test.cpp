// Starts and stops of programs with motors: R, S, Q, A, H, / and \ as motion:5.6 has them, corners without blending
// (motion:5.2), RAPID, PSET, HOMEZ, where axes are after jogs.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/jog.h"
}

namespace {

using namespace moving_motors;

class StopsOfMotors : public MovingMotors {
 protected:
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
  static bool rests() {
    const std::int64_t before[2] = {motors[0].trajectory, motors[1].trajectory};
    platform::servo_ticks(1);
    return before[0] == motors[0].trajectory && before[1] == motors[1].trajectory;
  }
  static void begin(const std::string& start = "&1B1R") {
    ASSERT_EQ(host(start), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    ASSERT_TRUE(cs().active);
  }
  static std::int64_t position(double counts) { return std::llround(counts * kUnit); }
};

TEST_F(StopsOfMotors, RunAsksForMotorsThatMayMove) {
  fit({"1000X", "1000Y"});
  store({"X1"});
  motors[1].loop = LOOP_OPEN;
  EXPECT_EQ(host("&1B1R"), "ERR012");
  EXPECT_EQ(host("B77R"), "ERR012") << "before ERR015";
  ASSERT_EQ(host("B1"), "");
  motors[1].loop = LOOP_KILLED;
  EXPECT_EQ(host("S"), "ERR012");
  motors[1].loop = LOOP_CLOSED;
  motors[1].found.positive_limit = motors[1].found.negative_limit = true;
  EXPECT_EQ(host("R"), "ERR010");
  motors[1].found.positive_limit = motors[1].found.negative_limit = false;
  ASSERT_TRUE(jog_to(1, position(500)));
  EXPECT_EQ(host("R"), "ERR011") << "a jog is under way";
  ticks(400);
  EXPECT_EQ(host("I200=0 R"), "ERR013");
  ASSERT_EQ(host("I200=1"), "");
  motors[1].loop = LOOP_CLOSED;
  EXPECT_EQ(host("R"), "");
}

TEST_F(StopsOfMotors, QuitEndsWithTheCalculatedMove) {
  fit({"1000X"});
  store({"TM100 TA20 TS0 INC", "X1", "X1", "X1", "X1"});
  for (const char* stop : {"Q", "/"}) {
    ASSERT_EQ(host("B1"), "");
    const std::int64_t from = motors[0].trajectory;
    begin();
    ticks(30);
    ASSERT_EQ(host(stop), "");
    for (int i = 0; i < 100 && run_is_running(0); ++i) ticks(10);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(motors[0].trajectory - from, position(2000))
        << stop << ": the one behind the executing one is calculated";
    begin("R");
    for (int i = 0; i < 100 && run_is_running(0); ++i) ticks(10);
    EXPECT_EQ(motors[0].trajectory - from, position(4000));
  }
}

TEST_F(StopsOfMotors, StepsTakeOneMoveEach) {
  fit({"1000X"});
  store({"TM50 TA20 TS0 INC", "X1", "X2", "X3"});
  ASSERT_EQ(host("B1"), "");
  for (const double end : {1000.0, 3000.0, 6000.0}) {
    begin("S");
    ticks(150);
    EXPECT_EQ(motors[0].trajectory, position(end));
  }
}

// On the path: X and Y stay in proportion while time slows down.
TEST_F(StopsOfMotors, HoldAndRateKeepThePath) {
  fit({"1000X", "250Y"});
  store({"TM400 TA100 TS20 X4 Y4"});
  ASSERT_EQ(host("I5195=20000 I5194=20000"), "");
  for (const char* stop : {"H", "\\"}) {
    motors[0].trajectory = motors[1].trajectory = 0;
    begin();
    ticks(200);
    ASSERT_EQ(host(stop), "");
    for (int i = 0; i < 1000; ++i) {
      platform::servo_ticks(1);
      ASSERT_NEAR(at(1), 4 * at(2), 12 / kUnit);
    }
    EXPECT_TRUE(rests());
    EXPECT_GT(at(1), 500.0);
    EXPECT_LT(at(1), 3500.0);
    const std::int64_t held = motors[0].trajectory;
    motors[0].trajectory += 5;  // as a jog
    EXPECT_EQ(host("R"), "ERR017");
    motors[0].trajectory = held;
    ASSERT_EQ(host("%50 R"), "");
    for (int i = 0; i < 3000 && run_is_running(0); ++i) {
      platform::servo_ticks(1);
      ASSERT_NEAR(at(1), 4 * at(2), 12 / kUnit);
    }
    EXPECT_EQ(motors[0].trajectory, position(4000));
    EXPECT_EQ(host("%100"), "");
    ticks(200);
  }
}

// Each motor leaves the path on its own ramp, Ixx15; then the axes are where the motors are.
TEST_F(StopsOfMotors, AbortRampsEachMotor) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I115=0.5 I215=0.125"), "");
  store({"TM1000 TA100 TS0 X20 Y10", "X0 Y0"});
  begin();
  ticks(500);  // 20 and 10 counts a ms
  const double x = at(1), y = at(2);
  ASSERT_EQ(host("A"), "");
  EXPECT_FALSE(run_is_running(0));
  double rest1 = 0, rest2 = 0, last1 = x, last2 = y;
  for (int i = 1; i < 600; ++i) {
    platform::servo_ticks(1);
    if (at(1) != last1) rest1 = i * kTickMs;
    if (at(2) != last2) rest2 = i * kTickMs;
    last1 = at(1), last2 = at(2);
  }
  EXPECT_NEAR(rest1, 20 / 0.5, 5.0);
  EXPECT_NEAR(rest2, 10 / 0.125, 5.0);
  EXPECT_NEAR(at(1) - x, 20 * 20 / 0.5 / 2, 20 * 5.0);
  EXPECT_NEAR(at(2) - y, 10 * 10 / 0.125 / 2, 10 * 5.0);
  store({"INC TM100 TA20 TS0 X1 Y-1"}, 2);
  const std::int64_t x2 = motors[0].trajectory, y2 = motors[1].trajectory;
  run([](double) {}, "B2R");
  EXPECT_NEAR(static_cast<double>(motors[0].trajectory - x2), 1000 * kUnit, 1.0);
  EXPECT_NEAR(static_cast<double>(motors[1].trajectory - y2), -1000 * kUnit, 1.0);
}

// motion:5.1/4. Motors of two axes each; the way back from motors to axes.
TEST_F(StopsOfMotors, RunBeginsWhereJogsHaveLeftTheMotors) {
  fit({"100X+50Y+10", "-20X+400Y", "7B-3"});
  store({"TM100 TA20 TS0 X2 Y1 B1"});
  motors[0].trajectory = position(100 * 5 + 50 * 3 + 10);
  motors[1].trajectory = position(-20 * 5 + 400 * 3);
  motors[2].trajectory = position(7 * -2 - 3);
  begin();
  EXPECT_NEAR(cs().moves[cs().executing].start[AXIS_X], 5.0, 1e-9);
  EXPECT_NEAR(cs().moves[cs().executing].start[AXIS_Y], 3.0, 1e-9);
  EXPECT_NEAR(cs().moves[cs().executing].start[AXIS_B], -2.0, 1e-9);
  ticks(200);
  EXPECT_EQ(motors[0].trajectory, position(100 * 2 + 50 + 10));
  EXPECT_EQ(motors[1].trajectory, position(-20 * 2 + 400));
  EXPECT_EQ(motors[2].trajectory, position(7 - 3));
}

TEST_F(StopsOfMotors, JogAfterQuitHasToComeBack) {
  fit({"1000X"});
  store({"TM100 TA20 TS0 X1", "X2", "X3"});
  begin();
  ticks(30);
  ASSERT_EQ(host("Q"), "");
  ticks(300);
  ASSERT_FALSE(run_is_running(0));
  const std::int64_t stopped = motors[0].trajectory;
  ASSERT_TRUE(jog_to(0, stopped + position(300)));
  ticks(600);
  EXPECT_EQ(host("R"), "ERR017");
  EXPECT_EQ(host("S"), "ERR017");
  ASSERT_TRUE(jog_to(0, stopped));
  ticks(600);
  begin("R");
  ticks(300);
  EXPECT_EQ(motors[0].trajectory, position(3000));
}

TEST_F(StopsOfMotors, CornersThatAreTooSharpDoNotBlend) {
  struct Case {
    const char* rules;
    const char* second;
    double stops;  // ms between the moves, in real-time interrupts of three servo interrupts; below 0: blended
  };
  const Case cases[] = {
      {"I5183=0", "X0 Y0", -1},                       // off
      {"I5183=0.5", "X2 Y0.1", -1},                   // about 6 degrees
      {"I5183=0.5", "X1 Y1", 0},                      // 90 degrees: cosine 0
      {"I5183=-0.5", "X1 Y1", -1},                    // not that sharp
      {"I5183=0.5", "X11 Y30", 0},                    // 72 degrees: cosine 0.32
      {"I5183=-0.5", "X0", 0},                        // 180 degrees
      {"I5183=-1", "X0", -1},                         // no cosine is below that
      {"I5183=0.5 I5182=40 I5185=0.1", "X1 Y1", 40},  // dwells
      {"I5183=0.5 I5182=40 I5185=-0.1", "X1 Y1", 0},  // not at this corner
      {"I5183=0.5", "X1 Z1", 0},                      // Z counts, A does not
      {"I5183=0.5", "X2 A5", -1},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.rules) + " " + c.second);
    platform::power_up();
    fit({"1000X", "1000Y", "1000Z", "1000A"});
    ASSERT_EQ(host(c.rules), "");
    store({"TM100 TA40 TS0 X1", c.second});
    const double end = run();
    const double pause = c.stops * 3 * kTickMs;
    EXPECT_NEAR(end, c.stops < 0 ? 240.0 : 280.0 + pause, c.stops > 0 ? 5 * kTickMs : 2 * kTickMs);
  }
}

TEST_F(StopsOfMotors, MotorsComeIntoPositionWithinIsx81) {
  for (const bool comes : {true, false}) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5181=60 I5192=1"), "");
    store({"TM100 TA40 TS0 X1", "X2"});
    begin();
    ticks(180);
    EXPECT_EQ(motors[0].trajectory, position(1000)) << "it waits";
    if (comes) { ASSERT_EQ(host("I128=8388607"), "") << "a band that reaches the motor, which stands at 0"; }
    double waited = 180.0;
    for (; !comes && run_is_running(0) && waited < 500.0; waited += kTickMs) platform::servo_ticks(1);
    EXPECT_NEAR(waited, comes ? 180.0 : 140.0 + 60 * 3 * kTickMs, 5 * kTickMs) << "60 real-time interrupts";
    ticks(300);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(motors[0].trajectory, position(comes ? 2000 : 1000));
    EXPECT_EQ(host("RY$2014"), comes ? "0" : "10");
  }
}

// What waits at a corner when Q comes does not count at the corner behind the next start: neither the time for Isx81,
// nor the one of Isx82.
TEST_F(StopsOfMotors, ACornerWaitsAnewBehindAStart) {
  for (const bool dwells : {true, false}) {
    SCOPED_TRACE(dwells);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(dwells ? "I5182=200" : "I5181=100 I188=40"), "");
    ASSERT_EQ(host("I5192=1 I5113=5"), "");
    store({"TM100 TA40 TS0 X1", "X2", "X3"});
    begin();
    ticks(180);
    ASSERT_EQ(host("Q"), "");
    ticks(700);
    ASSERT_FALSE(run_is_running(0));
    ASSERT_EQ(motors[0].trajectory, position(1000));
    ASSERT_EQ(host("I128=8388607 R"), "");
    ticks(180);
    EXPECT_EQ(motors[0].trajectory, position(2000)) << "it waits: 200 and 41 real-time interrupts";
    ticks(700);
    EXPECT_EQ(motors[0].trajectory, position(3000));
    EXPECT_EQ(host("RY$2014"), "0");
  }
}

// motion:5.3: RAPID blends with nothing, so what comes behind one waits.
TEST_F(StopsOfMotors, ARapidMoveIsWaitedForToo) {
  for (const char* second : {"RAPID X2", "LINEAR TM20 TA10 TS0 X2"}) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I122=20 I119=1 I120=20 I121=0 I192=1 I5181=180"), "");
    store({"RAPID X1", second});
    begin();
    ticks(180);  // 50 + 20 ms
    EXPECT_EQ(motors[0].trajectory, position(1000)) << second;
    ASSERT_EQ(host("I128=8388607"), "");
    ticks(200);
    EXPECT_EQ(motors[0].trajectory, position(2000)) << second;
    EXPECT_EQ(host("RY$2014"), "0");
  }
}

// motion:5.5: with Isx79 = 0 all take as long as the slowest; speeds by Ixx90.
TEST_F(StopsOfMotors, RapidMovesGoByMotors) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I122=20 I222=10 I119=1 I219=1 I120=20 I220=20 I121=0 I221=0 I192=1 I292=1"), "");
  store({"RAPID X4 Y1", "LINEAR TM100 TA20 TS0 X0 Y0"});
  for (const bool each : {false, true}) {
    ASSERT_EQ(host(each ? "I5179=1" : "I5179=0"), "");
    double end1 = 0, end2 = 0;
    bool done = false;
    run([&](double t) {
      if (cs().moves[cs().executing].kind != MOVE_OWN) done = true;
      if (done) return;
      if (motors[0].trajectory != position(4000)) end1 = t;
      if (motors[1].trajectory != position(1000)) end2 = t;
    });
    EXPECT_TRUE(done);
    EXPECT_NEAR(end1, 200 + 20, 10.0) << "4000 counts at 20 a ms";
    EXPECT_NEAR(end2, each ? 100 + 10 : 200 + 20, 12.0);
    EXPECT_EQ(motors[0].trajectory, 0);
    EXPECT_EQ(motors[1].trajectory, 0);
  }
}

// Without a trigger a move until one ends at its target; the speed is Ixx16 with Ixx90 = 1.
TEST_F(StopsOfMotors, RapidUntilATriggerThatDoesNotCome) {
  fit({"1000X"});
  ASSERT_EQ(host("I122=20 I116=40 I190=1 I119=1 I120=20 I121=0 I192=1"), "");
  store({"RAPID X4^0.5", "P1=1"});
  const double end = run();
  EXPECT_NEAR(end, 100 + 40, 12.0) << "4000 counts at 40 a ms, 40 ms by Ixx19";
  EXPECT_EQ(motors[0].trajectory, position(4000));
  EXPECT_EQ(cs().position[AXIS_X], 4.0);
  EXPECT_EQ(p_variable_read(1), 1.0);
}

// Isx93: the word in X of another address is the target of the time base, slewed at Isx94; H stops it, %0 does not.
TEST_F(StopsOfMotors, ExternalTimeBaseMovesThePath) {
  fit({"1000X"});
  ASSERT_EQ(host("I5194=8388607 I5195=8388607 WX$10F0,1856995 I5193=$10F0"), "");
  store({"TM100 TA20 TS0 X2"});
  EXPECT_NEAR(run(), 240, 2 * kTickMs) << "half the rate";
  ASSERT_EQ(host("%0 WX$10F0,$FFFFFF"), "");  // -1
  store({"TM100 TA20 TS0 X5"});
  begin("B1R");
  ticks(50);
  EXPECT_EQ(motors[0].trajectory, position(2000)) << "backwards is a stop";
  ASSERT_EQ(host("WX$10F0,3713991"), "");
  ticks(60);
  const std::int64_t running = motors[0].trajectory;
  EXPECT_GT(running, position(2500)) << "whatever % is";
  ASSERT_EQ(host("H"), "");
  ticks(10);
  EXPECT_LT(motors[0].trajectory, running + position(100));
  ASSERT_EQ(host("%100 R"), "");
  ticks(150);
  EXPECT_EQ(motors[0].trajectory, position(5000));
  ASSERT_EQ(host("WX$10F0,1000000"), "");  // nothing moves: time goes by it all the same
  ticks(5);
  EXPECT_EQ(host("RX$2002"), "1000000");
  ticks(5);
  ASSERT_EQ(host("WX$10F0,2000000"), "");
  ticks(5);
  EXPECT_EQ(host("RX$2002"), "2000000");
  ASSERT_EQ(host("I5294=8388607 I5293=$2002"), "");  // what &1 goes by
  ticks(5);
  EXPECT_EQ(host("&2 RX$2102"), "2000000");
  ASSERT_EQ(host("I5294=8388607 I5293=$2000"), "");  // &2 goes by what &1 is told
  ASSERT_EQ(host("WX$2000,1000000"), "");
  ticks(5);
  EXPECT_EQ(host("&2 RX$2102"), "1000000");
}

// motion:5.5: 36000, 100A: A270 is -9000 counts; incremental moves know no turn.
TEST_F(StopsOfMotors, RotaryAxesGoTheShortestWay) {
  fit({"100A"});
  ASSERT_EQ(host("I127=36000"), "");
  store({"TM100 TA20 TS0 A270", "DWELL5", "A170", "DWELL5", "INC A350"});
  std::vector<std::int64_t> stops;
  bool dwelt = false;
  run([&](double) {
    const bool dwells = cs().active && cs().moves[cs().executing].kind == MOVE_DWELL;
    if (dwells && !dwelt) stops.push_back(motors[0].trajectory);
    dwelt = dwells;
  });
  ASSERT_EQ(stops.size(), 2u);
  EXPECT_EQ(stops[0], position(-9000));
  EXPECT_EQ(stops[1], position(-19000)) << "from -90";
  EXPECT_EQ(motors[0].trajectory, position(16000));
}

// motion:4.4: the turn of an axis is that of the first motor of its own system which carries it alone.
TEST_F(StopsOfMotors, TheTurnIsThatOfAMotorOfTheSystem) {
  fit({"100A", "100A", "100X", "100B", "100A", "100A"});
  ASSERT_EQ(host("&1#1->0#2->0"), "");
  ASSERT_EQ(host("&2#1->100A#2->100A PMATCH"), "") << "it has looked at its motors";
  ticks(20);
  ASSERT_EQ(host("I127=0 I227=7200 I327=7200 I427=7200 I527=36000 I627=7200"), "");
  store({"TM100 TA20 TS0 A270"});
  run();
  EXPECT_EQ(motors[4].trajectory, position(-9000));
  EXPECT_EQ(motors[5].trajectory, position(-9000)) << "with it";
  EXPECT_EQ(motors[0].trajectory, 0);
}

// motion:4.4/4: below 0 the sign of the target is the direction, and 0 has none: upwards.
TEST_F(StopsOfMotors, RotaryAxesGoUpwardsTo0) {
  fit({"100A"});
  ASSERT_EQ(host("I127=-36000 I128=0"), "");
  store({"TM100 TA20 TS0 A90", "A0"});
  run();
  EXPECT_EQ(motors[0].trajectory, position(36000));
  store({"TM100 TA20 TS0 A-90"});
  run();
  EXPECT_EQ(motors[0].trajectory, position(27000)) << "downwards";
}

// Motors of others keep their bias.
TEST_F(StopsOfMotors, PsetIsForMotorsOfItsSystem) {
  fit({"1000X", "10Y", "100Z"});
  ASSERT_EQ(host("#2->0"), "");
  motors[1].bias = 1234;
  motors[1].trajectory = 777;
  store({"PSET X1 Y5 Z2", "P1=1"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(30);
  EXPECT_EQ(motors[0].bias, position(1000));
  EXPECT_EQ(motors[1].bias, 1234);
  EXPECT_EQ(motors[2].bias, position(200));
}

TEST_F(StopsOfMotors, PsetMovesTheOriginOfAxes) {
  fit({"1000X", "10Y"});
  store({"TM100 TA20 TS0 X3 Y2", "PSET X1", "P1=1", "X2"});
  run();
  EXPECT_EQ(motors[0].trajectory, position(4000)) << "one unit from there";
  EXPECT_EQ(motors[1].trajectory, position(20));
  EXPECT_EQ(motors[0].bias, position(-2000)) << "what reports add";
  EXPECT_EQ(motors[1].bias, 0) << "its axis is not of the line";
  EXPECT_EQ(cs().position[AXIS_X], 2.0);
}

TEST_F(StopsOfMotors, HomezMakesItZero) {
  fit({"1000X"});
  store({"TM100 TA20 TS0 X3", "HOMEZ1", "X1"});
  run();
  EXPECT_EQ(motors[0].trajectory, position(1000));
  store({"HOME2"}, 2);
  ASSERT_EQ(host("B2R"), "");
  platform::servo_ticks(9);
  EXPECT_EQ(host("RY$2014"), "1") << "its loop is not closed";
}

// motion:5.2: read at the start; the program may turn it round by bit 4 of status word 1.
TEST_F(StopsOfMotors, BlendingIsTurnedOffAtTheStart) {
  fit({"1000X"});
  const Lines moves = {"TM100 TA40 TS0 X1", "X2"};
  ASSERT_EQ(host("I5192=1 M1->X:$2040,4"), "");
  store(moves);
  EXPECT_NEAR(run([](double) { EXPECT_EQ(host("M1"), "0"); }), 280, 2 * kTickMs);
  store({"M1=1 TM100 TA40 TS0 X1", "X0"});
  unsigned others = 0;
  EXPECT_NEAR(run([&](double) { others += host("M1") != "1" ? 1 : 0; }), 240, 2 * kTickMs);
  EXPECT_EQ(others, 0u);
}

// Each line adds what a double cannot hold beside its position; none of it is lost.
TEST_F(StopsOfMotors, IncrementsFarFromZeroAddUp) {
  fit({"1000X"});
  store({"TM1 TA0 TS0 X1000000000.25", "INC P1=0 I8=0", "WHILE(P1<3000)", "X0.001 P1=P1+1", "ENDWHILE"});
  ASSERT_EQ(host("I116=1E12"), "ERR003");
  ASSERT_EQ(host("I116=30000000000 I117=30000000000 I108=1"), "");
  motors[0].position_scale = 1;
  run();
  EXPECT_NEAR(static_cast<double>(motors[0].trajectory - std::int64_t{1000000000250} * 32), 3000.0 * 32, 1.0);
}

// Assignments come with the first piece of their move.
TEST_F(StopsOfMotors, SynchronousAssignmentsComeWithTheirMove) {
  fit({"1000X"});
  ASSERT_EQ(host("M1->X:$10F0,0,24 M1=0"), "");
  store({"TM100 TA40 TS0 X1", "M1==1 X2", "DWELL20", "M1==2", "X3"});
  double first = 0, second = 0;
  run([&](double t) {
    if (m_variable_read(1) < 1) first = t;
    if (m_variable_read(1) < 2) second = t;
  });
  EXPECT_NEAR(first, 100, 5 * kTickMs) << "the blend begins 20 ms before the corner at 120 ms";
  EXPECT_NEAR(second, 240 + 20, 8 * kTickMs);
}

}  // namespace
