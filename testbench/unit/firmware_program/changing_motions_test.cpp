// The moments at which a motor goes from one motion to another: a ramp off the path, waits for Ixx92, holds, other time
// bases, triggers, positions counted from elsewhere (motion:4.1 to motion:4.5, motion:5.3, motion:5.5).
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/jog.h"
}

namespace {

using namespace moving_motors;

class ChangingMotions : public MovingMotors {
 protected:
  void SetUp() override {
    MovingMotors::SetUp();
    fit({"1000X"});
    quick(1);
    ASSERT_EQ(host("I115=1 I123=15 I125=$78000 I124=$120001 I5195=200000 I5194=200000"), "");
  }
  static void quick(unsigned motor) {  // 20 counts a ms, within 20 ms
    const std::string i = "I" + std::to_string(motor);
    ASSERT_EQ(host(i + "19=1 " + i + "20=20 " + i + "21=0 " + i + "22=20 " + i + "92=1"), "");
  }
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
  static std::int64_t position(double counts) { return std::llround(counts * kUnit); }
  static void begin(const std::string& start = "&1B1R") {
    ASSERT_EQ(host(start), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    ASSERT_TRUE(cs().active);
  }
  static void rest(unsigned motor = 0) {
    for (int i = 0; i < 4000 && jog_is_moving(motor); ++i) ticks(5);
    ASSERT_FALSE(jog_is_moving(motor));
  }
  static void capture(std::uint32_t count) {
    *hal_x(kCaptured) = count;
    *hal_x(kStatus) |= kCaptureFlag;
  }
  // After an abort: interrupts until its ramp begins, and from which velocity: the way of the ramp is v^2 / 2 Ixx15.
  struct Ramp {
    unsigned ticks = 0;
    double from = 0;
  };
  static Ramp ramp(double ixx15) {
    Ramp is;
    for (; is.ticks < 20 && !motors[0].status.aborting; ++is.ticks) platform::servo_ticks(1);
    const double begins = at(1);
    rest();
    is.from = std::sqrt(2 * ixx15 * (at(1) - begins));
    return is;
  }
  // Counts a ms over the next servo interrupt.
  static double speed() {
    const double before = at(1);
    platform::servo_ticks(1);
    return (at(1) - before) / kTickMs;
  }
};

// motion:4.5/1: from any moment the velocity goes on as the program has it, then falls by Ixx15: in none does it jump,
// in a change of velocity, at its end and at that of the move, where the ramp begins in a piece behind.
TEST_F(ChangingMotions, AnAbortAtAnyMomentLeavesTheVelocityAsItIs) {
  constexpr double kChange = 20.0;  // counts a ms^2: 200 counts a ms within 10 ms
  for (unsigned when = 3; when < 300; when += when == 40 ? 165 : 1) {
    platform::power_up();
    SetUp();
    ASSERT_EQ(host("I115=10"), "");
    store({"TM100 TA10 TS0 X20"});
    begin();
    platform::servo_ticks(when);
    double last = speed();
    ASSERT_EQ(host("A"), "");
    for (unsigned i = 0; i < ticks_of(60); ++i) {
      const double now = speed(), change = (now - last) / kTickMs;
      ASSERT_LT(change, when < 40 ? kChange * 1.02 : 0.2) << when << " interrupts, then " << i;
      ASSERT_GT(change, when < 40 ? -10.2 : -kChange * 1.02) << when << " interrupts, then " << i;
      last = now;
    }
    EXPECT_EQ(last, 0.0);
  }
}

// The same where two servo cycles pass over whole segments: at 225 % they are 1.99 ms. The velocity is 1 count a ms^2
// times the time of the path, which is 1 ms behind (motion:7.1/3).
TEST_F(ChangingMotions, AnAbortAmongShortSegmentsBeginsAtTheVelocityOfItsMoment) {
  for (unsigned when = 30; when < 50; ++when) {
    platform::power_up();
    SetUp();
    ASSERT_EQ(host("I115=10 I5113=1"), "");
    ASSERT_EQ(host("%225"), "");
    ticks(50);
    store({"TM200 TA100 TS0 X20"});
    begin();
    platform::servo_ticks(when);
    ASSERT_EQ(host("A"), "");
    const Ramp is = ramp(10);
    EXPECT_NEAR(is.from, (when + is.ticks) * 2.25 * kTickMs - 1.0, 0.01) << when;
  }
}

// The same in a piece that the blend of the next move has cut short.
TEST_F(ChangingMotions, AnAbortBeforeABlendBeginsAtTheVelocityOfItsMove) {
  store({"TM100 TA20 TS0 X1", "TA60 X3"});
  begin();
  ticks(50);
  ASSERT_EQ(host("A"), "");
  EXPECT_NEAR(ramp(1).from, 10.0, 0.01);
  for (unsigned when = ticks_of(80) - 5; when < ticks_of(80) + 2; ++when) {  // it begins at 110 - 60 / 2 ms
    platform::power_up();
    SetUp();
    store({"TM100 TA20 TS0 X1", "TA60 X3"});
    begin();
    platform::servo_ticks(when);
    ASSERT_EQ(host("A"), "");
    const Ramp is = ramp(1);
    const double blended = (when + is.ticks) * kTickMs - 80;  // from 10 to 20 counts a ms within 60 ms
    EXPECT_NEAR(is.from, 10.0 + std::max(blended, 0.0) * 10 / 60, 0.01) << when;
  }
}

// motion:7.1/10: segments that the real-time task does not go on with, aborted within two interrupts of their end.
TEST_F(ChangingMotions, AnAbortAtTheEndOfWhatIsMadeRamps) {
  ASSERT_EQ(host("I5113=5"), "");
  store({"TM200 TA20 TS0 X4", "X8"});
  begin();
  ticks(60);
  const auto left = [] {
    piece_ring& ring = cs().ring;
    std::int64_t sum = -ring.elapsed;
    for (std::uint32_t n = ring.executing; n != ring.added; ++n) sum += piece_ring_at(&ring, n)->end;
    return static_cast<double>(sum) / 8388608.0;
  };
  for (int i = 0; i < 200 && left() > 1.9 * kTickMs; ++i) fake_task_run_servo();
  ASSERT_GT(left(), 0.0);
  const double before = at(1);
  ASSERT_EQ(host("A"), "");
  ticks(40);
  EXPECT_FALSE(jog_is_moving(0));
  EXPECT_NEAR(at(1) - before, 20 * 20 / 2.0, 20 * 2 * kTickMs) << "Ixx15 = 1";
}

// The ramp is planned for a moment at which the time base is another: the place is what it was by then.
TEST_F(ChangingMotions, AnAbortWhileTheTimeBaseChangesDoesNotJump) {
  for (unsigned when = 1; when < 12; ++when) {
    platform::power_up();
    SetUp();
    store({"TM400 TA20 TS0 X40"});
    begin();
    ticks(100);
    ASSERT_EQ(host("%20"), "");  // 100 % within 19 interrupts: 5.4 counts a ms an interrupt
    platform::servo_ticks(when);
    double last = speed();
    ASSERT_EQ(host("A"), "");
    for (unsigned i = 0; i < ticks_of(60); ++i) {
      const double now = speed();
      ASSERT_LT(now - last, 0.1) << when << ", " << i;
      ASSERT_GT(now - last, -6.5) << when << ", " << i;
      last = now;
    }
  }
}

// motion:4.1/4, motion:4.2/3: what a program moves waits for its Ixx92 in the time of its system, and is the program's.
TEST_F(ChangingMotions, ARapidMoveThatWaitsForIxx92IsHeldToo) {
  ASSERT_EQ(host("I192=100"), "");
  store({"RAPID X4"});
  begin();
  ticks(20);
  ASSERT_EQ(motors[0].trajectory, 0);
  ASSERT_EQ(host("H"), "");
  ticks(300);
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_EQ(host("#1J+"), "ERR001");
  ASSERT_EQ(host("R"), "");
  ticks(60);
  EXPECT_EQ(motors[0].trajectory, 0) << "80 ms of it were left";
  ticks(60);
  EXPECT_GT(motors[0].trajectory, position(50));
  ticks(400);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(motors[0].trajectory, position(4000));
}

// The trigger comes so late that the move ends while the next one waits.
TEST_F(ChangingMotions, BehindATriggerTheWaitIsHeldToo) {
  ASSERT_EQ(host("I192=100"), "");
  store({"RAPID X1^0.5"});
  begin();
  for (int i = 0; i < 1000 && at(1) < 980.0; ++i) platform::servo_ticks(1);
  capture(990);
  ticks(20);
  ASSERT_EQ(motors[0].trajectory, position(1000));
  ASSERT_EQ(host("H"), "");
  ticks(300);
  EXPECT_EQ(motors[0].trajectory, position(1000)) << "held";
  ASSERT_EQ(host("R"), "");
  ticks(400);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(motors[0].trajectory, position(1490));
}

// motion:4.1/4, motion:5.1/1: a commanded time base below 0 stops, a jog in a held system too.
TEST_F(ChangingMotions, TimeDoesNotRunBackwards) {
  ASSERT_EQ(host("#1J+"), "");
  ticks(100);
  ASSERT_EQ(host("&1H"), "");
  ticks(50);
  EXPECT_NEAR(speed(), 20.0, 0.1) << "no program moves it";
  ASSERT_EQ(host("WX$2000,$800000"), "");
  ticks(50);
  const double stands = at(1);
  ticks(50);
  EXPECT_EQ(at(1), stands);
  ASSERT_EQ(host("J/"), "");
  ticks(50);
  EXPECT_EQ(at(1), stands);
}

// motion:4.1/4: out of a hold the jog's time goes over to that of its system at Isx95 or Isx94, another jog on the way
// as well.
TEST_F(ChangingMotions, ANewJogDoesNotChangeTheTimeBase) {
  ASSERT_EQ(host("I5295=20000 I5294=20000"), "");  // 186 interrupts from 0 to 100 %
  store({"DWELL10000"}, 2);
  ASSERT_EQ(host("&2B2R"), "");  // virtual axes: no motor is this program's
  motors[0].cs = 1;
  ASSERT_EQ(host("&2H"), "");
  ticks(120);
  ASSERT_EQ(coordinate_systems[1].increment, 0);
  ASSERT_EQ(host("#1J+"), "");
  ticks(100);
  ASSERT_NEAR(speed(), 20.0, 0.1);
  double last = speed();
  ASSERT_EQ(host("&2R"), "");
  for (unsigned i = 0; i < 300; ++i) {
    if (i == 20) { ASSERT_EQ(host("I122=21 J+"), ""); }
    const double now = speed();
    ASSERT_LT(std::abs(now - last), 1.1 * kTickMs) << i << ": Ixx19, and 0.11 counts a ms an interrupt";
    last = now;
  }
  EXPECT_NEAR(last, 21.0, 0.1);
}

// motion:4.1/3: Ixx19 = 0 is an acceleration of 1 / 2^23 of the speeds there are; the target is met all the same.
TEST_F(ChangingMotions, WithoutAnAccelerationTargetsAreMet) {
  ASSERT_EQ(host("I119=0 I122=100"), "");
  coordinate_systems[0].increment = coordinate_systems[0].increment_target = INT32_MAX;  // 256 ms an interrupt
  coordinate_systems[0].increment_command = INT32_MAX;
  ASSERT_EQ(host("#1J=1000000"), "");
  platform::servo_ticks(2000);
  EXPECT_TRUE(jog_is_moving(0));
  EXPECT_GT(at(1), 0.0);
  for (int i = 0; i < 200 && jog_is_moving(0); ++i) platform::servo_ticks(1000);
  EXPECT_FALSE(jog_is_moving(0));
  EXPECT_EQ(motors[0].trajectory, position(1000000));
}

// motion:4.2/11: where it was before it was jogged. A search that is stopped has moved it to where `J/` came.
TEST_F(ChangingMotions, BehindASearchThatIsStoppedJEqualsGoesToWhereItWasStopped) {
  ASSERT_EQ(host("#1HM"), "");
  ticks(100);
  const std::int64_t stopped = motors[0].trajectory;
  ASSERT_GT(stopped, position(1000));
  ASSERT_EQ(host("J/"), "");
  rest();
  ASSERT_GT(motors[0].trajectory, stopped);
  ASSERT_EQ(host("J="), "");
  rest();
  EXPECT_EQ(motors[0].trajectory, stopped);
}

// motion:4.2/14: from where the trigger was, whatever the motor follows.
TEST_F(ChangingMotions, ATriggerIsAPlaceOfTheMotorNotOfItsTrajectory) {
  motors[0].master = position(300);
  motors[0].compensation = position(20);  // of what is measured
  ASSERT_EQ(host("#1J:2000^40"), "");
  ticks(50);
  capture(200);  // the encoder stands at 0, where the motor is taken to be
  rest();
  EXPECT_EQ(motors[0].trajectory, position(200 + 40 - 300 - 20));
}

// motion:4.3/5: of an open loop the actual position is 0, and there it closes.
TEST_F(ChangingMotions, HmzOfAnOpenLoopMakesTheActualPositionZero) {
  ASSERT_EQ(host("I106=2"), "");
  motors[0].loop = LOOP_OPEN;
  motors[0].actual = position(1000);
  motors[0].commanded = position(1000);
  motors[0].trajectory = position(77);
  motors[0].master = position(300);
  ASSERT_EQ(host("#1HMZ"), "");
  EXPECT_EQ(motors[0].actual, 0);
  EXPECT_EQ(motors[0].commanded, 0);
  EXPECT_EQ(jog_position_before(0), position(-300)) << "the trajectory that has it there";
}

// motion:5.3: a DWELL breaks blending, so Isx82 passes before and behind it; before the first move it does not.
TEST_F(ChangingMotions, Isx82PassesBeforeAndBehindADwellNotAtTheStart) {
  ASSERT_EQ(host("I5182=100"), "");
  store({"TM100 TA20 TS0 X1", "DWELL50", "X2"});
  ASSERT_EQ(host("&1B1R"), "");
  double began = 0.0, end = 0.0;
  for (unsigned i = 0; run_is_running(0) && i < 5000; ++i) {
    platform::servo_ticks(1);
    if (began == 0.0 && motors[0].trajectory != 0) began = i * kTickMs;
    if (motors[0].trajectory < position(2000)) end = i * kTickMs;
  }
  EXPECT_LT(began, 10 * kTickMs) << "nothing comes before it";
  EXPECT_NEAR(end - began, 120 + 50 + 120 + 2 * 100 * 3 * kTickMs, 16 * kTickMs);
}

// motion:5.5/1 and 4: of one HOME statement, too.
TEST_F(ChangingMotions, SearchesOfOneLineBeginTogether) {
  fit({"1000X", "1000Y"});
  quick(1);
  quick(2);
  ASSERT_EQ(host("I223=-15 I225=$78008 I224=$120001 I292=20"), "");
  store({"HOME1,2"});
  ASSERT_EQ(host("&1B1R"), "");
  unsigned began[2] = {}, asked = 0;
  for (unsigned i = 1; i < 200; ++i) {
    platform::servo_ticks(1);
    if (asked == 0 && jog_is_moving(1)) asked = i;
    for (unsigned motor = 0; motor < 2; ++motor)
      if (began[motor] == 0 && motors[motor].trajectory != 0) began[motor] = i;
  }
  EXPECT_NEAR(began[0], asked + 20 / kTickMs, 5) << "the longest Ixx92";
  EXPECT_EQ(began[0], began[1]);
}

// motion:5.5/1: however much longer than Ixx92 it takes to plan them all.
TEST_F(ChangingMotions, MotorsBeginTogetherWhenTheLastIsPlanned) {
  fit({"1000X", "1000Y", "1000Z", "1000A"});
  for (unsigned motor = 1; motor <= 4; ++motor) quick(motor);
  store({"RAPID X4 Y3 Z2 A1"});
  ASSERT_EQ(host("&1B1R"), "");
  std::vector<unsigned> began(4);
  unsigned tick = 0;
  const auto servo = [&] {
    fake_task_run_servo();
    ++tick;
    for (unsigned i = 0; i < 4; ++i)
      if (began[i] == 0 && motors[i].trajectory != 0) began[i] = tick;
  };
  for (int i = 0; i < 20; ++i) {
    servo();
    unsigned pauses = 0;
    platform::real_time_in_slices([&] {
      if (++pauses % 10 == 0) servo();
    });
  }
  ASSERT_NE(began[0], 0u);
  for (unsigned i = 1; i < 4; ++i) EXPECT_EQ(began[i], began[0]) << i;
}

// What has found its trigger goes on for itself, planned for the moment at which it begins.
TEST_F(ChangingMotions, BehindATriggerEachMotorGoesForItself) {
  for (unsigned when = 0; when < 6; ++when) {
    platform::power_up();
    SetUp();
    fit({"1000X", "1000Y"});
    quick(1);
    quick(2);
    ASSERT_EQ(host("I192=0 I225=$78008 I224=$120001"), "");
    store({"RAPID X4^0.5 Y4^0.5"});
    begin();
    platform::servo_ticks(ticks_of(100) + when);
    double last = speed();
    ASSERT_NEAR(last, 20.0, 0.1);
    capture(static_cast<std::uint32_t>(at(1)));
    for (unsigned i = 0; i < ticks_of(60); ++i) {
      const double now = speed();
      ASSERT_LT(std::abs(now - last), 1.05 * kTickMs) << when << ", " << i << ": Ixx19 alone changes it";
      last = now;
    }
  }
}

// A motor that stood beside its axis when a program began is forgotten with that program, if nothing has moved it.
TEST_F(ChangingMotions, WhatStoodAsideInAProgramWithoutMovesIsForgotten) {
  fit({"1000X", "1000X"});
  motors[1].trajectory = position(250);
  store({"DWELL10"});
  ASSERT_EQ(host("&1B1R"), "");
  ticks(30);
  ASSERT_FALSE(run_is_running(0));
  motors[1].trajectory = 0;
  store({"TM100 TA20 TS0 X1"});
  double last = 0.0, fastest = 0.0;
  run([&](double) {
    fastest = std::max(fastest, std::abs(at(2) - last) / kTickMs);
    last = at(2);
  });
  EXPECT_NEAR(fastest, 10.0, 0.1);
  EXPECT_EQ(motors[1].trajectory, position(1000));
}

// motion:4.3/1: a trigger that stays is one; where it came first is home, though the search goes on for Ixx92.
TEST_F(ChangingMotions, ATriggerThatStaysIsFoundOnce) {
  ASSERT_EQ(host("I197=2 I192=50"), "");  // the warning following error, actual position: 0 here
  *hal_x(kCaptured) = 700;                // not this one
  ASSERT_EQ(host("#1HM"), "");
  ticks(100);
  motors[0].actual = 0;
  motors[0].found.warning_error = true;
  const double before = at(1);
  platform::servo_ticks(1);
  ASSERT_TRUE(motors[0].status.home_complete);
  EXPECT_FALSE(motors[0].status.home_search) << "until its trigger";
  ASSERT_NEAR(at(1) - before, 15 * kTickMs, 0.1) << "0 is where the motor is";
  motors[0].actual = position(100);
  const double moved = at(1);
  ticks(20);
  EXPECT_NEAR(at(1) - moved, 15 * ticks_of(20) * kTickMs, 0.1) << "and stays";
}

// An Ixx25 where no register is captures nothing; neither does it harm.
TEST_F(ChangingMotions, WithoutACaptureRegisterASearchGoesOn) {
  ASSERT_EQ(host("I125=$50000"), "");
  ASSERT_EQ(host("#1HM"), "");
  ticks(300);
  EXPECT_TRUE(motors[0].status.home_search);
  EXPECT_NEAR(speed(), 15.0, 0.1);
  ASSERT_EQ(host("K"), "");
  motors[0].loop = LOOP_CLOSED;
  ASSERT_EQ(host("I197=3 HM"), "");
  ticks(100);
  motors[0].found.warning_error = true;
  ticks(10);
  EXPECT_TRUE(motors[0].status.home_complete) << "by the following error, in software";
}

// Where motors are where the axes have them those stay exactly what they were, though a motor is rounded.
TEST_F(ChangingMotions, AxesStayExactFromProgramToProgram) {
  fit({"0.37X"});
  store({"TM100 TA20 TS0 X0.333333"});
  run();
  const double first = cs().position[AXIS_X];
  ASSERT_NEAR(first, 0.333333, 1e-6);
  store({"DWELL10"});
  ASSERT_EQ(host("&1B1R"), "");
  ticks(30);
  EXPECT_EQ(cs().position[AXIS_X], first);
}

// A DWELL or DELAY of virtual axes is where the move before has ended, whatever the move before that has been.
TEST_F(ChangingMotions, VirtualAxesStandInAWait) {
  for (const char* wait : {"DWELL500", "DELAY500"}) {
    store({"TM50 TA20 TS0 ABS X1", "X3", wait, "X4"}, 2);
    ASSERT_EQ(host("&2B2R"), "");
    ticks(300);
    ASSERT_EQ(host("&2A"), "");
    ticks(50);
    EXPECT_EQ(coordinate_systems[1].position[AXIS_X], 3.0) << wait;
  }
}

// firmware:7.5: without a feedrate axis the longest way of the others counts, below a unit too.
TEST_F(ChangingMotions, AShortWayOfOtherAxesTakesAShortTime) {
  ASSERT_EQ(host("I5190=1000"), "");
  store({"FRAX(Y) TA20 TS0 F10 X.5"});
  EXPECT_NEAR(run(), 50.0 + 20.0, 1.5 * kTickMs);
}

// motion:5.3/2, word 3: bit 6 is a corner's, bit 5 any pause's.
TEST_F(ChangingMotions, APauseBehindASharpCornerIsNone) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5183=0.5 I5185=0.5 I5182=100"), "");
  store({"TM50 TA20 TS0 X1", "X1 Y1", "DWELL5", "Y2"});
  std::vector<unsigned> seen;
  run([&](double) {
    const unsigned bits = motion_cs_status(0, 2) >> 5 & 3u;
    if (seen.empty() || seen.back() != bits) seen.push_back(bits);
  });
  EXPECT_EQ(seen, (std::vector<unsigned>{0, 3, 0, 1, 0, 1, 0})) << "the corner, before DWELL, behind it";
}

}  // namespace
