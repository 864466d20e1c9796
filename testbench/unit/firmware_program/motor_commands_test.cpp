// Commands of single motors (motion:4.2): every form of a jog, its end to a 1/3072 count, and its errors.
#include <cmath>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/base/float48.h"
#include "firmware/base/status.h"
#include "firmware/command/control_characters.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
}

namespace {

using platform::host;

constexpr double kUnits = 32 * 96;

class MotorCommands : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I100=1 I119=1 I120=0 I121=10 I122=20 I192=2 I116=32 I111=0 I112=0"), "");
    run(3);
  }
  static void run(unsigned cycles) { platform::servo_ticks(cycles); }
  static void settle() {
    run(20);
    for (int i = 0; i < 200000 && jog_is_moving(0); ++i) run(1);
    ASSERT_FALSE(jog_is_moving(0));
  }
  static double commanded() { return static_cast<double>(motors[0].trajectory) / kUnits; }
  static void jog(const std::string& line, double expected) {
    ASSERT_EQ(host(line), "") << line;
    settle();
    EXPECT_EQ(commanded(), expected) << line;
  }
};

TEST_F(MotorCommands, FirstJogClosesTheLoop) {
  ASSERT_EQ(motors[0].loop, LOOP_KILLED);
  ASSERT_EQ(host("#1J/"), "");
  EXPECT_EQ(motors[0].loop, LOOP_CLOSED);
  settle();
  ASSERT_EQ(host("K"), "");
  EXPECT_EQ(motors[0].loop, LOOP_KILLED);
  ASSERT_EQ(host("J:1"), "");
  EXPECT_EQ(motors[0].loop, LOOP_CLOSED);
}

TEST_F(MotorCommands, EachFormGoesWhereItSays) {
  jog("#1J/", 0);
  jog("J:1000", 1000);
  jog("J:-250.25", 749.75);
  jog("J=0", 0);
  jog("J=-1234.5", -1234.5);
  jog("J=$100", 256);
  jog("J:100J:100", 356);
  jog("J^10", 10);  // the encoder stands at 0
}

// motion:4.1/4: the time of its coordinate system, of none that of &1, whenever it is told to which it belongs.
TEST_F(MotorCommands, GoesByTheTimeOfItsCoordinateSystem) {
  for (const char* line : {"I5194=8388607 I5294=8388607 I5394=8388607", "&1%25", "&2%50", "&3%75"})
    ASSERT_EQ(host(line), "") << line;
  const auto speed = [] {
    run(200);
    const double before = commanded();
    run(100);
    return (commanded() - before) / (100 * platform::kDefaultI10 / 8388608.0);
  };
  ASSERT_EQ(host("&2#1->X #1J+"), "");
  EXPECT_NEAR(speed(), 10, 0.01);
  ASSERT_EQ(host("#1->0"), "");
  EXPECT_NEAR(speed(), 5, 0.01) << "of none";
  ASSERT_EQ(host("&3#1->X"), "");
  EXPECT_NEAR(speed(), 15, 0.01);
  ASSERT_EQ(host("UNDEFINE ALL"), "");
  EXPECT_NEAR(speed(), 5, 0.01);
  ASSERT_EQ(host("&2#1->X"), "");
  ASSERT_EQ(host("I100=0 I100=1 #1J+"), "");
  EXPECT_NEAR(speed(), 10, 0.01) << "activated behind its definition";
  ASSERT_EQ(host("#1K SAVE"), "");
  platform::reset();
  for (const char* line : {"&2%50", "#1J+"}) ASSERT_EQ(host(line), "") << line;
  EXPECT_NEAR(speed(), 10, 0.01) << "of a definition that was saved";
}

// The trajectory is what jogs go by (motion:1.2/4): from where it is means less the master and what is added.
TEST_F(MotorCommands, FromWhereItIsLeavesMasterAndCompensationOut) {
  jog("#1J/", 0);
  motors[0].master = static_cast<std::int64_t>(1000 * kUnits);
  motors[0].compensation = static_cast<std::int64_t>(30 * kUnits);
  jog("J^10", 10 - 1000 - 30);  // the encoder stands at 0
}

TEST_F(MotorCommands, StarTakesTheDistanceOfTheRegister) {
  const float48 word = float48_pack(-77.75);
  *hal_x(0xD7) = word.x;
  *hal_y(0xD7) = word.y;
  jog("#1J=*", -77.75);
  jog("J:*", -155.5);
  jog("J^*", -77.75);
  jog("J=100", 100);
  ASSERT_EQ(host("I200=1 I211=0 I219=1 I220=0 I221=10 I222=20 I292=2 M1->L:$157 M1=42"), "");
  ASSERT_EQ(host("#2J=*"), "");
  run(500);
  EXPECT_EQ(motors[1].trajectory, 42 * 3072) << "each motor has its own";
}

TEST_F(MotorCommands, JEqualsGoesBackToWhereItWasBeforeItJogged) {
  jog("#1J=", 0);
  jog("J=500", 500);
  jog("J:77", 577);
  jog("J=", 0);
  jog("J==300", 300);
  jog("J=500", 500);
  jog("J=", 300);
  ASSERT_EQ(host("J=500"), "");
  jog("#1J= P1=7", 300);
  EXPECT_EQ(host("P1"), "7") << "another command behind it";
  EXPECT_EQ(host("J=P1"), "ERR003") << "no distance";
  ASSERT_EQ(host("HMZ"), "");
  EXPECT_EQ(commanded(), 0);
  jog("J=50", 50);
  jog("J=", 0);
}

TEST_F(MotorCommands, JBangRoundsToAWholeCountAtRestOnly) {
  jog("#1J=10.5J!", 10.5);
  jog("J!", 11);
  jog("J=-3.25", -3.25);
  jog("J!", -3);
  ASSERT_EQ(host("J+"), "");
  run(100);
  const double before = commanded();
  ASSERT_NE(before, std::round(before));
  ASSERT_EQ(host("J!"), "");
  EXPECT_EQ(commanded(), before);
}

TEST_F(MotorCommands, EndlessJogsGoUntilTheyAreStopped) {
  for (const int sign : {1, -1}) {
    ASSERT_EQ(host(sign > 0 ? "#1J+" : "#1J-"), "");
    run(1000);
    const double before = commanded();
    run(100);
    EXPECT_NEAR(commanded() - before, sign * 20.0 * 100 * platform::kDefaultI10 / 8388608.0, 1.0 / 16);
    EXPECT_FALSE(motors[0].status.timed_move);
    ASSERT_EQ(host("J/"), "");
    settle();
  }
}

TEST_F(MotorCommands, Errors) {
  for (const char* line : {"#1J", "J=X", "J:", "J^", "J=1^", "J+^5", "J==", "J:99999999999", "OX"})
    EXPECT_EQ(host(line), "ERR003") << line;
  EXPECT_EQ(motors[0].loop, LOOP_KILLED) << "nothing was closed for what is wrong";
  for (const char* line :
       {"#2J+", "#2J/", "#2J=1", "#2J:1", "#2J^1", "#2J=*", "#2J=", "#2J!", "#2HM", "#2HMZ", "#2O1", "#2$", "#2$*"})
    EXPECT_EQ(host(line), "ERR013") << line;
  EXPECT_EQ(host("#1O"), "ERR003");
  EXPECT_EQ(host("HOME1"), "ERR005");
}

TEST_F(MotorCommands, AMotorOfARunningProgramIsThePrograms) {
  ASSERT_EQ(host("&1#1->X"), "");
  coordinate_systems[0].running = true;
  for (const char* line : {"#1J+", "J/", "J=1", "HM", "HMZ", "K", "O1", "$", "$*"})
    EXPECT_EQ(host(line), "ERR001") << line;
  ASSERT_EQ(host("I100=0"), "");
  EXPECT_EQ(host("J+"), "ERR013") << "it comes first";
  ASSERT_EQ(host("I100=1"), "");
  status_show(STATUS_NO_PHASE_CLOCK, true);
  EXPECT_EQ(host("J+"), "ERR001") << "before ERR018";
  status_show(STATUS_NO_PHASE_CLOCK, false);
  coordinate_systems[0].held = true;
  EXPECT_EQ(host("J=1"), "ERR001") << "not at rest yet";
  coordinate_systems[0].increment = coordinate_systems[0].increment_target = 0;
  for (const char* line : {"HM", "HMZ", "K", "O1", "$", "$*"}) EXPECT_EQ(host(line), "ERR001") << line;
  ASSERT_EQ(host("J=25"), "") << "jogged away from where it is held";
  settle();
  EXPECT_EQ(commanded(), 25);
  ASSERT_EQ(host("J="), "");
  settle();
  EXPECT_EQ(commanded(), 0);
  coordinate_systems[0].running = false;
}

TEST_F(MotorCommands, WithoutClocksNoneIsEnabled) {
  status_set(STATUS_NO_PHASE_CLOCK);
  for (const char* line : {"#1J+", "J/", "J=1", "HM", "O1", "&1E"}) EXPECT_EQ(host(line), "ERR018") << line;
  EXPECT_EQ(motors[0].loop, LOOP_KILLED);
}

TEST_F(MotorCommands, OpenLoopTakesPerCentOfIxx69) {
  ASSERT_EQ(host("#1I169=20000 O50"), "");
  EXPECT_EQ(motors[0].loop, LOOP_OPEN);
  EXPECT_EQ(motors[0].open_output, 10000 * 256);
  ASSERT_EQ(host("O-12.5"), "");
  EXPECT_EQ(motors[0].open_output, -2500 * 256);
  for (const int sign : {1, -1}) {
    ASSERT_EQ(host(sign > 0 ? "O100" : "O-100"), "");
    EXPECT_EQ(motors[0].open_output, sign * 20000 * 256);
    ASSERT_EQ(host("O0"), "");
    ASSERT_EQ(host(sign > 0 ? "O100.5" : "O-1000"), "") << "more is as much";
    EXPECT_EQ(motors[0].open_output, sign * 20000 * 256);
  }
  ASSERT_EQ(host("J/"), "");
  EXPECT_EQ(motors[0].loop, LOOP_CLOSED);
}

// motion:6.2/3
TEST_F(MotorCommands, InALimitNoLoopIsOpened) {
  ASSERT_EQ(host("#1J/"), "");
  for (const bool up : {true, false}) {
    auto& limit = up ? motors[0].found.positive_limit : motors[0].found.negative_limit;
    limit = true;
    EXPECT_EQ(host("O5"), "ERR010");
    EXPECT_EQ(host("O-5"), "ERR010");
    EXPECT_EQ(motors[0].loop, LOOP_CLOSED);
    limit = false;
  }
  ASSERT_EQ(host("O5"), "");
}

TEST_F(MotorCommands, OpenLoopEndsAJog) {
  ASSERT_EQ(host("#1J+"), "");
  run(500);
  ASSERT_EQ(host("O0"), "");
  EXPECT_FALSE(jog_is_moving(0));
  ASSERT_EQ(host("J+"), "");
  run(500);
  ASSERT_EQ(host("K"), "");
  EXPECT_FALSE(jog_is_moving(0));
}

double step_of(unsigned motor) {
  const std::int64_t before = motors[motor].trajectory;
  platform::servo_ticks(1);
  return static_cast<double>(motors[motor].trajectory - before) / kUnits;
}

class MotorStops : public MotorCommands {
 protected:
  // #1 of &1, #2 of none jog; #3 is open, #4 killed, both of &1.
  void SetUp() override {
    MotorCommands::SetUp();
    ASSERT_EQ(host("&1#1->X #3->Y #4->Z I200=1 I300=1 I400=1 I219=1 I220=0 I221=10 I222=20 I292=2 I115=.5 I215=.5"),
              "");
    ASSERT_EQ(host("I211=0 I311=0 I411=0 #3O1 #1J+ #2J-"), "");
    run(200);
    ASSERT_GT(step_of(0), 8);
    ASSERT_LT(step_of(1), -8);
  }
  static constexpr double kMs = platform::kDefaultI10 / 8388608.0;
};

TEST_F(MotorStops, AbortRampsAtIxx15AndClosesLoops) {
  const double before = commanded();
  ASSERT_EQ(host("&1A"), "");
  run(150);
  EXPECT_EQ(step_of(0), 0);
  EXPECT_NEAR(commanded() - before, 20 * 20 / (2 * .5), 20 * 5.5 * kMs) << "and a little until it begins";
  EXPECT_LT(step_of(1), -8) << "of no coordinate system";
  EXPECT_EQ(motors[0].loop, LOOP_CLOSED);
  EXPECT_EQ(motors[2].loop, LOOP_CLOSED);
  EXPECT_EQ(motors[3].loop, LOOP_CLOSED);
}

// What its program homes is a move of the system, of whomever the motor is; what somebody jogs is none.
TEST_F(MotorStops, AbortStopsMotorsOfNoSystemThatItsProgramHomes) {
  ASSERT_EQ(host("I223=20 #1J/#2J/ &1E"), "");
  run(300);
  for (const char* line : {"OPEN PROG 1 CLEAR", "HOME2", "CLOSE"}) ASSERT_EQ(host(line), "") << line;
  for (const char* meanwhile : {"", "#2J-"}) {
    ASSERT_EQ(host("&1B1R"), "");
    run(200);
    ASSERT_GT(step_of(1), 8);
    ASSERT_EQ(host(meanwhile), "");
    run(300);
    const bool searches = jog_is_homing(1);
    ASSERT_EQ(searches, *meanwhile == 0);
    ASSERT_EQ(host("&1A"), "");
    run(150);
    EXPECT_EQ(step_of(1) == 0, searches);
    EXPECT_FALSE(jog_is_homing(1));
    EXPECT_FALSE(motors[1].status.home_complete);
  }
}

// What its program homes may be jogged by somebody until the search begins: an abort before that stops it as one behind
// it does, and nothing is searched afterwards.
TEST_F(MotorStops, AbortForgetsAHomeThatWouldTakeTheMotorFromAJog) {
  ASSERT_EQ(host("I223=20 I5192=50 #1J/#2J/ &1E"), "");
  run(300);
  for (const char* line : {"OPEN PROG 1 CLEAR", "HOME2", "CLOSE"}) ASSERT_EQ(host(line), "") << line;
  int found = 0;  // aborts before a search
  for (int wait = 0; wait < 12; ++wait) {
    ASSERT_EQ(host("#2J-"), "");
    run(300);
    ASSERT_LT(step_of(1), -8);
    ASSERT_EQ(host("&1B1R"), "");
    run(wait);
    const bool searches = jog_is_homing(1);
    ASSERT_EQ(host("&1A"), "");
    run(300);
    EXPECT_FALSE(jog_is_homing(1)) << wait;
    found += searches ? 0 : 1;
  }
  EXPECT_GT(found, 2);
}

// motion:8.1/7, motion:8.1/8: so does a run-time error, by a bit that anybody may write while the motor moves.
TEST_F(MotorStops, ARunTimeErrorStopsMotorsOfNoSystemThatItsProgramHomes) {
  ASSERT_EQ(host("I223=20 #1J/#2J/ &1E"), "");
  run(300);
  for (const char* line : {"OPEN PROG 1 CLEAR", "HOME2", "CLOSE", "&1B1R"}) ASSERT_EQ(host(line), "") << line;
  run(200);
  ASSERT_GT(step_of(1), 8);
  ASSERT_EQ(host("WY$203F,$400000"), "");
  run(300);
  EXPECT_EQ(step_of(1), 0);
  EXPECT_FALSE(jog_is_homing(1));
}

// The motor has been asked to go before the servo interrupt with which the move begins.
TEST_F(MotorStops, AbortStopsWhatItsProgramIsAboutToHome) {
  ASSERT_EQ(host("I223=20 #1J/#2J/ &1E"), "");
  run(300);
  for (const char* line : {"OPEN PROG 1 CLEAR", "HOME2", "CLOSE", "&1B1R"}) ASSERT_EQ(host(line), "") << line;
  for (int i = 0; i < 100 && !jog_is_moving(1); ++i) run(1);
  ASSERT_TRUE(jog_is_moving(1) && !coordinate_systems[0].active);
  ASSERT_EQ(host("&1A"), "");
  run(150);
  EXPECT_EQ(step_of(1), 0);
  EXPECT_FALSE(jog_is_homing(1));
}

// A motor that another program homes has come to rest, so that its own may run meanwhile.
TEST_F(MotorStops, AbortLeavesAMotorToItsOwnSystem) {
  ASSERT_EQ(host("&2#2->X I123=20 I223=20 I222=20 #1J/#2J/ &1E"), "");
  run(300);
  for (const char* move : {"RAPID X100000", "HOME2"}) {
    for (const char* line : {"&1 OPEN PROG 1 CLEAR", "HOME1,2", "CLOSE", "OPEN PROG 2 CLEAR", "INC", move, "CLOSE"})
      ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("&1B1R"), "");
    run(200);
    ASSERT_TRUE(jog_is_homing(0) && jog_is_homing(1));
    ASSERT_EQ(host("#2J/"), "");
    run(300);
    ASSERT_EQ(host("&2B2R"), "");
    run(200);
    ASSERT_GT(step_of(1), 8);
    ASSERT_EQ(host("&1A"), "");
    run(300);
    EXPECT_EQ(step_of(0), 0) << move;
    EXPECT_GT(step_of(1), 8) << move;
    ASSERT_EQ(host("&2A"), "");
    run(300);
    EXPECT_EQ(step_of(1), 0) << move;
  }
}

TEST_F(MotorStops, I36SparesKilledMotorsAndEEnablesThem) {
  ASSERT_EQ(host("I36=1 &1A"), "");
  run(150);
  EXPECT_EQ(motors[2].loop, LOOP_CLOSED) << "enabled, in open loop";
  EXPECT_EQ(motors[3].loop, LOOP_KILLED);
  ASSERT_EQ(host("#2K &1E"), "");
  EXPECT_EQ(motors[3].loop, LOOP_CLOSED);
  EXPECT_EQ(motors[1].loop, LOOP_KILLED) << "of no coordinate system";
}

TEST_F(MotorStops, ReferencesOfASystemAreThoseOfItsMotors) {
  ASSERT_EQ(host("#1J/#2J/#3K"), "");
  run(300);
  ASSERT_NE(motors[0].trajectory, 0);
  const std::int64_t second = motors[1].trajectory;
  ASSERT_EQ(host("&1$$*"), "");
  EXPECT_EQ(motors[0].loop, LOOP_KILLED);
  EXPECT_EQ(motors[0].actual, 0);
  EXPECT_EQ(motors[1].loop, LOOP_CLOSED) << "of no coordinate system";
  EXPECT_EQ(motors[1].trajectory, second);
  jog("#1J=", 0);
  ASSERT_EQ(host("#1J/"), "");
  run(10);
  ASSERT_EQ(host("&1$$"), "") << "nothing to search for";
  EXPECT_EQ(motors[1].loop, LOOP_CLOSED);
}

TEST_F(MotorStops, ControlAAbortsMotorsOfNoSystemToo) {
  ASSERT_EQ(host("&3#6->X I600=1 I611=0 I615=.5 I619=1 I620=0 I621=10 I622=20 I692=2 #6J+"), "");
  run(200);
  ASSERT_GT(step_of(5), 8);
  ASSERT_FALSE(control_character(0x01));
  run(150);
  for (const unsigned motor : {0u, 1u, 2u, 3u, 5u}) {
    EXPECT_EQ(step_of(motor), 0) << motor;
    EXPECT_EQ(motors[motor].loop, LOOP_CLOSED) << motor;
  }
  EXPECT_EQ(motors[4].loop, LOOP_KILLED) << "not activated";
}

TEST_F(MotorStops, ControlKKillsAll) {
  ASSERT_EQ(host("#3J/"), "");
  ASSERT_FALSE(control_character(0x0B));
  for (const unsigned motor : {0u, 1u, 2u, 3u}) {
    EXPECT_EQ(motors[motor].loop, LOOP_KILLED) << motor;
    EXPECT_FALSE(jog_is_moving(motor)) << motor;
  }
}

TEST_F(MotorStops, ControlOHoldsNoJog) {
  ASSERT_FALSE(control_character(0x0F));
  run(3000);
  EXPECT_NEAR(step_of(0), 20 * kMs, 1.0 / 16);
}

TEST_F(MotorStops, AMotorInALineOfAPlcIsJogged) {
  for (const char* line : {"I5=2", "OPEN PLC 3 CLEAR", "CMD\"#1J/#2J/\"", "DISABLE PLC 3", "CLOSE", "ENABLE PLC 3"})
    ASSERT_EQ(host(line), "") << line;
  for (int i = 0; i < 300; ++i) {
    run(1);
    platform::background(1);
  }
  EXPECT_EQ(step_of(0), 0);
  EXPECT_EQ(step_of(1), 0);
}

}  // namespace
