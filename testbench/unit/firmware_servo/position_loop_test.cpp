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
#include "firmware/motion/conversion_table.h"
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
  for (int n = 0; n < 10; ++n) cycle(32 * 96 * n, 0, 0);
  EXPECT_NE(position_loop_integral(0), 0);
  EXPECT_NE(position_loop_step(0), 0);
  EXPECT_NE(c_.line("RX$AE"), "0");
  motor_kill(0);
  position_loop_servo(0);
  EXPECT_EQ(position_loop_integral(0), 0);
  EXPECT_EQ(position_loop_step(0), 0);
  EXPECT_EQ(position_loop_filtered(0), 0);
  EXPECT_EQ(c_.line("RX$AE"), "0");
  EXPECT_EQ(motors[0].output, 0);
  EXPECT_EQ(motors[0].commanded, motors[0].actual) << "a killed motor has no following error";
}

// Killed and closed between two servo interrupts: nothing of before is left, the notch's past neither.
TEST_F(PositionLoop, ALoopThatIsClosedAgainAtOnceBeginsAnew) {
  c_.line("I130=2000 I131=0 I132=128 I133=8388607 I134=0 I135=12800 I136=-1.5 I137=0.9 I138=-0.5 I139=0.25");
  close(0, 0);
  for (int n = 1; n <= 20; ++n) cycle(50 * n * 32 * 96, 0, 0);
  EXPECT_NE(position_loop_integral(0), 0);
  EXPECT_NE(position_loop_step(0), 0);
  motor_kill(0);
  ASSERT_TRUE(motor_close(0));
  EXPECT_EQ(position_loop_integral(0), 0);
  EXPECT_EQ(position_loop_step(0), 0);
  model_.start(0, 0);
  for (int n = 1; n <= 5; ++n) {
    cycle(10 * n * 32 * 96, 0, 0);
    EXPECT_NEAR(output_, expected_, 0.05) << n;
  }
}

// Under the sanitizers: gains, scales and limits at their ends, positions that jump from end to end.
TEST_F(PositionLoop, NothingOverflowsAtTheEndsOfAllRanges) {
  Pick pick;
  const auto one_of = [&pick](std::initializer_list<double> v) { return v.begin()[pick.whole(0, v.size() - 1)]; };
  for (int set = 0; set < 60; ++set) {
    motor_kill(0);
    for (const unsigned scale : {8u, 9u}) variable(scale, one_of({1, 96, 8388607}));
    for (const unsigned gain : {30u, 31u, 32u, 35u}) variable(gain, one_of({-8388608, 0, 8388607}));
    variable(33, one_of({0, 8388607}));
    variable(34, one_of({0, 1}));
    for (const unsigned k : {36u, 37u, 38u, 39u}) variable(k, set % 2 == 0 ? 0 : one_of({-2, 0, 1.9999997}));
    variable(63, one_of({-8388608, 0, 8388607}));
    variable(64, one_of({-32768, 0, 32767}));
    for (const unsigned k : {65u, 67u}) variable(k, one_of({0, 8388607}));
    for (const unsigned k : {68u, 69u}) variable(k, one_of({0, 32767}));
    variable(96, one_of({0, 2}));
    close(0, 0);
    for (int n = 0; n < 100; ++n) {
      motors[0].trajectory = static_cast<std::int64_t>(one_of({-1, 0, 1})) * (INT64_C(1) << pick.whole(0, 61));
      at(pick.whole(-8388608, 8388607), pick.whole(-8388608, 8388607));
      desired_position_servo(0);
      position_loop_servo(0);
      motor_output_servo(0);
      ASSERT_LE(std::abs(motors[0].output), i(69) * 256);
    }
  }
}

// motion:1.3: what the loop shows, in units of 1/(32 Ixx08) count and in bits of 24.
TEST_F(PositionLoop, WordsOfTheLoop) {
  c_.line("I130=4000 I131=0 I132=0 I133=131072 I134=0 I168=100 I137=0.5");
  close(0, 0);
  cycle(-10 * 32 * 96, 0, 0);
  cycle(-12 * 32 * 96, 0, 0);
  const auto word = [this](const char* command) { return std::stol(c_.line(command)); };
  const long integral = -22 * 32 * 96 / 64;  // Ixx33 / 2^23 = 1/64
  EXPECT_EQ(word("RX$9E"), -1);
  EXPECT_EQ(word("RY$9E"), integral);
  EXPECT_EQ(word("RX$87"), -1);
  EXPECT_EQ(word("RY$87"), -2 * 32 * 96);
  const double pid = (-12 - 22 / 64.0) * 4000 * 96 / 524288;  // bits of 16
  EXPECT_NEAR(word("RX$AE") / 256.0, pid, 0.01);
  const double before = -10 * (1 + 1 / 64.0) * 4000 * 96 / 524288;
  EXPECT_EQ(word("RX$BF"), motors[0].output);
  EXPECT_NEAR(word("RX$BF") / 256.0, pid - 100, 0.01) << "N2 is two closures back";
  cycle(-12 * 32 * 96, 0, 0);
  EXPECT_NEAR(word("RX$BF") / 256.0, (-12 - 34 / 64.0) * 4000 * 96 / 524288 + 0.5 * before, 0.01);
  EXPECT_EQ(word("RX$88"), -1);
  EXPECT_EQ(word("RY$88"), -12 * 32 * 96);
  at(-5 * 32, -5 * 32);
  position_loop_servo(0);
  EXPECT_EQ(word("RX$8B"), -1);
  EXPECT_EQ(word("RY$8B"), -5 * 32 * 96);
  EXPECT_EQ(word("RX$9D"), -5 * 32 * 96);
  cycle(6000 * 32 * 96, 5999 * 32, 0);
  EXPECT_EQ(word("RX$88"), 1);
  EXPECT_EQ(word("RY$88"), 6000 * 32 * 96 - 16777216);
  EXPECT_EQ(word("RX$8B"), 1);
  EXPECT_EQ(word("RY$8B"), 5999 * 32 * 96 - 16777216);
}

// What the notch is given may be far beyond a word, which shows its end.
TEST_F(PositionLoop, TheWordOfThePidHasAnEnd) {
  c_.line("I130=8388607 I131=0 I132=0 I133=0");
  close(0, 0);
  cycle(5000 * 32 * 96, 0, 0);
  EXPECT_EQ(c_.line("RX$AE"), "8388607");
  cycle(-5000 * 32 * 96, 0, 0);
  EXPECT_EQ(c_.line("RX$AE"), "-8388607");
}

// A counter that is cleared is no movement: in the interrupt after that and in the next.
TEST_F(PositionLoop, MovementThatIsForgotten) {
  close(0, 0);
  position_loop_forget_movement(0);
  const std::int64_t before = motors[0].actual;
  at(1000, 1000);
  position_loop_servo(0);
  at(1100, 1100);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual, before);
  at(1132, 1132);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual - before, 32 * 96);
}

// A filter that is switched on while the loop runs has no past.
TEST_F(PositionLoop, ANotchThatIsSwitchedOnBeginsAtRest) {
  c_.line("I130=2000 I131=0 I132=0 I133=0 I138=0.5");
  close(0, 0);
  for (int n = 0; n < 5; ++n) cycle(100 * 32 * 96, 0, 0);
  c_.line("I138=0");
  cycle(100 * 32 * 96, 0, 0);
  c_.line("I136=0.5");
  cycle(100 * 32 * 96, 0, 0);
  const double pid = 100 * 2000 * 96 / 524288.0;
  EXPECT_NEAR(output_, pid, 0.01);
  cycle(100 * 32 * 96, 0, 0);
  EXPECT_NEAR(output_, pid * 1.5, 0.01);
}

// D:$8D, D:$90 and D:$CC are set by writes of either half.
TEST_F(PositionLoop, PositionsThatMayBeWritten) {
  std::int64_t* const positions[] = {&motors[0].master, &motors[0].compensation, &motors[0].bias};
  const char* const addresses[] = {"$8D", "$90", "$CC"};
  for (int k = 0; k < 3; ++k) {
    const std::string at = addresses[k];
    c_.line("WX" + at + ",-2");
    c_.line("WY" + at + ",5");
    EXPECT_EQ(*positions[k], -2 * 16777216 + 5) << at;
    EXPECT_EQ(c_.line("RX" + at), "-2") << at;
    EXPECT_EQ(c_.line("RY" + at), "5") << at;
    c_.line("WY" + at + ",-1");
    EXPECT_EQ(*positions[k], -2 * 16777216 + 16777215) << at;
    c_.line("WX" + at + ",1");
    EXPECT_EQ(*positions[k], 2 * 16777216 - 1) << at;
  }
}

// motion:2: up to 2^18 bits of a parallel word an interrupt, 24 bits that go round, and no count is lost.
TEST_F(PositionLoop, AParallelWordMayMoveByTwoTo18) {
  c_.line("I8000=$2010F2 I8001=$18000 I103=$3502 I104=$3502 I8002=0");
  conversion_table_servo();
  position_loop_servo(0);
  const std::int64_t begin = motors[0].actual;
  for (std::int64_t n = 1; n <= 1000; ++n) {
    *hal_y(0x10F2) = static_cast<std::uint32_t>(n * 262143) & HAL_WORD_MASK;
    conversion_table_servo();
    position_loop_servo(0);
  }
  EXPECT_EQ(motors[0].actual - begin, 1000 * 262143ll * 32 * 96);
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

// Where another source stands is no movement.
TEST_F(PositionLoop, AnotherSourceIsNoMovement) {
  close(1000, 1000);
  position_loop_servo(0);
  at(1000, 5000);
  position_loop_servo(0);
  const std::int64_t before = motors[0].actual;
  c_.line("I103=$10F1 I104=$10F0");
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual, before);
  EXPECT_EQ(motors[0].velocity, 0);
  at(1000, 5032);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual - before, 32 * 96);
}

// A smaller Ixx60 acts at once, a loop that waits for its turn does not wait for the old one.
TEST_F(PositionLoop, ASmallerExtensionActsAtOnce) {
  c_.line("I160=255");
  close(0, 0);
  position_loop_servo(0);
  at(32, 32);
  c_.line("I160=1");
  position_loop_servo(0);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual, 32 * 96);
}

TEST_F(PositionLoop, OpenLoopPutsOutWhatItIsTold) {
  ASSERT_TRUE(motor_open(0, 1234 << 8));
  position_loop_servo(0);
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 1234u << 8);
  motor_kill(0);
  EXPECT_EQ(*hal_y(kDac), 0u);
  position_loop_servo(0);
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 0u) << "nor later";
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
