// What kinematic programs are refused for, and what stops one (motion:8.1/6 to motion:8.1/8).
#include "testbench/unit/firmware_kinematics/arm.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/system_path.h"
}

namespace {

using namespace moving_motors;
using arm::Arm;

class KinematicStops : public Arm {
 protected:
  // A run that ends with an error, at rest, with what was calculated lost; #3 of &2 moves on all the while.
  static void stops_with(run_time_error error, const Lines& lines = {"TM400 TA100 TS0", "X300 Y-200"}) {
    ASSERT_EQ(host("I300=1 I311=0 I312=0 I316=1000000 I317=1000000 I68=1 I5213=5"), "");
    ASSERT_EQ(host("&2#3->1000X"), "");
    motors[2] = {};
    motors[2].loop = LOOP_CLOSED;
    motors[2].position_scale = 96;
    motors[2].cs = 1;
    store({"TM100 TA50 TS0 INC P9=0 WHILE(P9<20)", "X1 P9=P9+1", "ENDWHILE"}, 2);
    store(lines);
    ASSERT_EQ(host("&1B1R&2B2R"), "");
    for (int i = 0; i < 10000 && run_is_running(0); ++i) platform::servo_ticks(3);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(cs().error, error);
    EXPECT_NE(motion_cs_status(0, 1) >> 22 & 1u, 0u);
    EXPECT_EQ(host("RY$2014"), std::to_string(error));
    platform::servo_ticks(1500);  // ramps
    const double stands = at(1);
    platform::servo_ticks(30);
    EXPECT_EQ(at(1), stands) << "it is at rest";
    for (int i = 0; i < 5000 && run_is_running(1); ++i) platform::servo_ticks(3);
    EXPECT_EQ(coordinate_systems[1].error, RUN_TIME_NONE);
    EXPECT_EQ(at(3), 20000) << "another system is not touched";
  }
};

TEST_F(KinematicStops, AProgramThatNeverEnds) {
  fit_arm();
  program("INVERSE", {"WHILE(1=1)", "ENDWHILE"});
  ASSERT_EQ(host("I5113=10"), "");
  stops_with(RUN_TIME_KINEMATIC);
}

TEST_F(KinematicStops, AWordThatIsNoStatement) {
  fit_arm();
  ASSERT_EQ(host("I5113=10"), "");
  user_memory_write(fixed_program_find(FIXED_INVERSE, 0)->base, WORD_START_OF_LINE | 8ull << 43 | 1ull << 40);
  stops_with(RUN_TIME_STATEMENT);
}

TEST_F(KinematicStops, InTheMiddleOfAPath) {
  fit_arm();
  Lines late = arm::inverse();
  late.push_back("WHILE(P5>20)");
  late.push_back("ENDWHILE");
  program("INVERSE", late);
  ASSERT_EQ(host("I5113=10"), "");
  const double from = at(1);
  stops_with(RUN_TIME_KINEMATIC);
  EXPECT_GT(std::abs(at(1) - from), 500) << "it was on its way";
}

// From its speed to rest at Ixx15.
TEST_F(KinematicStops, MotorsRamp) {
  fit_arm();
  Lines late = arm::inverse();
  late.insert(late.end(), {"IF(P5>40)", "P1=1/0", "ENDIF"});
  program("INVERSE", late);
  ASSERT_EQ(host("I5113=10 I115=0.5 I215=0.5"), "");
  store({"TM400 TA100 TS0", "X300 Y-200"});
  ASSERT_EQ(host("&1B1R"), "");
  for (int i = 0; i < 3000 && run_is_running(0); ++i) platform::servo_ticks(1);
  EXPECT_EQ(cs().error, RUN_TIME_KINEMATIC);
  const double from = at(1);
  platform::servo_ticks(1);
  const double speed = std::abs(at(1) - from) / kTickMs;
  EXPECT_GT(speed, 20);
  platform::servo_ticks(2000);
  EXPECT_NEAR(std::abs(at(1) - from), speed * speed / (2 * 0.5), 2 * speed * kTickMs + 1);
}

TEST_F(KinematicStops, AForwardProgramThatNeverEnds) {
  fit_arm();
  program("FORWARD", {"WHILE(1=1)", "Q7=1", "ENDWHILE"});
  const double stands = at(1);
  stops_with(RUN_TIME_KINEMATIC);
  EXPECT_EQ(at(1), stands);
  ASSERT_EQ(host("&1PMATCH"), "");
  platform::servo_ticks(600);
  EXPECT_EQ(cs().error, RUN_TIME_KINEMATIC) << "PMATCH says so too";
  EXPECT_FALSE(run_is_running(0));
}

// What stopped a program stays whatever a PMATCH finds; of its own one takes back what another has said.
TEST_F(KinematicStops, PmatchLeavesTheErrorOfAProgram) {
  fit_arm();
  const auto match = [&](bool fails) {
    program("FORWARD", fails ? Lines{"Q7=1/0", "WHILE(1=1)", "ENDWHILE"} : Lines{"Q7=1"});
    ASSERT_EQ(host("&1PMATCH"), "");
    platform::servo_ticks(600);
  };
  const auto start = [&] {
    program("FORWARD", {"Q7=1"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(600);
  };
  store({"CALL99"});
  start();
  ASSERT_EQ(cs().error, RUN_TIME_PROGRAM);
  for (const bool fails : {false, true, false, true, true, false}) {
    match(fails);
    EXPECT_EQ(cs().error, RUN_TIME_PROGRAM) << fails;
  }
  store({"P1=1"});
  start();
  EXPECT_EQ(cs().error, RUN_TIME_NONE) << "the next start takes it back";
  for (const bool fails : {true, false, true}) {
    match(fails);
    EXPECT_EQ(cs().error, fails ? RUN_TIME_KINEMATIC : RUN_TIME_NONE);
  }
  store({"CALL99"});
  start();
  ASSERT_EQ(cs().error, RUN_TIME_PROGRAM);
  match(false);
  EXPECT_EQ(cs().error, RUN_TIME_PROGRAM) << "a start lies between them";
}

// A long program is none that never ends.
TEST_F(KinematicStops, ALongOneEnds) {
  fit_arm();
  Lines with = arm::inverse();
  with.insert(with.begin(), {"Q50=0", "WHILE(Q50<400)", "Q50=Q50+1", "ENDWHILE"});
  program("INVERSE", with);
  store({"TM400 TA100 TS0", "X300 Y-200"});
  run();
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(hand().x, 300, 1e-3);
}

// Where the clock stands, words count, 5000 of them: one, then 3, 4 and 1 a turn, so the last is the end of an
// assignment.
TEST_F(KinematicStops, WordsCountWhereTheClockStands) {
  fit_arm();
  program("FORWARD", {"P8=8", "WHILE(1=1)", "P9=P9+1", "ENDWHILE"});
  ASSERT_EQ(host("P9=0 &1PMATCH"), "");
  platform::servo_ticks(600);
  EXPECT_EQ(cs().error, RUN_TIME_KINEMATIC);
  EXPECT_EQ(p(9), (5000 - 1 + 1) / 8);
}

// A start that its forward program fails is over with that: the program does not run once more, as of a PMATCH.
TEST_F(KinematicStops, AStartThatFailsIsNoPmatch) {
  fit_arm();
  program("FORWARD", {"P4=P4+1", "WHILE(1=1)", "ENDWHILE"});
  store({"DWELL100"});
  ASSERT_EQ(host("P4=0 &1B1R"), "");
  platform::servo_ticks(300);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(cs().error, RUN_TIME_KINEMATIC);
  EXPECT_EQ(p(4), 1);
}

// A PMATCH that waits when R comes is what R does itself: the forward program runs once for both.
TEST_F(KinematicStops, AStartTakesThePlaceOfAPmatchThatWaits) {
  unsigned before = 0, behind = 0;
  for (unsigned n = 1; n < 60; ++n) {
    platform::power_up();
    fit_arm();
    store({"DWELL100"});
    ASSERT_EQ(host("&1B1 P4=0 PMATCH"), "");
    static unsigned left;
    static bool ran, waited;
    left = n;
    fake_hal_on_unmask([] {
      if (--left != 0) return;
      fake_hal_on_unmask(nullptr);
      ran = run_is_running(0);
      platform::real_time();
      waited = p(4) != 0;
    });
    const firmware_error_t error = run_start(0, false);
    fake_hal_on_unmask(nullptr);
    if (left != 0 || ran) break;
    EXPECT_EQ(error, ERR_NONE);
    platform::servo_ticks(30);
    EXPECT_EQ(p(4), waited ? 2 : 1) << n;
    (waited ? before : behind)++;
  }
  EXPECT_GT(before, 0u);
  EXPECT_GT(behind, 0u) << "R has begun to look at the motors anew";
}

// Of the time of slices, one after the other: the same 800 words with looks at the clock that take 20 and 3000 cycles.
TEST_F(KinematicStops, TimeCounts) {
  for (const unsigned cycles : {20u, 3000u}) {
    SCOPED_TRACE(cycles);
    platform::power_up();
    fit_arm();
    program("INVERSE", {"Q50=0", "WHILE(Q50<100)", "Q50=Q50+1", "ENDWHILE", "P1=Q7", "P2=Q8 P5=P5+1"});
    store({"TM50 TA20 TS0", "X300 Y-200"});
    ASSERT_EQ(host("&1B1R"), "");
    fake_hal_on_pause([] {});
    fake_hal_slices_leave(true);
    fake_hal_set_look(cycles);
    for (int i = 0; i < 10000 && p(5) == 0 && cs().error == RUN_TIME_NONE; ++i) fake_task_run_real_time();
    fake_hal_slices_leave(false);
    fake_hal_on_pause(nullptr);
    fake_hal_set_look(100);
    EXPECT_EQ(cs().error, cycles < 1000 ? RUN_TIME_NONE : RUN_TIME_KINEMATIC);
    EXPECT_EQ(p(5), cycles < 1000 ? 1 : 0);
  }
}

// motion:8.1/7: 10 ms, of the time of slices, from the beginning of the inverse program to its end.
TEST_F(KinematicStops, TenMillisecondsAreTheMost) {
  fit_arm();
  program("INVERSE", {"P5=1", "WHILE(1=1)", "ENDWHILE"});
  store({"TM50 TA20 TS0", "X300 Y-200"});
  ASSERT_EQ(host("&1B1R"), "");
  fake_hal_on_pause([] {});
  fake_hal_slices_leave(true);
  fake_hal_set_look(1000);
  std::uint32_t begun = 0;
  for (int i = 0; i < 10000 && cs().error == RUN_TIME_NONE; ++i) {
    fake_task_run_real_time();
    if (p(5) != 0 && begun == 0) begun = slice_spent();
  }
  const double spent = (slice_spent() - begun) / static_cast<double>(hal_cycles_per_ms());
  fake_hal_slices_leave(false);
  fake_hal_on_pause(nullptr);
  fake_hal_set_look(100);
  EXPECT_EQ(cs().error, RUN_TIME_KINEMATIC);
  EXPECT_NEAR(spent, 10, 0.5);
}

// While a program of &1 runs away, a motor of &2 begins its ramp.
TEST_F(KinematicStops, RampsDoNotWait) {
  fit_arm();
  program("INVERSE", {"WHILE(1=1)", "ENDWHILE"});
  ASSERT_EQ(host("I300=1 I311=0 I312=0 I315=1 I322=20 I319=1 I68=1"), "");
  ASSERT_EQ(host("&2#3->1000X"), "");
  ASSERT_EQ(host("#3->"), "1000X");
  ASSERT_EQ(axis_definitions[2].cs, 1u);
  motors[2] = {};
  motors[2].loop = LOOP_CLOSED;
  motors[2].position_scale = 96;
  motors[2].cs = 1;
  ASSERT_EQ(host("#3J+"), "");
  platform::servo_ticks(300);
  store({"TM50 TA20 TS0", "X300 Y-200"});
  ASSERT_FALSE(jog_is_moving(0) || jog_is_moving(1));
  ASSERT_EQ(host("&1B1R"), "");
  fake_hal_on_pause([] {});
  fake_hal_slices_leave(true);
  for (int i = 0; i < 300; ++i) fake_task_run_real_time();  // within the program
  ASSERT_EQ(host("#3J/"), "");
  double before = at(3);
  int still = 0;
  for (int i = 0; i < 1500 && still < 2; ++i) {
    fake_task_run_real_time();
    platform::servo_ticks(1);
    still = at(3) == before ? still + 1 : 0;
    before = at(3);
  }
  EXPECT_TRUE(run_is_running(0)) << "the program still runs away";
  fake_hal_slices_leave(false);
  fake_hal_on_pause(nullptr);
  EXPECT_EQ(still, 2) << "20 counts a ms at 1 a ms^2 is 20 ms, 45 servo interrupts";
}

// 1/0 is 2^47 (firmware:10/9): no position of a motor.
TEST_F(KinematicStops, ADivisionByZero) {
  for (const char* isx13 : {"0", "10"}) {
    SCOPED_TRACE(isx13);
    platform::power_up();
    fit_arm();
    program("INVERSE", {"P1=Q8/0", "P2=0"});
    ASSERT_EQ(host(std::string("I5113=") + isx13), "");
    stops_with(RUN_TIME_KINEMATIC);
  }
}

// motion:8.1/7: 2^47 units are 45812984490.67 counts of 3072 units.
TEST_F(KinematicStops, PositionsHave47Bits) {
  const std::pair<const char*, bool> cases[] = {
      {"2*22906492245", true}, {"2*22906492246", false}, {"-2*22906492245", true}, {"-2*22906492246", false}};
  for (const auto& [counts, fits] : cases) {
    SCOPED_TRACE(counts);
    platform::power_up();
    fit({"I"});
    program("FORWARD", {"Q7=P1/1000"});
    program("INVERSE", {std::string("P1=") + counts});
    ASSERT_EQ(host("I5150=1"), "");
    store({"TM1000 TA500", "X1"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(30);
    EXPECT_EQ(cs().error, fits ? RUN_TIME_NONE : RUN_TIME_KINEMATIC);
  }
}

// motion:8.1/10
TEST_F(KinematicStops, ATriggerBehindAnAxisIsARunTimeError) {
  for (const char* isx50 : {"1", "0"}) {
    SCOPED_TRACE(isx50);
    platform::power_up();
    fit_arm({400, 100}, {"1000Z"});
    ASSERT_EQ(host(std::string("I322=100 I5150=") + isx50), "");
    store({"RAPID Z1^1"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(30);
    EXPECT_EQ(cs().error, *isx50 == '1' ? RUN_TIME_STATEMENT : RUN_TIME_NONE);
  }
}

// What could not be solved is not executed, in cubics neither: no motor moves at all.
TEST_F(KinematicStops, NothingMovesByASolutionThatFailed) {
  const Lines programs[] = {
      {"PVT100", "X390:-200", "X370:0"}, {"SPLINE1 TM100", "X390", "X370"}, {"TM100 TA50", "X390"}};
  for (const Lines& lines : programs) {
    SCOPED_TRACE(lines.front());
    platform::power_up();
    fit_arm();
    program("INVERSE", {"P1=Q8/0", "P2=0"});
    store(lines);
    const double stands = at(1), other = at(2);
    ASSERT_EQ(host("&1B1R"), "");
    bool moved = false;
    for (int i = 0; i < 1000; ++i) {
      platform::servo_ticks(1);
      moved = moved || at(1) != stands || at(2) != other;
    }
    EXPECT_FALSE(moved);
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(cs().error, RUN_TIME_KINEMATIC);
  }
}

// The idiom of the field: the program finds that there is no such place and sets bit 22 of word 2 itself.
TEST_F(KinematicStops, AProgramThatSetsTheErrorBit) {
  for (const char* isx13 : {"0", "10"}) {
    SCOPED_TRACE(isx13);
    platform::power_up();
    fit_arm();
    ASSERT_EQ(host(std::string("I5113=") + isx13), "");
    stops_with(RUN_TIME_BY_USER, {"TM400 TA100 TS0", "X600 Y100"});
  }
}

TEST_F(KinematicStops, AHostThatSetsTheErrorBit) {
  fit_arm();
  ASSERT_EQ(host("M5182=1"), "");
  EXPECT_EQ(cs().error, RUN_TIME_NONE) << "nothing runs";
  store({"TM400 TA100 TS0", "X300 Y-200"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(300);
  EXPECT_TRUE(run_is_running(0)) << "what was set before the start means nothing";
  ASSERT_EQ(host("WY$203F,$BFFFFF WX$203F,$FFFFFF"), "");
  platform::servo_ticks(3);
  EXPECT_TRUE(run_is_running(0)) << "other bits mean nothing";
  ASSERT_EQ(host("M5182=1"), "");
  platform::servo_ticks(3);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(cs().error, RUN_TIME_BY_USER);
}

// PVT, SPLINE, RAPID, PSET, DELAY: whatever asks.
TEST_F(KinematicStops, InEachMode) {
  const Lines programs[] = {{"PVT100", "X600:0"}, {"SPLINE1 TM100", "X600"}, {"RAPID X600"}, {"PSET X600"}};
  for (const Lines& lines : programs) {
    SCOPED_TRACE(lines.front());
    platform::power_up();
    fit_arm();
    const std::int64_t bias = motors[0].bias;
    stops_with(RUN_TIME_BY_USER, lines);
    EXPECT_EQ(motors[0].bias, bias);
  }
}

TEST_F(KinematicStops, AnErrorStaysUntilTheNextStart) {
  fit_arm();
  stops_with(RUN_TIME_BY_USER, {"TM400 TA100 TS0", "X600 Y100"});
  store({"TM100 TA50 TS0", "X350"});
  run();
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(hand().x, 350, 1e-3);
}

TEST_F(KinematicStops, WhatIsNotThereIsRefused) {
  fit({"I", "I"});
  store({"TM100 TA50 TS0", "X350"});
  ASSERT_EQ(host("I5150=1"), "");
  EXPECT_EQ(host("B1R"), "ERR015");
  EXPECT_EQ(host("B1S"), "ERR015");
  EXPECT_EQ(host("PMATCH"), "ERR015");
  program("FORWARD", arm::forward());
  EXPECT_EQ(host("B1R"), "ERR015") << "without an inverse program";
  EXPECT_EQ(host("PMATCH"), "ERR015");
  program("INVERSE", arm::inverse());
  EXPECT_EQ(host("PMATCH"), "");
  ASSERT_EQ(host("OPEN INVERSE"), "");
  EXPECT_EQ(host("PMATCH"), "ERR015") << "while it is open";
  ASSERT_EQ(host("CLEAR CLOSE I5150=0 B1"), "");
  EXPECT_EQ(host("PMATCH"), "") << "nothing is asked for";
  EXPECT_EQ(host("R"), "");
}

TEST_F(KinematicStops, AForwardProgramAloneIsEnoughForDefinedMotors) {
  fit({"1000X"});
  store({"TM100 TA50 TS0", "X3"});
  program("FORWARD", {"Q7=P1/1000 P4=P4+1"});
  ASSERT_EQ(host("I5150=1"), "");
  run();
  EXPECT_EQ(p(4), 1);
  EXPECT_EQ(at(1), 3000);
}

TEST_F(KinematicStops, BlocksThatDoNotFitTogether) {
  fit_arm();
  store({"TM100 TA50 TS0", "X350"});
  ASSERT_EQ(host("OPEN INVERSE CLEAR"), "");
  ASSERT_EQ(host("WHILE(1=1)"), "");
  EXPECT_EQ(host("CLOSE"), "ERR009");
  EXPECT_EQ(host("B1R"), "ERR016");
  EXPECT_EQ(host("PMATCH"), "ERR016");
}

TEST_F(KinematicStops, PmatchWhileMovesExecute) {
  fit_arm();
  store({"TM400 TA100 TS0", "X300 Y-200"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(300);
  EXPECT_EQ(host("PMATCH"), "ERR001");
  platform::servo_ticks(ticks_of(400));
  EXPECT_NEAR(hand().x, 300, 1e-3);
}

// R, or PMATCH once more, while the forward program of PMATCH stands in a slice: it begins anew.
TEST_F(KinematicStops, WhatComesInTheMiddleOfPmatch) {
  fit_arm();
  store({"TM20 TA10 TS0", "X350"});
  for (const bool starts : {true, false}) {
    unsigned within = 0;
    for (unsigned slices = 1; slices < 200; slices += 3) {
      SCOPED_TRACE(testing::Message() << (starts ? "R" : "PMATCH") << " behind " << slices << " slices");
      put(arm::joints({400, 100}));
      ASSERT_EQ(host("&1B1 PMATCH"), "");
      fake_hal_on_pause([] {});
      fake_hal_slices_leave(true);
      for (unsigned i = 0; i < slices && cs().matching; ++i) fake_task_run_real_time();
      const bool left = cs().matching;
      within += left ? 1u : 0u;
      put(arm::joints({420, 50}));
      EXPECT_EQ(starts ? run_start(0, false) : run_match(0), ERR_NONE);
      fake_hal_slices_leave(false);
      fake_hal_on_pause(nullptr);
      for (int i = 0; i < 500 && (run_is_running(0) || cs().matching); ++i) platform::servo_ticks(1);
      ASSERT_EQ(cs().error, RUN_TIME_NONE);
      ASSERT_NEAR(axis(AXIS_Y), 50, 1e-4);
      ASSERT_NEAR(hand().x, starts ? 350 : 420, 1e-3);
      ASSERT_NEAR(hand().y, 50, 1e-3);
      if (!left) break;
    }
    EXPECT_GT(within, 20u);
  }
}

// In a running program, behind a DWELL: one that comes while another is being worked out counts too.
TEST_F(KinematicStops, PmatchOnceMoreInARunningProgram) {
  fit_arm();
  Lines tool = arm::forward();
  tool[0] += "+P10";
  program("FORWARD", tool);
  ASSERT_EQ(host("P10=0"), "");
  store({"TM50 TA20 TS0", "X390", "DWELL3000"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(200));
  ASSERT_TRUE(run_is_running(0));
  unsigned within = 0;
  for (unsigned at_pause = 1; at_pause < 400; at_pause += 3) {
    SCOPED_TRACE(at_pause);
    ASSERT_EQ(host("P10=50 PMATCH"), "");
    unsigned pauses = 0;
    for (int i = 0; i < 3; ++i)
      platform::real_time_in_slices([&] {
        if (++pauses != at_pause || !cs().matching) return;
        ++within;
        p_variable_write(10, 80);
        ASSERT_EQ(run_match(0), ERR_NONE);
      });
    ASSERT_FALSE(cs().matching);
    ASSERT_EQ(cs().error, RUN_TIME_NONE);
    ASSERT_NEAR(axis(AXIS_X), hand().x + p(10), 1e-4);
    if (pauses < at_pause) break;
  }
  EXPECT_GT(within, 20u);
  EXPECT_EQ(p(10), 50) << "the last one was left alone";
}

// While the first move of a sequence that goes on in motion is calculated: it waits until one ends at rest.
TEST_F(KinematicStops, PmatchWhileAPvtMoveIsCalculated) {
  unsigned accepted = 0;
  for (unsigned at_pause = 1; at_pause < 400; ++at_pause) {
    SCOPED_TRACE(at_pause);
    platform::power_up();
    fit({"1000X"});
    store({"PVT100", "X5:100", "X15:100", "X20:0", "X10:0"});
    ASSERT_EQ(host("&1B1R"), "");
    unsigned pauses = 0;
    for (int i = 0; i < 3 && pauses < at_pause; ++i)
      platform::real_time_in_slices([&] { accepted += ++pauses == at_pause && run_match(0) == ERR_NONE; });
    double highest = 0;
    for (int i = 0; i < 2000 && run_is_running(0); ++i) {
      if (cs().matching && cs().started > 3) ADD_FAILURE() << "it waits longer than it has to";
      platform::servo_ticks(1);
      highest = std::max(highest, at(1));
    }
    ASSERT_EQ(cs().error, RUN_TIME_NONE);
    ASSERT_EQ(at(1), 10000);
    ASSERT_NEAR(highest, 20000, 60);
    ASSERT_FALSE(cs().matching);
    if (pauses < at_pause) break;
  }
  EXPECT_GT(accepted, 10u);
}

// In a held program the motors are not the program's: one that jogs is not taken from its jog.
TEST_F(KinematicStops, PmatchWhileAMotorOfAHeldProgramJogs) {
  fit_arm();
  ASSERT_EQ(host("I122=100 I119=10 I5195=200000 I5194=200000"), "");
  store({"TM50 TA20 TS0", "X390", "DWELL1000", "X350"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(200));
  ASSERT_EQ(host("H"), "");
  platform::servo_ticks(ticks_of(100));
  const double from = at(1);
  ASSERT_EQ(host("#1J:3000"), "");
  platform::servo_ticks(20);
  EXPECT_EQ(host("PMATCH"), "ERR011");
  platform::servo_ticks(ticks_of(300));
  EXPECT_NEAR(at(1), from + 3000, 1e-3) << "the jog has come to its end";
  EXPECT_EQ(host("PMATCH"), "");
  platform::servo_ticks(30);
  const arm::Point stands = hand();
  EXPECT_NEAR(axis(AXIS_X), stands.x, 1e-4);
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(ticks_of(1500));
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(hand().x, 350, 1e-3);
  EXPECT_NEAR(hand().y, stands.y, 1e-3);
}

// An abort at any pause of a program: nothing of it is left, and the next run is as the first.
TEST_F(KinematicStops, AnAbortInTheMiddle) {
  fit_arm();
  ASSERT_EQ(host("I5113=10"), "");
  store({"TM100 TA50 TS0", "X350", "X300"});
  for (unsigned at_pause = 1; at_pause < 200; at_pause += 7) {
    ASSERT_EQ(host("&1B1R"), "");
    unsigned pauses = 0;
    for (int i = 0; i < 60 && pauses < at_pause; ++i) {
      platform::real_time_in_slices([&] {
        if (++pauses == at_pause) run_abort(0);
      });
      platform::servo_ticks(1);
    }
    platform::servo_ticks(1200);
    EXPECT_FALSE(run_is_running(0));
  }
  run();
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_NEAR(hand().x, 300, 1e-3);
}

TEST_F(KinematicStops, AnAbortOnThePath) {
  fit_arm();
  ASSERT_EQ(host("I5113=10 I115=1 I215=1"), "");
  store({"TM400 TA100 TS0", "X300 Y-200"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(500);
  ASSERT_EQ(host("A"), "");
  platform::servo_ticks(600);
  EXPECT_FALSE(run_is_running(0));
  const arm::Point stood = hand();
  ASSERT_EQ(host("PMATCH"), "");
  platform::servo_ticks(3);
  EXPECT_NEAR(axis(AXIS_X), stood.x, 1e-4);
  EXPECT_NEAR(axis(AXIS_Y), stood.y, 1e-4);
  run();
  EXPECT_NEAR(hand().x, 300, 1e-3);
}

// motion:5.4/6 in joints: without the real-time task each goes on at its own last velocity, 20 and 20 counts a ms, not
// along the program, which has joint 1 by the square of X.
TEST_F(KinematicStops, PvtRunsOnMotorByMotor) {
  fit({"I", "I"});
  program("FORWARD", {"Q7=SQRT(P1/1000) Q8=P2/1000"});
  program("INVERSE", {"P1=Q7*Q7*1000 P2=Q8*1000 P101=2000*Q7*Q17 P102=1000*Q18"});
  ASSERT_EQ(host("I5150=1 I5190=1000"), "");
  store({"PVT100", "X1:10 Y2:20", "WHILE(P9=0) WAIT"});
  ASSERT_EQ(host("&1B1R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  for (double t = 0; t < 250; t += kTickMs) {
    if (t > 100) {
      ASSERT_NEAR(at(1), 1000 + 20 * (t - 100), 3 / kUnit) << t;
      ASSERT_NEAR(at(2), 2000 + 20 * (t - 100), 3 / kUnit) << t;
    }
    system_path_servo();
  }
}

// motion:8.1/4: P101 on are of PVT alone, in other moves they are the user's.
TEST_F(KinematicStops, VelocitiesOfOtherMovesAreNotLookedAt) {
  for (const char* isx13 : {"0", "5"}) {
    platform::power_up();
    fit({"I"});
    program("FORWARD", {"Q7=P1/1000"});
    program("INVERSE", {"P1=Q7*1000 P101=1000000*1000000*1000000"});
    ASSERT_EQ(host(std::string("I5150=1 I5113=") + isx13), "");
    store({"TM100 TA20 TS0 X1"});
    run();
    EXPECT_EQ(cs().error, RUN_TIME_NONE) << isx13;
    EXPECT_NEAR(at(1), 1000, 1e-3);
    store({"PVT100 X0:0"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(30);
    EXPECT_EQ(cs().error, RUN_TIME_KINEMATIC) << isx13;
  }
}

}  // namespace
