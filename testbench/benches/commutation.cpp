// commutation: three-phase motors whose currents the controller measures, a brush motor, and one with the wrong phase
// angle. Judged by what the motors do: nothing without a phase reference; the current that a known load takes, which
// shows by how many degrees the field is off; following error; and a trip where Ixx72 makes positive feedback
// (motion:3.4, motion:3.5).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"

namespace brick {
namespace {

constexpr unsigned kGuess = 1, kHalls = 2, kWrong = 3, kBrush = 4;  // motors
constexpr double kLoad = 0.2, kTorquePerAmp = 0.1;                  // N m; N m / A
constexpr unsigned kPwm = 7180;                                     // Ixx66
constexpr double kSearch = 2000, kFullAmps = 10, kTripAmps = 15;    // Ixx73

class Commutation {
 public:
  explicit Commutation(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  void set_up(unsigned motor);
  void reference(unsigned motor, const std::string& name, double degrees);
  double amps(unsigned motor);
  double mean_amps(unsigned motor);
  void field(unsigned motor, const std::string& name, double degrees);
  void jog(const std::vector<unsigned>& motors);
  void wrong_angle();

  MotorHost host_;
};

std::vector<plant::AxisParameters> axes() {
  plant::AxisParameters a;
  a.drive = plant::Drive::kThreePhase;
  a.motor.inertia = 1e-5;
  a.motor.viscous = 1e-4;
  a.motor.coulomb = 5e-4;
  a.motor.torque_constant = kTorquePerAmp;
  a.amplifier.bus_volts = 48;
  a.amplifier.full_scale_amps = kFullAmps;
  a.amplifier.trip_amps = kTripAmps;
  a.encoder.wiring = plant::EncoderParameters::Wiring::kHalls;
  a.encoder.pole_pairs = a.motor.pole_pairs;
  // Ixx91 = $800000: state 011 is 0 to 60 degrees of 1000 counts.
  a.encoder.hall_offset = -1000 * plant::kUnitsPerCount / 6;
  std::vector<plant::AxisParameters> list(4, a);
  list[kGuess - 1].start = 137;  // the field stands anywhere
  list[kHalls - 1].start = 431;
  list[kBrush - 1].drive = plant::Drive::kBrush;
  return list;
}

// As examples/setups/servo8.pmc derives it.
void Commutation::set_up(unsigned motor) {
  const unsigned channel = motor - 1;
  std::vector<std::string> words{fmt::format("I{}=0", host_.i_channel(channel, 6)), fmt::format("I{}00=0", motor)};
  const auto at = [&](unsigned k, const std::string& value) {
    words.push_back(fmt::format("I{}={}", 100 * motor + k, value));
  };
  at(1, "1");
  at(24, "$C00401");  // a fault or following error switches this motor off alone
  at(82, fmt::format("${:X}", host_.address(channel, word::kAdcB)));
  at(83, fmt::format("${:X}", host_.address(channel, word::kPhasePosition)));
  const bool wrong = motor == kWrong || (motor == kGuess && host_.bench().negative);
  for (const auto& [k, value] : {std::pair{70u, 4.0},
                                 {71u, 4000.0},
                                 {72u, wrong ? 683.0 : 1365.0},
                                 {73u, kSearch},
                                 {74u, 8.0},
                                 {77u, 0.0},
                                 {80u, 0.0},
                                 {61u, 0.011},
                                 {62u, 0.2},
                                 {66u, double{kPwm}},
                                 {76u, 0.0},
                                 {30u, 97385.0},
                                 {69u, 20480.0},
                                 {57u, 10000.0},
                                 {58u, 20000.0}})
    at(k, fmt::format("{}", value));
  at(84, "$FFFC00");
  if (motor == kHalls) {
    at(81, fmt::format("${:X}", host_.address(channel, word::kStatus)));
    at(91, "$800000");
  }
  if (motor == kBrush) {
    at(70, "0");
    at(72, "1536");  // the ADCs show current into the motor, and so the output has the other sign
    at(30, "-112450");
    at(96, "1");
  }
  at(0, "1");
  host_.say(words);
}

// Amplitude of the phase currents.
double Commutation::amps(unsigned motor) {
  const plant::Motor& m = host_.axis(motor).motor();
  const double a = m.current_a();
  return std::hypot(a, (a + 2 * m.current_b()) / std::sqrt(3.0));
}

// Over twelve phase periods, at times that drift through them: the PWM has a ripple of a twentieth.
double Commutation::mean_amps(unsigned motor) {
  constexpr unsigned kTimes = 100;
  double sum = 0;
  for (unsigned i = 0; i < kTimes; ++i) {
    host_.wait_ms(0.013);
    sum += amps(motor);
  }
  return sum / kTimes;
}

// The current that holds the load, against what it would take with the field at a right angle.
void Commutation::field(unsigned motor, const std::string& name, double degrees) {
  host_.axis(motor).set_load(kLoad);
  host_.wait_ms(40);
  const double amps = mean_amps(motor);
  const double least = kLoad / kTorquePerAmp, most = (least + 0.01) / std::cos(degrees * M_PI / 180);
  host_.axis(motor).set_load(0);
  host_.expect(fmt::format("#{0}K #{0}J/", motor), "");  // the integrator begins anew
  report().step(name + ": field at a right angle", amps > least - 0.1 && amps <= most,
                fmt::format("{:.3f} A hold {} N m, expected {:.3f} to {:.3f}: {} degrees", amps, kLoad, least - 0.1,
                            most, degrees));
}

void Commutation::reference(unsigned motor, const std::string& name, double degrees) {
  report().equal(name + ": phase reference error in ? at first", host_.status_bit(motor, 2, 8), true);
  report().equal(name + ": J/ without it", host_.ask(fmt::format("#{}J/", motor)), std::string("ERR018"));
  report().equal(name + ": AENA without it", int{host_.pin(motor_pin::kAena, motor - 1) != 0}, 0);
  host_.expect(fmt::format("#{}$", motor), "");
  for (unsigned i = 0; i < 40; ++i) {
    host_.wait_ms(2);
    if (!host_.status_bit(motor, 2, 9)) break;
  }
  report().equal(name + ": search active in ?", host_.status_bit(motor, 2, 9), false);
  report().equal(name + ": phase reference error in ?", host_.status_bit(motor, 2, 8), false);
  host_.expect(fmt::format("#{}J/", motor), "");
  host_.wait_ms(5);
  field(motor, name, degrees);
}

void Commutation::jog(const std::vector<unsigned>& motors) {
  host_.wait_ms(10);
  host_.record();
  std::string line;
  for (const unsigned motor : motors) line += fmt::format("#{}J:900 ", motor);
  host_.expect(line, "");
  host_.settle(120, 15);
  for (const unsigned motor : motors) {
    double moving = 0, resting = 0;
    unsigned moved = 0;
    const auto& s = host_.samples(motor);
    for (std::size_t i = 1; i < s.size(); ++i) {
      const double error = std::fabs(s[i].commanded - s[i].actual);
      if (s[i].commanded != s[i - 1].commanded) moving = std::max(moving, error), ++moved;
      if (s.size() - i < 5) resting = error;
    }
    report().step(fmt::format("#{}J:900: following error at 32 counts/ms", motor),
                  moved > 60 && moving <= 20 && resting <= 2,
                  fmt::format("{:.2f} counts moving, expected up to 20; {:.2f} at rest, expected up to 2; {} samples",
                              moving, resting, moved));
    report().equal(fmt::format("#{}J:900: way in units of 1/3072 count", motor),
                   std::llround((s.back().commanded - s.front().commanded) * MotorHost::kUnits),
                   900 * std::llround(MotorHost::kUnits));
  }
}

// The current feeds itself back: far above what the search commands, until the amplifier's fault ends it.
void Commutation::wrong_angle() {
  double most = 0;
  const auto watch = [this, &most](double ms) {
    for (double waited = 0; waited < ms; waited += 0.1) {
      host_.wait_ms(0.1);
      most = std::max(most, amps(kWrong));
    }
  };
  host_.record();
  host_.ask(fmt::format("#{}$", kWrong));
  watch(25);
  host_.ask(fmt::format("#{}J/", kWrong));
  host_.ask(fmt::format("#{}J:50", kWrong));
  watch(20);
  const auto& e = host_.enables(kWrong);
  const bool was_on = std::any_of(e.begin(), e.end(), [](const auto& x) { return x.on; });
  report().step("wrong Ixx72 trips", was_on && host_.pin(motor_pin::kAena, kWrong - 1) == 0,
                was_on ? "amplifier off" : "the amplifier was never enabled");
  const double commanded = kSearch / 32768 * kFullAmps / std::cos(M_PI / 6);
  report().step("wrong Ixx72: the current runs away", most > kTripAmps / 2,
                fmt::format("{:.1f} A, {:.1f} A were commanded, expected {} or more", most, commanded, kTripAmps / 2));
  report().equal("wrong Ixx72: amplifier fault in ?", host_.status_bit(kWrong, 2, 3), true);
  report().equal("wrong Ixx72: phase reference error in ?", host_.status_bit(kWrong, 2, 8), true);
}

void Commutation::run() {
  if (host_.motors() < 4) return report().fail("channels", "expected four");
  host_.set_up();
  for (unsigned motor = 1; motor <= 4; ++motor) set_up(motor);
  host_.variables(92, 3);
  host_.variables(19, 1.5);  // the current loops lag
  host_.variables(21, 8);
  reference(kGuess, "two guesses", 25);
  reference(kHalls, "halls", 15);  // 431 counts are 155 degrees, in the sector whose middle is 150
  host_.expect(fmt::format("#{}J/", kBrush), "");
  jog({kGuess, kHalls, kBrush});
  wrong_angle();
  report().equal("the others stay on", int{host_.pin(motor_pin::kAena, kGuess - 1) != 0}, 1);
}

}  // namespace

Bench commutation_bench() {
  return {"commutation",
          "phase references, direct PWM with current loops, a brush motor; the wrong phase angle trips",
          {"Ixx72 of motor 1 is that of the opposite sense", "two guesses: *", "expected"},
          [](BenchContext& b) { Commutation(b).run(); },
          kAServoIc,
          axes};
}

}  // namespace brick
