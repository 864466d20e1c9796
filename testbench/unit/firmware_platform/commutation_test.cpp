// Angle, sine outputs, phase advance, slip and micro-steps natively, against motion:3.2 and motion:3.3 in double
// precision.
#include <cmath>
#include <random>

#include "testbench/unit/firmware_platform/commutation_rig.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

class Commutation : public CommutationRig {
 protected:
  double a() { return y_word(kOutput) / 256.0; }
  double b() { return y_word(kOutput + 1) / 256.0; }
};

// The table's own cosine: 2048 entries, the one at or below the angle.
double table_cosine(std::int64_t index) { return std::cos(2 * kPi * static_cast<double>(index & 2047) / 2048); }
double table_sine(std::int64_t index) { return std::sin(2 * kPi * static_cast<double>(index & 2047) / 2048); }

std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

TEST_F(Commutation, SineTableIsThatOfTheDataSheet) {
  const auto word = [](double value) { return std::min(8388607.0, std::floor(value * kFull + 0.5)); };
  for (std::uint32_t k = 0; k < 2048; ++k) {
    ASSERT_NEAR(x_word(0x3800 + k), word(table_cosine(k)), k == 1024 ? 0 : 1) << "cosine " << k;
    ASSERT_NEAR(y_word(0x3800 + k), word(table_sine(k)), k == 1536 ? 0 : 1) << "sine " << k;
  }
  EXPECT_EQ(x_word(0x3800 + 512), 0);
  EXPECT_EQ(y_word(0x3800), 0);
  EXPECT_EQ(x_word(0x3800 + 256), 5931642);  // 2^23 / sqrt(2) = 5931641.6
}

TEST_F(Commutation, SineOutputsAreThoseOfTheDataSheet) {
  std::mt19937 random(random_seed(3));
  const auto pick = [&random](int first, int last) { return std::uniform_int_distribution<int>(first, last)(random); };
  for (int round = 0; round < 60; ++round) {
    const int ixx71 = round == 5 ? 0 : round % 10 == 0 ? 1 << pick(4, 18) : pick(20, 260000), phi = pick(0, 2047);
    const int cycle = ixx71 == 0 ? 1 << 24 : ixx71;
    const int id = pick(-9000, 9000), bias_a = pick(-3000, 3000), bias_b = pick(-3000, 3000);
    set("I171=" + std::to_string(ixx71) + " I172=" + std::to_string(phi) + " I177=" + std::to_string(id));
    set("I129=" + std::to_string(bias_a) + " I179=" + std::to_string(bias_b));
    enable();
    for (int i = 0; i < 50; ++i) {
      const int position = pick(-(cycle / 2), cycle - cycle / 2 - 1), iq = pick(-20000, 20000);
      const std::int64_t index = floor_div(2048ll * position, cycle);
      stand_at(position);
      command(iq);
      phase();
      ASSERT_NEAR(a(), id * table_cosine(index) - iq * table_sine(index) + bias_a, 0.02)
          << "I171=" << ixx71 << " position " << position;
      ASSERT_NEAR(b(), id * table_cosine(index + phi) - iq * table_sine(index + phi) + bias_b, 0.02)
          << "I172=" << phi << " position " << position;
    }
  }
}

// motion:3.6: without a current loop X:+$39 and Y:+$39 show what is commanded.
TEST_F(Commutation, CurrentsAreShownAsTheyAreCommanded) {
  set("I177=-300");
  enable();
  command(1000.5);
  EXPECT_EQ(c_.line("RX$B9 RY$B9"), std::to_string(1000 * 256 + 128) + "|" + std::to_string(-300 * 256));
}

TEST_F(Commutation, OutputsAreClippedAtTheirWords) {
  set("I172=512 I129=32767 I179=-32768");
  enable();
  stand_at(-250);  // -90 degrees: A = +Iq, B = -Iq sin(0) = 0
  command(20000);
  phase();
  EXPECT_EQ(y_word(kOutput), 8388607);
  EXPECT_EQ(y_word(kOutput + 1), -32768 * 256 + 1);
  stand_at(0);  // B = -Iq
  phase();
  EXPECT_EQ(y_word(kOutput + 1), -8388607);
}

TEST_F(Commutation, BiasStaysOnTheOutputsOfAKilledMotor) {
  set("I129=100 I179=-200 I177=5000");
  stand_at(137);
  enable();
  command(3000);
  phase();
  EXPECT_GT(std::fabs(a() - 100), 500);
  enable(false);
  command(3000);
  phase();
  EXPECT_EQ(a(), 100);
  EXPECT_EQ(b(), -200);
}

// motion:3.1/3: of a motor that is killed nothing of a command is left, to the last bit.
TEST_F(Commutation, AKilledMotorIsCommandedNothing) {
  set("I177=-300 I156=0.001 I178=0.0004");
  phase_motor& m = phase_motors[0];
  for (const bool micro_steps : {false, true}) {
    set(micro_steps ? "I196=1 I170=1" : "I196=0");
    enable();
    motors[0].velocity = 500000;
    command(1000.5);
    EXPECT_NE(m.d.command, 0);
    EXPECT_EQ(m.q.command != 0, !micro_steps);
    EXPECT_TRUE(m.step != 0 || m.step_parts != 0);
    m.q.integrator = m.d.integrator = 1;
    m.held = m.searched = true;
    enable(false);
    for (const std::int32_t left :
         {std::int32_t{m.d.command}, std::int32_t{m.q.command}, m.q.integrator, m.d.integrator, std::int32_t{m.step}})
      EXPECT_EQ(left, 0);
    EXPECT_EQ(m.advance, 0u);
    EXPECT_EQ(m.step_parts, 0u);
    EXPECT_FALSE(m.held || m.searched || m.enabled);
  }
}

// motion:3.2: 5 degrees at a velocity of 1,391,616 units is an Ixx56 of 0.0000204.
TEST_F(Commutation, AdvanceTurnsTheAngleWithTheVelocity) {
  set("I171=36000 I156=0.0000204");
  enable();
  for (const int sign : {1, -1}) {
    motors[0].velocity = sign * 1391616;
    stand_at(3000);
    command(-10000);
    phase();
    const double degrees = 30 + sign * 5;
    EXPECT_NEAR(a(), 10000 * std::sin(degrees * kPi / 180), 10000 * 2 * kPi / 2048) << sign;
  }
  motors[0].velocity = 0;
  command(-10000);
  phase();
  EXPECT_NEAR(a(), 5000, 10000 * 2 * kPi / 2048);
}

// A rotor with the time constant Tr, Ixx78 = T / Tr: slip in radians an update is Ixx78 Iq / Id.
TEST_F(Commutation, SlipTurnsTheFieldOfAnInductionMotor) {
  set("I171=100000 I177=2500 I178=0.0004");
  enable();
  stand_at(0);
  command(5000);
  phase(1000);
  const double units = 1000 * 0.0004 * 5000 / 2500 / (2 * kPi) * 100000;  // 12732.4
  EXPECT_NEAR(x_word(kPosition), units, 1.5);
  command(-5000);
  phase(2000);
  EXPECT_NEAR(x_word(kPosition), -units, 2.5);
  command(0);
  phase(100);
  EXPECT_NEAR(x_word(kPosition), -units, 2.5);
}

// The gain is a whole number of 2^-40 of a unit for 2^-8 of an output, the nearest.
TEST_F(Commutation, SlipIsThatOfTheNearestGain) {
  for (const double steps : {0.3, 0.7, -0.3, -0.7, 1.4, 1.6}) {
    char slip[40];
    std::snprintf(slip, sizeof slip, "I178=%.15f", steps / 0x1p32 * 30000 * 2 * kPi / 1000);
    set("I171=1000 I177=30000");
    set(slip);
    enable();
    stand_at(0);
    set_y(kPosition, 0);
    command(32767);
    phase(1000);
    const double parts = x_word(kPosition) * 0x1p24 + (*hal_y(kPosition) & HAL_WORD_MASK);
    const double step = 1000 * 32767.0 * 256 / 65536;  // one of the gain's, in 2^-24 of a unit
    EXPECT_NEAR(parts, steps * step, step / 2) << steps;
    enable(false);
  }
}

TEST_F(Commutation, MicroStepsTurnByTheOutputAndNotByTheEncoder) {
  set("I196=1 I170=4 I171=65536 I177=8000 I172=512");
  enable();
  stand_at(0);
  command(10.25);
  for (int i = 1; i <= 1000; ++i) {
    set_x(kSource, 7 * i);
    phase();
    const std::int64_t position = i * 41ll, index = floor_div(2048 * position, 65536);
    ASSERT_NEAR(a(), 8000 * table_cosine(index), 0.02) << i;
    ASSERT_NEAR(b(), 8000 * table_cosine(index + 512), 0.02) << i;
  }
  command(-10.25);
  phase(1500);
  EXPECT_EQ(x_word(kPosition), -20500);
  command(0.25);  // a whole unit each update
  phase(100);
  EXPECT_EQ(x_word(kPosition), -20400);
}

// motion:3.2/1: from -Ixx71/2 on, which it is still, to Ixx71/2 - 1; steps of 4,096 and of 4,095 units.
TEST_F(Commutation, ThePositionGoesRoundAtHalfOfTheCycle) {
  set("I196=1 I170=4 I171=65536 I177=8000 I172=512");
  enable();
  const struct {
    double output;
    int updates;
    std::int32_t position;
  } cases[] = {{-1024, 8, -32768},     {-1024, 9, 65536 - 9 * 4096},
               {1024, 8, -32768},      {-1023.75, 9, 65536 - 9 * 4095},
               {1023.75, 8, 8 * 4095}, {1023.75, 9, 9 * 4095 - 65536}};
  for (const auto& c : cases) {
    stand_at(0);
    command(c.output);
    phase(c.updates);
    EXPECT_EQ(x_word(kPosition), c.position) << c.output << " " << c.updates;
  }
}

// A motor that is commutated again turns with its encoder alone, whether it made whole units or parts of them.
TEST_F(Commutation, MicroStepsEndWithTheirMode) {
  for (const double output : {0.25, 0.3}) {
    set("I196=1 I170=4 I171=65536 I177=8000 I178=0 I172=512");
    enable();
    stand_at(0);
    command(output);
    phase(40);
    ASSERT_GE(x_word(kPosition), 40);
    set("I196=0");
    command(output);
    const std::int32_t stood = x_word(kPosition);
    phase(100);
    EXPECT_EQ(x_word(kPosition), stood) << output;
  }
}

TEST_F(Commutation, PartsOfMicroStepsAddUp) {
  set("I196=1 I170=1 I171=65536 I177=8000 I172=512");
  enable();
  stand_at(0);
  command(0.25);
  phase(8);
  EXPECT_EQ(x_word(kPosition), 2);
  command(0.75);
  phase(8);
  EXPECT_EQ(x_word(kPosition), 8);
  command(-0.75);
  phase(8);
  EXPECT_EQ(x_word(kPosition), 2);
  set("I170=255 I171=16777215");  // more than 2^22 an update is none
  stand_at(0);
  command(32767);
  phase(1);
  EXPECT_EQ(x_word(kPosition), 1 << 22);
  command(-32767);
  phase(1);
  EXPECT_EQ(x_word(kPosition), 0);
}

// A killed motor does not slip on, one that is enabled begins without advance; Ixx77 and modes act at the next servo
// interrupt.
TEST_F(Commutation, EnablingBeginsAnew) {
  set("I171=100000 I177=2500 I178=0.0004 I156=0.001 I172=512");
  enable();
  stand_at(0);
  motors[0].velocity = 500000;  // 500 of 2048
  command(5000);
  phase(1);
  enable(false);
  const std::int32_t stood = x_word(kPosition);
  phase(100);
  EXPECT_EQ(x_word(kPosition), stood);
  enable();
  stand_at(0);
  phase(100);
  EXPECT_EQ(x_word(kPosition), 0);
  EXPECT_NEAR(a(), 2500, 0.02) << "Id cos(0)";
  EXPECT_NEAR(b(), 0, 0.02) << "Id cos(90)";
  motors[0].velocity = 0;
  set("I177=1000 I178=0 I156=0");
  command(300);
  phase();
  EXPECT_NEAR(a(), 1000, 0.02);
  EXPECT_NEAR(b(), -300, 0.02);
  set("I196=1 I170=0");  // micro-steps: the output is no torque
  command(300);
  phase();
  EXPECT_NEAR(a(), 1000, 0.02);
  EXPECT_NEAR(b(), 0, 0.02);
}

TEST_F(Commutation, TheTableOfIxx55IsUsed) {
  set("I155=$8000 I171=2048");  // $B800, in the buffers
  for (std::uint32_t k = 0; k < 2048; ++k) set_x(0xB800 + k, 0), set_y(0xB800 + k, k == 77 ? -4194304 : 0);
  enable();
  stand_at(77);
  command(1000);
  phase();
  EXPECT_EQ(a(), 500);
  set("I155=$8123");  // the address is a multiple of $800
  phase();
  EXPECT_EQ(a(), 500);
  set("I155=$7FFFFF");  // no memory there: the table of all
  phase();
  EXPECT_NEAR(a(), -1000 * table_sine(77), 0.02);
}

}  // namespace
}  // namespace brick
