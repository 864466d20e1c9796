// The servo loop against a model in double precision, written from motion:1.1: within one bit of a 16-bit output. Where
// the two are within a bit of a clip, the model takes the firmware's decision to freeze the integral.
#include <random>

#include "testbench/unit/firmware_servo/position_loop_rig.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

using PositionLoop = PositionLoopRig;

struct Pick {
  std::mt19937_64 random{random_seed(1)};
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
    const double bits_a_count = std::abs(ixx(30)) * ixx(8) / 524288;
    const double reach = std::min(1e5, pick.power(50, 30000) / bits_a_count);  // counts of error
    close(position, velocity);
    for (int n = 0; n < kCycles; ++n) {
      speed = pick.one_in(20) ? pick.whole(-300, 300) : speed;
      position += speed;
      velocity += speed + pick.whole(-2, 2);
      const bool stands = n / 20 % 3 == 0;
      static std::int64_t last;
      const double error = reach * pick.real(-1, 1);
      const std::int64_t wanted = position * static_cast<std::int64_t>(ixx(8)) + std::llround(error * 32 * ixx(8));
      last = stands && n > 0 ? last : wanted;
      cycle(last, position, velocity);
      const double difference = std::abs(output_ - expected_);
      worst = std::max(worst, difference);
      ASSERT_LE(difference, 1.0) << "set " << set << " cycle " << n << ": " << output_ << " for " << expected_
                                 << c_.line("I108 I109 I130..135 I136..139 I163..165 I167..169 I196");
      (std::abs(output_) == ixx(69) ? clipped : inside)++;
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

// motion:1.1/11
TEST_F(PositionLoop, TheExtendedAlgorithmClosesNoLoop) {
  EXPECT_EQ(c_.line("I100=1 I3300=1 I3301=0.5 I3310=7 I3300 I3301 I3310"), "1|0.5|7");
  for (const char* command : {"J/", "J+", "HM"}) EXPECT_EQ(c_.line(std::string("#1") + command), "ERR018") << command;
  EXPECT_EQ(c_.line("I3300=0 #1J/"), "");
  EXPECT_EQ(c_.line("I200=1 #2J/"), "") << "each motor has a switch of its own";
}

// Errors and steps of more than 32 bits: Ixx67 and the ends of the output hold, and the sign is right.
TEST_F(PositionLoop, FarAwayTheSignIsRight) {
  c_.line("I130=10 I131=0 I132=0 I133=0 I167=1600");
  close(0, 0);
  for (const double counts : {1e6, -1e6, 2e6, -3e6, 1e9, -1e12}) {
    cycle(std::llround(counts * 32 * 96), 0, 0);
    EXPECT_NEAR(output_, (counts > 0 ? 100 : -100) * 10 * 96 / 524288.0, 1 / 256.0) << counts;
    for (int n = 0; n < 3; ++n) cycle(std::llround(counts * 32 * 96), 0, 0);
    EXPECT_NEAR(output_, (counts > 0 ? 100 : -100) * 10 * 96 / 524288.0, 1 / 256.0) << counts << " and stays";
  }
  c_.line("I132=32767");
  cycle(0, 0, 0);
  cycle(std::llround(1e6 * 32 * 96), 0, 0);
  EXPECT_EQ(output_, ixx(69)) << "velocity feedforward of a step";
  cycle(std::llround(-1e6 * 32 * 96), 0, 0);
  EXPECT_EQ(output_, -ixx(69));
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

// motion:1.1/10: a limit beyond 2^39 units is that, and the integral comes to it.
TEST_F(PositionLoop, TheIntegralHasAnEndOfItsOwn) {
  c_.line("I108=8388607 I109=8388607 I130=0 I131=0 I132=0 I133=8388607 I134=0 I163=8388607 I167=8388607");
  for (const std::int64_t sign : {1, -1}) {
    close(0, 0);
    motors[0].trajectory = sign * (INT64_C(1) << 40);
    for (int n = 0; n < 200; ++n) {
      desired_position_servo(0);
      position_loop_servo(0);
    }
    EXPECT_EQ(position_loop_integral(0), sign * (INT64_C(1) << 39));
    EXPECT_TRUE(position_loop_is_limited(0));
  }
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
      ASSERT_LE(std::abs(motors[0].output), ixx(69) * 256);
    }
  }
}

// A filter that is switched on while the loop runs has no past, and then keeps it.
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
  c_.line("I131=0 I167=8388607");
  cycle(100 * 32 * 96, 0, 0);
  EXPECT_NEAR(output_, pid * 1.5, 0.01) << "other variables leave its past alone";
}

}  // namespace
}  // namespace brick
