// What H, Q and A leave behind for R, jogs and assignments that wait (motion:5.6).
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/jog.h"
}

namespace {

using namespace moving_motors;

double place() { return static_cast<double>(motors[0].trajectory) / kUnit; }

class HoldsAndAborts : public MovingMotors {
 protected:
  void SetUp() override {
    MovingMotors::SetUp();
    fit({"1000X"});
    ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=20 I192=1 I115=1 I5195=200000 I5194=200000"), "");
  }
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
  static std::int64_t position(double counts) { return std::llround(counts * kUnit); }
  static void begin(const std::string& start = "&1B1R") {
    ASSERT_EQ(host(start), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    ASSERT_TRUE(cs().active);
  }
};

TEST_F(HoldsAndAborts, AMotorJoggedAwayFromAHoldAndBackGoesOn) {
  store({"TM400 TA20 TS0 X1"});
  begin();
  ticks(200);
  ASSERT_EQ(host("H"), "");
  ticks(50);
  const std::int64_t held = motors[0].trajectory;
  ASSERT_EQ(host("#1J:100"), "");
  ticks(200);
  EXPECT_EQ(motors[0].trajectory, held + position(100));
  EXPECT_EQ(host("R"), "ERR017");
  ASSERT_EQ(host("J="), "");
  ticks(10);
  EXPECT_EQ(host("R"), "ERR011") << "on its way back";
  ticks(200);
  EXPECT_EQ(motors[0].trajectory, held);
  ASSERT_EQ(host("R"), "");
  ticks(400);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(motors[0].trajectory, position(1000));
}

TEST_F(HoldsAndAborts, AMotorOfNoSystemNeedsNoWayBack) {
  fit({"0", "1000X"});
  store({"TM400 TA20 TS0 X1"});
  begin();
  ticks(200);
  ASSERT_EQ(host("H"), "");
  ticks(50);
  ASSERT_EQ(host("#1J:100"), "");
  ticks(200);
  ASSERT_EQ(motors[0].trajectory, position(100));
  EXPECT_EQ(host("R"), "");
  ticks(400);
  EXPECT_EQ(motors[1].trajectory, position(1000));
}

// A program whose last move executes has ended already: R does not begin it anew.
TEST_F(HoldsAndAborts, RunInTheLastMoveDoesNotRepeatTheProgram) {
  store({"INC TM200 TA20 TS0 X1", "X1"});
  for (const char* again : {"R", "H", "S"}) {
    begin();
    ticks(250);
    const std::int64_t from = motors[0].trajectory;
    ASSERT_EQ(host(again), "");
    ticks(20);
    ASSERT_EQ(host("R"), "");
    ticks(700);
    EXPECT_FALSE(run_is_running(0)) << again;
    EXPECT_LT(motors[0].trajectory - from, position(1000)) << again;
    EXPECT_EQ(motors[0].trajectory % position(2000), 0) << again;
  }
}

TEST_F(HoldsAndAborts, AnAbortForgetsTheWayBackAndTheHold) {
  store({"INC TM400 TA20 TS0 X1"});
  for (const char* stop : {"H", "Q"}) {
    begin();
    ticks(200);
    ASSERT_EQ(host(stop), "");
    ticks(50);
    ASSERT_EQ(host("A"), "");
    ticks(100);
    EXPECT_FALSE(cs().held) << stop;
    EXPECT_EQ(host("%"), "100") << stop;
    ASSERT_EQ(host("#1J:100"), "");
    ticks(200);
    const std::int64_t from = motors[0].trajectory;
    begin();
    ticks(500);
    EXPECT_EQ(motors[0].trajectory, from + position(1000)) << stop;
  }
}

// Behind `/` as behind Q; B begins anew from where the motors are.
TEST_F(HoldsAndAborts, AnotherStartNeedsNoWayBack) {
  store({"INC TM100 TA20 TS0 X1", "X1", "X1", "X1"});
  for (const char* stop : {"Q", "/"}) {
    begin();
    ticks(30);
    ASSERT_EQ(host(stop), "");
    ticks(300);
    ASSERT_EQ(host("#1J:50"), "") << stop;
    ticks(200);
    EXPECT_EQ(host("R"), "ERR017") << stop;
    const std::int64_t from = motors[0].trajectory;
    begin();
    ticks(500);
    EXPECT_EQ(motors[0].trajectory, from + position(4000)) << stop;
  }
}

// The move that they wait for does not come.
TEST_F(HoldsAndAborts, AnAbortForgetsAssignmentsThatWait) {
  ASSERT_EQ(host("M1->X:$10F0,0,24 M1=0"), "");
  store({"TM200 TA20 TS0 X1", "M1==5 X2"});
  begin();
  ticks(100);
  ASSERT_EQ(host("A"), "");
  ticks(300);
  EXPECT_EQ(host("M1"), "0");
}

// motion:5.1/3: both limits, not one of them.
TEST_F(HoldsAndAborts, RunGoesWithOneLimit) {
  store({"X1"});
  ASSERT_TRUE(jog_to(0, position(-500)));
  motors[0].found.positive_limit = true;
  EXPECT_EQ(host("&1B1R"), "ERR011") << "the jog";
  motors[0].found.negative_limit = true;
  EXPECT_EQ(host("R"), "ERR010");
}

TEST_F(HoldsAndAborts, ARapidMoveUntilATriggerIsHeld) {
  ASSERT_EQ(host("I125=$78000 I124=$120001"), "");
  store({"RAPID X10^0.5"});
  begin();
  ticks(100);
  ASSERT_EQ(host("H"), "");
  ticks(50);
  const std::int64_t held = motors[0].trajectory;
  ticks(20);
  EXPECT_EQ(motors[0].trajectory, held);
  ASSERT_EQ(host("R"), "");
  ticks(700);
  EXPECT_EQ(motors[0].trajectory, position(10000));
}

// Where a program has left a motor is where it came to rest, when it was aborted.
TEST_F(HoldsAndAborts, JEqualsBehindAnAbortedRapidMove) {
  store({"RAPID X10"});
  begin();
  ticks(100);
  ASSERT_EQ(host("A"), "");
  ticks(100);
  const std::int64_t left = motors[0].trajectory;
  ASSERT_EQ(host("#1J:50"), "");
  ticks(200);
  ASSERT_EQ(host("J="), "");
  ticks(200);
  EXPECT_EQ(motors[0].trajectory, left);
}

// Largest change of velocity (counts a ms) from one servo interrupt to the next, over some ms.
double largest_change(double ms, double velocity) {
  double largest = 0.0, last = place();
  for (unsigned i = 0; i < ticks_of(ms); ++i) {
    platform::servo_ticks(1);
    const double now = (place() - last) / kTickMs;
    largest = std::max(largest, std::abs(now - velocity));
    velocity = now;
    last = place();
  }
  return largest;
}

// A ramp does not wait for a jog that is planned and waits for its Ixx92.
TEST_F(HoldsAndAborts, AnAbortComesBeforeAJogThatWaits) {
  ASSERT_EQ(host("#1J+"), "");
  ticks(100);
  ASSERT_EQ(host("I192=200 J-"), "");
  ticks(10);
  ASSERT_EQ(host("A"), "");
  ticks(30);
  const std::int64_t stands = motors[0].trajectory;
  ticks(300);
  EXPECT_EQ(motors[0].trajectory, stands) << "20 counts a ms at Ixx15 = 1, and no jog behind it";
}

// A ramp begins at the velocity that the motor has when it begins, while that changes too.
TEST_F(HoldsAndAborts, AnAbortInAnAccelerationDoesNotChangeTheVelocity) {
  store({"TM400 TA40 TS0 X8"});  // 0.5 counts a ms^2
  begin();
  ticks(25);
  ASSERT_EQ(host("A"), "");
  const double last = place();
  platform::servo_ticks(1);
  EXPECT_LT(largest_change(60, (place() - last) / kTickMs), 1.6 * kTickMs) << "Ixx15 and half a count a ms^2";
}

// A motor that a hold has stopped in the middle of its move begins a jog at rest.
TEST_F(HoldsAndAborts, AJogFromAHoldBeginsAtRest) {
  store({"TM400 TA20 TS0 X4"});
  begin();
  ticks(200);
  ASSERT_EQ(host("H"), "");
  ticks(50);
  ASSERT_EQ(host("#1J:100"), "");
  EXPECT_LT(largest_change(60, 0.0), 1.1 * kTickMs) << "Ixx19";
}

// motion:4.2/12 behind a program, motion:4.2/11 behind a search.
TEST_F(HoldsAndAborts, JEqualsBehindJEqualsEqualsAndHome) {
  store({"TM50 TA20 TS0 X1"});
  run();
  for (const char* line : {"#1J==300", "J:50", "J="}) {
    ASSERT_EQ(host(line), "");
    ticks(200);
  }
  EXPECT_EQ(motors[0].trajectory, position(300));
  ASSERT_EQ(host("I123=20 I126=0 I125=$78000 I124=$120001 HM"), "");
  ticks(100);
  *hal_x(0x78003) = 0xFFFFFF;  // at -1, the motor has gone on
  *hal_x(0x78000) |= 1u << 11;
  ticks(200);
  ASSERT_FALSE(jog_is_moving(0));
  EXPECT_EQ(motors[0].trajectory, 0);
  ASSERT_EQ(host("J:50"), "");
  ticks(200);
  ASSERT_EQ(host("J="), "");
  ticks(200);
  EXPECT_EQ(motors[0].trajectory, 0);
}

// motion:5.6/5
TEST_F(HoldsAndAborts, StepsByLine) {
  ASSERT_EQ(host("I5153=1 P1=0 P2=0 P3=0"), "");
  store({"P1=1", "P2=1 TM50 TA20 TS0 X1", "BLOCKSTART", "P3=1", "X2", "BLOCKSTOP"});
  ASSERT_EQ(host("&1B1"), "");
  const auto at_end = [](unsigned p) { return p_variable_read(p); };
  for (const double end : {0.0, 1000.0, 2000.0}) {
    ASSERT_EQ(host("S"), "");
    ticks(150);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(motors[0].trajectory, position(end));
    EXPECT_EQ(at_end(1), 1.0);
    EXPECT_EQ(at_end(2), end > 0 ? 1.0 : 0.0);
    EXPECT_EQ(at_end(3), end > 1000 ? 1.0 : 0.0);
  }
  ASSERT_EQ(host("I5153=0 P1=0 &1B1S"), "");
  ticks(150);
  EXPECT_EQ(at_end(1), 1.0);
  EXPECT_EQ(motors[0].trajectory, position(1000)) << "to the next move";
  const Lines blocks = {"BLOCKSTART", "P1=4", "BLOCKSTOP", "BLOCKSTART", "X3", "X4", "BLOCKSTOP", "P1=5"};
  Lines lines = {"P1=2 DWELL5", "P1=3 X2"};
  lines.insert(lines.end(), blocks.begin(), blocks.end());
  store(lines, 2);
  ASSERT_EQ(host("&1B2"), "");
  for (const auto& [p1, end] : {std::pair{2, 1000}, {3, 2000}, {4, 2000}, {4, 4000}}) {
    ASSERT_EQ(host("S"), "");
    ticks(200);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(at_end(1), p1);
    EXPECT_EQ(motors[0].trajectory, position(end)) << "to a DWELL, a move, a BLOCKSTOP, all of a block";
  }
}

// During a step S changes nothing: it is no stop that a motor has to come back to.
TEST_F(HoldsAndAborts, AStepInAStepNeedsNoWayBack) {
  store({"INC TM100 TA20 TS0 X1", "X1", "X1"});
  begin("&1B1S");
  ticks(30);
  ASSERT_EQ(host("S"), "");
  ticks(200);
  ASSERT_EQ(motors[0].trajectory, position(1000));
  ASSERT_EQ(host("#1J:100"), "");
  ticks(200);
  EXPECT_EQ(host("R"), "");
  ticks(400);
  EXPECT_EQ(motors[0].trajectory, position(3100));
}

// Into a limit that the motor stands in no jog goes, out of it each (motion:6.2/3); a search for home goes into those
// of software. Seen as the command comes: no pass of protection has been.
TEST_F(HoldsAndAborts, JogsGoOutOfALimitOnly) {
  constexpr std::uint32_t kFlags = 0x78000, kPositive = 1u << 17, kNegative = 1u << 18;
  ASSERT_EQ(host("#1J/"), "");
  ticks(10);
  const struct {
    bool up, searches;
    const char* limits;
    std::uint32_t inputs;
    int actual;
  } cases[] = {{true, true, "I124=$820001 I113=50 I114=0", 0, 50},
               {false, true, "I124=$820001 I113=0 I114=50", 0, 50},
               {true, true, "I124=$828001 I113=60 I114=0 I141=20", 0, 30},
               {false, true, "I124=$828001 I113=0 I114=40 I141=20", 0, 70},
               {true, false, "I124=$800001 I113=0 I114=0", kPositive, 50},
               {false, false, "I124=$800001 I113=0 I114=0", kNegative, 50}};
  for (const auto& one : cases) {
    ASSERT_EQ(host(one.limits), "");
    *hal_x(kFlags) = one.inputs;
    for (const std::string line : {"J+", "J=100", "J:50", "J-", "J=0", "J:-50", "I123=10 HM", "I123=-10 HM"}) {
      motors[0].trajectory = motors[0].commanded = position(50);
      motors[0].actual = position(one.actual);
      ASSERT_EQ(host("#1" + line), "") << line;
      const bool goes_up = line == "J+" || line == "J=100" || line == "J:50" || line == "I123=10 HM";
      const bool searches = line.back() == 'M' && one.searches;
      EXPECT_EQ(jog_is_moving(0), goes_up != one.up || searches) << one.limits << " " << line;
      const std::uint32_t state = hal_mask_servo();
      jog_drop(0);
      hal_unmask(state);
    }
  }
}

// A motor of the program that does not move stands through the abort, whatever its moves before were.
TEST_F(HoldsAndAborts, AMotorThatStandsStandsThroughAnAbort) {
  for (int moment = 0; moment < 40; ++moment) {
    platform::power_up();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I115=0.5 I215=0.5"), "");
    Lines lines = {"TM30 TA10 TS2"};
    for (int i = 1; i <= 12; ++i) lines.push_back("X" + std::to_string(i) + "Y" + std::to_string(i % 2));
    for (int i = 13; i <= 30; ++i) lines.push_back("X" + std::to_string(i));
    store(lines);
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(ticks_of(430 + 3.3 * moment));
    const double stood = at(2);
    ASSERT_EQ(stood, 0.0);
    ASSERT_GT(at(1), 13000.0);
    ASSERT_EQ(host("A"), "");
    for (int tick = 0; tick < 200; ++tick) {
      platform::servo_ticks(1);
      ASSERT_EQ(at(2), stood) << moment << ", " << tick;
    }
  }
}

}  // namespace
