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

}  // namespace
