// Phase references natively (motion:3.5): what says that one is missing, absolute sensors, and searches with a motor of
// the plant that turns.
#include <algorithm>
#include <cmath>
#include <string>

#include "testbench/plant/motor.h"
#include "testbench/unit/firmware_platform/commutation_rig.h"

extern "C" {
#include "firmware/motion/motor_state.h"
#include "firmware/motion/phase_search.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/protection.h"
}

namespace brick {
namespace {

class Phasing : public CommutationRig {
 protected:
  void TearDown() override { EXPECT_FALSE(fake_hal_masked()) << "a section that holds a task off was not left"; }
};

TEST_F(Phasing, IsMissingForSynchronousMotors) {
  EXPECT_TRUE(phasing_is_missing(0));
  EXPECT_FALSE(phasing_is_missing(1)) << "not commutated";
  set("I201=1 I301=1 I401=1 I378=0.001 I496=1");
  EXPECT_TRUE(phasing_is_missing(1));
  EXPECT_FALSE(phasing_is_missing(2)) << "induction motor";
  EXPECT_FALSE(phasing_is_missing(3)) << "micro-steps";
  phasing_set_missing(1, false);
  set("I201=3 I278=0");
  EXPECT_FALSE(phasing_is_missing(1)) << "it was commutated before";
  set("I201=0 I378=0");
  set("I201=1");
  EXPECT_TRUE(phasing_is_missing(1));
  EXPECT_TRUE(phasing_is_missing(2));
}

// A motor that becomes one whose reference is missing is not controlled any more.
TEST_F(Phasing, ALoopIsOpenedThatNeedsOne) {
  set("I200=1 I224=$120001");
  ASSERT_TRUE(motor_close(1));
  set("I201=2 I270=4");
  EXPECT_EQ(motors[1].loop, LOOP_CLOSED) << "not commutated";
  set("I278=0.001 I201=1");
  EXPECT_EQ(motors[1].loop, LOOP_CLOSED) << "an induction motor";
  set("I278=0");
  EXPECT_EQ(motors[1].loop, LOOP_KILLED);
  set("I201=0");
  ASSERT_TRUE(motor_close(1));
  set("I201=1");
  EXPECT_EQ(motors[1].loop, LOOP_KILLED);
}

TEST_F(Phasing, IsMissingAfterAReset) {
  phasing_set_missing(0, false);
  set("SAVE");
  c_.restart();
  EXPECT_TRUE(phasing_is_missing(0));
  EXPECT_FALSE(motor_close(0));
}

TEST_F(Phasing, StaysMissingWithoutAWayToFindIt) {
  EXPECT_FALSE(phasing_begin(0));  // Ixx74 = 0
  set("I174=8 I173=2000 I171=0");
  EXPECT_FALSE(phasing_begin(0)) << "without a cycle there is no angle";
  set("I181=$10F1 I191=$800000");
  set_x(0x10F1, 3 << 20);
  EXPECT_FALSE(phasing_begin(0)) << "nor with a sensor";
  set("I171=1000 I181=$10F1 I191=$730000");
  EXPECT_FALSE(phasing_begin(0)) << "a format that is not read";
  set("I191=$400007");
  EXPECT_FALSE(phasing_begin(0));
  EXPECT_TRUE(phasing_is_missing(0));
  EXPECT_FALSE(phasing_is_searched(0));
}

// A program that knows the angle by itself writes the phase position and clears the bit: M171 and M148 of the usual
// set.
TEST_F(Phasing, AUserWhoHasSetThePositionClearsTheError) {
  set("M148->Y:$C0,8 M171->X:$B4,0,24,S M171=123 M148=0");
  EXPECT_FALSE(phasing_is_missing(0));
  EXPECT_EQ(c_.line("M148 M171"), "0|123");
  EXPECT_TRUE(motor_close(0));
  set("M148=1");
  EXPECT_TRUE(phasing_is_missing(0));
  EXPECT_EQ(c_.line("#1?").substr(9, 1), "1");
  set("M5->Y:$C0,10 M5=0");  // another bit of the word
  EXPECT_TRUE(phasing_is_missing(0));
}

TEST_F(Phasing, SetphaseTakesIxx75AtOnce) {
  set("I171=1000 I175=300");
  stand_at(-77);
  phasing_set_here(1);
  phase();
  EXPECT_EQ(x_word(kPosition), 300);
  set("I175=900");
  phasing_set_here(1);
  phase();
  EXPECT_EQ(x_word(kPosition), -100);
  set("I201=1 I271=1000 I275=77 I301=1 I371=1000 I375=78 I401=1 I471=1000 I475=79");
  EXPECT_EQ(c_.line("SETPHASE1,3..4"), "");
  phase();
  EXPECT_EQ(x_word(kPosition + 0x80), 0);
  EXPECT_EQ(x_word(kPosition + 0x100), 78);
  EXPECT_EQ(x_word(kPosition + 0x180), 79);
  EXPECT_EQ(c_.line("SETPHASE33"), "ERR003");
  EXPECT_EQ(c_.line("SETPHASE"), "ERR003");
  set("OPEN PLC 1 CLEAR SETPHASE2 DISABLE PLC 1 CLOSE I5=3 ENABLE PLC 1");
  EXPECT_EQ(c_.line("LIST PLC 1"), "SETPHASE2|DISPLC1|RET");
  c_.servo(20);
  set("");
  phase();
  EXPECT_EQ(x_word(kPosition + 0x80), 77);
  set("I171=16000000 I175=12000000");
  phasing_set_here(1);
  phase();
  EXPECT_EQ(x_word(kPosition), -4000000);
}

// The lists of the data sheet: states U V W for 0-60, 60-120, ... degrees.
class Halls : public Phasing {
 protected:
  // Phase position in degrees 0..360 that state U V W gives.
  double degrees(const std::string& format, unsigned uvw) {
    set("I171=3600 I181=$10F1 I191=" + format);
    set_x(0x10F1, static_cast<std::int64_t>(uvw) << 20 | 0x8FFFF);
    phasing_set_missing(0, true);
    (void)phasing_begin(0);
    EXPECT_FALSE(phasing_is_missing(0)) << format << " state " << uvw;
    phase();
    const double found = x_word(kPosition) / 10.0;
    return found < 0 ? found + 360 : found;
  }
};

TEST_F(Halls, StatesAreThoseOfTheDataSheet) {
  const unsigned up[] = {3, 2, 6, 4, 5, 1}, down[] = {1, 5, 4, 6, 2, 3};
  for (unsigned sector = 0; sector < 6; ++sector) {
    EXPECT_NEAR(degrees("$800000", up[sector]), 60 * sector + 30, 0.1);
    EXPECT_NEAR(degrees("$C00000", down[sector]), 60 * sector + 30, 0.1);
    // 11/64 of a cycle are 61.9 degrees: the list begins one sector later.
    EXPECT_NEAR(degrees("$8B0000", up[sector]), std::fmod(60 * sector + 30 + 61.875, 360), 0.1);
    EXPECT_NEAR(degrees("$CB0000", down[sector]), std::fmod(60 * sector + 30 + 61.875, 360), 0.1);
    EXPECT_NEAR(degrees("$AB0000", up[sector]), std::fmod(60 * sector + 30 + 43 * 5.625, 360), 0.1);
  }
}

TEST_F(Halls, ImpossibleStatesAreRefused) {
  set("I171=3600 I181=$10F1 I191=$800000");
  for (const unsigned uvw : {0u, 7u}) {
    set_x(0x10F1, static_cast<std::int64_t>(uvw) << 20);
    EXPECT_FALSE(phasing_begin(0));
    EXPECT_TRUE(phasing_is_missing(0));
  }
}

// `$` begins without a reference, and what does not end with one leaves the motor killed.
TEST_F(Halls, AnImpossibleStateTakesTheReferenceAway) {
  EXPECT_NEAR(degrees("$800000", 3), 30, 0.1);
  ASSERT_EQ(motors[0].loop, LOOP_CLOSED);
  set_x(0x10F1, 7 << 20);
  EXPECT_EQ(c_.line("#1$"), "ERR018");
  EXPECT_TRUE(phasing_is_missing(0));
  EXPECT_EQ(motors[0].loop, LOOP_KILLED);
  EXPECT_EQ(c_.line("#1J/"), "ERR018");
}

TEST_F(Halls, AreReadAtPowerOnIfIxx80SaysSo) {
  for (const int mode : {0, 1, 5}) {
    set("I171=3600 I181=$78000 I191=$800000 I124=$120001 I180=" + std::to_string(mode) + " SAVE");
    set_x(0x78000, 6 << 20);
    c_.restart();
    EXPECT_EQ(phasing_is_missing(0), mode != 1) << mode;
    EXPECT_EQ(motors[0].loop, mode == 1 ? LOOP_CLOSED : LOOP_KILLED) << mode;
    phase();
    if (mode == 1) { EXPECT_EQ(x_word(kPosition), 1500); }
  }
}

TEST_F(Phasing, ParallelWordTimesIxx70PlusIxx75) {
  set("I170=4 I171=5000 I175=50 I181=$10F1 I191=$0C0000");  // 12 bits of Y
  set_y(0x10F1, 0xABC123);
  (void)phasing_begin(0);
  phase();
  EXPECT_EQ(x_word(kPosition), 0x123 * 4 + 50);
  set("I191=$580000");  // 24 bits of X
  set_x(0x10F1, 1000007);
  (void)phasing_begin(0);
  phase();
  EXPECT_EQ(x_word(kPosition), (1000007 * 4 + 50) % 5000);
  set("I191=$1E0000 I170=1");  // 30 bits: six of the next word
  set_y(0x10F1, 5);
  set_y(0x10F2, 0x41);
  (void)phasing_begin(0);
  phase();
  EXPECT_EQ(x_word(kPosition), (16777216 + 5 + 50) % 5000);
}

// The motor of --plant servo8: 48 V, 10 A, 1 ohm, 1 mH, four pole pairs, 4000 counts, and the gains of its set-up.
class PhaseSearch : public Phasing {
 protected:
  static constexpr double kHalfBus = 24, kFullAmps = 10, kPhaseHz = 9034.6;
  static constexpr unsigned kSteps = 10, kPhasesOfServo = 4;
  static constexpr std::int64_t kUnits = 65536;  // of the plant, a count

  void SetUp() override {
    Phasing::SetUp();
    parameters_.inertia = 1e-5;
    parameters_.viscous = 1e-4;
    parameters_.coulomb = 5e-4;
    set("I183=$78001 I182=$78006 I184=$FFFC00 I124=$100401 I166=6527 I161=0.011 I162=0.2 I172=1365 I170=4 I171=4000");
    set("I125=0 I173=2000 I174=8");
  }

  void run(plant::Motor& motor, unsigned servos) {
    for (unsigned servo = 0; servo < servos; ++servo) {
      for (unsigned i = 0; i < kPhasesOfServo; ++i) run_phase(motor);
      c_.servo(1);
      phasing_pass();
    }
  }
  void run_phase(plant::Motor& motor) {
    set_x(0x78001, counts(motor));
    const auto word = [](double amps) { return std::clamp(std::floor(amps / kFullAmps * 8192), -8192.0, 8191.0); };
    set_y(kAdcA, static_cast<std::int64_t>(word(motor.current_a())) * 1024);
    set_y(kAdcB, static_cast<std::int64_t>(word(motor.current_b())) * 1024);
    phase();
    const auto volts = [this](unsigned n) { return y_word(kOutput + n) / 256.0 / 6527 * kHalfBus; };
    for (unsigned step = 0; step < kSteps; ++step)
      motor.drive_three_phase(1 / kPhaseHz / kSteps, volts(0), volts(1), volts(2));
  }
  static std::int64_t counts(const plant::Motor& motor) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(motor.position()) / static_cast<double>(kUnits)));
  }
  // Degrees of an electrical cycle by which the phase position is wrong.
  double wrong_by(const plant::Motor& motor) {
    return std::remainder((x_word(kPosition) - 4.0 * static_cast<double>(counts(motor))) / 4000 * 360, 360);
  }
  plant::Motor motor_at(std::int64_t start) const { return {parameters_, 4000 * kUnits, start * kUnits}; }

  plant::MotorParameters parameters_;
};

TEST_F(PhaseSearch, TwoGuessesFindTheAngleWhereverTheRotorStands) {
  for (std::int64_t start = 0; start < 1000; start += 37) {
    plant::Motor motor = motor_at(start);
    set_x(0x78001, counts(motor));
    phase(2);
    ASSERT_TRUE(phasing_begin(0));
    EXPECT_TRUE(phasing_is_searched(0));
    EXPECT_TRUE(phasing_is_missing(0));
    run(motor, 4 * 8);
    EXPECT_TRUE(phasing_is_searched(0)) << "four parts of eight servo cycles";
    run(motor, 3);
    EXPECT_FALSE(phasing_is_searched(0)) << start;
    EXPECT_FALSE(phasing_is_missing(0)) << start;
    EXPECT_LT(std::fabs(wrong_by(motor)), 12) << start;
    motor_kill(0);
  }
}

TEST_F(PhaseSearch, TheSignOfIxx73DoesNotMatterToGuesses) {
  set("I173=-2000");
  plant::Motor motor = motor_at(333);
  ASSERT_TRUE(phasing_begin(0));
  run(motor, 40);
  EXPECT_FALSE(phasing_is_missing(0));
  EXPECT_LT(std::fabs(wrong_by(motor)), 12);
}

TEST_F(PhaseSearch, ARotorThatDoesNotMoveGivesNoReference) {
  parameters_.coulomb = 10;
  for (const auto* mode : {"I180=0", "I180=2 I174=1"}) {
    set(mode);
    plant::Motor motor = motor_at(100);
    ASSERT_TRUE(phasing_begin(0));
    run(motor, 600);
    EXPECT_FALSE(phasing_is_searched(0)) << mode;
    EXPECT_TRUE(phasing_is_missing(0)) << mode;
    EXPECT_EQ(motors[0].loop, LOOP_KILLED) << mode;
  }
}

TEST_F(PhaseSearch, StepperPullsTheRotorToTheFirstPhase) {
  set("I180=2 I174=2 I173=8000");
  parameters_.viscous = 2e-3;
  for (std::int64_t start = 20; start < 1000; start += 190) {
    plant::Motor motor = motor_at(start);
    set_x(0x78001, counts(motor));
    phase(2);
    stand_at(1234);  // means nothing
    ASSERT_TRUE(phasing_begin(0));
    run(motor, 2 * 512);
    EXPECT_TRUE(phasing_is_searched(0)) << "two parts of 256 Ixx74 servo cycles";
    run(motor, 3);
    EXPECT_FALSE(phasing_is_missing(0)) << start;
    EXPECT_LT(std::fabs(wrong_by(motor)), 4) << start;
    motor_kill(0);
  }
}

// A quarter of the way between the phases, 683 of 2048: 333 units of 4000, 83.4 counts of Ixx70 = 4.
TEST_F(PhaseSearch, StepperWantsAQuarterOfTheWay) {
  set("I180=2 I174=1 I173=8000");
  for (const int moved : {83, 84, -83, -84}) {
    const auto servo = [this](unsigned interrupts) {
      for (unsigned n = 0; n < interrupts; ++n) {
        phase(kPhasesOfServo);
        c_.servo(1);
        phasing_pass();
      }
    };
    set_x(0x78001, 0);
    phase(2);
    ASSERT_TRUE(phasing_begin(0));
    servo(200);
    set_x(0x78001, 3000);  // the first part may move as it likes
    servo(100);
    set_x(0x78001, 3000 + moved);
    servo(300);
    EXPECT_FALSE(phasing_is_searched(0));
    EXPECT_EQ(phasing_is_missing(0), std::abs(moved) < 84) << moved;
    motor_kill(0);
    phasing_pass();
  }
}

// motion:3.5/4 and 5: the current lasts as long as the parts do, whenever the background finds that they are over.
TEST_F(PhaseSearch, TheCurrentEndsWithTheLastPart) {
  set("I182=0 I173=1000 I174=1");
  const auto servo = [this](unsigned interrupts) {
    for (unsigned n = 0; n < interrupts; ++n) {
      c_.servo(1);
      phase(kPhasesOfServo);
    }
  };
  for (const unsigned interrupts : {4u, 2u * 256u}) {
    set(interrupts == 4 ? "I180=0" : "I180=2");
    ASSERT_TRUE(phasing_begin(0));
    servo(interrupts);
    EXPECT_NE(y_word(kOutput), 0) << interrupts;
    servo(1);
    EXPECT_TRUE(phasing_is_searched(0));
    EXPECT_EQ(y_word(kOutput), 0) << interrupts;
    EXPECT_EQ(y_word(kOutput + 1), 0) << interrupts;
    phasing_pass();
    EXPECT_FALSE(phasing_is_searched(0));
  }
}

TEST_F(PhaseSearch, AKillEndsTheSearchWithoutAReference) {
  plant::Motor motor = motor_at(100);
  ASSERT_TRUE(phasing_begin(0));
  run(motor, 10);
  motor_kill(0);
  EXPECT_TRUE(phasing_is_searched(0));
  run(motor, 1);
  EXPECT_FALSE(phasing_is_searched(0));
  EXPECT_TRUE(phasing_is_missing(0));
  for (unsigned n = 0; n < 3; ++n) EXPECT_EQ(y_word(kOutput + n), 0);
}

// Its loop is open, and stays so with what it is told to put out.
TEST_F(PhaseSearch, AnOpenLoopCommandEndsTheSearchWithoutAReference) {
  set("I169=20000");
  for (const unsigned servos : {1u, 10u, 33u}) {  // the last: it has found the reference, which nobody has taken yet
    plant::Motor motor = motor_at(100);
    ASSERT_TRUE(phasing_begin(0));
    run(motor, servos - 1);
    for (unsigned i = 0; i < kPhasesOfServo; ++i) run_phase(motor);
    c_.servo(1);
    ASSERT_EQ(c_.line("#1O10"), "");
    for (unsigned n = 0; n < 50; ++n) {
      c_.servo(1);
      phasing_pass();
    }
    EXPECT_FALSE(phasing_is_searched(0)) << servos;
    EXPECT_TRUE(phasing_is_missing(0)) << servos;
    EXPECT_EQ(motors[0].loop, LOOP_OPEN) << servos;
    EXPECT_EQ(motors[0].output, 2000 * 256) << servos;
    EXPECT_EQ(phase_motors[0].q.command, 2000 << (CURRENT_FRACTION_BITS - 15)) << servos;
    EXPECT_FALSE(phase_motors[0].held) << servos;
    motor_kill(0);
  }
}

// It has found the reference, which nobody has taken yet: a motor that is killed then stays so.
TEST_F(PhaseSearch, AKillBehindTheLastPartIsAKill) {
  plant::Motor motor = motor_at(100);
  ASSERT_TRUE(phasing_begin(0));
  run(motor, 4 * 8);
  for (unsigned n = 0; n < 3; ++n) {
    for (unsigned i = 0; i < kPhasesOfServo; ++i) run_phase(motor);
    c_.servo(1);
  }
  motor_kill(0);
  phasing_pass();
  EXPECT_EQ(motors[0].loop, LOOP_KILLED);
  EXPECT_FALSE(phasing_is_searched(0));
  EXPECT_TRUE(phasing_is_missing(0));
}

// So does `$` on one line with what has ended it.
TEST_F(PhaseSearch, BeginsAnewBehindAKill) {
  plant::Motor motor = motor_at(100);
  ASSERT_TRUE(phasing_begin(0));
  run(motor, 10);
  motor_kill(0);
  ASSERT_TRUE(phasing_begin(0));
  EXPECT_EQ(motors[0].loop, LOOP_OPEN);
  run(motor, 4 * 8 + 3);
  EXPECT_FALSE(phasing_is_missing(0));
  EXPECT_EQ(motors[0].loop, LOOP_CLOSED);
}

TEST_F(PhaseSearch, ALimitEndsTheSearchWithoutAReference) {
  set("I125=$78000");
  for (const unsigned limit : {17, 18}) {
    set_x(0x78000, 0);
    plant::Motor motor = motor_at(100);
    ASSERT_TRUE(phasing_begin(0));
    run(motor, 10);
    protection_pass();
    run(motor, 1);
    EXPECT_TRUE(phasing_is_searched(0));
    set_x(0x78000, 1 << limit);
    protection_pass();
    run(motor, 1);
    EXPECT_FALSE(phasing_is_searched(0)) << "bit " << limit;
    EXPECT_TRUE(phasing_is_missing(0));
    EXPECT_EQ(motors[0].loop, LOOP_KILLED);
  }
}

// Nor is the motor kept from being enabled otherwise.
TEST_F(PhaseSearch, EndsWhenTheMotorIsNotCommutatedAnyMore) {
  for (const char* variable : {"I101=0", "I100=0"}) {
    set("I100=1 I101=1");
    plant::Motor motor = motor_at(100);
    ASSERT_TRUE(phasing_begin(0)) << variable;
    run(motor, 10);
    ASSERT_TRUE(phasing_is_searched(0)) << variable;
    set(variable);
    run(motor, 1);
    EXPECT_FALSE(phasing_is_searched(0)) << variable;
    EXPECT_EQ(motors[0].loop, LOOP_KILLED) << variable;
    set("I100=1 I101=0");
    EXPECT_TRUE(motor_close(0)) << variable;
    motor_kill(0);
  }
}

TEST_F(PhaseSearch, IsMadeByACommand) {
  plant::Motor motor = motor_at(250);
  set_x(0x78001, counts(motor));
  phase(2);
  EXPECT_EQ(c_.line("#1J/"), "ERR018");
  EXPECT_EQ(c_.line("#1$"), "");
  EXPECT_EQ(c_.line("#1?").substr(9, 1), "3") << "bits 9 and 8 of the second word";
  EXPECT_EQ(c_.line("#1J/"), "ERR018");
  run(motor, 40);
  EXPECT_EQ(c_.line("#1?").substr(9, 1), "0");
  EXPECT_EQ(motors[0].loop, LOOP_CLOSED);
  set("#1K I174=0");
  EXPECT_EQ(c_.line("#1$"), "ERR018") << "no search is made";
}

// For users of sine outputs with Ixx72 above 1024 the sign of Ixx73 is the other one, as the manuals have it.
TEST_F(PhaseSearch, StepperOfSineOutputsTakesTheOtherSign) {
  set("I182=0 I180=2 I174=1");
  for (const bool above : {true, false}) {
    set(above ? "I172=1365 I173=-1000" : "I172=683 I173=1000");
    ASSERT_TRUE(phasing_begin(0));
    plant::Motor still = motor_at(0);
    run(still, 200);
    phase();
    EXPECT_NEAR(y_word(kOutput + 1) / 256.0, 1000, 1) << "second phase first";
    EXPECT_NEAR(y_word(kOutput) / 256.0, -500, 1);
    run(still, 256);
    EXPECT_NEAR(y_word(kOutput) / 256.0, 1000, 1);
    EXPECT_NEAR(y_word(kOutput + 1) / 256.0, -500, 1);
    motor_kill(0);
    phasing_pass();
  }
}

}  // namespace
}  // namespace brick
