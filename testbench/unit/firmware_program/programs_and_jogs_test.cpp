// Motors between programs and jogs: moves on which each goes for itself that are held, aborts while time changes its
// rate, positions before a jog, motors that stand beside their axes, HOME and triggers in programs.
#include "testbench/unit/firmware_program/moving_motors.h"

#include "testbench/unit/firmware_platform/fake_tasks.h"

extern "C" {
#include "firmware/motion/jog.h"
#include "firmware/motion/motor_state.h"
}

namespace {

using namespace moving_motors;

class ProgramsAndJogs : public MovingMotors {
 protected:
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
  static std::int64_t position(double counts) { return std::llround(counts * kUnit); }
  static void begin(const std::string& start = "&1B1R") {
    ASSERT_EQ(host(start), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    ASSERT_TRUE(cs().active);
  }
  static void rest() {
    ticks(20);
    for (int i = 0; i < 2000 && jog_is_moving(0); ++i) ticks(5);
    ASSERT_FALSE(jog_is_moving(0));
  }
  static void end() {
    for (int i = 0; i < 2000 && run_is_running(0); ++i) ticks(5);
    ASSERT_FALSE(run_is_running(0));
  }
  static void jog(const std::string& line, double expected) {
    ASSERT_EQ(host(line), "") << line;
    rest();
    EXPECT_EQ(motors[0].trajectory, position(expected)) << line;
  }
  // Counts a ms over the next servo interrupt.
  static double speed(unsigned motor = 1) {
    const double before = at(motor);
    platform::servo_ticks(1);
    return (at(motor) - before) / kTickMs;
  }
  static void quick(unsigned motor = 1) {  // 20 counts a ms, within 20 ms
    const std::string i = "I" + std::to_string(motor);
    ASSERT_EQ(host(i + "19=1 " + i + "20=20 " + i + "21=0 " + i + "22=20 " + i + "92=1"), "");
  }
  static void capture(std::uint32_t count) {
    *hal_x(kCaptured) = count;
    *hal_x(kStatus) |= kCaptureFlag;
  }
};

// A motor of &2 leaves the path of &2, and its RAPID moves are held with that; &1 stands meanwhile.
TEST_F(ProgramsAndJogs, MotorsOfAnotherSystemGoByThat) {
  fit({"1000X"});
  quick();
  for (const char* line : {"I115=0.5 I5295=200000 I5294=200000 I5194=200000", "#1->0", "&2#1->1000X", "&1%10"})
    ASSERT_EQ(host(line), "") << line;
  store({"INC TM1000 TA20 TS0", "X20", "X20"});
  ASSERT_EQ(host("&2B1R"), "");
  ticks(200);
  ASSERT_NEAR(speed(), 20, 0.01);
  const double from = at(1);
  ASSERT_EQ(host("&2A"), "");
  rest();
  EXPECT_NEAR(at(1) - from, 20 * 20 / (2 * 0.5), 20 * 4 * kTickMs) << "at Ixx15";
  store({"RAPID X100"});
  ASSERT_EQ(host("&2B1R"), "");
  ticks(200);
  ASSERT_NEAR(speed(), 20, 0.01);
  ASSERT_EQ(host("H"), "");
  ticks(100);
  EXPECT_EQ(speed(), 0);
  ASSERT_EQ(host("R"), "");
  ticks(100);
  EXPECT_NEAR(speed(), 20, 0.01);
  ASSERT_EQ(host("A"), "");
}

// motion:4.1/4, motion:5.5/1: `H` stops a RAPID move, R goes on with it.
TEST_F(ProgramsAndJogs, ARapidMoveThatIsHeldGoesOn) {
  fit({"1000X"});
  quick();
  ASSERT_EQ(host("I5195=200000 I5194=200000"), "");
  store({"RAPID X10", "LINEAR TM100 TA20 TS0 X11"});
  begin();
  ticks(200);
  ASSERT_EQ(host("H"), "");
  ticks(50);
  ASSERT_EQ(speed(), 0.0);
  const double held = at(1);
  ASSERT_GT(held, 2000.0);
  ASSERT_LT(held, 9000.0);
  EXPECT_EQ(host("#1J+"), "ERR001") << "the move is not over";
  ASSERT_EQ(host("R"), "");
  ticks(50);
  EXPECT_NEAR(speed(), 20.0, 0.1);
  end();
  EXPECT_EQ(motors[0].trajectory, position(11000));
}

TEST_F(ProgramsAndJogs, ASearchOfAProgramThatIsHeldGoesOn) {
  fit({"1000X"});
  quick();
  ASSERT_EQ(host("I123=15 I125=$78000 I124=$120001 I5195=200000 I5194=200000"), "");
  store({"HOME1", "LINEAR TM100 TA20 TS0 X1"});
  begin();
  ticks(100);
  ASSERT_EQ(host("H"), "");
  ticks(50);
  ASSERT_EQ(speed(), 0.0);
  ASSERT_EQ(host("R"), "");
  ticks(60);
  EXPECT_NEAR(speed(), 15.0, 0.1);
  EXPECT_TRUE(motors[0].status.home_search);
  capture(0);
  ticks(5);
  EXPECT_TRUE(motors[0].status.home_complete);
  end();
  EXPECT_EQ(motors[0].trajectory, position(1000));
}

// motion:5.6/2, motion:5.6/4: a motor that has come to its end already is where it was stopped, until it is jogged
// away.
TEST_F(ProgramsAndJogs, AHeldMoveOfWhichOneMotorHasArrivedGoesOn) {
  for (const bool homes : {false, true}) {
    SCOPED_TRACE(homes);
    platform::power_up();
    fit({"1000X", "1000Y"});
    quick(1);
    quick(2);
    ASSERT_EQ(host("I5179=1 I5195=200000 I5194=200000 I123=15 I125=$78000 I124=$120001 I126=0"), "");
    ASSERT_EQ(host("I223=15 I225=$78008 I224=$120001 I226=0"), "");
    store({homes ? "HOME1,2" : "RAPID X1 Y10", "LINEAR TM100 TA20 TS0 X2 Y11"});
    begin();
    ticks(homes ? 50 : 100);
    if (homes) capture(0);
    ticks(150);
    ASSERT_FALSE(jog_is_moving(0));
    ASSERT_EQ(motors[0].trajectory, position(homes ? 0 : 1000));
    ASSERT_TRUE(jog_is_moving(1));
    ASSERT_EQ(host("&1H"), "");
    ticks(50);
    EXPECT_EQ(host("#2J:100"), "ERR001");
    jog("#1J:100", homes ? 100 : 1100);
    EXPECT_EQ(host("&1R"), "ERR017");
    jog("#1J=", homes ? 0 : 1000);
    ASSERT_EQ(host("&1R"), "");
    ticks(60);
    EXPECT_NEAR(speed(2), homes ? 15.0 : 20.0, 0.1);
    if (homes) *hal_x(kStatus + 8) |= kCaptureFlag;
    end();
    EXPECT_EQ(motors[0].trajectory, position(2000));
    EXPECT_EQ(motors[1].trajectory, position(11000));
  }
}

// motion:5.6/4: what the program of another system homes is not where this one's was stopped.
TEST_F(ProgramsAndJogs, HomeByAnotherSystemIsAWay) {
  fit({"1000X"});
  quick();
  ASSERT_EQ(host("I123=15 I125=$78000 I124=$120001 I126=0"), "");
  store({"INC TM100 TA20 TS0 X1", "X1", "X1"});
  store({"HOME1"}, 2);
  begin();
  ticks(30);
  ASSERT_EQ(host("&1Q"), "");
  end();
  ASSERT_EQ(host("&2B2R"), "");
  ticks(100);
  capture(0xFFFFFF);
  ticks(300);
  ASSERT_TRUE(motors[0].status.home_complete);
  ASSERT_FALSE(run_is_running(1));
  EXPECT_EQ(host("&1R"), "ERR017");
}

// motion:5.6/4 behind Q, which does not stop a RAPID move.
TEST_F(ProgramsAndJogs, WhereARapidMoveEndsIsWhereQLeavesIt) {
  fit({"1000X", "1000Y"});
  quick(1);
  quick(2);
  store({"RAPID X1 Y2", "LINEAR TM100 TA20 TS0 X2 Y11"});
  begin();
  ticks(70);
  ASSERT_EQ(host("&1Q"), "");
  end();
  EXPECT_EQ(motors[1].trajectory, position(2000));
  jog("#1J:100", 1100);
  EXPECT_EQ(host("&1R"), "ERR017");
  jog("#1J=", 1000);
  ASSERT_EQ(host("&1R"), "");
  end();
  EXPECT_EQ(motors[0].trajectory, position(2000));
  EXPECT_EQ(motors[1].trajectory, position(11000));
}

// motion:5.5/4: the program waits until the motor stands at its home, and goes on from there.
TEST_F(ProgramsAndJogs, HomeInAProgramIsZeroOfTheAxis) {
  fit({"1000X"});
  quick();
  ASSERT_EQ(host("I123=-15 I126=1600 I125=$78000 I124=$120001"), "");
  store({"P1=0", "HOME1", "P1=1", "LINEAR TM100 TA20 TS0 X2"});
  begin();
  ticks(100);
  EXPECT_EQ(p_variable_read(1), 0.0);
  capture(0xFFFFFF - 699);  // -700: the motor's encoder stands at 0, the trigger is taken for where it was
  const double before = at(1);
  ticks(3);
  EXPECT_NEAR(at(1) - before, 700.0 - 100.0, 15.0 * 4.0) << "counted from 100 behind it at once";
  EXPECT_TRUE(motors[0].status.home_complete);
  end();
  EXPECT_EQ(p_variable_read(1), 1.0);
  EXPECT_EQ(motors[0].trajectory, position(2000));
  EXPECT_EQ(cs().position[AXIS_X], 2.0);
}

// motion:5.5/2: so far behind the trigger; the axis is where the motor ended.
TEST_F(ProgramsAndJogs, RapidUntilATriggerEndsBehindIt) {
  fit({"1000X"});
  quick();
  ASSERT_EQ(host("I125=$78000 I124=$120001"), "");
  store({"RAPID X4^0.5", "P1=1", "INC LINEAR TM100 TA20 TS0 X1"});
  begin();
  ticks(60);
  EXPECT_TRUE(motors[0].status.trigger_move);
  capture(1000);
  ticks(3);
  EXPECT_FALSE(motors[0].status.home_search);
  EXPECT_TRUE(motors[0].status.trigger_move) << "it goes on to its end";
  end();
  EXPECT_FALSE(motors[0].status.trigger_move);
  EXPECT_EQ(motors[0].trajectory, position(1000 + 500 + 1000));
  EXPECT_EQ(cs().position[AXIS_X], 2.5);
}

// An abort begins at the speed that the motor has, whatever the rate of time is just then.
TEST_F(ProgramsAndJogs, AnAbortWhileAHoldSlewsDoesNotChangeTheSpeed) {
  fit({"1000X"});
  ASSERT_EQ(host("I115=0.1 I5195=1644"), "");  // a second from 100 %
  store({"TM2000 TA100 TS0 X40"});             // 20 counts a ms
  begin();
  ticks(300);
  ASSERT_EQ(host("H"), "");
  ticks(500);
  double last = speed();
  EXPECT_GT(last, 8.0);
  EXPECT_LT(last, 12.0);
  ASSERT_EQ(host("A"), "");
  for (int i = 0; i < 1500; ++i) {
    const double now = speed();
    ASSERT_NEAR(now, last, 0.1 * 3 * kTickMs + 0.03) << i;
    last = now;
  }
  EXPECT_EQ(last, 0.0);
}

// The trajectory alone is what jogs and ramps go by (motion:1.2/4): a master that moves adds to all of them.
TEST_F(ProgramsAndJogs, JogsAndRampsOfAMotorThatFollowsLeaveTheMasterOut) {
  for (const bool aborts : {true, false}) {
    platform::power_up();
    fit({"1000X"});
    quick();
    ASSERT_EQ(host("I115=1 I105=$10F0 I107=96 I106=1"), "");
    store({"TM1000 TA20 TS0 X1"});  // 1 count a ms; the master moves by 10
    begin();
    std::uint32_t master = 0;
    const auto tick = [&] {
      *hal_x(0x10F0) = master += static_cast<std::uint32_t>(10 * 32 * kTickMs);
      const double before = at(1);
      platform::servo_ticks(1);
      return (at(1) - before) / kTickMs;
    };
    for (unsigned i = 0; i < ticks_of(500); ++i) tick();
    EXPECT_NEAR(tick(), 1.0, 0.01);
    if (aborts) {
      ASSERT_EQ(host("A"), "");
    } else {
      for (unsigned i = 0; i < ticks_of(600); ++i) tick();
      ASSERT_FALSE(run_is_running(0));
      ASSERT_EQ(host("#1J/"), "");
    }
    const double from = at(1);
    for (int i = 0; i < 400; ++i) {
      const double now = tick();
      ASSERT_LE(std::abs(now), 1.01) << aborts << " " << i;
    }
    EXPECT_NEAR(at(1), from, aborts ? 3.0 : 0.0) << aborts;
  }
}

// motion:4.2/13, motion:4.2/11 behind a program.
TEST_F(ProgramsAndJogs, JBangActsOnAMotorThatAProgramHasLeft) {
  fit({"1000X"});
  quick();
  store({"TM50 TA20 TS0 X0.0104"});
  run();
  ASSERT_EQ(motors[0].trajectory, position(10.4));
  jog("#1J!", 10);
  jog("J:100", 110);
  jog("J=", 10.4);
}

TEST_F(ProgramsAndJogs, ThePositionBeforeAJogOutlivesAnOpenLoop) {
  fit({"1000X"});
  quick();
  jog("#1J:300", 300);
  jog("J=", 0);
  store({"TM50 TA20 TS0 X0.5"});
  run();
  for (const char* opens : {"#1K", "#1O0"}) {
    ASSERT_EQ(host(opens), "");
    ticks(5);  // the encoder stands at 0
    ASSERT_EQ(host("J/"), "");
    rest();
    EXPECT_EQ(motors[0].trajectory, 0) << opens;
    jog("J=", 500);
  }
  ASSERT_EQ(host("HMZ"), "");
  jog("J:200", 200);
  run();  // the program takes it to 0.5 units
  ASSERT_EQ(motors[0].trajectory, position(500));
  jog("J:70", 570);
  jog("J=", 500);
}

// A position that is counted from elsewhere is the same place: R goes on behind Q and HMZ (motion:5.6/4).
TEST_F(ProgramsAndJogs, HomeBehindQuitIsNoWay) {
  fit({"1000X"});
  store({"INC TM100 TA20 TS0 X1", "X1", "X1"});
  begin();
  ticks(30);
  ASSERT_EQ(host("Q"), "");
  end();
  ASSERT_EQ(motors[0].trajectory, position(2000));
  ASSERT_EQ(host("#1HMZ"), "");
  EXPECT_EQ(motors[0].trajectory, 0);
  ASSERT_EQ(host("R"), "");
  end();
  EXPECT_EQ(motors[0].trajectory, position(1000));
}

// Two motors of one axis, one of them jogged aside: it comes along with the move, it does not jump.
TEST_F(ProgramsAndJogs, AMotorThatStandsBesideItsAxisDoesNotJump) {
  for (const char* mode :
       {"LINEAR TM100 TA20 TS0", "LINEAR TM100 TA20 TS5", "PVT100", "SPLINE1 TM100", "DWELL30 TM100 TA20"}) {
    SCOPED_TRACE(mode);
    platform::power_up();
    fit({"1000X", "1000X"});
    motors[1].trajectory = position(250);
    store({std::string(mode) + " X1", "X2"});
    double last = at(2), fastest = 0.0;
    run([&](double t) {
      if (t < 1.5 * kTickMs) { EXPECT_NEAR(at(2), 250.0, 0.3) << "from rest"; }
      fastest = std::max(fastest, std::abs(at(2) - last) / kTickMs);
      last = at(2);
    });
    EXPECT_LT(fastest, 20.0) << "250 counts at once are 565 a ms";
    EXPECT_EQ(motors[0].trajectory, position(2000));
    EXPECT_EQ(motors[1].trajectory, position(2000));
  }
}

// `S` while it runs is like Q (4.7 of the motion sheet): the motors have to come back.
TEST_F(ProgramsAndJogs, StepWhileItRunsStopsLikeQuit) {
  fit({"1000X"});
  quick();
  store({"INC TM100 TA20 TS0 X1", "X1", "X1"});
  begin();
  ticks(30);
  ASSERT_EQ(host("S"), "");
  end();
  EXPECT_EQ(motors[0].trajectory, position(2000));
  jog("#1J:100", 2100);
  EXPECT_EQ(host("R"), "ERR017");
  jog("J=", 2000);
  EXPECT_EQ(host("R"), "");
  end();
  EXPECT_EQ(motors[0].trajectory, position(3000));
}

// `<` and `>` outside of a lookahead sequence are H and R.
TEST_F(ProgramsAndJogs, BackwardHoldsAndForwardRuns) {
  fit({"1000X"});
  ASSERT_EQ(host("I5195=200000"), "");
  store({"TM200 TA20 TS0 X1"});
  begin("&1B1>");
  ticks(50);
  ASSERT_EQ(host("<"), "");
  ticks(20);
  EXPECT_EQ(speed(), 0.0);
  EXPECT_TRUE(cs().held);
  motors[0].trajectory += 5;
  EXPECT_EQ(host(">"), "ERR017");
  motors[0].trajectory -= 5;
  ASSERT_EQ(host(">"), "");
  end();
  EXPECT_EQ(motors[0].trajectory, position(1000));
}

// motion:4.4/4: the sign of the target is the direction of the axis, of a motor that is mounted the other way round
// too.
TEST_F(ProgramsAndJogs, RotaryAxisOfANegativeScale) {
  fit({"-100A"});
  ASSERT_EQ(host("I127=-36000"), "");
  store({"TM100 TA20 TS0 A270", "DWELL1 A-120"});
  std::vector<std::int64_t> stops;
  bool dwelt = false;
  run([&](double) {
    const bool dwells = cs().active && cs().moves[cs().executing].kind == MOVE_DWELL;
    if (dwells && !dwelt) stops.push_back(motors[0].trajectory);
    dwelt = dwells;
  });
  ASSERT_EQ(stops.size(), 1u);
  EXPECT_EQ(stops[0], position(-27000));
  EXPECT_EQ(motors[0].trajectory, position(-24000)) << "-120 degrees are 240, from above";
  platform::power_up();
  fit({"-100A"});
  ASSERT_EQ(host("I127=36000"), "");
  store({"TM100 TA20 TS0 A270"});
  run();
  EXPECT_EQ(motors[0].trajectory, position(9000));
}

// A RAPID move begins when the move before it has ended.
TEST_F(ProgramsAndJogs, ARapidMoveWaitsForTheMoveBefore) {
  fit({"1000X"});
  quick();
  store({"TM100 TA20 TS0 X1", "RAPID X2"});
  const auto first = changes_of({{1000, 100, 20, 0}}, 20);
  double worst = 0, begins = 0;
  run([&](double t) {
    if (t < 120) worst = std::max(worst, std::abs(at(1) - way(first, t)));
    if (motors[0].trajectory == position(1000)) begins = t;
  });
  EXPECT_LT(worst * kUnit, 3.0);
  EXPECT_GE(begins, 120.0);
  EXPECT_EQ(motors[0].trajectory, position(2000));
}

// motion:5.5/1: however long it takes to plan them.
TEST_F(ProgramsAndJogs, MotorsOfARapidMoveBeginTogether) {
  fit({"1000X", "1000Y", "1000Z", "1000A"});
  for (unsigned motor = 1; motor <= 4; ++motor) quick(motor);
  ASSERT_EQ(host("I392=20"), "");
  store({"RAPID X4 Y3 Z2 A1"});
  ASSERT_EQ(host("&1B1R"), "");
  std::vector<unsigned> began(4);
  unsigned tick = 0, pauses = 0, asked = 0;
  const auto servo = [&] {
    fake_task_run_servo();
    ++tick;
    if (asked == 0 && jog_is_moving(3)) asked = tick;
    for (unsigned i = 0; i < 4; ++i)
      if (began[i] == 0 && motors[i].trajectory != 0) began[i] = tick;
  };
  for (int i = 0; i < 100; ++i) {
    servo();
    platform::real_time_in_slices([&] {
      if (++pauses % 10 == 0) servo();
    });
  }
  EXPECT_NEAR(began[0], asked + 20 / kTickMs, 8) << "the longest Ixx92";
  for (unsigned i = 1; i < 4; ++i) EXPECT_EQ(began[i], began[0]) << i;
  end();
  for (unsigned i = 0; i < 4; ++i) EXPECT_EQ(motors[i].trajectory, position(4000 - 1000.0 * i));
}

// Commands of a program jog what belongs to none, or to another system.
TEST_F(ProgramsAndJogs, ProgramsJogOtherMotors) {
  fit({"1000X"});
  quick(2);
  ASSERT_EQ(host("I200=1 I211=0"), "");
  store({"CMD\"#2J:40\" TM200 TA20 TS0 X1", "DWELL1", "CMD\"#1J+\" X0"});
  ASSERT_EQ(host("B1R"), "");
  for (int i = 0; i < 1500; ++i) {
    platform::servo_ticks(1);
    platform::background(1);
  }
  EXPECT_EQ(motors[1].loop, LOOP_CLOSED);
  EXPECT_EQ(motors[1].trajectory, position(40));
  EXPECT_EQ(motors[0].trajectory, 0) << "its own is not jogged";
}

// A RAPID move waits for its own motors. One that took part in the last ones and has left the system is jogged while
// others move.
TEST_F(ProgramsAndJogs, AMotorThatHasLeftTheSystemIsNotWaitedFor) {
  fit({"1000X", "1000Y"});
  quick(1);
  quick(2);
  store({"RAPID X1 Y1", "X2 Y2"});
  run();
  ASSERT_EQ(host("&1#1->0"), "");
  ASSERT_EQ(host("#1J+"), "");
  ticks(50);
  store({"LINEAR TM100 TA20 TS0 Y3", "Y4"}, 2);
  EXPECT_NEAR(run([](double) {}, "&1B2R"), 220, kTickMs);
  EXPECT_EQ(motors[1].trajectory, position(4000));
  EXPECT_TRUE(jog_is_moving(0));
  EXPECT_NEAR(speed(1), 20, 1e-2);
}

// motion:4.1/4: what no program moves goes on while its system is held, also a motor that a RAPID move has moved last.
TEST_F(ProgramsAndJogs, AMotorIsJoggedInAHoldBehindARapidMove) {
  fit({"1000X"});
  quick();
  ASSERT_EQ(host("I5195=200000"), "");
  store({"RAPID X1", "DWELL10000"});
  begin();
  ticks(400);
  ASSERT_EQ(motors[0].trajectory, position(1000));
  ASSERT_EQ(host("&1H"), "");
  ticks(50);
  jog("#1J:500", 1500);
}

}  // namespace
