// Compensation tables (motion:1.4) by their part of the net desired position, natively.
#include <string>
#include <utility>

#include "testbench/unit/firmware_servo/desired_position_rig.h"

extern "C" {
#include "firmware/motion/compensation.h"
}

namespace brick {
namespace {

// Entries are sixteenths of a count at the end of each of four parts of 1000 counts; between them it is a line.
TEST_F(DesiredPosition, PositionTables) {
  ASSERT_EQ(c_.line("#1 DEFINE COMP 4,#2D,#1,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  close();
  const auto at = [this](double source) {
    desired(source, 1);
    return desired(0);
  };
  EXPECT_EQ(at(250), 0) << "I51=0";
  c_.line("I51=1");
  struct {
    double source, value;
  } const points[] = {{0, 0},    {125, 5},  {250, 10},  {375, 2.5}, {500, -5},   {750, 3},
                      {1125, 5}, {1000, 0}, {-750, 10}, {-500, -5}, {100000, 0}, {100250, 10}};
  for (const auto& p : points) EXPECT_NEAR(at(p.source), p.value, 0.005) << p.source;
  EXPECT_NEAR(at(999), 3 + (1 - 3) * 0.996, 0.01);
  c_.line("I30=1");
  EXPECT_NEAR(at(0), 1, 0.005) << "the last entry";
  EXPECT_NEAR(at(125), 5.5, 0.005);
  EXPECT_NEAR(static_cast<double>(motors[0].compensation) / kCount, 5.5, 0.005);
  EXPECT_EQ(c_.line("RX$90"), "0");
  EXPECT_NEAR(std::stod(c_.line("RY$90")) / kCount, 5.5, 0.005) << "what is added";
  c_.line("#1 DELETE COMP");
  EXPECT_EQ(at(125), 0);
}

// The loop is closed where the motor stands, tables or not.
TEST_F(DesiredPosition, ALoopIsClosedWhereTheMotorIsInSpiteOfTables) {
  ASSERT_EQ(c_.line("#1 DEFINE COMP 4,#2,#1,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  c_.line("I51=1");
  close();
  *hal_x(0x10F1) = 250 * 32;
  desired(0, 1);
  position_loop_servo(1);
  EXPECT_NEAR(desired(0), 10, 0.005);
  *hal_x(0x10F0) = 300 * 32;
  position_loop_servo(0);
  motor_kill(0);
  position_loop_servo(0);
  close();
  EXPECT_EQ(motors[0].commanded, 300 * kCount);
  EXPECT_EQ(desired(static_cast<double>(motors[0].trajectory) / kCount), 300);
  EXPECT_EQ(motors[0].desired_step, 0);
}

// So it is behind a way that the motor was turned while it was killed, which its table sees, and P with it.
TEST_F(DesiredPosition, ATableSeesAMotorThatIsTurnedByHand) {
  ASSERT_EQ(c_.line("#1 DEFINE COMP 4,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  c_.line("I51=1");
  close();
  c_.servo(2);
  motor_kill(0);
  *hal_x(0x10F0) = 250 * 32;
  c_.servo(2);
  EXPECT_EQ(c_.line("#1P"), "240") << "10 counts of it are the screw's";
  ASSERT_TRUE(motor_close(0));
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(motors[0].commanded, 250 * kCount);
    c_.servo(1);
    EXPECT_EQ(motors[0].desired_step, 0);
  }
  EXPECT_EQ(c_.line("#1P"), "240");
}

// Tables that are made anew leave the backlash that is taken up, of a killed motor too.
TEST_F(DesiredPosition, OtherTablesLeaveTheBacklashOfAKilledMotor) {
  c_.line("I185=8388607 I186=80 I187=0");
  close();
  EXPECT_EQ(desired(0), 0);
  desired_position_pass();
  EXPECT_EQ(desired(-1), -6) << "downwards";
  *hal_x(0x10F0) = static_cast<std::uint32_t>(-6 * 32) & HAL_WORD_MASK;
  c_.servo(1);
  motor_kill(0);
  c_.line("I208=48");
  c_.servo(1);
  EXPECT_EQ(c_.line("#1P"), "-1");
  ASSERT_EQ(c_.line("#1 DEFINE COMP 1,1000"), "");
  c_.line("16 I51=1");
  c_.servo(1);
  ASSERT_EQ(c_.line("#1 DELETE COMP"), "");
  c_.servo(1);
  EXPECT_EQ(c_.line("#1P"), "-1") << "its own table is gone";
  ASSERT_TRUE(motor_close(0));
  c_.servo(1);
  EXPECT_EQ(motors[0].commanded, -6 * kCount);
  motor_kill(0);
  c_.line("I208=96 I185=0");
  c_.servo(1);
  EXPECT_EQ(c_.line("#1P"), "-6") << "it is off";
}

// motion:1.4/4: three tables of one target.
TEST_F(DesiredPosition, TablesOfOneTargetAddUp) {
  ASSERT_EQ(c_.line("#3 DEFINE COMP 2,#3,#1,1000"), "");
  ASSERT_EQ(c_.line("64 0"), "");
  ASSERT_EQ(c_.line("#2 DEFINE COMP 2,#1D,#1,2000"), "");
  ASSERT_EQ(c_.line("32 32"), "");
  ASSERT_EQ(c_.line("#1 DEFINE COMP 4,#2D,#1,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  c_.line("I51=1");
  close();
  desired(250, 1);
  motors[2].actual = 500 * kCount;
  EXPECT_NEAR(desired(0), 14, 0.005);
  EXPECT_NEAR(desired(500), 514 + 1, 0.005) << "that of motor 1 by where it is without corrections";
  EXPECT_NEAR(desired(1000), 1014 + 2, 0.005);
}

// motion:1.4/2: with D by trajectory and master, before corrections and filter, in the same interrupt.
TEST_F(DesiredPosition, ATableByTheDesiredPositionTakesTheOneBeforeCorrections) {
  ASSERT_EQ(c_.line("#1 DEFINE COMP 2,#1D,#1,2000"), "");
  ASSERT_EQ(c_.line("1600 0"), "");  // 100 counts at 1000
  master(0);
  c_.line("I51=1 I105=$10F5 I107=96 I106=1");
  close();
  EXPECT_NEAR(desired(500), 550, 0.005);
  master(100);
  EXPECT_NEAR(desired(500), 660, 0.005);
  master(0);
  c_.line("I140=0.5");
  EXPECT_NEAR(desired(100), (660 + 110) / 2.0, 0.005);
}

// motion:1.4/7: HMZ says where the motor is; no table sends it elsewhere for that.
TEST_F(DesiredPosition, HmzMovesNoMotorWithATable) {
  for (const std::string source : {"#1D", "#1"}) {
    SCOPED_TRACE(source);
    ASSERT_EQ(c_.line("I51=0 #1 DEFINE COMP 4," + source + ",#1,1000"), "");
    ASSERT_EQ(c_.line("160 -80 48 0"), "");
    c_.line("I51=1 I30=0");
    *hal_x(0x10F0) = 0;
    c_.servo(2);
    ASSERT_EQ(c_.line("#1$*"), "");
    close();
    motors[0].trajectory = 250 * kCount;
    std::int64_t word = 0;
    const auto follow = [&] {  // the motor is where it is commanded to be
      word += motors[0].commanded / 96 - motors[0].actual / 96;
      *hal_x(0x10F0) = static_cast<std::uint32_t>(word) & HAL_WORD_MASK;
      c_.servo(1);
    };
    for (int i = 0; i < 60; ++i) follow();
    ASSERT_NEAR(static_cast<double>(motors[0].actual) / kCount, 260, 0.7) << "9.4 at 259.4, by the actual position";
    ASSERT_EQ(c_.line("#1HMZ"), "");
    EXPECT_NEAR(std::stod(c_.line("#1P")), 0, 1 / 16.0);
    for (int i = 0; i < 5; ++i) {
      follow();
      EXPECT_LE(std::abs(motors[0].desired_step), 96) << "1/32 count";
    }
    EXPECT_NEAR(static_cast<double>(motors[0].commanded) / kCount, 0, 1 / 16.0) << "no correction at zero";
    EXPECT_NEAR(std::stod(c_.line("#1P")), 0, 1 / 16.0);
    motor_kill(0);
    c_.line("#1 DELETE COMP");
  }
}

// Whenever an interrupt comes in which the master moves the motor on: the tables are those of where it is then. With
// one at each look it is not looked for ever.
TEST_F(DesiredPosition, HmzLooksAtTablesWhereTheMotorIsByThen) {
  static unsigned left, came, every;
  ASSERT_EQ(c_.line("I51=0 #1 DEFINE COMP 4,#1D,#1,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 0"), "");
  c_.line("I51=1 I30=0 I105=$10F5 I106=3");
  const auto zero = [&](unsigned first, bool again) {
    motor_kill(0);
    *hal_x(0x10F0) = 0;
    master(0);
    c_.servo(2);
    ASSERT_EQ(c_.line("#1$*"), "");
    close();
    c_.servo(1);
    left = first;
    every = again ? 1 : 0;
    came = 0;
    fake_hal_on_unmask([] {
      if (left == 0 || --left != 0) return;
      left = every;
      master(25 * ++came);
      fake_task_run_servo();
    });
    const std::string answer = c_.line("#1HMZ");
    fake_hal_on_unmask(nullptr);
    ASSERT_EQ(answer, "");
  };
  unsigned places = 0;
  for (; places < 1000; ++places) {
    ASSERT_NO_FATAL_FAILURE(zero(places + 1, false));
    if (came == 0) break;
    c_.servo(1);
    EXPECT_LE(std::abs(motors[0].desired_step), 96) << "1/32 count, interrupt " << places;
  }
  EXPECT_GT(places, 2u);
  ASSERT_NO_FATAL_FAILURE(zero(1, true));
  EXPECT_GE(came, 4u) << "looks";
  EXPECT_LT(came, places + 20);
  motor_kill(0);
  c_.line("#1 DELETE COMP");
}

// Of an open loop the actual position is 0, and its table knows that at once: it adds nothing there, by the desired
// position neither. At 250 that one adds 4 % of what is left: 250/1.04.
TEST_F(DesiredPosition, HmzOfAKilledMotorWithATable) {
  const std::pair<std::string, double> sources[] = {{"#1", 240.0}, {"#1D", 250 / 1.04}};
  for (const auto& [source, there] : sources)
    for (const std::string command : {"#1HMZ", "#1$*"}) {
      SCOPED_TRACE(source + " " + command);
      motor_kill(0);
      ASSERT_EQ(c_.line("I51=0 #1 DEFINE COMP 4," + source + ",#1,1000"), "");
      ASSERT_EQ(c_.line("160 -80 48 16"), "");
      *hal_x(0x10F0) = 0;
      c_.servo(2);
      ASSERT_EQ(c_.line("#1$*"), "");
      c_.servo(2);
      c_.line("I51=1");
      *hal_x(0x10F0) = 250 * 32;
      c_.servo(20);
      ASSERT_NEAR(std::stod(c_.line("#1P")), there, 1 / 16.0);
      ASSERT_EQ(c_.line(command), "");
      EXPECT_EQ(motors[0].compensation, 0);
      EXPECT_EQ(c_.line("#1P"), "0");
      c_.servo(1);
      EXPECT_EQ(c_.line("#1P"), "0");
      ASSERT_EQ(c_.line("#1J="), "");
      c_.servo(100);
      EXPECT_EQ(motors[0].commanded, 0) << "where it was before it was jogged";
      motor_kill(0);
      ASSERT_EQ(c_.line("#1 DELETE COMP"), "");
    }
}

// Before any servo interrupt has seen the table, at 250: by the actual position 10, else 250 (1 - 1/1.04).
TEST_F(DesiredPosition, ALoopIsClosedWithWhatItsTableAddsThere) {
  *hal_x(0x10F0) = 250 * 32;
  const std::pair<std::string, double> sources[] = {{"#1", 10.0}, {"#1D", 250 - 250 / 1.04}};
  for (const auto& [source, added] : sources) {
    SCOPED_TRACE(source);
    motor_kill(0);
    c_.servo(2);
    ASSERT_EQ(c_.line("#1 DEFINE COMP 4," + source + ",#1,1000"), "");
    ASSERT_EQ(c_.line("160 -80 48 16 I51=1"), "");
    close();
    EXPECT_NEAR(static_cast<double>(motors[0].compensation) / kCount, added, 1 / 32.0);
    EXPECT_EQ(motors[0].commanded, 250 * kCount);
    EXPECT_EQ(motors[0].trajectory + motors[0].compensation, 250 * kCount);
    ASSERT_EQ(c_.line("I51=0 #1 DELETE COMP"), "");
    EXPECT_EQ(motors[0].compensation, 0);
  }
}

// A table that is deleted while it works works no more, whatever command has deleted it.
TEST_F(DesiredPosition, ADeletedTableCorrectsNoMore) {
  *hal_x(0x10F0) = 250 * 32;
  for (const char* command : {"#1 DELETE COMP", "DELETE ALL"}) {
    motor_kill(0);
    c_.servo(2);
    ASSERT_EQ(c_.line("#1 DEFINE COMP 4,1000"), "");
    ASSERT_EQ(c_.line("160 -80 48 16 I51=1"), "");
    close();
    ASSERT_NE(motors[0].compensation, 0);
    ASSERT_EQ(c_.line(command), "");
    c_.servo(1);
    EXPECT_EQ(motors[0].compensation, 0) << command;
  }
}

// firmware:5.7: bit 14 of global status word 1 follows I51.
TEST_F(DesiredPosition, StatusTellsWhetherTablesCorrect) {
  for (const char* i51 : {"0", "1", "1", "0"}) {
    c_.line(std::string("I51=") + i51);
    EXPECT_EQ(std::stoul(c_.line("RHX$6"), nullptr, 16) >> 14 & 1u, *i51 == '1' ? 1u : 0u);
  }
}

// Tables go while the servo task works: a motor whose own are not gone yet is corrected as before, whichever set of
// them is made anew.
TEST_F(DesiredPosition, TablesThatGoAreWholeUntilThen) {
  static bool seen;
  ASSERT_EQ(c_.line("#2 DEFINE COMP 4,#1D,#2,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  ASSERT_EQ(c_.line("#1 DEFINE COMP 4,#1D,#1,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  close();
  for (int turn = 0; turn < 4; ++turn) {
    c_.line("I51=1");
    if (turn % 2 == 1) compensation_changed();  // the other set
    ASSERT_NEAR(desired(250), 260, 0.005);
    ASSERT_NEAR(desired(0, 1), 10, 0.005);
    seen = false;
    fake_hal_on_unmask([] {
      if ((compensation_of_position & 2u) == 0 || (compensation_of_position & 1u) != 0) return;
      seen = true;  // the first has gone, the second not yet
      desired_position_servo(1);
      EXPECT_NEAR(static_cast<double>(motors[1].compensation) / kCount, 10, 0.005);
    });
    c_.line("I51=0");
    fake_hal_on_unmask(nullptr);
    EXPECT_TRUE(seen);
    EXPECT_EQ(desired(250), 250);
    EXPECT_EQ(desired(0, 1), 0);
    EXPECT_EQ(motors[1].compensation, 0);
  }
}

// Entries are of the target's counts, the span of the source's; Ixx08 of either may change.
TEST_F(DesiredPosition, TablesGoByTheScalesOfBothMotors) {
  ASSERT_EQ(c_.line("#1 DEFINE COMP 4,#2D,#1,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  c_.line("I51=1 I108=24 I208=192");
  close();
  const auto at = [](double source) {
    motors[1].trajectory = std::llround(source * 32 * 192);
    desired_position_servo(1);
    motors[0].trajectory = 0;
    desired_position_servo(0);
    return static_cast<double>(motors[0].commanded) / (32 * 24);
  };
  EXPECT_NEAR(at(250), 10, 0.01);
  EXPECT_NEAR(at(625), -1, 0.01);
  EXPECT_NEAR(at(-750), 10, 0.01);
}

// D:$90 of a motor without tables is the user's: added to where it shall be, and hidden from what is reported.
TEST_F(DesiredPosition, ACompensationThatIsWrittenIsAdded) {
  close();
  EXPECT_EQ(desired(5), 5);
  c_.line("WY$90," + std::to_string(3 * kCount));
  EXPECT_EQ(desired(5), 8);
  *hal_x(0x10F0) = 8 * 32;
  position_loop_servo(0);
  EXPECT_EQ(c_.line("#1P"), "5");
}

// Whatever else makes its position: what is not of tables and backlash stays.
TEST_F(DesiredPosition, ACompensationThatIsWrittenStays) {
  close();
  c_.line("WY$90," + std::to_string(3 * kCount));
  c_.line("I105=$10F5 I106=1 I140=0.000001");
  EXPECT_NEAR(desired(5), 8, 0.001) << "a master, a filter";
  ASSERT_EQ(c_.line("#2 DEFINE COMP 4,1000"), "");
  ASSERT_EQ(c_.line("160 -80 48 16"), "");
  c_.line("I51=1 I208=48");
  EXPECT_NEAR(desired(5), 8, 0.001) << "another motor's tables";
  c_.line("#2 DELETE COMP");
  EXPECT_NEAR(desired(5), 8, 0.001);
}

TEST_F(DesiredPosition, TorqueTables) {
  ASSERT_EQ(c_.line("#1 DEFINE TCOMP 2,1000"), "");
  ASSERT_EQ(c_.line("25600 51200"), "");
  c_.line("I51=1 I130=10000 I131=0 I132=0 I133=0");
  close();
  *hal_x(0x10F0) = 500 * 32;
  const double bits = 100 * 10000 * 96 / 524288.0;
  desired(600);
  position_loop_servo(0);
  EXPECT_NEAR(motors[0].output / 256.0, bits + 100, 0.1);
  desired(400);
  position_loop_servo(0);
  EXPECT_NEAR(motors[0].output / 256.0, -bits - 100, 0.1);
  desired(500);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].output, 0) << "no sign, no torque";
  c_.line("#2 DEFINE TCOMP 2,1000");
  c_.line("256 256");
  desired(600);
  position_loop_servo(0);
  EXPECT_NEAR(motors[0].output / 256.0, bits + 100, 0.1) << "of another motor";
}

TEST_F(DesiredPosition, BacklashTables) {
  ASSERT_EQ(c_.line("#1 DEFINE BLCOMP 2,1000"), "");
  ASSERT_EQ(c_.line("16 48"), "");
  c_.line("I51=1 I185=8388607 I186=80 I187=0");
  close();
  EXPECT_EQ(desired(500), 500);
  *hal_x(0x10F0) = 900 * 32;
  position_loop_servo(0);
  desired_position_pass();
  EXPECT_NEAR(desired(499), 499 - 5 - 1, 0.01) << "where it is asked to be, not where it is";
  desired_position_pass();
  EXPECT_NEAR(desired(250), 250 - 5 - 0.5, 0.01);
}

}  // namespace
}  // namespace brick
