// B R S Q A H / on a rotary program (firmware:4.10, firmware:4.11), status words, execution of statements, axis
// definitions.
#include <cmath>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
}

namespace {

using platform::host;

class RunControl : public FirmwareTest {
 protected:
  static void open() {
    ASSERT_EQ(host("DEF ROT 200 B0 OPEN ROT"), "");
    ASSERT_EQ(host("TM100 TA40 TS0"), "");
  }
  static void settle() {
    for (int i = 0; i < 20000 && (cs().active || cs().next_valid || rotary_buffers[0].lines != 0); ++i)
      platform::servo_ticks(1);
    platform::servo_ticks(3);
  }
  // The trajectory stops at once; servo interrupts change nothing until the real-time task has found the position.
  static void abort() {
    ASSERT_EQ(host("A"), "");
    EXPECT_FALSE(run_is_running(0));
    const auto elapsed = cs().elapsed;
    platform::servo_ticks(1);
    EXPECT_EQ(cs().elapsed, elapsed);
    platform::real_time();
  }
  static coordinate_system& cs() { return coordinate_systems[0]; }
};

TEST_F(RunControl, RunNeedsAValidProgram) {
  EXPECT_EQ(host("R"), "ERR015");
  EXPECT_EQ(host("B0R"), "ERR015") << "no rotary buffer";
  ASSERT_EQ(host("DEF ROT 20"), "");
  EXPECT_EQ(host("B5"), "");
  EXPECT_EQ(host("R"), "ERR015") << "no such program";
  EXPECT_EQ(host("B0"), "");
  EXPECT_EQ(host("R"), "") << "an empty rotary buffer is accepted";
  EXPECT_TRUE(run_is_running(0));
  EXPECT_EQ(host("Q"), "");
  platform::real_time();
  EXPECT_EQ(host("DEL ROT"), "");
  EXPECT_EQ(host("R"), "ERR015");
  EXPECT_EQ(host("B32768"), "ERR003");
  EXPECT_EQ(host("B-1"), "ERR003");
}

TEST_F(RunControl, NewLineForAWaitingProgramRunsAtOnce) {
  open();
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(30);
  ASSERT_EQ(host("X7"), "");
  platform::servo_ticks(6);
  EXPECT_TRUE(cs().active);
  settle();
  EXPECT_EQ(cs().position[AXIS_X], 7.0);
}

TEST_F(RunControl, StepTakesOneMove) {
  open();
  ASSERT_EQ(host("P1=5"), "");
  ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("X2"), "");
  ASSERT_EQ(host("S"), "");
  platform::servo_ticks(1000);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(p_variable_read(1), 5.0);
  EXPECT_EQ(cs().position[AXIS_X], 1.0);
  EXPECT_EQ(host("PR"), "1");
}

TEST_F(RunControl, SecondStepRequestBeforeTheMoveDoesNotSwallowTheFirst) {
  open();
  ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("X2"), "");
  ASSERT_EQ(host("S"), "");
  ASSERT_EQ(host("S"), "");
  platform::servo_ticks(1000);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(cs().position[AXIS_X], 1.0);
  EXPECT_EQ(host("PR"), "1");
}

TEST_F(RunControl, QuitFinishesWhatIsCalculated) {
  open();
  for (const char* text : {"X1", "X2", "X3", "X4"}) ASSERT_EQ(host(text), "");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(12);
  ASSERT_EQ(host("PR"), "2");
  ASSERT_EQ(host("Q"), "");
  platform::servo_ticks(1000);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(cs().position[AXIS_X], 2.0);
  EXPECT_EQ(host("PR"), "2");
  ASSERT_EQ(host("R"), "");
  settle();
  EXPECT_EQ(cs().position[AXIS_X], 4.0);
}

TEST_F(RunControl, AbortStopsOnThePathAndKeepsUnreadLines) {
  open();
  for (const char* text : {"X1", "X2", "X3", "X4"}) ASSERT_EQ(host(text), "");
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  platform::servo_ticks(1);
  platform::servo_ticks(150);
  abort();
  EXPECT_FALSE(run_is_running(0));
  EXPECT_FALSE(cs().active);
  EXPECT_EQ(host("PR"), "2");
  // Constant acceleration for Ta = 40 ms to 1/100 units a ms, then straight: x = (t - Ta/2) / Tm.
  const double t = 150.0 * platform::kDefaultI10 / 8388608.0;
  EXPECT_NEAR(cs().position[AXIS_X], (t - 20.0) / 100.0, 1e-6);
  ASSERT_EQ(host("R"), "");
  settle();
  EXPECT_EQ(cs().position[AXIS_X], 4.0);
}

TEST_F(RunControl, AbortDuringABlendIsOnTheBlendedPath) {
  open();
  for (const char* text : {"X1", "X1 Y1"}) ASSERT_EQ(host(text), "");
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  platform::servo_ticks(1);
  platform::servo_ticks(static_cast<unsigned>(120.0 * 8388608.0 / platform::kDefaultI10) +
                        1);  // the middle of the corner, 100..140 ms
  const double t =
      (std::floor(120.0 * 8388608.0 / platform::kDefaultI10) + 1) * platform::kDefaultI10 / 8388608.0 - 100.0;
  abort();
  // From the blend's start X slows from 1/100 to 0 and Y rises from 0 to 1/100, both linearly over 40 ms; X is at 0.8
  // there.
  EXPECT_NEAR(cs().position[AXIS_X], 0.8 + (t - t * t / 80.0) / 100.0, 1e-6);
  EXPECT_NEAR(cs().position[AXIS_Y], t * t / 80.0 / 100.0, 1e-6);
}

TEST_F(RunControl, AbortInTheSCurveIsOnThePath) {
  for (const unsigned ticks : {10u, 45u, 80u, 88u}) {
    platform::power_up();
    open();
    ASSERT_EQ(host("TS10 X1"), "");  // Ta = 40 ms: acceleration rises 10 ms, is constant 20 ms, falls 10 ms
    ASSERT_EQ(host("R"), "");
    platform::real_time();
    platform::servo_ticks(1);
    platform::servo_ticks(ticks);
    abort();
    const double t = ticks * static_cast<double>(platform::kDefaultI10) / 8388608.0, step = 1e-4;
    double velocity = 0.0,
           position = 0.0;  // numeric double integration; peak acceleration 1/30 of the final velocity a ms
    for (double u = 0.0; u < t; u += step) {
      const double acceleration = u < 10 ? u / 10 : u < 30 ? 1.0 : u < 40 ? (40 - u) / 10 : 0.0;
      position += velocity * step;
      velocity += acceleration / 30.0 * step;
    }
    EXPECT_NEAR(cs().position[AXIS_X], position / 100.0, 2e-5) << t << " ms";
  }
}

TEST_F(RunControl, HoldStopsTimeAndRunResumes) {
  open();
  ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("CLOSE I5195=8388607 OPEN ROT R"), "");
  platform::servo_ticks(100);
  ASSERT_EQ(host("H"), "");
  platform::servo_ticks(2);
  const auto elapsed = cs().elapsed;
  platform::servo_ticks(500);
  EXPECT_EQ(cs().elapsed, elapsed);
  EXPECT_TRUE(run_is_running(0));
  EXPECT_EQ(host("X2"), "") << "the buffer may still be filled";
  ASSERT_EQ(host("R"), "");
  settle();
  EXPECT_EQ(cs().position[AXIS_X], 2.0);
}

TEST_F(RunControl, EndBlockStopsAfterTheExecutingMove) {
  open();
  for (const char* text : {"X1", "X2", "X3"}) ASSERT_EQ(host(text), "");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(20);
  ASSERT_EQ(host("/"), "");
  EXPECT_EQ(motion_cs_status(0, 1) >> 14 & 1u, 1u);
  platform::servo_ticks(1000);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_FALSE(cs().active);
  EXPECT_EQ(host("PR"), "1") << "X2 is calculated";
  ASSERT_EQ(host("R"), "");
  settle();
  EXPECT_EQ(cs().position[AXIS_X], 3.0);
}

TEST_F(RunControl, StatementsActInSequence) {
  open();
  for (const char* text : {"P1=3", "X(P1*2) Y(P1)", "INC", "X1 Y-1", "ABS(X)", "X10 Y1", "Q5=P1+0.5", "P(Q5+0.5)=77",
                           "I5114=P1*100", "M3=2"})
    ASSERT_EQ(host(text), "") << text;
  ASSERT_EQ(host("R"), "");
  settle();
  EXPECT_EQ(cs().position[AXIS_X], 10.0);
  EXPECT_EQ(cs().position[AXIS_Y], 3.0);
  EXPECT_EQ(q_variable_read(0, 5), 3.5);
  EXPECT_EQ(p_variable_read(4), 77.0);
  EXPECT_EQ(i_variable_read(5114), 300.0);
  EXPECT_EQ(m_variable_read(3), 2.0);
}

TEST_F(RunControl, RatesAreReadBackInTheirVariables) {
  open();
  for (const char* text : {"TA12 TS3 F250", "X1"}) ASSERT_EQ(host(text), "");
  ASSERT_EQ(host("R"), "");
  settle();
  EXPECT_EQ(host("I5187 I5188 I5189"), "12|3|250");
}

TEST_F(RunControl, PrefixExtendsTheNumberOfTheNextCommand) {
  BRICK_COVERS("BIN-3");
  open();
  instruction in{OP_PREFIX, 0, 4, 0.0};
  word48_t words[2];
  words[0] = word_encode(&in);
  in = {OP_ASSIGN, VARIABLE_P, 4, 9.0};
  words[1] = word_encode(&in);
  ASSERT_EQ(rotary_store(0, words, 2), ERR_NONE);
  ASSERT_EQ(host("R"), "");
  settle();
  EXPECT_EQ(p_variable_read(4 * 1024 + 4), 9.0);
}

TEST_F(RunControl, IllegalWordStopsTheProgramWithARunTimeError) {
  open();
  const word48_t bad = 9ull << 43;
  ASSERT_EQ(rotary_store(0, &bad, 1), ERR_NONE);
  ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(12);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(motion_cs_status(0, 1) >> 22 & 1u, 1u);
  EXPECT_EQ(host("PR"), "1") << "the line after it is kept";
  ASSERT_EQ(host("R"), "");
  EXPECT_EQ(motion_cs_status(0, 1) >> 22 & 1u, 0u);
}

TEST_F(RunControl, StatusWordsOfAnIdleAndARunningSystem) {
  EXPECT_EQ(host("??"), "A80020020000000000");  // firmware:5.4; in position (bit 17)
  open();
  ASSERT_EQ(host("INC X1"), "");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(6);
  EXPECT_EQ(motion_cs_status(0, 0), 0xFD5560u | 0x19u);  // all axes incremental; R, TM mode, running
  EXPECT_EQ(motion_cs_status(0, 1), 0u);
  EXPECT_TRUE(run_any_running());
  abort();
  EXPECT_EQ(motion_cs_status(0, 1), 0x020000u);
}

TEST_F(RunControl, OnLineAxisModes) {
  EXPECT_EQ(host("INC(X,R)"), "");
  EXPECT_EQ(motion_cs_status(0, 0), 0xA80020u | 1u << 18);
  EXPECT_EQ(host("ABS(X)"), "");
  EXPECT_EQ(motion_cs_status(0, 0), 0xA80020u) << "the vector by its own letter";
  EXPECT_EQ(host("ABS(X,R) FRAX(A)"), "");
  EXPECT_EQ(motion_cs_status(0, 0), 1u << 7);
  EXPECT_EQ(host("FRAX INC ABS"), "");
  EXPECT_EQ(motion_cs_status(0, 0), 0xA80000u);
  EXPECT_EQ(host("FRAX (A)"), "ERR003");  // no space before the bracket
  EXPECT_EQ(motion_cs_status(0, 0), 0xA80000u);
}

TEST_F(RunControl, ProgramPointers) {
  EXPECT_EQ(host("PC"), "ERR003");
  EXPECT_EQ(host("PE"), "ERR003");
  open();
  for (const char* text : {"X1 Y1", "X2"}) ASSERT_EQ(host(text), "");
  EXPECT_EQ(host("PC"), "P0:0");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(6);
  EXPECT_EQ(host("PC PE"), "P0:6|P0:3");  // TM TA TS, X1 Y1, X2
}

TEST_F(RunControl, AxisDefinitions) {
  EXPECT_EQ(host("#1->"), "0");
  EXPECT_EQ(host("#1->1000X"), "");
  EXPECT_EQ(host("#1->"), "1000X");
  EXPECT_EQ(host("#2->8660X-5000Y #3->100A+500 #4->2000Z-666.667 #5->X #6->-Y #7->I"), "");
  EXPECT_EQ(host("#2-> #3-> #4-> #5-> #6-> #7->"), "8660X-5000Y|100A+500|2000Z-666.667|X|-Y|I");
  EXPECT_EQ(host("&2#1->X"), "ERR003");  // golden exchange 27
  EXPECT_EQ(host("&2#1->"), "0");
  EXPECT_EQ(host("&1#1->100X+20A"), "ERR003") << "two groups of axes";
  EXPECT_EQ(host("#1->10X+5X"), "ERR003") << "one axis twice";
  for (const char* nothing : {"#1->0X", "#1->0X+0Y", "#1->0A+500"}) EXPECT_EQ(host(nothing), "ERR003") << nothing;
  EXPECT_EQ(host("#1->"), "1000X") << "as it was";
  EXPECT_EQ(host("#8->0X+5Y #8-> #8->0"), "5Y");
  EXPECT_EQ(host("#1->0"), "");
  EXPECT_EQ(host("#1->"), "0");
  EXPECT_EQ(host("&2#1->X"), "");
  EXPECT_EQ(host("UNDEFINE &1#2-> #1-> &2#1->"), "8660X-5000Y|0|0");
  EXPECT_EQ(host("UNDEFINE ALL &1#2->"), "0");
}

// firmware:4.10/1, firmware:5.10/3
TEST_F(RunControl, AnInactiveMotorHoldsItsSystemAndARunningOneHoldsSave) {
  open();
  ASSERT_EQ(host("DWELL60000"), "");
  ASSERT_EQ(host("CLOSE &1#3->X I300=0"), "");
  EXPECT_EQ(host("R"), "ERR013");
  EXPECT_EQ(host("S"), "ERR013");
  EXPECT_EQ(host("&2#3->X"), "ERR003") << "of &1";
  EXPECT_EQ(host("SAVE"), "");
  ASSERT_EQ(host("&2#4->X I400=0 I300=1"), "");
  EXPECT_EQ(host("&1R"), "ERR012") << "its loop is open";
  motors[2].loop = LOOP_CLOSED;
  EXPECT_EQ(host("&1R"), "") << "motor 4 is of another system";
  EXPECT_EQ(host("SAVE"), "ERR001");
  EXPECT_EQ(host("&2SAVE"), "ERR001") << "whoever runs";
}

// firmware:5.10/4: whoever has addressed what, a system that runs keeps its definitions.
TEST_F(RunControl, UndefineAllIsRefusedWhileASystemThatLosesDefinitionsRuns) {
  ASSERT_EQ(host("I300=1"), "");
  motors[2].loop = LOOP_CLOSED;
  ASSERT_EQ(host("&1#1->5X &3#3->7X DEF ROT 50 B0 OPEN ROT"), "");
  ASSERT_EQ(host("DWELL60000"), "");
  ASSERT_EQ(host("CLOSE &3R &1"), "");
  EXPECT_EQ(host("UNDEFINE ALL"), "ERR001") << "&1 is addressed, &3 runs";
  EXPECT_EQ(host("&1#1-> &3#3->"), "5X|7X");
  EXPECT_EQ(host("&3UNDEFINE"), "ERR001");
  EXPECT_EQ(host("&1UNDEFINE #1->"), "0") << "its own";
  ASSERT_EQ(host("&3A"), "");
  platform::servo_ticks(6);
  EXPECT_EQ(host("&2#2->3X &3UNDEFINE"), "");
  ASSERT_EQ(host("&3R"), "");
  EXPECT_EQ(host("UNDEFINE ALL &2#2->"), "0") << "&3 runs and has nothing to lose";
}

// Commands of a line are executed one after the other, up to what is none.
TEST_F(RunControl, ACommandBeforeWhatIsNoWordIsExecuted) {
  ASSERT_EQ(host("OPEN PROG 1 CLEAR DWELL60000 CLOSE"), "");
  EXPECT_EQ(host("B1R["), "ERR003");
  EXPECT_TRUE(run_is_running(0));
  EXPECT_EQ(host("A]"), "ERR003");
  platform::servo_ticks(6);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(host("R1"), "ERR005") << "R with a number is a statement of a program";
}

TEST_F(RunControl, UndefineAllIsRefusedWhicheverMotorWouldBeLost) {
  for (const char* const n : {"1", "2", "32"}) {
    platform::power_up();
    const std::string motor = n;
    ASSERT_EQ(host("I" + motor + "00=1"), "");
    motors[std::stoi(motor) - 1].loop = LOOP_CLOSED;
    ASSERT_EQ(host("&1#" + motor + "->5X DEF ROT 50 B0 OPEN ROT"), "");
    ASSERT_EQ(host("DWELL60000"), "");
    ASSERT_EQ(host("CLOSE R"), "");
    EXPECT_EQ(host("UNDEFINE ALL"), "ERR001") << "#" << motor;
    EXPECT_EQ(host("#" + motor + "->"), "5X");
  }
}

// `happens` at the nth time that a start of &1 lets interrupts come, for each n.
template <typename Prepare>
void start_meanwhile(const Prepare& prepare, void (*happens)(), void (*expect)(firmware_error_t error, bool ran)) {
  static void (*event)();
  static unsigned left;
  static bool ran;
  event = happens;
  unsigned times = 0;
  for (bool came = true; came; ++times) {
    platform::power_up();
    ASSERT_NO_FATAL_FAILURE(prepare());
    left = times + 1;
    fake_hal_on_unmask([] {
      if (--left != 0) return;
      fake_hal_on_unmask(nullptr);
      ran = run_is_running(0);
      event();
    });
    const firmware_error_t error = run_start(0, false);
    fake_hal_on_unmask(nullptr);
    came = left == 0;
    if (came) expect(error, ran);
  }
  EXPECT_GT(times, 3u) << "nothing has come in between";
}

// firmware:4.10: the errors of R are those of the moment in which it starts the program.
TEST_F(RunControl, AStartLooksAtMotorsAtLast) {
  const auto prepare = [] {
    ASSERT_EQ(host("&1#1->X"), "");
    motors[0].loop = LOOP_CLOSED;
    open();
    ASSERT_EQ(host("CLOSE"), "");
  };
  start_meanwhile(
      prepare, [] { motors[0].loop = LOOP_KILLED; },
      [](firmware_error_t error, bool ran) { EXPECT_EQ(error, ran ? ERR_NONE : ERR_OPEN_LOOP); });
  start_meanwhile(
      prepare, [] { ASSERT_TRUE(jog_stop_at(0, 1)); },  // as at a limit
      [](firmware_error_t error, bool ran) { EXPECT_EQ(error, ran ? ERR_NONE : ERR_MOVE_IN_PROGRESS); });
}

TEST_F(RunControl, AProgramThatEndsDuringItsStartIsNotBegunAnew) {
  start_meanwhile(
      [] {
        ASSERT_EQ(host("OPEN PROG 1 CLEAR P1=P1+1 DWELL100 CLOSE B1R"), "");
        platform::servo_ticks(30);
        ASSERT_TRUE(run_is_running(0));
      },
      [] { platform::servo_ticks(1000); },
      [](firmware_error_t error, bool) {
        EXPECT_EQ(error, ERR_NONE);
        EXPECT_FALSE(run_is_running(0));
        platform::servo_ticks(30);
        EXPECT_EQ(host("P1"), "1");
      });
}

}  // namespace
