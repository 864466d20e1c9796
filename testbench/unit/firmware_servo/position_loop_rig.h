// A motor whose words the test writes, its servo loop step by step, and the loop's model in double precision, written
// from motion:1.1.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_output.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/position_loop.h"
#include "firmware/variables/i_variables.h"
}

namespace brick {

constexpr std::uint32_t kPosition = 0x10F0, kVelocity = 0x10F1, kDac = 0x78002;

// Ixxnn of motor 1.
inline double ixx(unsigned number) { return i_variable_read(100 + number); }

class LoopModel {
 public:
  // Positions in counts; `frozen`: what the firmware has decided about the integral, where it may.
  double cycle(double commanded, double actual, double velocity_position) {
    const double fe = commanded - actual;
    const double cv = commanded - commanded_, ca = cv - cv_, av = velocity_position - velocity_position_;
    const double e = clamp(fe, ixx(67) / 16);
    const double ep = e + ixx(64) / 16 * clamp(e, ixx(65) / 16);
    double integrand = ep;
    if ((static_cast<int>(ixx(96)) & 2) != 0)
      integrand += (ixx(32) * cv * ixx(8) - ixx(31) * av * ixx(9)) / 128 / ixx(8);
    if (!saturated_ && !(ixx(34) == 1 && cv != 0)) integral_ += ixx(33) * integrand / 8388608;
    integral_ = clamp(integral_, std::abs(ixx(63)) / 16);
    const double v = (ixx(32) * cv + ixx(35) * ca) / 128 * ixx(8) - ixx(31) * av / 128 * ixx(9);
    const double u = ixx(30) * clamp(ixx(8) * (ep + integral_) + v, 0x1p39 / 32) / 524288;  // motion:1.1/10
    const double y = u + ixx(36) * u_[0] + ixx(37) * u_[1] - ixx(38) * y_[0] - ixx(39) * y_[1];
    u_[1] = u_[0];
    u_[0] = u;
    y_[1] = y_[0];
    y_[0] = y;
    commanded_ = commanded;
    cv_ = cv;
    velocity_position_ = velocity_position;
    return clamp(y + (cv > 0 ? ixx(68) : cv < 0 ? -ixx(68) : 0), ixx(69));
  }
  void saturated(bool value) { saturated_ = value; }
  void start(double position, double velocity_position) {
    *this = LoopModel();
    commanded_ = position;
    velocity_position_ = velocity_position;
  }
  double integral() const { return integral_; }

 private:
  static double clamp(double value, double most) { return std::max(-most, std::min(most, value)); }

  double commanded_ = 0, velocity_position_ = 0, cv_ = 0, integral_ = 0, u_[2] = {0, 0}, y_[2] = {0, 0};
  bool saturated_ = false;
};

class PositionLoopRig : public ::testing::Test {
 protected:
  PositionLoopRig() { c_.line("I100=1 I8000=0 I103=$10F0 I104=$10F1 I167=8388607 I124=$800001"); }

  void variable(unsigned number, double value) {
    char text[64];
    std::snprintf(text, sizeof text, "I1%02u=%.10f", number, value);
    ASSERT_EQ(c_.line(text), "");
  }
  static void source(std::uint32_t address, std::int64_t value) {
    *hal_x(address) = static_cast<std::uint32_t>(value) & HAL_WORD_MASK;
  }
  // 1/32 counts.
  void at(std::int64_t position, std::int64_t velocity_position) {
    source(kPosition, position);
    source(kVelocity, velocity_position);
  }
  void close(std::int64_t position, std::int64_t velocity_position) {
    motor_kill(0);
    at(position, velocity_position);
    position_loop_servo(0);
    motors[0].actual = position * motors[0].position_scale;  // where the test's counts begin
    motors[0].master = 0;
    ASSERT_TRUE(motor_close(0));
    model_.start(position / 32.0, velocity_position / 32.0);
  }
  // One servo interrupt: the trajectory is at `commanded` position units. Both outputs, 16-bit.
  void cycle(std::int64_t commanded, std::int64_t position, std::int64_t velocity_position) {
    motors[0].trajectory = commanded;
    at(position, velocity_position);
    desired_position_servo(0);
    position_loop_servo(0);
    expected_ = model_.cycle(static_cast<double>(commanded) / 32 / ixx(8), position / 32.0, velocity_position / 32.0);
    output_ = motors[0].output / 256.0;
    model_.saturated(std::abs(output_) == ixx(69));
  }

  Controller c_;
  LoopModel model_;
  double expected_ = 0, output_ = 0;
};

}  // namespace brick
