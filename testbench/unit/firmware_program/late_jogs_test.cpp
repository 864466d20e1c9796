// Jogs whose planning others take the time of (firmware/motion/jog_plan.h), and several that one character stops.
#include <algorithm>

#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/command/control_characters.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/jog_servo.h"
#include "firmware/motion/motor.h"
extern volatile std::uint32_t jogs_asked;  // jog_state.h: motors whose request is not planned yet
}

namespace {

// Each moment that it is planned for is over too soon, 2 to 512 interrupts ahead, as long as others take the time: in
// the same round it is planned once they do not.
TEST(LateJogs, ArePlannedInTheSameRound) {
  constexpr std::int64_t kTarget = 10 * 32 * 96;
  platform::power_up();
  ASSERT_EQ(platform::host("I100=1 I119=0.25 I120=0 I121=50 I122=20 I192=1"), "");
  motors[0].position_scale = 96;
  motors[0].loop = LOOP_CLOSED;
  int longest = 0;
  for (const int late : {0, 30, 150, 400, 900}) {
    motors[0].trajectory = 0;
    motors[0].path = PATH_STANDS;
    ASSERT_TRUE(jog_to(0, kTarget));
    ASSERT_NE(jogs_asked, 0u);
    int pauses = 0;
    platform::real_time_in_slices([&] {
      if (jogs_asked == 0 || ++pauses > late) return;
      for (int i = 0; i < 600; ++i) jog_servo(0);
    });
    EXPECT_EQ(jogs_asked, 0u) << late;
    longest = std::max(longest, pauses);
    for (int i = 0; i < 2000 && jog_is_moving(0); ++i) jog_servo(0);
    EXPECT_EQ(motors[0].trajectory, kTarget) << late;
  }
  EXPECT_GT(longest, 900) << "nothing was late for so long";
}

// It is planned for the second interrupt from then. That has just come: it is in time, and moves with the next one.
// Else for the eighth from where it is looked at again.
TEST(LateJogs, AMomentThatHasJustComeIsInTime) {
  for (const unsigned within : {0u, 1u, 2u, 3u}) {
    platform::power_up();
    ASSERT_EQ(platform::host("I100=1 I119=0.25 I120=0 I121=0 I122=20 I192=0"), "");
    motors[0].position_scale = 96;
    motors[0].loop = LOOP_CLOSED;
    ASSERT_TRUE(jog_to(0, 10 * 32 * 96));
    unsigned came = 0, pauses = 0;
    platform::real_time_in_slices([&] {
      for (++pauses; pauses == 2 && came < within; ++came) jog_servo(0);  // behind its first look
    });
    ASSERT_EQ(jogs_asked, 0u);
    for (; came < 100 && motors[0].trajectory == 0; ++came) jog_servo(0);
    EXPECT_EQ(came, within <= 2 ? 3u : 3u + 8 + 1) << within;
  }
}

// ^A: one of no system is stopped by its own Ixx15. From 20 counts/ms 20 ms by 1 count/ms^2, 200 ms by 0.1.
TEST(StoppedJogs, EachDeceleratesByItsOwnRate) {
  platform::power_up();
  for (const char* set :
       {"I100=1 I111=0 I119=1 I120=20 I121=0 I122=20 I115=1", "I200=1 I211=0 I219=1 I220=20 I221=0 I222=20 I215=.1",
        "I300=1 I311=0 I319=1 I320=20 I321=0 I322=20 I315=1"})
    ASSERT_EQ(platform::host(set), "");
  for (unsigned motor = 0; motor < 3; ++motor) {
    motors[motor].position_scale = 96;
    motors[motor].loop = LOOP_CLOSED;
  }
  ASSERT_EQ(platform::host("#1J+#2J+#3J+"), "");
  const auto run = [](double ms) {
    platform::servo_ticks(static_cast<unsigned>(ms * 8388608 / platform::kDefaultI10));
  };
  run(60);
  for (unsigned motor = 0; motor < 3; ++motor) ASSERT_TRUE(jog_is_moving(motor)) << motor;
  ASSERT_FALSE(control_character(1));
  run(30);
  for (unsigned motor = 0; motor < 3; ++motor) EXPECT_EQ(jog_is_moving(motor), motor == 1) << motor;
  run(160);
  EXPECT_TRUE(jog_is_moving(1));
  run(30);
  EXPECT_FALSE(jog_is_moving(1));
}

}  // namespace
