// Trips, limits, in position and status words, natively: motion:6, firmware:5.2, firmware:5.3. The flag
// words stand in the fake servo IC.
#include <gtest/gtest.h>

#include <string>

#include "testbench/unit/firmware_servo/protection_rig.h"

extern "C" {
#include "firmware/base/status.h"
#include "firmware/motion/conversion_table.h"
}

namespace brick {
namespace {

using Protection = ProtectionRig;

TEST_F(Protection, ClosingEnables) {
  EXPECT_FALSE(enabled(1));
  EXPECT_EQ(c_.line("#1?"), "850000078000");
  ASSERT_TRUE(motor_close(0));
  EXPECT_TRUE(enabled(1));
  EXPECT_FALSE(enabled(2));
  servo();
  protection_pass();
  // activated, enabled, integration mode, desired velocity 0; assigned X, enabled, in position
  EXPECT_EQ(c_.line("#1?"), "89200007C001");
  motor_kill(0);
  EXPECT_FALSE(enabled(1));
  EXPECT_EQ(c_.line("#1?"), "850000078000");
}

TEST_F(Protection, WhatMayNotClose) {
  EXPECT_FALSE(motor_close(2)) << "I300=0";
  c_.line("I8000=$F00000 I8001=$200000 I103=$3502");
  EXPECT_FALSE(motor_close(0)) << "method $F";
  c_.line("I103=$10F0 I104=$3502");
  EXPECT_FALSE(motor_close(0)) << "that of the velocity";
  c_.line("I8000=0 I104=$10F0");
  EXPECT_TRUE(motor_close(0));
  motor_kill(0);
  c_.line("I101=1 M148->Y:$C0,8 M148=1");
  motors[0].found.fatal_error = true;
  EXPECT_FALSE(motor_close(0)) << "no phase reference";
  EXPECT_TRUE(motors[0].found.fatal_error) << "nor is it forgotten why the loop was opened";
  c_.line("M148=0");
  EXPECT_TRUE(motor_close(0));
  EXPECT_FALSE(motors[0].found.fatal_error);
}

TEST_F(Protection, EnableGoesWithItsFlagWord) {
  ASSERT_TRUE(motor_close(0));
  c_.line("I142=$78008");
  EXPECT_FALSE(enabled(1));
  EXPECT_TRUE(enabled(2));
  c_.line("I142=0 I124=$810001");
  EXPECT_FALSE(enabled(1)) << "bit 16: not used";
  EXPECT_FALSE(enabled(2));
  c_.line("I124=$840001");
  EXPECT_FALSE(enabled(1)) << "bits 19, 18 = 01: capture and amplifier flags over MACRO";
  c_.line("I124=$8C0001");
  EXPECT_TRUE(enabled(1)) << "11: capture flags only";
  c_.line("I124=$880001");
  EXPECT_FALSE(enabled(1)) << "10: amplifier flags";
  c_.line("I124=$800001");
  EXPECT_TRUE(enabled(1));
  c_.line("I100=0");
  EXPECT_FALSE(enabled(1));
  EXPECT_EQ(loop(1), LOOP_KILLED);
}

// The compare output would be written again by bit 11, so it is not written back.
TEST_F(Protection, EnableLeavesOtherBitsOfItsWord) {
  *hal_x(kControl) = 0x1800;
  ASSERT_TRUE(motor_close(0));
  EXPECT_EQ(*hal_x(kControl), 0x1000u | kEnable);
  motor_kill(0);
  EXPECT_EQ(*hal_x(kControl), 0x1000u);
}

// SAVE: motion:6.
TEST_F(Protection, ChecksStandWhileTheyAreToldTo) {
  ASSERT_TRUE(motor_close(0));
  protection_stand(true);
  flags(1, kFault);
  servo(6);
  EXPECT_EQ(loop(1), LOOP_CLOSED);
  protection_stand(false);
  servo(3);
  EXPECT_EQ(loop(1), LOOP_KILLED);
}

// I111 and I112 are sixteenths of a count; 0 is off.
TEST_F(Protection, FollowingErrorWarnsAndTrips) {
  close_all();
  c_.line("I111=1600 I112=160");
  counts(1, -10);
  servo();
  EXPECT_FALSE(status2(1, 1));
  counts(1, -10.0625);
  servo();
  EXPECT_TRUE(status2(1, 1));
  EXPECT_FALSE(status2(1, 0)) << "not in position";
  counts(1, 0);
  servo();
  EXPECT_FALSE(status2(1, 1)) << "the warning follows";
  counts(1, 100);
  servo();
  EXPECT_EQ(loop(1), LOOP_CLOSED);
  counts(1, 100.0625);
  servo();
  protection_pass();
  EXPECT_EQ(loop(1), LOOP_KILLED);
  EXPECT_FALSE(enabled(1));
  EXPECT_TRUE(status2(1, 2));
  EXPECT_TRUE(status2(1, 1)) << "the warning stays";
  EXPECT_EQ(std::stoul(c_.line("&1??").substr(6, 6), nullptr, 16) >> 18 & 3u, 3u) << "of its system too";
  EXPECT_FALSE(status2(2, 1)) << "not of one that has only gone with it";
  c_.line("I111=0");
  ASSERT_TRUE(motor_close(0));
  EXPECT_FALSE(status2(1, 2) || status2(1, 1)) << "closed again";
  counts(1, 9999);
  servo();
  protection_pass();
  EXPECT_EQ(loop(1), LOOP_CLOSED);
}

// With Ixx60 the error is that of the last closure: what has been commanded since, up to 141 counts here, is none of
// it.
TEST_F(Protection, TheFollowingErrorIsThatOfTheClosure) {
  for (const char* real_time : {"I8=2", "I8=40"}) {
    c_.line(real_time);
    c_.line("I160=9 I111=160 I112=80 I119=10 I120=1 I121=0 I122=32 I192=1");
    close_all();
    c_.line("#1J+");
    for (int n = 0; n < 300; ++n) {
      counts(1, at(1) + static_cast<double>(motors[0].desired_step) / kFine);  // where it is to be next
      servo();
      ASSERT_EQ(loop(1), LOOP_CLOSED) << n;
    }
    EXPECT_FALSE(status2(1, 1)) << "nor is it a warning";
    EXPECT_LT(std::abs(std::stod(c_.line("#1F"))), 1);
    counts(1, at(1) - 20);
    servo(20);
    EXPECT_EQ(loop(1), LOOP_KILLED) << "a true one trips";
    c_.line("I160=0");
    counts(1, 0);
    servo();
  }
}

// Ixx24 bits 22 and 21: all motors, this coordinate system, this motor.
TEST_F(Protection, OthersAreKilledAsIxx24Says) {
  struct {
    const char* mode;
    bool second, fifth;
  } const cases[] = {{"$800001", true, true}, {"$A00001", true, false}, {"$C00001", false, false}};
  for (const auto& one : cases) {
    c_.line(std::string("I124=") + one.mode);
    counts(1, 0);
    servo();
    close_all();
    counts(1, 3000);
    servo();
    protection_pass();
    EXPECT_EQ(loop(1), LOOP_KILLED) << one.mode;
    EXPECT_EQ(loop(2) == LOOP_KILLED, one.second) << one.mode;
    EXPECT_EQ(loop(5) == LOOP_KILLED, one.fifth) << one.mode;
  }
}

// A program of a motor that is killed ends, in other coordinate systems too; one whose motors stay on is aborted with
// them on.
TEST_F(Protection, ProgramsOfKilledMotorsAreAborted) {
  struct {
    const char* mode;
    bool second_on, other_runs;
  } const cases[] = {{"$800001", false, false}, {"$A00001", false, true}, {"$C00001", true, true}};
  for (const auto& one : cases) {
    ASSERT_EQ(c_.line(std::string("I124=") + one.mode + " I111=1600 I211=0 I511=0 I216=9999 I516=9999"), "");
    ASSERT_EQ(c_.line("&2#5->X #1K #2K #5K"), "");
    for (const unsigned motor : {1u, 2u, 5u}) counts(motor, 0);
    servo(3);
    run({"INC TM1000 TA20 TS0 X0 Y5000", "Y5000"});
    ASSERT_EQ(c_.line("&2B1R"), "") << "Y of &2 is virtual";
    follow(30);
    ASSERT_TRUE(runs(1) && runs(2));
    counts(1, 101);
    servo(3);
    EXPECT_EQ(loop(1), LOOP_KILLED);
    EXPECT_FALSE(runs(1)) << one.mode;
    EXPECT_EQ(runs(2), one.other_runs) << one.mode;
    EXPECT_EQ(loop(2) == LOOP_CLOSED, one.second_on) << one.mode;
    EXPECT_EQ(loop(5) == LOOP_CLOSED, one.other_runs) << one.mode;
    EXPECT_FALSE(status2(2, 2) || status2(5, 2)) << "they have not tripped";
    c_.line("&2A");
    follow(100);
  }
}

// So does one of a motor that is no longer activated, or has no phase reference any more; another's jog goes on.
TEST_F(Protection, ProgramsOfMotorsThatAVariableKillsEnd) {
  for (const char* variable : {"I200=0", "I201=1"}) {
    c_.line("I200=1 I201=0");
    run({"INC TM1000 TA20 TS0", "X2000 Y1000", "X2000 Y1000"});
    follow(50);
    ASSERT_TRUE(runs());
    c_.line(variable);
    EXPECT_EQ(loop(2), LOOP_KILLED) << variable;
    follow(3);
    EXPECT_FALSE(runs()) << variable;
    EXPECT_EQ(loop(1), LOOP_CLOSED) << variable;
    follow(200);
    EXPECT_FALSE(status1(1, 12)) << variable;
  }
  c_.line("I201=0 I200=1 #1J+");
  follow(30);
  ASSERT_TRUE(motor_close(1));
  c_.line("I200=0");
  follow(10);
  EXPECT_FALSE(status1(1, 12)) << "no program, no abort";
  EXPECT_FALSE(status1(1, 13));
}

// So does one that homes a motor which is not its own, when that trips, by itself or with others, or is killed.
TEST_F(Protection, AProgramEndsWithTheMotorThatItHomes) {
  for (const char* of : {"&2#5->0", "&2#5->X"})
    for (const unsigned cause : {0u, 1u, 2u}) {
      ASSERT_EQ(c_.line(of), "");
      ASSERT_EQ(c_.line(cause == 1 ? "&1#1->0#2->0" : "&1#1->X#2->Y"), ""); /* else &1 ends with a motor of its own */
      c_.line("I500=1 I523=20 I511=1600 I111=1600 I124=$800001 I524=$C00001 P1=0 #1K #2K #5K");
      for (const unsigned motor : {1u, 2u, 5u}) counts(motor, 0);
      servo(3);
      run({"HOME5", "DWELL10", "P1=1"});
      follow(50);
      ASSERT_TRUE(runs());
      if (cause == 2)
        c_.line("I500=0");
      else
        counts(cause == 0 ? 5 : 1, at(cause == 0 ? 5 : 1) + 101);
      servo(3);
      EXPECT_EQ(loop(5), LOOP_KILLED) << of << cause;
      EXPECT_FALSE(runs()) << of << cause;
      follow(100);
      EXPECT_EQ(c_.line("P1"), "0") << of << cause;
    }
}

// Another's program homes it no longer when it has come to rest: it does not end with it.
TEST_F(Protection, AProgramGoesOnWithoutAMotorThatItDoesNotHomeAnyMore) {
  c_.line("I523=20 I123=20 I524=$C00001 I511=1600");
  run({"HOME1,5"});
  follow(50);
  c_.line("#5J/");
  follow(100);
  counts(5, at(5) + 101);
  servo(3);
  EXPECT_EQ(loop(5), LOOP_KILLED);
  EXPECT_TRUE(runs());
}

// A motor that no axis moves is its system's too: a start asks for it, and what was is forgotten.
TEST_F(Protection, AMotorOfAnInverseProgramThatIsOffIsOfItsSystem) {
  ASSERT_EQ(c_.line("&1#2->I"), "");
  run({"INC TM1000 TA20 TS0", "X2000", "X2000", "X2000"});
  follow(50);
  c_.line("&1A");
  follow(200);
  c_.line("I200=0");
  ASSERT_EQ(c_.line("I200=1 &1E"), "");
  ASSERT_EQ(c_.line("&1B1R"), "");
  follow(50);
  EXPECT_TRUE(runs());
  c_.line("I200=0");
  follow(3);
  EXPECT_FALSE(runs());
}

// Not one that is begun behind it, before the next pass has looked.
TEST_F(Protection, AProgramThatBeginsBehindAKillIsNotEndedByIt) {
  run({"INC TM1000 TA20 TS0", "X2000 Y1000", "X2000 Y1000", "X2000 Y1000"});
  follow(50);
  c_.line("&1A");
  follow(200);
  c_.line("I200=0");
  ASSERT_EQ(c_.line("I200=1 &1E"), "");
  ASSERT_EQ(c_.line("&1B1R"), "");
  follow(50);
  EXPECT_TRUE(runs());
  EXPECT_EQ(loop(2), LOOP_CLOSED);
  c_.line("I200=0");
  follow(3);
  EXPECT_FALSE(runs()) << "that one is";
}

// motion:6.5, rule 2: with I13 = 1 at each servo interrupt, without passes.
TEST_F(Protection, ForegroundInPosition) {
  c_.line("I128=160 I188=255");
  ASSERT_TRUE(motor_close(0));
  servo(3);
  EXPECT_FALSE(status2(1, 13));
  c_.line("I13=1");
  servo(3);
  EXPECT_TRUE(status2(1, 13));
  EXPECT_FALSE(status2(1, 0));
  counts(1, 10);
  servo(1);
  EXPECT_FALSE(status2(1, 13));
  counts(1, 9.9);
  servo(1);
  EXPECT_TRUE(status2(1, 13));
  motor_kill(0);
  servo(1);
  EXPECT_FALSE(status2(1, 13));
  ASSERT_TRUE(motor_close(0));
  servo(1);
  EXPECT_TRUE(status2(1, 13));
  c_.line("I13=0");
  EXPECT_FALSE(status2(1, 13));
}

// In each servo interrupt, however seldom the real-time interrupt comes.
TEST_F(Protection, ForegroundInPositionKnowsNoTurns) {
  c_.line("I128=160 I13=1 I8=255");
  protection_pass();
  ASSERT_TRUE(motor_close(0));
  servo(1);
  for (int n = 0; n < 4; ++n) {
    counts(1, 10);
    servo(1);
    EXPECT_FALSE(motors[0].found.foreground_in_position) << n;
    counts(1, 9.9);
    servo(1);
    EXPECT_TRUE(motors[0].found.foreground_in_position) << n;
  }
}

TEST_F(Protection, NothingIsControlledWithoutClocks) {
  run({"TM1000 X100", "X200"});
  servo(6);
  ASSERT_TRUE(runs());
  flags(1, kFault);  // what is read is worth nothing either
  status_show(STATUS_NO_PHASE_CLOCK, true);
  protection_pass();
  for (const unsigned motor : {1u, 2u, 5u}) {
    EXPECT_EQ(loop(motor), LOOP_KILLED);
    EXPECT_FALSE(enabled(motor));
    EXPECT_FALSE(status2(motor, 3));
  }
  EXPECT_FALSE(runs());
  EXPECT_EQ(c_.line("#1J/"), "ERR018");
  EXPECT_FALSE(motor_close(0));
  EXPECT_FALSE(motor_open(0, 0));
  status_show(STATUS_NO_PHASE_CLOCK, false);
  flags(1, 0);
  EXPECT_EQ(c_.line("#1J/"), "");
  EXPECT_EQ(loop(1), LOOP_CLOSED);
}

// Of all motors those that are not activated are none: their words are the user's (motion:1.5/2).
TEST_F(Protection, ATripLeavesMotorsThatAreNotActivatedAlone) {
  constexpr std::uint32_t kOutput = 0x78012, kAmplifier = 0x78015;  // of motor 3
  c_.line("I302=$78012 I325=$78010");
  *hal_y(kOutput) = 0x123456;
  *hal_x(kAmplifier) |= kEnable;
  ASSERT_TRUE(motor_close(0));
  flags(1, kFault);
  servo(3);
  ASSERT_EQ(loop(1), LOOP_KILLED);
  EXPECT_EQ(*hal_y(kOutput), 0x123456u);
  EXPECT_NE(*hal_x(kAmplifier) & kEnable, 0u);
}

TEST_F(Protection, AmplifierFault) {
  ASSERT_TRUE(motor_close(0));
  servo();
  flags(1, kFault);
  EXPECT_TRUE(status2(1, 3));
  EXPECT_EQ(loop(1), LOOP_KILLED);
  flags(1, 0);
  EXPECT_TRUE(status2(1, 3)) << "stays until it is enabled";
  ASSERT_TRUE(motor_close(0));
  EXPECT_FALSE(status2(1, 3));
  c_.line("I124=$000001");
  protection_pass();
  EXPECT_EQ(loop(1), LOOP_KILLED) << "bit 23 = 0: a low input is a fault";
  c_.line("I124=$100001");
  ASSERT_TRUE(motor_close(0));
  for (const std::uint32_t level : {0u, kFault}) {
    flags(1, level);
    protection_pass();
    EXPECT_EQ(loop(1), LOOP_CLOSED) << "bit 20: not looked at";
  }
}

TEST_F(Protection, InPositionAfterItsScans) {
  c_.line("I188=3 I128=160");
  ASSERT_TRUE(motor_close(0));
  servo();
  protection_pass();
  unsigned scans = 1;
  for (; scans < 100 && !motors[0].found.in_position; ++scans) protection_pass();
  EXPECT_EQ(scans, 4u);
  counts(1, 9.96875);
  servo();
  EXPECT_TRUE(status2(1, 0));
  counts(1, 10);
  servo();
  EXPECT_FALSE(status2(1, 0));
  counts(1, 0);
  servo();
  protection_pass();
  EXPECT_FALSE(motors[0].found.in_position);
}

// A motor that follows a master is on its way, however near it is: desired velocity 0 is asked for.
TEST_F(Protection, InPositionNeedsACommandedStandstill) {
  c_.line("I128=160 I105=$10F6 I107=96");
  ASSERT_TRUE(motor_close(0));
  c_.line("I106=1");
  follow(6);
  EXPECT_TRUE(status2(1, 0) && status1(1, 13));
  for (std::uint32_t n = 1; n < 20; ++n) {
    *hal_x(0x10F6) = 32 * n;
    follow(1);
  }
  EXPECT_NEAR(at(1), 19, 1);
  EXPECT_FALSE(status2(1, 0) || status1(1, 13));
  follow(6);
  EXPECT_TRUE(status2(1, 0) && status1(1, 13));
}

// Nor is one whose jog waits for its Ixx92 in position: who polls would take it for done.
TEST_F(Protection, AJogThatWaitsIsNotInPosition) {
  c_.line("I192=100 I111=0");
  close_all();
  follow(6);
  ASSERT_TRUE(status2(1, 0));
  const auto system = [this] { return std::stoul(c_.line("&1??").substr(6, 6), nullptr, 16) >> 17 & 1; };
  EXPECT_EQ(system(), 1u);
  EXPECT_EQ(c_.line("#1J=500 #1?").back(), '0') << "not even at once";
  EXPECT_EQ(system(), 0u) << "nor is its coordinate system";
  follow(6);
  EXPECT_EQ(motors[0].desired_step, 0);
  EXPECT_FALSE(status2(1, 0));
}

TEST_F(Protection, SignalsOfTheSelectedSystem) {
  c_.line("&1 I211=0 I212=160");
  close_all();
  protection_pass();
  EXPECT_EQ(fake_hal_signals() & (HAL_SIGNAL_IPOS | HAL_SIGNAL_F1ER | HAL_SIGNAL_EROR), HAL_SIGNAL_IPOS);
  counts(2, 50);
  servo();
  protection_pass();
  EXPECT_EQ(fake_hal_signals() & (HAL_SIGNAL_IPOS | HAL_SIGNAL_F1ER | HAL_SIGNAL_EROR), HAL_SIGNAL_F1ER);
  c_.line("I211=160");
  protection_pass();
  EXPECT_EQ(fake_hal_signals() & (HAL_SIGNAL_IPOS | HAL_SIGNAL_F1ER | HAL_SIGNAL_EROR),
            HAL_SIGNAL_EROR | HAL_SIGNAL_F1ER);
  c_.line("I200=0");
  protection_pass();
  EXPECT_EQ(fake_hal_signals() & HAL_SIGNAL_EROR, 0u) << "no more activated: nobody is to wait for it";
  c_.line("I200=1 &2");
  protection_pass();
  EXPECT_EQ(fake_hal_signals() & (HAL_SIGNAL_IPOS | HAL_SIGNAL_F1ER | HAL_SIGNAL_EROR), 0u);
}

// 1 = the switch is open: stop in that direction.
TEST_F(Protection, LimitsShowAndStop) {
  c_.line("I111=0 I122=32 I120=0 I121=0 I119=10 I115=1 I192=1");
  c_.line("#1J+");
  servo(200);
  const std::int64_t speed = motors[0].desired_step;
  EXPECT_GT(speed, 0);
  flags(1, kPositive);
  EXPECT_TRUE(status1(1, 21));
  EXPECT_FALSE(status1(1, 22));
  servo(10);
  EXPECT_TRUE(status1(1, 12)) << "abort deceleration";
  for (int n = 0; n < 300; ++n) {
    counts(1, static_cast<double>(motors[0].commanded) / kFine);
    servo();
    protection_pass();
  }
  EXPECT_EQ(motors[0].desired_step, 0);
  EXPECT_EQ(loop(1), LOOP_CLOSED);
  EXPECT_TRUE(status2(1, 11));
  flags(1, 0);
  EXPECT_FALSE(status1(1, 21));
}

TEST_F(Protection, LimitsMayBeIgnored) {
  c_.line("I124=$820001");
  flags(1, kPositive | kNegative);
  ASSERT_TRUE(motor_close(0));
  EXPECT_FALSE(status1(1, 21));
  EXPECT_FALSE(status1(1, 22));
  c_.line("I124=$800001");
  EXPECT_TRUE(status1(1, 21));
  EXPECT_TRUE(status1(1, 22));
}

TEST_F(Protection, SoftwareLimits) {
  c_.line("I113=100 I114=-50 I111=0");
  ASSERT_TRUE(motor_close(0));
  const double at[] = {99.9, 100, 0, -49.9, -50};
  const bool up[] = {false, true, false, false, false}, down[] = {false, false, false, false, true};
  for (int i = 0; i < 5; ++i) {
    counts(1, at[i]);
    servo();
    EXPECT_EQ(status1(1, 21), up[i]) << at[i];
    EXPECT_EQ(status1(1, 22), down[i]) << at[i];
  }
}

// Ixx63 < 0: the integral at its limit is a fatal error, bits 2 and 6.
TEST_F(Protection, IntegratedError) {
  c_.line("I130=1000 I131=0 I133=8000000 I134=0 I163=-1600 I111=0 I169=32767");
  ASSERT_TRUE(motor_close(0));
  counts(1, -1);
  servo(150);
  EXPECT_EQ(word(1, 6) & 0x44u, 0x44u);
  EXPECT_EQ(loop(1), LOOP_KILLED);
}

// motion:6.5/1: what trips a motor opens its loop, and so takes its in-position bit away in the same pass, however
// wide Ixx28 is.
TEST_F(Protection, ATripEndsInPosition) {
  const std::function<void()> causes[] = {[] { counts(1, 150); }, [] { flags(1, kFault); },
                                          [this] { c_.line("I163=-160"); }};
  for (const auto& cause : causes) {
    counts(1, 0);
    flags(1, 0);
    c_.line("I111=1600 I128=32767 I188=0 I130=1000 I131=0 I133=8388607 I134=0 I163=160 I169=32767");
    servo();
    ASSERT_TRUE(motor_close(0));
    servo();
    counts(1, 1);
    servo(100);
    protection_pass();
    ASSERT_TRUE(motors[0].found.in_position);
    cause();
    servo();
    protection_pass();
    EXPECT_EQ(loop(1), LOOP_KILLED);
    EXPECT_FALSE(motors[0].found.in_position);
  }
}

// motion:6.3: Ixx69 = 32767, Ixx57 = 10589 for 60 s at 2250 Hz is Ixx58 = 120,894.
TEST_F(Protection, OverloadTripsAfterItsTime) {
  c_.line("I157=10589 I158=120894 I169=32767 I111=0 I124=$C00001");
  ASSERT_TRUE(motor_open(0, 32767 << 8));
  const auto trips_after = [this](unsigned most) {
    for (unsigned n = 0; n <= most; ++n) {
      servo();
      if (n % 50 == 0) protection_pass();
      if (loop(1) == LOOP_KILLED) return n;
    }
    return most + 1;
  };
  EXPECT_NEAR(trips_after(140000), 60 * 2250, 60);
  EXPECT_EQ(word(1, 6) & 0x2Cu, 0x28u) << "amplifier fault by overload";
  // Linear: (32767 - 16384)/32768 a cycle.
  c_.line("I157=-16384 I158=0");
  c_.line("I158=500");
  ASSERT_TRUE(motor_open(0, 0));
  servo(400);  // what stays below the continuous current is no credit
  ASSERT_TRUE(motor_open(0, -32767 * 256));
  EXPECT_NEAR(trips_after(2000), 500 * 32768.0 / (32767 - 16384), 51);
}

TEST_F(Protection, AFollowingErrorIsReported) {
  c_.line("I111=0 I60=0 I61=4");
  ASSERT_TRUE(motor_close(0));
  servo(16);
  counts(1, -12.5);
  servo();
  EXPECT_EQ(c_.line("#1F"), "12.5");
  EXPECT_EQ(c_.line("#1P"), "-12.5");
  EXPECT_EQ(c_.line("#1V"), "-0.78125") << "a mean of sixteen";
  servo(15);
  EXPECT_EQ(c_.line("#1V"), "-0.78125");
  servo();
  EXPECT_EQ(c_.line("#1V"), "0");
}

// motion:1.3: the words of the loop are the variables.
TEST_F(Protection, WordsOfTheLoopAreItsVariables) {
  struct {
    const char *read, *write, *variable;
  } const words[] = {{"RY$89", "WY$89,", "I108"}, {"RY$9C", "WY$9C,", "I109"}, {"RY$99", "WY$99,", "I130"},
                     {"RX$92", "WX$92,", "I131"}, {"RX$8F", "WX$8F,", "I132"}, {"RX$9F", "WX$9F,", "I133"},
                     {"RY$93", "WY$93,", "I135"}, {"RY$9F", "WY$9F,", "I163"}, {"RY$8F", "WY$8F,", "I160"}};
  for (const auto& w : words) {
    c_.line(std::string(w.variable) + "=77");
    EXPECT_EQ(c_.line(w.read), "77") << w.read;
    c_.line(std::string(w.write) + "99");
    EXPECT_EQ(c_.line(w.variable), "99") << w.write;
  }
  c_.line("I169=1000");
  EXPECT_EQ(c_.line("RY$AE"), "256000");
  c_.line("WY$AE,512000");
  EXPECT_EQ(c_.line("I169"), "2000");
  c_.line("I8000=$78000 WY$3502,$78008");
  EXPECT_EQ(c_.line("RHY$3501 I8001"), "78000|$78008");
  conversion_table_servo();
}

}  // namespace
}  // namespace brick
