// Aborts while the time base changes (motion:4.5/1): ramps to rest at Ixx15 that quicken no motor and come to an end,
// whatever is ordered with them.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "testbench/unit/firmware_platform/fake_tasks.h"
}

namespace {

using namespace moving_motors;

double place() { return static_cast<double>(motors[0].trajectory) / kUnit; }

class RampsAndTime : public MovingMotors {
 protected:
  static void begin(const std::string& program) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I119=1 I120=20 I121=0 I122=40 I192=1 I115=1"), "");
    store({program});
    ASSERT_EQ(host("&1B1R"), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    ticks(900);
  }
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
};

constexpr const char* kPrograms[] = {"TM2500 TA100 TS0 X100", "RAPID X100"};  // 40 counts a ms

// motion:4.5/1: what a hold has slowed down comes to rest at Ixx15 from the velocity that it has, and never quickens.
TEST_F(RampsAndTime, AnAbortInAHoldDoesNotQuicken) {
  for (const char* program : kPrograms)
    for (const char* abort : {"A", "WY$203F,$400000"})  // by a run-time error, too
      for (const double within : {0.5, 8.0, 14.0}) {
        SCOPED_TRACE(std::string(program) + " " + std::to_string(within));
        begin(program);
        ASSERT_EQ(host("I5195=100000 H"), "");
        ticks(within);
        double velocity = 40 * cs().increment / double{platform::kDefaultI10}, last = place(), time = 0;
        const double from = last, asked = velocity;
        ASSERT_EQ(host(abort), "");
        for (int tick = 1; tick < 300; ++tick) {
          platform::servo_ticks(1);
          const double now = (place() - last) / kTickMs;
          ASSERT_LE(now, velocity + 0.01) << tick;
          if (now != 0) time = tick * kTickMs;
          velocity = now;
          last = place();
        }
        EXPECT_NEAR(time, asked / 1, 3.0);
        EXPECT_NEAR(last - from, asked * asked / 2 / 1, asked * 2.0);
        EXPECT_EQ(host("%"), "100") << "the hold is over";
        EXPECT_FALSE(cs().held);
      }
}

// Isx93, on its way up from 10 %.
TEST_F(RampsAndTime, AnAbortStaysAtTheExternalTimeBaseThatThereIs) {
  begin(kPrograms[0]);
  ASSERT_EQ(host("I5194=8388607 WX$10F0,371399 I5193=$10F0"), "");
  ticks(50);
  ASSERT_EQ(host("I5194=200000 WX$10F0,3713991"), "");
  platform::servo_ticks(2);
  double velocity = 40.0 * (371399 + 2 * 200000) / platform::kDefaultI10, last = place();
  ASSERT_EQ(host("A"), "");
  for (int tick = 1; tick < 60; ++tick) {
    platform::servo_ticks(1);
    const double now = (place() - last) / kTickMs;
    ASSERT_LE(now, velocity + 0.01) << tick;
    velocity = now;
    last = place();
  }
  EXPECT_EQ(velocity, 0.0) << "8.3 counts a ms at Ixx15 = 1";
}

// Nor does what is left of the velocity take the longer the slower time goes just then.
TEST_F(RampsAndTime, AnAbortIsNotSlowedDownByWhatSlews) {
  for (const char* program : kPrograms)
    for (const char* slows : {"H", "%0", "WX$10F0,0"}) {
      SCOPED_TRACE(std::string(program) + " " + slows);
      begin(program);
      ASSERT_EQ(host("I5194=1644 I5195=1644"), "");  // 100 % in a second
      if (slows[0] == 'W') { ASSERT_EQ(host("WX$10F0,3713991 I5193=$10F0"), ""); }
      ASSERT_EQ(host(slows), "");
      ticks(900);
      ASSERT_LT(cs().increment, 0.11 * platform::kDefaultI10);
      ASSERT_GT(cs().increment, 0.09 * platform::kDefaultI10);
      ASSERT_EQ(host("A"), "");
      ticks(4.4 + 3);
      const double rest = place();
      ticks(100);
      EXPECT_EQ(place(), rest) << "4 counts a ms at Ixx15 = 1";
    }
}

// It ends as it has begun, whatever comes of the time base meanwhile.
TEST_F(RampsAndTime, ARampKeepsItsRate) {
  for (const char* since : {"%10", "%0", "%200"}) {
    SCOPED_TRACE(since);
    begin(kPrograms[0]);
    ASSERT_EQ(host("I5194=8388607 A"), "");
    ticks(10);
    const double from = place();
    ASSERT_EQ(host(since), "");
    ticks(32);
    const double rest = place();
    EXPECT_NEAR(rest - from, 30 * 30 / 2, 60.0) << "30 counts a ms are left";
    ticks(100);
    EXPECT_EQ(place(), rest);
    ASSERT_EQ(host("%100 B1R"), "") << "it is over";
  }
}

// Where one goes down to 0 the ramp may be at no speed: it is over then.
TEST_F(RampsAndTime, AnAbortEndsWhateverComesWithIt) {
  const Lines orders[] = {{"A", "H"}, {"A", "%0"}, {"H", "A"}, {"%0", "A"}, {"#1J/", "WY$203F,$400000"}};
  for (const char* program : kPrograms)
    for (const Lines& two : orders)
      for (const char* slew : {"1644", "1000000", "8388607"}) {
        SCOPED_TRACE(std::string(program) + " " + two[0] + " " + two[1] + " " + slew);
        begin(program);
        ASSERT_EQ(host(std::string("I5194=") + slew + " I5195=" + slew), "");
        if (two[0] == "#1J/") {
          ASSERT_EQ(host("H"), "");
          ticks(1100);
          if (program[0] == 'R') continue;  // ERR001: the move is held
        }
        ASSERT_EQ(host(two[0]), "");
        platform::servo_ticks(1);
        ASSERT_EQ(host(two[1]), "");
        ticks(100);
        const double rest = place();
        ticks(20);
        EXPECT_EQ(place(), rest);
        EXPECT_FALSE(cs().held);
        EXPECT_EQ(host("&1B1R"), "");
      }
}

// What is ordered until the ramp begins changes no rate: it begins at the velocity that it was planned for.
TEST_F(RampsAndTime, AnOrderBeforeTheRampBeginsQuickensNothing) {
  for (const char* order : {"H", "<", "%50", "%200", "WX$2000,0"}) {
    SCOPED_TRACE(order);
    begin(kPrograms[0]);
    ASSERT_EQ(host("I5194=200000 I5195=200000"), "");
    ASSERT_EQ(host("A"), "");
    fake_task_run_servo();
    ASSERT_EQ(host(order), "");
    fake_task_run_servo();
    double velocity = 40, last = place();
    for (int tick = 1; tick < 400; ++tick) {
      if (tick == 4) platform::real_time();  // late
      fake_task_run_servo();
      const double now = (place() - last) / kTickMs;
      ASSERT_LE(now, velocity + 0.01) << tick;
      ASSERT_GE(now, velocity - 4.4 * kTickMs) << tick;  // Ixx15 at 200 %
      if (tick > 10) platform::real_time();
      velocity = now;
      last = place();
    }
    EXPECT_EQ(velocity, 0.0);
    EXPECT_FALSE(cs().settling || cs().held);
    EXPECT_EQ(cs().increment_target, cs().increment_command) << "it counts behind that";
  }
}

// A jog that is asked for with the abort takes the ramp's place: it leaves the path at the path's rate, where that is.
TEST_F(RampsAndTime, AJogInPlaceOfTheRampLeavesThePathAsItGoes) {
  for (const char* hold : {"H", "%150"})
    for (const char* jog : {"#1J/", "#1J+", "#1J:500"}) {
      SCOPED_TRACE(hold + std::string(jog));
      begin(kPrograms[0]);
      ASSERT_EQ(host("I5194=100000 I5195=100000 I192=2"), "");
      ASSERT_EQ(host(hold), "");
      ticks(12);
      double last = place();
      platform::servo_ticks(1);
      double velocity = (place() - last) / kTickMs;
      ASSERT_EQ(host("A"), "");
      ASSERT_EQ(host(jog), "");
      for (int tick = 1; tick < 300; ++tick) {
        last = place();
        platform::servo_ticks(1);
        const double now = (place() - last) / kTickMs;
        ASSERT_LE(std::abs(now - velocity), 40 * 100000.0 / platform::kDefaultI10 + 2.5 * kTickMs) << tick;
        velocity = now;
      }
    }
}

// A jog that is to follow the ramp of an abort, and another abort in its place: that begins as fast as the motor is.
TEST_F(RampsAndTime, AnotherAbortOnTheRampOfOneKeepsItsRate) {
  for (const char* hold : {"H", "%50", "%150"})
    for (const char* jog : {"#1J-", "#1J/", "#1J:100"}) {
      SCOPED_TRACE(hold + std::string(jog));
      begin(kPrograms[0]);
      ASSERT_EQ(host("I5194=1000 I5195=1000 I192=2"), "");
      ASSERT_EQ(host(hold), "");
      ticks(12);
      ASSERT_EQ(host("A"), "");
      platform::servo_ticks(4);
      double last = place();
      platform::servo_ticks(1);
      double velocity = (place() - last) / kTickMs;
      ASSERT_EQ(host(jog), "");
      ASSERT_EQ(host("A"), "");
      for (int tick = 1; tick < 300; ++tick) {
        last = place();
        platform::servo_ticks(1);
        const double now = (place() - last) / kTickMs;
        ASSERT_LE(std::abs(now - velocity), 2.5 * kTickMs) << tick;
        velocity = now;
      }
    }
}

// motion:5.1/1: its last step, too; a RAPID move made that at Isx94, which may be long.
TEST_F(RampsAndTime, ARapidMoveIsBackAtItsSpeedWithTheHoldsEnd) {
  begin("RAPID X100");
  ASSERT_EQ(host("I5195=1000000 I5194=1"), "");
  ASSERT_EQ(host("H"), "");
  ticks(50);
  ASSERT_EQ(host("R"), "");
  ticks(10);
  const double from = place();
  ticks(10);
  EXPECT_NEAR(place() - from, 40 * ticks_of(10) * kTickMs, 0.5);
}

}  // namespace
