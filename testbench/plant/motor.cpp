#include "testbench/plant/motor.h"

#include <cmath>
#include <stdexcept>

namespace brick::plant {
namespace {

constexpr double kTwoPi = 6.283185307179586, kSqrt3 = 1.7320508075688772;

}  // namespace

Motor::Motor(const MotorParameters& parameters, std::int64_t units_per_revolution, std::int64_t position)
    : par_(parameters), revolution_(units_per_revolution), position_(position) {
  if (!(par_.inertia > 0) || !(par_.inductance > 0) || par_.viscous < 0 || par_.coulomb < 0)
    throw std::invalid_argument("motor: inertia and inductance must be positive, friction not negative");
}

double Motor::current_b() const { return three_phase_ ? -alpha_ / 2 + beta_ * kSqrt3 / 2 : -alpha_; }

// Coulomb friction opposes motion and at most stops it: what it could take away in this step is taken from the speed
// that the other torques give. A rotor at rest so stays until they exceed it.
void Motor::turn(double dt, double torque) {
  torque_ = torque;
  double speed = speed_ + dt / par_.inertia * (torque - load_ - par_.viscous * speed_);
  const double friction = dt / par_.inertia * (par_.coulomb + brake_);
  if (std::fabs(speed) <= friction)
    speed = 0;
  else
    speed -= speed > 0 ? friction : -friction;
  speed_ = speed;

  rest_ += speed_ * dt * (static_cast<double>(revolution_) / kTwoPi);
  const double whole = std::floor(rest_);
  rest_ -= whole;
  position_ += static_cast<std::int64_t>(whole);
}

void Motor::drive_current(double dt, double amps) {
  alpha_ = amps;
  beta_ = 0;
  three_phase_ = false;
  turn(dt, par_.torque_constant * amps);
}

// Backward Euler for the currents: stable however short the time constant L/R is.
void Motor::drive_brush(double dt, double volts) {
  const double k = dt / par_.inductance;
  alpha_ = (alpha_ + k * (volts - par_.torque_constant * speed_)) / (1 + k * par_.resistance);
  beta_ = 0;
  three_phase_ = false;
  turn(dt, par_.torque_constant * alpha_);
}

// Windings in stator coordinates. The rotor's field has the back electromotive force 2/3 of the torque constant,
// because three phases share the power: T w = 3/2 (e_alpha i_alpha + e_beta i_beta).
void Motor::drive_three_phase(double dt, double a, double b, double c) {
  const std::int64_t turned = position_ - detail::floor_div(position_, revolution_) * revolution_;
  const double angle =
      kTwoPi * static_cast<double>(turned * par_.pole_pairs % revolution_) / static_cast<double>(revolution_);
  const double sine = std::sin(angle), cosine = std::cos(angle);
  const double emf = par_.torque_constant * 2 / 3 * speed_;
  const double k = dt / par_.inductance;
  alpha_ = (alpha_ + k * ((2 * a - b - c) / 3 + emf * sine)) / (1 + k * par_.resistance);
  beta_ = (beta_ + k * ((b - c) / kSqrt3 - emf * cosine)) / (1 + k * par_.resistance);
  three_phase_ = true;
  turn(dt, par_.torque_constant * (beta_ * cosine - alpha_ * sine));
}

}  // namespace brick::plant
