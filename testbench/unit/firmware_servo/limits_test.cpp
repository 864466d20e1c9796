// What stops motors at the ends of their way, natively: overtravel inputs, software limits, limits of the desired
// position (motion:6.2), in jogs, programs, open loops.
#include "testbench/unit/firmware_servo/protection_rig.h"

extern "C" {
#include "firmware/motion/jog.h"
}

namespace brick {
namespace {

class MotionLimits : public ProtectionRig {
 protected:
  MotionLimits() {
    for (const char* motor : {"1", "2", "5"}) {
      const std::string i = std::string("I") + motor;
      c_.line(i + "11=0 " + i + "15=1 " + i + "16=200 " + i + "17=1 " + i + "19=10 " + i + "20=0 " + i + "21=0 " + i +
              "22=32 " + i + "92=1");
    }
  }
};

// A ramp of Ixx15 = 1 count/ms^2 from 32 counts/ms takes 32 ms and 512 counts; 1.4 ms pass at most until it is seen.
void expect_ramp(double from, double to, double speed) {
  const double way = speed * speed / 2;
  EXPECT_GE(to - from, way - 1);
  EXPECT_LE(to - from, way + speed * 2);
}

// What lookahead asks for: a side without a limit has none.
TEST_F(MotionLimits, OfTheDesiredPositionByTheirSides) {
  std::int64_t lowest = 0, highest = 0;
  EXPECT_FALSE(protection_desired_limits(0, &lowest, &highest));
  EXPECT_EQ(lowest, INT64_MIN);
  EXPECT_EQ(highest, INT64_MAX);
  c_.line("I124=$808001 I141=0 I113=100");
  EXPECT_TRUE(protection_desired_limits(0, &lowest, &highest));
  EXPECT_EQ(lowest, INT64_MIN);
  EXPECT_NEAR(static_cast<double>(highest) / kFine, 100, 0.1);
  c_.line("I113=0 I114=-100");
  EXPECT_TRUE(protection_desired_limits(0, &lowest, &highest));
  EXPECT_NEAR(static_cast<double>(lowest) / kFine, -100, 0.1);
  EXPECT_EQ(highest, INT64_MAX);
}

TEST_F(MotionLimits, ASoftwareLimitStopsAJogByIxx15) {
  c_.line("I113=1000 I514=-1000");
  c_.line("#1J+ #5J-");
  double passed = 0;
  follow_until([] { return at(1) >= 1000; });
  passed = at(1);
  follow(3);
  EXPECT_TRUE(status1(1, 12)) << "abort deceleration";
  EXPECT_TRUE(status1(1, 21));
  follow(200);
  expect_ramp(passed, at(1), 32);
  expect_ramp(1000, -at(5), 32);
  EXPECT_TRUE(status1(5, 22));
  EXPECT_TRUE(status2(5, 11)) << "stopped on a limit";
  EXPECT_EQ(loop(1), LOOP_CLOSED);
  // Out of it, and not further in.
  const double stands = at(1);
  c_.line("#1J+");
  follow(50);
  EXPECT_EQ(at(1), stands);
  c_.line("#1J=2000");
  follow(50);
  EXPECT_EQ(at(1), stands);
  c_.line("#1J=0");
  follow(400);
  EXPECT_EQ(at(1), 0);
  EXPECT_FALSE(status1(1, 21));
  EXPECT_FALSE(status2(1, 11));
}

// 24.5 counts of commanded way are not enough, the actual position counts: motion:6.2/2.
TEST_F(MotionLimits, SoftwareLimitsLookAtTheActualPosition) {
  c_.line("I113=100");
  ASSERT_TRUE(motor_close(0));
  counts(1, 99);
  c_.line("#1J:50");
  servo(60);
  EXPECT_FALSE(status1(1, 21));
  counts(1, 100);
  servo(3);
  EXPECT_TRUE(status1(1, 21));
}

// motion:6.2/3: what leads further into a limit moves nothing; what leads out of it does.
TEST_F(MotionLimits, OnlyWhatLeadsIntoALimitIsNotTaken) {
  const struct {
    const char* line;
    int way;
  } jogs[] = {{"I122=32 #1J+", 1},  {"I122=32 #1J-", -1}, {"I122=0 #1J+", 0}, {"I122=0 #1J-", 0},
              {"I122=32 #1J=1", 1}, {"#1J=-1", -1},       {"#1J=0", 0}};
  for (const int side : {0, 1, -1})
    for (const auto& jog : jogs) {
      motor_kill(0);
      counts(1, 0);
      motors[0].actual = motors[0].trajectory = 0;
      flags(1, side > 0 ? kPositive : side < 0 ? kNegative : 0);
      ASSERT_TRUE(motor_close(0));
      servo(3);
      ASSERT_EQ(motors[0].trajectory, 0);
      EXPECT_EQ(c_.line(jog.line), "");
      EXPECT_EQ(jog_is_moving(0), side == 0 || jog.way != side) << jog.line << " at " << side;
    }
}

// A motor that stands in a limit is not stopped, nor one that moves out of it.
TEST_F(MotionLimits, OnlyWhatMovesOnIsStopped) {
  close_all();
  flags(1, kPositive);
  follow(10);
  EXPECT_TRUE(status1(1, 21));
  EXPECT_FALSE(status2(1, 11));
  c_.line("#1J-");
  follow(100);
  EXPECT_LT(at(1), -500);
  EXPECT_FALSE(status1(1, 12));
  EXPECT_FALSE(status2(1, 11));
  flags(1, kNegative);
  follow(100);
  const double stands = at(1);
  follow(10);
  EXPECT_EQ(at(1), stands);
  EXPECT_TRUE(status2(1, 11));
  EXPECT_TRUE(status1(1, 22));
}

TEST_F(MotionLimits, AProgramIsAbortedWithAllItsMotors) {
  run({"INC TM1000 TA20 TS0", "X20000 Y10000", "X20000 Y10000"});
  follow(300);
  const double x = at(1), y = at(2);
  ASSERT_GT(x, 1000);
  flags(2, kPositive);
  follow(3);
  EXPECT_TRUE(status1(1, 12) && status1(2, 12));
  EXPECT_FALSE(runs());
  follow(200);
  expect_ramp(x, at(1), 20);
  expect_ramp(y, at(2), 10);
  EXPECT_TRUE(status2(2, 11));
  EXPECT_FALSE(status2(1, 11));
  EXPECT_EQ(loop(1), LOOP_CLOSED);
  EXPECT_EQ(loop(2), LOOP_CLOSED);
}

// RAPID and HOME of a program are its motion too.
TEST_F(MotionLimits, RapidMovesAreOfTheirProgram) {
  for (const char* move : {"RAPID X20000 Y20000", "HOME1,2"}) {
    flags(2, 0);
    c_.line("I123=20 I223=20 UNDEFINE ALL &1#1->X #2->Y");
    run({move, "DWELL10", "P1=1"});
    follow(200);
    const double x = at(1);
    flags(2, kPositive);
    follow(6);
    EXPECT_TRUE(status1(1, 12)) << move << ": the other one";
    EXPECT_FALSE(runs()) << move;
    follow(300);
    EXPECT_LT(at(1), x + 700) << move;
    c_.line("#1K #2K");
    counts(1, 0);
    counts(2, 0);
    servo(2);
  }
}

// So is that of a motor of no coordinate system, or of another one: it takes the program that homes it with it.
TEST_F(MotionLimits, AMotorIsOfTheProgramThatHomesIt) {
  for (const char* of : {"&2#5->0", "&2#5->X"}) {
    flags(5, 0);
    ASSERT_EQ(c_.line(of), "");
    c_.line("I523=20 I515=.5 P1=0");
    run({"HOME5", "DWELL10", "P1=1"});
    follow(200);
    const double was = at(5);
    ASSERT_GT(was, 1000);
    flags(5, kPositive);
    follow(6);
    EXPECT_FALSE(runs()) << of;
    EXPECT_TRUE(status1(5, 12)) << of;
    follow(300);
    EXPECT_LT(at(5), was + 700) << of;
    EXPECT_EQ(c_.line("P1"), "0") << of;
    c_.line("&1B1R"); /* further into it */
    follow(100);
    EXPECT_FALSE(runs()) << of;
    EXPECT_EQ(c_.line("P1"), "0") << of;
    EXPECT_TRUE(status2(5, 11)) << of;
    c_.line("#5K");
    counts(5, 0);
    servo(2);
  }
}

// A program does not pass over a move into a limit in which its motor stands: it is aborted.
TEST_F(MotionLimits, AProgramEndsAtAMoveIntoALimit) {
  for (const char* move : {"RAPID X20000", "HOME1", "LINEAR TM100 TA20 TS0 X20000"}) {
    flags(1, 0);
    c_.line("I123=20 P1=0 #1HMZ");
    close_all();
    flags(1, kPositive);
    follow(10);
    const double stands = at(1);
    run({move, "DWELL10", "P1=1"});
    follow(100);
    EXPECT_FALSE(runs()) << move;
    EXPECT_EQ(c_.line("P1"), "0") << move;
    EXPECT_TRUE(status2(1, 11)) << move;
    EXPECT_LT(at(1), stands + 20) << move;
    EXPECT_EQ(status2(1, 10), move[0] != 'H') << "home complete: " << move;
    run({"RAPID X-1000", "DWELL1", "P1=2"});
    follow(300);
    EXPECT_EQ(c_.line("P1"), "2") << "out of it, behind " << move;
  }
}

// A search for home into an input where the motor stands goes nowhere; one that has passed a software limit does.
TEST_F(MotionLimits, ASearchDoesNotBeginInAnInput) {
  c_.line("I123=20");
  ASSERT_TRUE(motor_close(0));
  flags(1, kPositive);
  follow(10);
  EXPECT_EQ(c_.line("#1HMZ HM"), "");
  follow(50);
  EXPECT_EQ(at(1), 0);
  EXPECT_FALSE(status2(1, 10)) << "home complete";
  c_.line("#1I123=-20 HM");
  follow(50);
  EXPECT_LT(at(1), -100) << "out of it";
  c_.line("#1J/");
  follow(50);
  flags(1, 0);
  c_.line("#1HMZ I113=-1 I123=20");
  follow(10);
  EXPECT_TRUE(status1(1, 21));
  c_.line("#1HM");
  follow(50);
  EXPECT_GT(at(1), 100);
}

// Ixx24 bit 8: the input kills, if the software limit of its side is on and not reached.
TEST_F(MotionLimits, AnInputKillsInFrontOfTheSoftwareLimit) {
  const struct {
    const char* limits;
    std::uint32_t input;
    bool kills;
  } cases[] = {{"I113=100000 I114=0", kPositive, true},
               {"I113=0 I114=-100000", kPositive, false},
               {"I113=500 I114=0", kPositive, false},
               {"I113=0 I114=-100000", kNegative, true},
               {"I113=100000 I114=0", kNegative, false}};
  for (const auto& one : cases) {
    flags(1, 0);
    counts(1, 0);
    servo();
    c_.line(std::string("I124=$800101 ") + one.limits);
    ASSERT_TRUE(motor_close(0));
    c_.line(one.input == kPositive ? "#1J+" : "#1J-");
    follow(100);
    flags(1, one.input);
    follow(3);
    EXPECT_EQ(loop(1), one.kills ? LOOP_KILLED : LOOP_CLOSED) << one.limits << " " << one.input;
    if (one.kills) { EXPECT_FALSE(enabled(1)); }
    EXPECT_TRUE(status2(1, 11));
    motor_kill(0);
  }
}

// Others then go as behind a fault: bits 22 and 21.
TEST_F(MotionLimits, AnInputThatKillsTripsOthersAsIxx24Says) {
  const struct {
    const char* mode;
    bool second, fifth;
  } cases[] = {{"$800101", true, true}, {"$A00101", true, false}, {"$C00101", false, false}};
  for (const auto& one : cases) {
    flags(1, 0);
    counts(1, 0);
    servo();
    c_.line(std::string("I113=100000 I124=") + one.mode);
    close_all();
    c_.line("#1J+");
    follow(100);
    flags(1, kPositive);
    follow(3);
    EXPECT_EQ(loop(1), LOOP_KILLED) << one.mode;
    EXPECT_EQ(loop(2) == LOOP_KILLED, one.second) << one.mode;
    EXPECT_EQ(loop(5) == LOOP_KILLED, one.fifth) << one.mode;
    EXPECT_TRUE(status2(1, 11)) << "stopped on a limit";
    EXPECT_FALSE(status2(1, 2) || status2(1, 3)) << "neither a following error nor a fault";
  }
}

// A search for home that has passed the software limit ends at the input by a ramp, one that has not is a runaway.
TEST_F(MotionLimits, AnInputKillsASearchInFrontOfTheSoftwareLimitOnly) {
  for (const bool passed : {false, true}) {
    flags(1, 0);
    counts(1, 0);
    servo();
    c_.line(std::string("I124=$C00101 I123=10 I113=") + (passed ? "100" : "100000"));
    c_.line("#1HMZ HM");
    follow(200);
    ASSERT_GT(at(1), 500);
    flags(1, kPositive);
    follow(3);
    EXPECT_EQ(loop(1), passed ? LOOP_CLOSED : LOOP_KILLED);
    EXPECT_TRUE(status2(1, 11));
    follow(100);
    motor_kill(0);
  }
}

// The ramp of an abort is no excuse.
TEST_F(MotionLimits, AnInputKillsWhileAnAbortIsUnderWay) {
  c_.line("I124=$800101 I113=100000");
  ASSERT_TRUE(motor_close(0));
  c_.line("#1J+");
  follow(100);
  c_.line("&1A");
  follow(4);
  ASSERT_TRUE(status1(1, 12));
  flags(1, kPositive);
  follow(3);
  EXPECT_EQ(loop(1), LOOP_KILLED);
}

// What comes to rest already is left alone, and was not stopped by the limit.
TEST_F(MotionLimits, ARampThatIsUnderWayIsLeftAlone) {
  c_.line("#1J+");
  follow(60);
  ASSERT_EQ(c_.line("&1A"), "");
  follow_until([] { return motors[0].status.aborting; });
  const double begins = at(1);
  c_.line("I113=" + std::to_string(std::lround(begins) - 1));
  flags(1, kPositive);
  follow(20);
  EXPECT_TRUE(status1(1, 21));
  EXPECT_FALSE(status2(1, 11));
  follow(200);
  EXPECT_NEAR(at(1) - begins, 512, 20);
  EXPECT_FALSE(status2(1, 11));
  EXPECT_EQ(loop(1), LOOP_CLOSED);
}

// An open loop that comes to a limit is closed; O is refused as long as it stands there.
TEST_F(MotionLimits, AnOpenLoopIsClosed) {
  c_.line("I113=100");
  ASSERT_EQ(c_.line("#1O10"), "");
  for (int n = 0; n < 12; ++n) {
    counts(1, 10 * n);
    servo();
  }
  EXPECT_EQ(loop(1), LOOP_CLOSED);
  EXPECT_TRUE(status1(1, 21));
  EXPECT_TRUE(status2(1, 11));
  EXPECT_EQ(c_.line("#1O10"), "ERR010");
  EXPECT_EQ(c_.line("#1O-10"), "ERR010") << "which way a command goes is not known";
  c_.line("#1J=50");
  follow(50);
  EXPECT_FALSE(status1(1, 21));
  EXPECT_EQ(c_.line("#1O-10"), "");
  EXPECT_EQ(loop(1), LOOP_OPEN);
  // Away from a limit an open loop may go.
  flags(1, kPositive);
  for (int n = 0; n < 12; ++n) {
    counts(1, -10 * n);
    servo();
  }
  EXPECT_EQ(loop(1), LOOP_OPEN);
}

// What may not be closed cannot be brought to rest.
TEST_F(MotionLimits, AnOpenLoopThatMayNotBeClosedIsKilled) {
  c_.line("I113=100");
  ASSERT_EQ(c_.line("#1O10"), "");
  c_.line("I3300=1");
  for (int n = 0; n <= 9; ++n) {
    counts(1, 10 * n);
    servo();
  }
  ASSERT_EQ(loop(1), LOOP_OPEN);
  for (int n = 10; n < 14; ++n) {
    counts(1, 10 * n);
    servo();
  }
  EXPECT_EQ(loop(1), LOOP_KILLED);
  EXPECT_FALSE(enabled(1));
  EXPECT_TRUE(status2(1, 11)) << "by the limit";
}

TEST_F(MotionLimits, BitsStandWhileTheMotorIsKilled) {
  ASSERT_TRUE(motor_close(0));
  flags(1, kPositive);
  follow(3);
  EXPECT_TRUE(status1(1, 21));
  motor_kill(0);
  flags(1, kNegative);
  servo(6);
  EXPECT_TRUE(status1(1, 21));
  EXPECT_FALSE(status1(1, 22));
  ASSERT_TRUE(motor_close(0));
  follow(3);
  EXPECT_FALSE(status1(1, 21));
  EXPECT_TRUE(status1(1, 22));
}

// Until the trigger software limits do not count, inputs do.
TEST_F(MotionLimits, HomingKnowsNoSoftwareLimits) {
  c_.line("I113=100 I123=10");
  ASSERT_EQ(c_.line("#1HM"), "");
  follow(200);
  EXPECT_GT(at(1), 500);
  EXPECT_FALSE(status1(1, 21));
  EXPECT_TRUE(status1(1, 10)) << "search";
  flags(1, kPositive);
  follow(6);
  EXPECT_TRUE(status1(1, 12));
  follow(100);
  EXPECT_FALSE(status1(1, 10));
  EXPECT_FALSE(status2(1, 10)) << "home complete";
}

// Ixx43 has its own word, Ixx24 bits 19 and 18 = 10 (amplifier over MACRO) leave the limits, others do not.
TEST_F(MotionLimits, InputsComeFromTheWordOfIxx43) {
  c_.line("I143=$78008");
  ASSERT_TRUE(motor_close(0));
  flags(1, kNegative);
  flags(2, kPositive);
  follow(3);
  EXPECT_TRUE(status1(1, 21));
  EXPECT_FALSE(status1(1, 22));
  c_.line("I143=0");
  follow(3);
  EXPECT_FALSE(status1(1, 21));
  EXPECT_TRUE(status1(1, 22));
  const struct {
    const char* mode;
    bool limits;
  } modes[] = {{"$800001", true}, {"$840001", false}, {"$880001", true}, {"$8C0001", false}, {"$820001", false}};
  for (const auto& one : modes) {
    c_.line(std::string("I124=") + one.mode);
    follow(3);
    EXPECT_EQ(status1(1, 22), one.limits) << one.mode;
  }
}

// Ixx24 bit 15: the commanded position beyond Ixx13 - Ixx41 or Ixx14 + Ixx41 aborts, whatever the actual one is. At the
// limit itself it may stand.
TEST_F(MotionLimits, TheDesiredPositionHasLimits) {
  c_.line("I124=$808001 I113=1100 I114=-1050 I141=100");
  ASSERT_TRUE(motor_close(0));
  c_.line("#1J=1000");
  follow(200);
  EXPECT_EQ(at(1), 1000);
  EXPECT_FALSE(status1(1, 12) || status2(1, 12) || status2(1, 11));
  c_.line("I122=5 #1J=1050");
  follow(300);
  EXPECT_TRUE(status2(1, 12)) << "stopped on a desired limit";
  EXPECT_FALSE(status2(1, 11) || status1(1, 21));
  EXPECT_EQ(std::stoul(c_.line("&1??").substr(12), nullptr, 16) & 2u, 2u);
  const double stands = at(1);
  expect_ramp(1000, stands, 5);
  c_.line("I122=32");
  c_.line("#1J+");
  follow(50);
  EXPECT_EQ(at(1), stands) << "not further";
  c_.line("#1J-");
  double passed = 0;
  follow_until([] { return at(1) <= -950; });
  passed = at(1);
  follow(6);
  EXPECT_TRUE(status1(1, 12));
  EXPECT_TRUE(status2(1, 12));
  follow(200);
  expect_ramp(-passed, -at(1), 32);
  c_.line("#1J=0");
  follow(300);
  EXPECT_EQ(at(1), 0);
  EXPECT_FALSE(status2(1, 12));
  EXPECT_EQ(std::stoul(c_.line("&1??").substr(12), nullptr, 16), 0u);
  // The commanded position counts: the motor itself is held.
  c_.line("I122=5 #1J=1050");
  servo(600);
  EXPECT_TRUE(status2(1, 12));
  c_.line("I122=32 #1J=0");
  servo(300);
  // Without bit 15, and of a side whose software limit is off, there is none.
  c_.line("I124=$800001 #1J=-1000");
  follow(400);
  EXPECT_EQ(at(1), -1000);
  c_.line("I124=$808001 I114=0 #1J=-2000");
  follow(400);
  EXPECT_EQ(at(1), -2000);
}

// A master leads no motor beyond it either, and back from where it has left the motor.
TEST_F(MotionLimits, TheDesiredPositionFollowsNoFurtherThanItsLimit) {
  const auto master = [](int counts) { *hal_x(0x10F6) = static_cast<std::uint32_t>(counts * 32) & HAL_WORD_MASK; };
  master(0);
  c_.line("I105=$10F6 I107=96 I106=1 I124=$808001 I113=1100 I114=-1100 I141=100");
  ASSERT_TRUE(motor_close(0));
  for (const int side : {1, -1}) {
    const double begins = at(1);
    int way = 0;
    for (int n = 0; n < 300; ++n) {
      master(way += side * 10);
      follow(1);
    }
    EXPECT_GE(side * at(1), 1000);
    EXPECT_LE(side * at(1), 1000 + 10 * 5) << "seen within five interrupts";
    EXPECT_TRUE(status2(1, 12));
    EXPECT_FALSE(status1(1, side > 0 ? 21 : 22)) << "the actual position has not come to its limit";
    const double stands = at(1);
    master(way -= side * 10);
    follow(3);
    EXPECT_EQ(at(1), stands - side * 10) << "out of it";
    EXPECT_NE(begins, stands);
    for (int n = 0; n < 90; ++n) {
      master(way -= side * 10);
      follow(1);
    }
    EXPECT_FALSE(status2(1, 12));
    master(0);
    c_.line("I106=0 I106=1");
  }
}

TEST_F(MotionLimits, TheDesiredPositionOfAProgramHasLimits) {
  c_.line("I224=$808001 I213=600");
  run({"TM1000 TA20 TS0 X20000 Y20000", "P1=1"});
  follow_until([] { return at(2) >= 600; });
  follow(8);
  EXPECT_FALSE(runs());
  EXPECT_TRUE(status1(1, 12) && status1(2, 12));
  EXPECT_TRUE(status2(2, 12));
  EXPECT_FALSE(status2(1, 12));
}

// Both at once: programs do not start.
TEST_F(MotionLimits, BothLimitsKeepProgramsFromStarting) {
  c_.line("OPEN PROG 1 CLEAR");
  c_.line("X100");
  c_.line("CLOSE");
  close_all();
  flags(1, kPositive | kNegative);
  follow(3);
  EXPECT_EQ(c_.line("&1B1R"), "ERR010");
  flags(1, kPositive);
  follow(3);
  EXPECT_EQ(c_.line("&1B1R"), "");
}

}  // namespace
}  // namespace brick
