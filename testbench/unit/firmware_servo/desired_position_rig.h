// Motors 1 and 2 with encoders and a master whose words the test writes; the servo interrupt a part at a time.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/position_loop.h"
}

namespace brick {

constexpr std::int64_t kCount = 32 * 96;

class DesiredPosition : public ::testing::Test {
 protected:
  DesiredPosition() {
    c_.line(
        "I8000=0 I103=$10F0 I104=$10F0 I124=$800001 I111=0 I203=$10F1 I204=$10F1 I224=$800001 I211=0 I100=1 I200=1");
    position_loop_servo(0);
    position_loop_servo(1);
  }
  void close() {
    ASSERT_TRUE(motor_close(0));
    ASSERT_TRUE(motor_close(1));
  }
  static double desired(double trajectory, unsigned motor = 0) {
    motors[motor].trajectory = std::llround(trajectory * kCount);
    desired_position_servo(motor);
    return static_cast<double>(motors[motor].commanded) / kCount;
  }
  static void master(double counts) {
    *hal_x(0x10F5) = static_cast<std::uint32_t>(std::lround(counts * 32)) & HAL_WORD_MASK;
  }

  Controller c_;
};

}  // namespace brick
