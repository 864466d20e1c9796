// The motor's equations against what mechanics textbooks say.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "testbench/plant/motor.h"

namespace brick::plant {
namespace {

constexpr double kTwoPi = 6.283185307179586, kDt = 1.0 / 102400;
constexpr std::int64_t kRevolution = 4000 * kUnitsPerCount;

double turns(const Motor& motor) { return static_cast<double>(motor.position()) / static_cast<double>(kRevolution); }

// 2 A x 0.1 N m/A on 1e-4 kg m2: 2000 rad/s2, after 0.1 s 200 rad/s and 10 rad (and half a step's way more: n (n + 1) /
// 2 steps).
TEST(Motor, AcceleratesEvenlyUnderConstantTorque) {
  Motor motor(MotorParameters{}, kRevolution);
  for (int i = 0; i < 10240; ++i) motor.drive_current(kDt, 2);
  EXPECT_NEAR(motor.speed(), 200, 1e-6);
  EXPECT_NEAR(turns(motor) * kTwoPi, 10 + 2000 * kDt * 0.1 / 2, 1e-6);
  EXPECT_EQ(motor.current_a(), 2);
}

// 0.05 N m against a brake of 0.01 N m and 1e-4 N m s: (0.05 - 0.01) / 1e-4 = 400 rad/s. Time constant J/b = 0.1 s.
TEST(Motor, FrictionSetsTheFinalSpeed) {
  for (const double sign : {1.0, -1.0}) {
    MotorParameters p;
    p.inertia = 1e-5;
    p.viscous = 1e-4;
    p.coulomb = 0.01;
    Motor motor(p, kRevolution);
    for (int i = 0; i < 102400; ++i) motor.drive_current(kDt, 0.5 * sign);
    EXPECT_NEAR(motor.speed(), 400 * sign, 0.03);  // e^-10 of it is missing
    for (int i = 0; i < 10240; ++i) motor.drive_current(kDt, 0.5 * sign);
    EXPECT_NEAR(motor.speed(), 400 * sign, 0.01);
  }
}

TEST(Motor, SticksUntilFrictionIsOvercome) {
  MotorParameters p;
  p.coulomb = 0.01;  // 0.1 A
  Motor motor(p, kRevolution);
  for (int i = 0; i < 10240; ++i) motor.drive_current(kDt, 0.0999);
  EXPECT_EQ(motor.position(), 0);
  for (int i = 0; i < 10240; ++i) motor.drive_current(kDt, 0.2);
  EXPECT_NEAR(motor.speed(), (0.02 - 0.01) / 1e-4 * 0.1, 1e-6);
  // It stops after v J / T = 10 x 1e-4 / 0.01 = 0.1 s without reversing, and stays.
  for (int i = 0; i < 10240 + 2; ++i) motor.coast(kDt);
  EXPECT_EQ(motor.speed(), 0);
  const std::int64_t stopped = motor.position();
  for (int i = 0; i < 1024; ++i) motor.coast(kDt);
  EXPECT_EQ(motor.position(), stopped);
}

TEST(Motor, LoadPullsBackwards) {
  Motor motor(MotorParameters{}, kRevolution);
  motor.set_load(0.1);
  for (int i = 0; i < 1024; ++i) motor.drive_current(kDt, 1);  // 0.1 N m holds it
  EXPECT_EQ(motor.position(), 0);
  for (int i = 0; i < 1024; ++i) motor.coast(kDt);
  EXPECT_NEAR(motor.speed(), -0.1 / 1e-4 * 0.01, 1e-9);
  EXPECT_LT(motor.position(), 0);
}

// Held by the brake up to its torque: 0.1 N m of gravity against 0.15, then 0.2.
TEST(Motor, BrakeHoldsUpToItsTorque) {
  Motor motor(MotorParameters{}, kRevolution);
  motor.set_load(0.1);
  motor.set_brake(0.15);
  for (int i = 0; i < 1024; ++i) motor.coast(kDt);
  EXPECT_EQ(motor.position(), 0);
  motor.set_load(0.2);
  for (int i = 0; i < 1024; ++i) motor.coast(kDt);
  EXPECT_NEAR(motor.speed(), -(0.2 - 0.15) / 1e-4 * 0.01, 1e-9);
  motor.set_brake(0.3);
  for (int i = 0; i < 1024; ++i) motor.coast(kDt);
  EXPECT_EQ(motor.speed(), 0) << "5 rad/s at 1000 rad/s^2: 5 ms";
}

// No load: 24 V / 0.1 V s = 240 rad/s. With 0.2 N m: 2 A take 2 V of it, 220 rad/s. Mechanical time constant J R / k2 =
// 10 ms.
TEST(Motor, BrushMotorRunsUpToItsBackVoltage) {
  Motor motor(MotorParameters{}, kRevolution);
  for (int i = 0; i < 51200; ++i) motor.drive_brush(kDt, 24);
  EXPECT_NEAR(motor.speed(), 240, 1e-3);
  EXPECT_NEAR(motor.current_a(), 0, 1e-4);
  motor.set_load(0.2);
  for (int i = 0; i < 51200; ++i) motor.drive_brush(kDt, 24);
  EXPECT_NEAR(motor.speed(), 220, 1e-3);
  EXPECT_NEAR(motor.current_a(), 2, 1e-4);
  EXPECT_EQ(motor.current_b(), -motor.current_a());
}

// Locked by friction, 10 V on 1 ohm and 1 mH: after one time constant (1 ms) 1 - 1/e of 10 A, less half a step's share.
TEST(Motor, CurrentRisesWithTheWindingsTimeConstant) {
  MotorParameters p;
  p.coulomb = 10;
  Motor motor(p, kRevolution);
  for (int i = 0; i < 102; ++i) motor.drive_brush(kDt, 10);
  EXPECT_NEAR(motor.current_a(), 10 * (1 - std::exp(-102 * kDt / 1e-3)), 0.02);
  for (int i = 0; i < 2000; ++i) motor.drive_brush(kDt, 10);
  EXPECT_NEAR(motor.current_a(), 10, 1e-6);
}

// A constant vector pulls the rotor to its angle: A alone to 0, B alone to a third of the electrical turn. 6 V on A and
// -3 V on the others are an amplitude of 6 V, 6 A.
TEST(Motor, ThreePhaseRotorLinesUpWithTheVector) {
  MotorParameters p;
  p.viscous = 5e-3;
  p.pole_pairs = 4;
  Motor motor(p, kRevolution);
  const auto hold = [&](double a, double b, double c) {
    for (int i = 0; i < 51200; ++i) motor.drive_three_phase(kDt, a, b, c);
  };
  hold(-3, 6, -3);
  EXPECT_NEAR(turns(motor), 1.0 / 12, 1e-4);
  EXPECT_NEAR(motor.current_a(), -3, 1e-3);
  EXPECT_NEAR(motor.current_b(), 6, 1e-3);
  hold(-3, -3, 6);
  EXPECT_NEAR(turns(motor), 2.0 / 12, 1e-4);
  hold(6, -3, -3);
  EXPECT_NEAR(turns(motor), 3.0 / 12, 1e-4);  // on, not back
  EXPECT_NEAR(motor.current_a(), 6, 1e-3);
  hold(16, 7, 7);  // what the three have in common makes no current
  EXPECT_NEAR(motor.current_a(), 6, 1e-3);
}

// A vector that turns with 10 turns/s electrical takes the rotor along at 10/4 turns/s.
TEST(Motor, ThreePhaseRotorFollowsATurningVector) {
  MotorParameters p;
  p.viscous = 5e-3;
  Motor motor(p, kRevolution);
  for (int i = 0; i < 204800; ++i) {
    const double angle = kTwoPi * 10 * i * kDt;
    motor.drive_three_phase(kDt, 6 * std::cos(angle), 6 * std::cos(angle - kTwoPi / 3),
                            6 * std::cos(angle + kTwoPi / 3));
  }
  EXPECT_NEAR(motor.speed(), kTwoPi * 10 / 4, 1e-3);
  EXPECT_NEAR(turns(motor), 20.0 / 4, 0.02);  // the load angle: 5e-3 x 15.7 / (0.1 x 6) = 0.13 electrical, 0.005 turns
}

TEST(Motor, WhatCannotBeIsRefused) {
  double MotorParameters::*const positive[] = {&MotorParameters::inertia, &MotorParameters::inductance};
  for (const auto member : positive)
    for (const double value : {0.0, -1e-6, std::nan("")}) {
      MotorParameters p;
      p.*member = value;
      EXPECT_THROW(Motor(p, kRevolution), std::invalid_argument) << value;
    }
  double MotorParameters::*const friction[] = {&MotorParameters::viscous, &MotorParameters::coulomb};
  for (const auto member : friction) {
    MotorParameters p;
    p.*member = -1e-9;
    EXPECT_THROW(Motor(p, kRevolution), std::invalid_argument);
    p.*member = 0;
    EXPECT_NO_THROW(Motor(p, kRevolution));
  }
}

}  // namespace
}  // namespace brick::plant
