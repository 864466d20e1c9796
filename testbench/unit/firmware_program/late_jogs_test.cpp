// Jogs whose planning others take the time of (firmware/motion/jog_plan.h).
#include <algorithm>

#include "testbench/unit/firmware_program/platform.h"

extern "C" {
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

}  // namespace
