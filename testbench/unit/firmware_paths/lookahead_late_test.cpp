// A real-time task that comes too late to make segments in lookahead (motion:7.1/10).
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/system_path.h"
}

namespace {

using namespace moving_motors;

class LookaheadLate : public MovingMotors {};

// motion:7.1/10: the real-time task does not come for 60 ms. With limits too: 25 counts/ms at 0.05 count/ms^2 are no
// end of what is made at rest.
TEST_F(LookaheadLate, WhatIsLateOnTheWayIsARunTimeError) {
  for (const char* isx20 : {"1", "200"}) {
    SCOPED_TRACE(isx20);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I5113=5 I116=50 I117=0.05 I5120=") + isx20), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,0"), "");
    store({"TM1200 TA20 TS0", "X30"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(ticks_of(700));
    const double before = at(1);
    for (unsigned n = ticks_of(60); n > 0; --n) system_path_servo();
    EXPECT_GT(at(1), before + 20);
    EXPECT_EQ(cs().error, RUN_TIME_NONE);
    platform::servo_ticks(10);
    EXPECT_EQ(cs().error, RUN_TIME_LATE);
    EXPECT_FALSE(run_is_running(0));
  }
}

// The same while the real-time task makes the next segment, whose work is left meanwhile: what comes then is not
// executed from a stand at full speed.
TEST_F(LookaheadLate, WhatIsLateWhileItIsMadeIsARunTimeError) {
  for (const char* isx20 : {"0", "1", "200"})
    for (unsigned left = 1; left < 34; left += 4) {
      SCOPED_TRACE(isx20 + std::string(", left at pause ") + std::to_string(left));
      platform::power_up();
      fit({"1000X"});
      ASSERT_EQ(host(std::string("I5113=5 I116=50 I117=1 I5120=") + isx20), "");
      ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,0"), "");
      store({"TM1200 TA20 TS0", "X30"});
      ASSERT_EQ(host("&1B1R"), "");
      platform::servo_ticks(ticks_of(700));
      while (cs().ring.added - cs().ring.executing > 1) system_path_servo();
      unsigned pauses = 0;
      platform::real_time_in_slices([&] {
        if (++pauses == left)
          while (cs().active) system_path_servo();
      });
      ASSERT_GE(pauses, left);
      const double stands = at(1);
      platform::servo_ticks(40);
      EXPECT_EQ(cs().error, RUN_TIME_LATE);
      EXPECT_EQ(at(1), stands);
    }
}

// At rest nothing is late: where `\\` has led it, at the oldest segment, and at the end.
TEST_F(LookaheadLate, WhatIsLateAtRestIsNoError) {
  for (const char* isx20 : {"1", "40"}) {
    SCOPED_TRACE(isx20);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I5113=5 I116=50 I117=1 I5120=") + isx20), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,0"), "");
    store({"TM200 TA20 TS0", "X5"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(ticks_of(150));
    for (const char* order : {"\\", "<", ">"}) {
      ASSERT_EQ(host(std::string("&1") + order), "");
      for (unsigned n = 0; n < 40; ++n) {
        platform::servo_ticks(ticks_of(8));
        for (unsigned late = ticks_of(9); late > 0; --late) system_path_servo();
      }
      EXPECT_EQ(cs().error, RUN_TIME_NONE) << order;
    }
    EXPECT_EQ(motors[0].trajectory, 5000 * 3072);
  }
}

}  // namespace
