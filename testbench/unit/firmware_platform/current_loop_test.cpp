// The current loop natively: against motion:3.4 in double precision, open, and closed through the plant's motor.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "testbench/plant/motor.h"
#include "testbench/unit/firmware_platform/commutation_rig.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/motion/motor_state.h"
#include "firmware/motion/overload.h"
}

namespace brick {
namespace {

constexpr int kPwmScale = 6527;

// One axis of the controller, everything in parts of full scale.
struct AxisModel {
  double sum = 0, actual = 0, other = 0;  // other: what the sum is as well, where that is a matter of rounding
  double volts(double command, double ki, double kp, double kb) {
    const double growth = 8 * ki * (command - actual), before = sum, next = sum + growth;
    const double v = next + 4 * kp * (command - actual) - 4 * kb * actual;
    const bool outward = (v > 1 && growth >= 0) || (v < -1 && growth <= 0);
    sum = outward ? before : next;
    other = std::fabs(std::fabs(v) - 1) > kTie ? sum : outward ? next : before;
    return std::clamp(v, -1.0, 1.0);
  }
  void follow(double measured) {
    if (std::fabs(measured - other) < std::fabs(measured - sum)) sum = other;
  }

 private:
  static constexpr double kTie = 5e-5;  // of the voltage: 0.3 counts of PWM
};

class CurrentLoop : public CommutationRig {
 protected:
  void SetUp() override {
    CommutationRig::SetUp();
    set("I182=$78006 I184=$FFFF00 I171=2048 I172=1365 I124=$401 I166=" + std::to_string(kPwmScale));
  }
  void gains(double ki, double kp, double kb) {
    set("I161=" + std::to_string(ki) + " I162=" + std::to_string(kp) + " I176=" + std::to_string(kb));
  }
  void measure(double a, double b) {
    set_y(kAdcA, static_cast<std::int64_t>(std::floor(a * kFull)));
    set_y(kAdcB, static_cast<std::int64_t>(std::floor(b * kFull)));
  }
  double pwm(unsigned n) { return y_word(kOutput + n) / 256.0; }
  double seen_q() { return x_word(kCurrents) / kFull; }
  double seen_d() { return y_word(kCurrents) / kFull; }
};

TEST_F(CurrentLoop, AgreesWithTheDataSheetOverRandomCurrents) {
  std::mt19937 random(random_seed(5));
  const auto real = [&random](double first, double last) {
    return std::uniform_real_distribution<double>(first, last)(random);
  };
  const auto whole = [&random](int first, int last) { return std::uniform_int_distribution<int>(first, last)(random); };
  int saturated = 0, compared = 0;
  for (int round = 0; round < 40; ++round) {
    const int phi = round % 4 == 0 ? 1365 : round % 4 == 1 ? 1536 : whole(1, 2047), id = whole(-4000, 4000);
    const double ki = real(0, 0.02), kp = real(0, 0.4), kb = real(0, 0.4);
    const bool harmonic = round % 3 == 0;
    const int bias_a = whole(-500, 500), bias_b = whole(-500, 500);
    gains(ki, kp, kb);
    const std::string ki_text = std::to_string(ki), kp_text = std::to_string(kp), kb_text = std::to_string(kb);
    const double ki_stored = std::stod(ki_text), kp_stored = std::stod(kp_text), kb_stored = std::stod(kb_text);
    set("I172=" + std::to_string(phi) + " I177=" + std::to_string(id) + (harmonic ? " I124=1" : " I124=$401"));
    set("I129=" + std::to_string(bias_a) + " I179=" + std::to_string(bias_b));
    enable(false);
    enable();
    AxisModel q, d;
    for (int i = 0; i < 60; ++i) {
      const int position = whole(-1024, 1023), iq = whole(-12000, 12000);
      const double th = 2 * kPi * position / 2048, thb = th + 2 * kPi * phi / 2048;
      const double adc_a = real(-0.4, 0.4), adc_b = real(-0.4, 0.4);
      measure(adc_a, adc_b);
      stand_at(position);
      command(iq);
      phase();
      // 16 bits of the words, then the bias.
      const double ia = std::floor(adc_a * 32768) / 32768 + bias_a / 32768.0;
      const double ib = std::floor(adc_b * 32768) / 32768 + bias_b / 32768.0;
      d.actual = ib * std::sin(th) - ia * std::sin(thb);
      q.actual = ib * std::cos(th) - ia * std::cos(thb);
      ASSERT_NEAR(seen_q(), q.actual, 1e-6);
      ASSERT_NEAR(seen_d(), d.actual, 1e-6);
      const double vq = q.volts(iq / 32768.0, ki_stored, kp_stored, kb_stored);
      const double vd = d.volts(id / 32768.0, ki_stored, kp_stored, kb_stored);
      if (std::fabs(vq) == 1 || std::fabs(vd) == 1) ++saturated;
      std::array<double, 3> v = {vd * std::cos(th) - vq * std::sin(th), vd * std::cos(thb) - vq * std::sin(thb), 0};
      v[2] = -v[0] - v[1];
      std::array<double, 3> sorted = v;
      std::sort(sorted.begin(), sorted.end());
      for (unsigned n = 0; n < 3; ++n) {
        const double phase_volts = std::clamp(v[n] + (harmonic ? sorted[1] / 2 : 0), -1.0, 1.0);
        ASSERT_NEAR(pwm(n), phase_volts * kPwmScale, 0.3) << "I172=" << phi << " output " << n << " step " << i;
        ++compared;
      }
      q.follow(x_word(kIntegrators) / 1048576.0);
      d.follow(y_word(kIntegrators) / 1048576.0);
      ASSERT_NEAR(x_word(kIntegrators) / 1048576.0, q.sum, 1e-4);
      ASSERT_NEAR(y_word(kIntegrators) / 1048576.0, d.sum, 1e-4);
    }
  }
  EXPECT_EQ(compared, 40 * 60 * 3);
  EXPECT_GT(saturated, 100);
  EXPECT_LT(saturated, 2000);
}

TEST_F(CurrentLoop, TheSumStopsAtFullVoltageAndComesBackAtOnce) {
  gains(0.01, 0, 0);
  enable();
  measure(0, 0);
  command(16384);  // 8 * 0.01 * 0.5 = 0.04 an update: full after 25
  phase(10);
  EXPECT_NEAR(x_word(kIntegrators) / 1048576.0, 0.4, 1e-3);
  phase(1000);
  EXPECT_NEAR(x_word(kIntegrators) / 1048576.0, 1, 0.04);
  command(-16384);
  phase(26);
  EXPECT_LT(x_word(kIntegrators), 0);
}

// `O` behind `O` is a new command and nothing else.
TEST_F(CurrentLoop, AnotherOpenLoopCommandKeepsTheSum) {
  gains(0.01, 0, 0);
  set("I100=1");
  ASSERT_TRUE(motor_open(0, 5000 << 8));
  measure(0, 0);
  command(5000);
  phase(5);
  const std::int64_t sum = x_word(kIntegrators);
  ASSERT_GT(sum, 10000);
  ASSERT_TRUE(motor_open(0, 6000 << 8));
  phase();
  EXPECT_NEAR(x_word(kIntegrators), sum * 6.0 / 5.0, sum / 20.0);
}

// Vq = -4 * 1 * -0.3 - ... is at its end, and the sum goes the other way.
TEST_F(CurrentLoop, TheSumFallsWhileTheVoltageIsAtItsUpperEnd) {
  gains(0.01, 0, 1);
  set("I172=1536");
  for (const int sign : {1, -1}) {
    enable(false);
    enable();
    stand_at(0);
    measure(0, sign * -0.3);  // Iq = Ib cos(0)
    command(sign * -0.4 * 32768);
    phase(10);
    EXPECT_NEAR(pwm(1), sign * kPwmScale, 1);  // B = -Vq sin(270)
    EXPECT_NEAR(x_word(kIntegrators) / 1048576.0, sign * 10 * 8 * 0.01 * -0.1, 1e-3);
  }
}

TEST_F(CurrentLoop, AKilledMotorPutsOutNothingAndForgetsItsSum) {
  gains(0.01, 0.1, 0);
  enable();
  measure(0, 0);
  command(5000);
  phase(10);
  EXPECT_NE(pwm(1), 0);
  enable(false);
  phase();
  for (const int position : {0, 300, 512, 900, -200, -700}) {
    stand_at(position);
    phase();
    for (unsigned n = 0; n < 3; ++n) EXPECT_EQ(y_word(kOutput + n), 0) << "not even a bit of its sine";
  }
  EXPECT_EQ(x_word(kIntegrators), 0);
  measure(0.25, -0.125);
  phase();
  EXPECT_GT(std::fabs(seen_q()) + std::fabs(seen_d()), 0.1) << "what flows is shown all the same";
}

TEST_F(CurrentLoop, OutputsAreClippedAtThePwmScale) {
  gains(0, 1, 0);
  set("I172=1536");
  enable();
  measure(0, 0);
  stand_at(-512);  // -90 degrees: A = Vq, B = -Vq sin(180) = 0, C = -A
  command(32000);
  phase();
  EXPECT_NEAR(pwm(0), kPwmScale, 0.01);
  EXPECT_NEAR(pwm(2), -kPwmScale, 0.01);
  stand_at(-768);  // -135: A = 0.707 Vq, B = -0.707 sin(135), C = -1.41 Vq: clipped
  phase();
  EXPECT_NEAR(pwm(2), 0, kPwmScale * 0.001);
}

// Under the sanitizers: largest gains, largest biases, currents and commands that jump from end to end.
TEST_F(CurrentLoop, NothingOverflowsAtTheEndsOfAllRanges) {
  std::mt19937 random(random_seed(7));
  const auto one_of = [&random](std::initializer_list<int> values) { return values.begin()[random() % values.size()]; };
  for (int round = 0; round < 40; ++round) {
    const int gain = one_of({-9, 9});
    gains(gain, one_of({-9, 9}), one_of({-9, 9}));
    set("I124=" + std::to_string(one_of({1, 0x401})) + " I172=" + std::to_string(one_of({0, 512, 1024, 1365})));
    set("I129=" + std::to_string(one_of({-32768, 32767})) + " I179=" + std::to_string(one_of({-32768, 32767})));
    set("I177=" + std::to_string(one_of({-32768, 32767})) + " I166=32767");
    enable();
    for (int i = 0; i < 300; ++i) {
      set_y(kAdcA, one_of({-8388608, 8388607}));
      set_y(kAdcB, one_of({-8388608, 8388607}));
      stand_at(one_of({-1024, -512, 0, 512}));
      command(one_of({-32767, 32767}));
      phase(random() % 3);
      for (unsigned n = 0; n < 3; ++n) ASSERT_LE(std::fabs(pwm(n)), 32767.01);
    }
  }
}

TEST_F(CurrentLoop, MaskTakesTheStatusBitsAway) {
  gains(0, 0.1, 0);
  set("I184=$FFFC00");
  enable();
  set_y(kAdcA, 0x1003FF);
  set_y(kAdcB, 0x0003FF);
  stand_at(0);
  phase();
  // Id = -Ia sin(240), Iq = -Ia cos(240)
  EXPECT_NEAR(seen_d(), 0.125 * 0.8660254, 1e-3);
  EXPECT_EQ(y_word(kCurrents), -(static_cast<std::int32_t>(std::floor(0x100000 * std::sin(kPi * 1365 / 1024)))) - 1);
}

TEST_F(CurrentLoop, ABrushMotorHasOneCurrent) {
  gains(0.01, 0.1, 0);
  set("I196=1 I170=0 I172=1536 I177=4000");
  enable();
  set_y(kCurrents, 55);
  set_y(kIntegrators, 55);
  stand_at(0);
  measure(0.3, -0.3);
  command(1000);
  phase(3);
  EXPECT_EQ(y_word(kCurrents), 0);
  EXPECT_EQ(phase_motors[0].d.actual, 0);
  EXPECT_EQ(y_word(kIntegrators), 0);
  EXPECT_EQ(pwm(0), 0);  // Vd is 0, sin(0) is 0
  EXPECT_NE(pwm(1), 0);
  EXPECT_NEAR(seen_q(), -0.3, 1e-3);  // Ib cos(0) - Ia cos(270)
}

// motion:6.3: I is the vector sum of what is measured. Both converters at their ends and 120 degrees apart make 1.732
// of full scale, whose square has 33 bits, wherever the rotor stands.
TEST_F(CurrentLoop, OverloadCountsCurrentsBeyondFullScale) {
  set("I157=0 I158=100 I178=0.001");
  enable();
  measure(32767.0 / 32768, 32767.0 / 32768);
  const auto trips_after = [this] {
    set("I158=0");
    set("I158=100");
    unsigned n = 0;
    for (; n < 10000 && !overload_is_too_much(0); ++n) overload_servo(0);
    return n;
  };
  for (const int position : {0, 256, 512, -256}) {
    stand_at(position);
    phase();
    EXPECT_EQ(trips_after(), 34u) << "100 / 3 servo interrupts at " << position;
  }
  set("I157=-1");
  EXPECT_EQ(trips_after(), 58u) << "100 / 1.732";
  measure(-0.5, 0.5);  // A - B of two phases: 0.5 / cos(30 degrees) x 0.866
  phase();
  set("I157=0");
  EXPECT_EQ(trips_after(), 401u) << "0.25 a servo interrupt";
  set("I182=0 I177=3000");  // without a current loop what is commanded
  enable();
  command(4000);
  set("I157=3000");
  EXPECT_EQ(trips_after(), 6711u) << "(5000^2 - 3000^2) / 32768^2 = 0.0149 a servo interrupt";
}

// motion:6.3: Ixx57 < 0 counts the length of the vector, rounded downwards: one more than Ixx57 is 2^-15 each time.
TEST_F(CurrentLoop, LinearOverloadCountsTheLengthOfTheVector) {
  const struct {
    int q, d;
  } vectors[] = {{4000, 3000}, {-3000, 4000}, {16384, 16384}, {32767, 5}, {32767, 32767}, {-7, 31000}, {20000, 8000}};
  for (const auto& v : vectors) {
    const int length = static_cast<int>(std::sqrt(std::pow(v.q, 2) + std::pow(v.d, 2)));
    set("I182=0 I177=" + std::to_string(v.d));
    enable();
    command(v.q);
    for (const int least : {length - 1, length}) {
      set("I157=-" + std::to_string(std::min(least, 32767)) + " I158=0");
      set("I158=1");
      const int more = length - std::min(least, 32767);  // of 2^15
      int n = 0;
      for (; n < 40000 && !overload_is_too_much(0); ++n) overload_servo(0);
      EXPECT_EQ(n, more == 0 ? 40000 : 32768 / more + 1) << v.q << ", " << v.d;
    }
  }
}

// The sum is not below 0, so rest is not saved up, and not above twice Ixx58, so that it is forgotten in time. Outputs
// are rounded to 16 bits.
TEST_F(CurrentLoop, OverloadIsBetweenNothingAndTwiceItsMost) {
  set("I182=0 I157=16384 I158=100 I177=0");
  enable();
  const auto until = [](bool too_much) {
    unsigned n = 0;
    for (; n < 10000 && overload_is_too_much(0) != too_much; ++n) overload_servo(0);
    return n;
  };
  command(0);
  for (int n = 0; n < 1000; ++n) overload_servo(0);
  command(32767);
  EXPECT_EQ(until(true), 134u) << "0.75 a servo interrupt";
  for (int n = 0; n < 5000; ++n) overload_servo(0);
  command(0);
  EXPECT_EQ(until(false), 400u) << "100 of 0.25";
  set("I157=32766 I158=0");
  set("I158=1");
  command(32766.4);
  EXPECT_EQ(until(true), 10000u);
  command(32766.6);
  EXPECT_EQ(until(true), 10000u);
  EXPECT_EQ(until(true), 6385u) << "2^30 / (32767^2 - 32766^2) = 16385";
  set("I157=0 I158=0");
  set("I158=100");
  command(16384);
  EXPECT_EQ(until(true), 401u) << "Ixx57 = 0: all of it counts";
}

// Closed through the windings of the plant's motor: 24 V on each side, 10 A full scale, 1 ohm, 1 mH.
class ClosedCurrentLoop : public CurrentLoop {
 protected:
  static constexpr double kHalfBus = 24, kFullAmps = 10, kPhaseHz = 9034.6;
  static constexpr unsigned kSteps = 10;  // of the motor in a phase period

  void SetUp() override {
    CurrentLoop::SetUp();
    parameters_.inertia = 1e9;  // does not turn
    set("I184=$FFFC00 I124=1");
  }
  void run(plant::Motor& motor, unsigned interrupts) {
    run(motor, interrupts, [&](double dt) { motor.drive_three_phase(dt, volts(0), volts(1), volts(2)); });
  }
  template <typename Drive>
  void run(plant::Motor& motor, unsigned interrupts, Drive drive) {
    for (unsigned i = 0; i < interrupts; ++i) {
      const auto word = [](double amps) { return std::clamp(std::floor(amps / kFullAmps * 8192), -8192.0, 8191.0); };
      set_y(kAdcA, static_cast<std::int64_t>(word(motor.current_a())) * 1024);
      set_y(kAdcB, static_cast<std::int64_t>(word(motor.current_b())) * 1024);
      phase();
      for (unsigned step = 0; step < kSteps; ++step) drive(1 / kPhaseHz / kSteps);
    }
  }
  double volts(unsigned n) { return pwm(n) / kPwmScale * kHalfBus; }
  double amplitude(const plant::Motor& motor) {
    const double alpha = motor.current_a(), beta = (2 * motor.current_b() + alpha) / std::sqrt(3.0);
    return std::hypot(alpha, beta);
  }

  plant::MotorParameters parameters_;
};

// Amplitude of the phase current is Iq / cos(30 degrees), motion:3.4.
TEST_F(ClosedCurrentLoop, CurrentFollowsTheCommand) {
  gains(0.02, 0.15, 0);
  for (const int angle : {0, 100, 700, -900}) {
    plant::Motor motor(parameters_, 65536 * 4000);
    enable(false);
    enable();
    stand_at(angle);
    command(8192);  // 2.5 A
    run(motor, 60);
    EXPECT_NEAR(seen_q(), 0.25, 0.002) << angle;
    EXPECT_NEAR(seen_d(), 0, 0.002) << angle;
    EXPECT_NEAR(amplitude(motor), 2.5 / std::cos(kPi / 6), 0.03) << angle;
    const double th = 2 * kPi * angle / 2048;  // Iq is a quarter of a cycle ahead of the phase position
    EXPECT_NEAR(motor.current_a(), -amplitude(motor) * std::sin(th), 0.03) << angle;
  }
}

TEST_F(ClosedCurrentLoop, MagnetisationCurrentLiesInTheDirectAxis) {
  gains(0.02, 0.15, 0);
  set("I177=4096");
  plant::Motor motor(parameters_, 65536 * 4000);
  enable();
  stand_at(200);
  command(0);
  run(motor, 80);
  EXPECT_NEAR(seen_d(), 0.125, 0.002);
  EXPECT_NEAR(motor.current_a(), 1.25 / std::cos(kPi / 6) * std::cos(2 * kPi * 200 / 2048), 0.03);
}

TEST_F(ClosedCurrentLoop, BackGainDampsLikeResistance) {
  gains(0.02, 0, 0.15);
  plant::Motor motor(parameters_, 65536 * 4000);
  enable();
  stand_at(0);
  command(8192);
  run(motor, 120);
  EXPECT_NEAR(seen_q(), 0.25, 0.002);
}

// One winding between A and B: ADC B shows the current of A with the other sign.
TEST_F(ClosedCurrentLoop, CurrentOfABrushMotorFollowsTheCommand) {
  gains(0.02, 0.1, 0);
  set("I196=1 I170=0 I172=1536 I124=$401");
  plant::Motor motor(parameters_, 65536 * 4000);
  enable();
  stand_at(0);
  command(6554);
  run(motor, 100, [&](double dt) { motor.drive_brush(dt, volts(0) - volts(1)); });
  EXPECT_NEAR(seen_q(), 0.2, 0.002);
  EXPECT_NEAR(motor.current_a(), -2, 0.02) << "Iq is Ib";
}

// Negative control: with the other value of the pair the same windings and converters are positive feedback.
TEST_F(ClosedCurrentLoop, WrongPhaseAngleRunsAway) {
  gains(0.02, 0.15, 0);
  set("I172=683");
  plant::Motor motor(parameters_, 65536 * 4000);
  enable();
  stand_at(0);
  command(100);
  run(motor, 100);
  EXPECT_GT(amplitude(motor), 5) << "0.03 A were commanded";
}

}  // namespace
}  // namespace brick
