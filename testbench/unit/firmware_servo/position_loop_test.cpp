// The servo loop against a model in double precision, written from motion:1.1: within one bit of a 16-bit output. Where
// the two are within a bit of a clip, the model takes the firmware's decision to freeze the integral.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
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
namespace {

constexpr std::uint32_t kPosition = 0x10F0, kVelocity = 0x10F1, kDac = 0x78002;

double i(unsigned number) { return i_variable_read(100 + number); }

class Model {
 public:
  // Positions in counts; `frozen`: what the firmware has decided about the integral, where it may.
  double cycle(double commanded, double actual, double velocity_position) {
    const double fe = commanded - actual;
    const double cv = commanded - commanded_, ca = cv - cv_, av = velocity_position - velocity_position_;
    const double e = clamp(fe, i(67) / 16);
    const double ep = e + i(64) / 16 * clamp(e, i(65) / 16);
    double integrand = ep;
    if ((static_cast<int>(i(96)) & 2) != 0) integrand += (i(32) * cv * i(8) - i(31) * av * i(9)) / 128 / i(8);
    if (!saturated_ && !(i(34) == 1 && cv != 0)) integral_ += i(33) * integrand / 8388608;
    integral_ = clamp(integral_, std::abs(i(63)) / 16);
    const double v = (i(32) * cv + i(35) * ca) / 128 * i(8) - i(31) * av / 128 * i(9);
    const double u = i(30) * (i(8) * (ep + integral_) + v) / 524288;
    const double y = u + i(36) * u_[0] + i(37) * u_[1] - i(38) * y_[0] - i(39) * y_[1];
    u_[1] = u_[0];
    u_[0] = u;
    y_[1] = y_[0];
    y_[0] = y;
    commanded_ = commanded;
    cv_ = cv;
    velocity_position_ = velocity_position;
    return clamp(y + (cv > 0 ? i(68) : cv < 0 ? -i(68) : 0), i(69));
  }
  void saturated(bool value) { saturated_ = value; }
  void start(double position, double velocity_position) {
    *this = Model();
    commanded_ = position;
    velocity_position_ = velocity_position;
  }
  double integral() const { return integral_; }

 private:
  static double clamp(double value, double most) { return std::max(-most, std::min(most, value)); }

  double commanded_ = 0, velocity_position_ = 0, cv_ = 0, integral_ = 0, u_[2] = {0, 0}, y_[2] = {0, 0};
  bool saturated_ = false;
};

class PositionLoop : public ::testing::Test {
 protected:
  PositionLoop() { c_.line("I100=1 I8000=0 I103=$10F0 I104=$10F1 I167=8388607 I124=$800001"); }

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
    expected_ = model_.cycle(static_cast<double>(commanded) / 32 / i(8), position / 32.0, velocity_position / 32.0);
    output_ = motors[0].output / 256.0;
    model_.saturated(std::abs(output_) == i(69));
  }

  Controller c_;
  Model model_;
  double expected_ = 0, output_ = 0;
};

struct Pick {
  std::mt19937_64 random{1};
  double real(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
  std::int64_t whole(std::int64_t from, std::int64_t to) {
    return std::uniform_int_distribution<std::int64_t>(from, to)(random);
  }
  double power(double from, double to) { return std::exp(real(std::log(from), std::log(to))); }
  bool one_in(int n) { return whole(1, n) == 1; }
};

TEST_F(PositionLoop, EqualsTheModelOverRandomMotion) {
  constexpr int kSets = 500, kCycles = 200;
  Pick pick;
  int clipped = 0, inside = 0, notched = 0;
  double worst = 0;
  for (int set = 0; set < kSets; ++set) {
    motor_kill(0);
    variable(8, set % 3 != 0 ? 96 : pick.whole(1, 5000));
    variable(9, set % 3 != 0 ? 96 : pick.whole(1, 5000));
    variable(30, std::floor(pick.power(100, 400000)) * (pick.one_in(5) ? -1 : 1));
    variable(31, std::floor(pick.power(1, 20000)) * (pick.one_in(5) ? -1 : 1));
    variable(32, std::floor(pick.power(1, 20000)));
    variable(33, pick.one_in(3) ? 0 : std::floor(pick.power(1, 1000000)));
    variable(34, pick.whole(0, 1));
    variable(35, pick.one_in(2) ? 0 : std::floor(pick.power(1, 100000)));
    variable(63, pick.one_in(3) ? std::floor(pick.power(1, 1000)) : 4194304);
    variable(64, pick.one_in(2) ? 0 : pick.whole(-16, 32));
    variable(65, pick.whole(0, 64));
    variable(67, pick.one_in(3) ? std::floor(pick.power(1, 1000)) : 8388607);
    variable(68, pick.one_in(2) ? 0 : pick.whole(0, 2000));
    variable(69, pick.whole(1000, 32767));
    variable(96, pick.one_in(4) ? 2 : 0);
    const bool notch = pick.one_in(2);
    const double radius = pick.real(0, 0.95), angle = pick.real(0, M_PI);  // of the poles
    variable(36, notch ? pick.real(-1.9, 1.9) : 0);
    variable(37, notch ? pick.real(-0.99, 0.99) : 0);
    variable(38, notch ? -2 * radius * std::cos(angle) : 0);
    variable(39, notch ? radius * radius : 0);
    notched += notch ? 1 : 0;
    std::int64_t position = pick.whole(-8000000, 8000000), velocity = position, speed = 0;
    const double bits_a_count = std::abs(i(30)) * i(8) / 524288;
    const double reach = std::min(1e5, pick.power(50, 30000) / bits_a_count);  // counts of error
    close(position, velocity);
    for (int n = 0; n < kCycles; ++n) {
      speed = pick.one_in(20) ? pick.whole(-300, 300) : speed;
      position += speed;
      velocity += speed + pick.whole(-2, 2);
      const bool stands = n / 20 % 3 == 0;
      static std::int64_t last;
      const double error = reach * pick.real(-1, 1);
      const std::int64_t wanted = position * static_cast<std::int64_t>(i(8)) + std::llround(error * 32 * i(8));
      last = stands && n > 0 ? last : wanted;
      cycle(last, position, velocity);
      const double difference = std::abs(output_ - expected_);
      worst = std::max(worst, difference);
      ASSERT_LE(difference, 1.0) << "set " << set << " cycle " << n << ": " << output_ << " for " << expected_
                                 << c_.line("I108 I109 I130..135 I136..139 I163..165 I167..169 I196");
      (std::abs(output_) == i(69) ? clipped : inside)++;
    }
  }
  EXPECT_GT(clipped, 5000);
  EXPECT_GT(inside, 50000);
  EXPECT_GT(notched, 200);
  RecordProperty("worst", std::to_string(worst));
  std::printf("worst %.3f, clipped %d, inside %d\n", worst, clipped, inside);
}

// 2^-19 Ixx30 Ixx08 bits a count.
TEST_F(PositionLoop, ProportionalGain) {
  c_.line("I130=2000 I131=0 I132=0 I133=0");
  close(0, 0);
  cycle(100 * 32 * 96, 0, 0);
  EXPECT_NEAR(output_, 100 * 2000 * 96 / 524288.0, 1 / 256.0);
  c_.line("I130=-2000");
  cycle(100 * 32 * 96, 0, 0);
  EXPECT_NEAR(output_, -100 * 2000 * 96 / 524288.0, 1 / 256.0);
}

// Ixx63 is 16 times the integral's equivalent in counts; 0 takes it away; Ixx33 = 0 keeps what there is.
TEST_F(PositionLoop, IntegrationLimit) {
  c_.line("I130=10000 I131=0 I132=0 I133=8388607 I134=0 I163=1600 I167=160");
  close(0, 0);
  for (int n = 0; n < 100; ++n) cycle(1000 * 32 * 96, 0, 0);
  EXPECT_NEAR(output_, (10 + 100) * 10000 * 96 / 524288.0, 0.01);
  EXPECT_TRUE(position_loop_is_limited(0));
  c_.line("I133=0");
  cycle(0, 0, 0);
  EXPECT_NEAR(output_, 100 * 10000 * 96 / 524288.0, 0.01);
  c_.line("I163=0");
  cycle(0, 0, 0);
  EXPECT_EQ(output_, 0);
}

TEST_F(PositionLoop, TheIntegralStandsWhileTheOutputIsAtItsLimit) {
  c_.line("I130=100000 I131=0 I132=0 I133=1000000 I134=0 I169=1000");
  close(0, 0);
  for (int n = 0; n < 10; ++n) cycle(1000 * 32 * 96, 0, 0);
  const std::int64_t integral = position_loop_integral(0);
  EXPECT_NEAR(integral, 1000 * 32 * 96 * 1000000.0 / 8388608, 2) << "the first cycle only";
  EXPECT_EQ(output_, 1000);
}

TEST_F(PositionLoop, Ixx34IntegratesAtRestOnly) {
  c_.line("I130=2000 I131=0 I132=0 I133=100000 I134=1");
  close(0, 0);
  for (int n = 1; n <= 10; ++n) cycle(n * 32 * 96, 0, 0);
  EXPECT_EQ(position_loop_integral(0), 0);
  cycle(10 * 32 * 96, 0, 0);
  EXPECT_NEAR(position_loop_integral(0), 10 * 32 * 96 * 100000.0 / 8388608, 2);
}

TEST_F(PositionLoop, AnOpenLoopHasNoIntegral) {
  c_.line("I130=2000 I133=100000 I134=0");
  close(0, 0);
  for (int n = 0; n < 10; ++n) cycle(32 * 96, 0, 0);
  EXPECT_NE(position_loop_integral(0), 0);
  motor_kill(0);
  position_loop_servo(0);
  EXPECT_EQ(position_loop_integral(0), 0);
  EXPECT_EQ(position_loop_filtered(0), 0);
  EXPECT_EQ(c_.line("RX$AE"), "0");
  EXPECT_EQ(motors[0].output, 0);
  EXPECT_EQ(motors[0].commanded, motors[0].actual) << "a killed motor has no following error";
}

// Every Ixx60+1 interrupts; velocities are those of a closure.
TEST_F(PositionLoop, ExtensionSlowsTheLoopOnly) {
  c_.line("I160=3 I130=2000 I131=1280 I132=0");
  close(0, 0);
  int closures = 0;
  for (int n = 1; n <= 40; ++n) {
    const std::int64_t before = motors[0].actual;
    at(n * 32, n * 32);
    motors[0].trajectory = n * 32 * 96;
    desired_position_servo(0);
    position_loop_servo(0);
    if (motors[0].actual != before) {
      closures++;
      if (closures > 1) { EXPECT_EQ(motors[0].velocity, 4 * 32 * 96); }
    }
    EXPECT_EQ(motors[0].desired_step, 32 * 96) << "the trajectory goes on every interrupt";
  }
  EXPECT_EQ(closures, 10);
}

// The raw word is that of a closure; V stays that of a servo interrupt.
TEST_F(PositionLoop, ReportedVelocityKnowsNoExtension) {
  c_.line("I160=3");
  close(0, 0);
  for (int n = 1; n <= 40; ++n) {
    at(n * 32 * 5, n * 32 * 5);
    position_loop_servo(0);
  }
  EXPECT_EQ(c_.line("RX$9D"), std::to_string(4 * 5 * 32 * 96));
  EXPECT_EQ(c_.line("#1V"), "5");
}

TEST_F(PositionLoop, SourcesRollOver) {
  close(0x7FFFF0, 0x7FFFF0);
  position_loop_servo(0);
  const std::int64_t before = motors[0].actual;
  at(-0x7FFFF0, -0x7FFFF0);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual - before, 32 * 96);
  EXPECT_EQ(motors[0].velocity, 32 * 96);
}

// One word for position and velocity is read once; then Ixx04 or Ixx09 become others, and nothing jumps.
TEST_F(PositionLoop, VelocityOfTheSameWord) {
  c_.line("I104=$10F0");
  close(0, 0);
  const auto velocity_after = [this](std::int64_t position) {
    at(position, 5000);
    position_loop_servo(0);
    return motors[0].velocity;
  };
  velocity_after(0);
  EXPECT_EQ(velocity_after(7), 7 * 96);
  EXPECT_EQ(velocity_after(9), 2 * 96);
  c_.line("I109=48");
  EXPECT_EQ(velocity_after(10), 48);
  c_.line("I109=96");
  EXPECT_EQ(velocity_after(14), 4 * 96);
  c_.line("I104=$10F1");
  EXPECT_EQ(velocity_after(15), 0);
}

TEST_F(PositionLoop, OpenLoopPutsOutWhatItIsTold) {
  ASSERT_TRUE(motor_open(0, 1234 << 8));
  position_loop_servo(0);
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 1234u << 8);
}

// The bias is added after the clip, and stays on the output of a killed motor.
TEST_F(PositionLoop, BiasIsAddedToTheWord) {
  c_.line("I129=-300 I169=1000 I130=100000");
  close(0, 0);
  cycle(1000 * 32 * 96, 0, 0);
  motor_output_servo(0);
  EXPECT_EQ(hal_signed(*hal_y(kDac)), (1000 - 300) * 256);
  motor_kill(0);
  EXPECT_EQ(hal_signed(*hal_y(kDac)), -300 * 256);
  c_.line("I129=32767 I169=32767");
  close(0, 0);
  cycle(1000 * 32 * 96, 0, 0);
  motor_output_servo(0);
  EXPECT_EQ(hal_signed(*hal_y(kDac)), 0x7FFFFF);
}

TEST_F(PositionLoop, AKilledMotorLeavesItsRegisterToTheUser) {
  motor_output_servo(0);
  c_.line("WY$78002,$123400");
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 0x123400u);
  ASSERT_TRUE(motor_open(0, 0));
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 0u);
}

TEST_F(PositionLoop, TheWordGoesToXForIxx01Of2) {
  c_.line("I101=2 I102=$10F8");
  ASSERT_TRUE(motor_open(0, 77 << 8));
  position_loop_servo(0);
  motor_output_servo(0);
  EXPECT_EQ(*hal_x(0x10F8), 77u << 8);
}

}  // namespace
}  // namespace brick
