// A rotary motor: windings, rotor, friction. Integrated in fixed steps of the plant with a fixed order of operations,
// so that equal runs give equal positions. SI units; the position is an integer in encoder units and keeps its
// resolution for ever.
#pragma once

#include <cstdint>

#include "testbench/plant/motion.h"

namespace brick::plant {

struct MotorParameters {
  double inertia = 1e-4;         // kg m2, with the load
  double viscous = 0;            // N m s
  double coulomb = 0;            // N m
  double torque_constant = 0.1;  // N m / A; three-phase: per amplitude of the phase current
  double resistance = 1;         // ohm, one winding
  double inductance = 1e-3;      // H
  unsigned pole_pairs = 4;       // three-phase only
};

class Motor {
 public:
  Motor(const MotorParameters& parameters, std::int64_t units_per_revolution, std::int64_t position = 0);

  // One step of `dt` seconds with the current given, or with voltages at the terminals (three-phase: against the star
  // point of the supply; the motor's own star point is not connected).
  void drive_current(double dt, double amps);
  void drive_brush(double dt, double volts);
  void drive_three_phase(double dt, double volts_a, double volts_b, double volts_c);
  void coast(double dt) { drive_current(dt, 0); }  // amplifier off

  void set_load(double torque) {
    load_ = torque;
  }  // N m, against positive motion; acts in both directions as gravity does

  void set_brake(double torque) { brake_ = torque; }  // N m, friction beside that of the motor

  double speed() const { return speed_; }              // rad/s
  std::int64_t position() const { return position_; }  // encoder units
  double current_a() const { return alpha_; }
  double current_b() const;
  double torque() const { return torque_; }  // N m, that of the current

 private:
  void turn(double dt, double torque);

  MotorParameters par_;
  std::int64_t revolution_;
  double load_ = 0, brake_ = 0, speed_ = 0, rest_ = 0, torque_ = 0;
  std::int64_t position_ = 0;
  double alpha_ = 0, beta_ = 0;  // currents; alpha_ alone when there is one winding
  bool three_phase_ = false;
};

}  // namespace brick::plant
