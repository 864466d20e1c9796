// limits: what stops motors by itself: end switches, software limits, following error, amplifier fault, I2T, and the
// host's ^K. Judged by the times of motion:6 at the amplifier enable pin and in the commanded position, by the ramp
// of Ixx15, and by the status bits of firmware:5.2 and firmware:5.3.
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/velocity_profile.h"

namespace brick {
namespace {

constexpr std::int64_t kEnd = 500;         // counts where switches open, both ways
constexpr double kReaction = 2;            // ms, motion:6
constexpr double kSpeed = 32, kAbort = 4;  // Ixx22; Ixx15
constexpr std::uint16_t kQuadrature = 1u << kEncA | 1u << kEncB;

class Limits {
 public:
  explicit Limits(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  double ms(Tick ticks) const { return static_cast<double>(ticks) / kTicksPerMs; }
  void bit(unsigned motor, unsigned word, unsigned bit, const char* what, bool expected = true);
  void enabled(const std::string& name, std::vector<unsigned> on);  // AENA of these and no others
  void ends();
  void stopped(unsigned motor, const std::string& name, double direction);
  void killed(unsigned motor, const std::string& name, Tick cause);
  void following_error();
  void integrated_current();
  void kill_all();
  void fault();

  MotorHost host_;
};

std::vector<plant::AxisParameters> axes() {
  std::vector<plant::AxisParameters> axes(4, dac_axis());
  axes[0].switches = {{kPlim, kEnd, 1'000'000}};
  axes[2].switches = {{kMlim, -1'000'000, -kEnd}};
  axes[3].switches = {{kPlim, kEnd, 1'000'000}};
  return axes;
}

void Limits::bit(unsigned motor, unsigned word, unsigned bit, const char* what, bool expected) {
  report().equal(fmt::format("#{}? word {} bit {}, {}", motor, word, bit, what), host_.status_bit(motor, word, bit),
                 expected);
}

void Limits::enabled(const std::string& name, std::vector<unsigned> on) {
  Comparison compared;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor)
    compared.equal(fmt::format("AENA of motor {}", motor), host_.pin(motor_pin::kAena, motor - 1),
                   std::count(on.begin(), on.end(), motor));
  report().step(name, compared, host_.motors(), "amplifiers enabled as they have to be");
}

// From where it passes its limit the ramp of Ixx15 begins within the reaction time, and is what it has to be.
void Limits::stopped(unsigned motor, const std::string& name, double direction) {
  const auto& s = host_.samples(motor);
  const auto passed = std::find_if(s.begin(), s.end(), [&](const MotorHost::Sample& x) {
    return direction * (motor == 2 ? x.actual : x.turned) >= static_cast<double>(kEnd);
  });
  if (passed == s.end()) return report().fail(name + ": passes its limit", "never");
  const auto from = static_cast<std::size_t>(passed - s.begin()) - 5;
  const double time = kSpeed / (host_.bench().negative ? kAbort / 2 : kAbort);
  const auto fit = host_.fit(
      motor,
      [&](double start) -> MotorHost::Path {
        VelocityProfile p(start, direction * kSpeed);
        p.add({0, time, 0, -direction * kSpeed});
        return [p](double t) { return p.position(t); };
      },
      time, from, direction* kSpeed);
  const double late = fit.begin - static_cast<double>(passed - s.begin()) * host_.period();
  report().step(name + ": reaction", late <= kReaction,
                fmt::format("{:.2f} ms after the limit was passed, expected up to {}", late, kReaction));
  report_fit(report(), name + ": ramp of Ixx15", fit, 12);
}

// 1: switch at the positive end; 2: software limit; 3: switch at the negative end; 4: as 1, but told to ignore it.
void Limits::ends() {
  host_.say({fmt::format("I213={} I214=0 I424=$820001", kEnd)});
  host_.record();
  host_.expect("#1J+ #2J+ #3J- #4J+", "");
  host_.wait_ms(50);
  stopped(1, "positive end switch", 1);
  bit(1, 1, 21, "positive end limit");
  bit(1, 2, 11, "stopped on a limit");
  stopped(2, "software limit", 1);
  bit(2, 1, 21, "positive end limit");
  bit(2, 2, 11, "stopped on a limit");
  stopped(3, "negative end switch", -1);
  bit(3, 1, 22, "negative end limit");
  enabled("motors in their limits stay on", {1, 2, 3, 4});
  const auto& s = host_.samples(4);
  report().step(
      "Ixx24 bit 17: end switch is ignored",
      s.size() > 2 && std::fabs((s.back().commanded - s[s.size() - 2].commanded) / host_.period() - kSpeed) < 0.01,
      "goes on at 32 counts/ms");
  host_.expect("#4J/", "");
  host_.settle(60);
  host_.record();
  host_.ask("#1J+");  // may be refused
  host_.ask("#3J-");
  host_.wait_ms(10);
  for (const unsigned motor : {1u, 3u}) {
    const double way = host_.samples(motor).back().commanded - host_.samples(motor).front().commanded;
    report().step(fmt::format("#{} goes no further into its limit", motor), way == 0,
                  fmt::format("{:.3f} counts, expected 0", way));
  }
  host_.record();
  host_.expect("#1J:-400 #2J:-400 #3J:400 #4J:-400", "");
  host_.settle(60);
  Comparison out;
  for (unsigned motor = 1; motor <= 4; ++motor) {
    const auto& of = host_.samples(motor);
    out.equal(fmt::format("#{} counts", motor), std::llround(of.back().commanded - of.front().commanded),
              motor == 3 ? 400 : -400);
  }
  report().step("out of the limits", out, 4, "jogs of 400 counts");
  bit(1, 1, 21, "positive end limit", false);
  bit(1, 2, 11, "stopped on a limit", false);
}

void Limits::killed(unsigned motor, const std::string& name, Tick cause) {
  const Tick off = cause < 0 ? -1 : host_.disabled_at(motor, cause);
  report().step(fmt::format("{}: AENA of motor {}", name, motor), off >= 0 && ms(off - cause) <= kReaction,
                off < 0 ? (cause < 0 ? "there was no cause" : "stays on")
                        : fmt::format("off after {:.2f} ms, expected up to {}", ms(off - cause), kReaction));
}

// The encoder of motor 1 is cut while it jogs. Ixx24 bits 22, 21 = 10: the others go on.
void Limits::following_error() {
  host_.say({"I124=$C00001 I111=4800 I112=1600"});  // 300 and 100 counts
  host_.record();
  host_.expect("#1J-", "");
  host_.wait_ms(25);
  bit(1, 2, 1, "warning following error", false);
  host_.axis(1).cut(kQuadrature);
  host_.wait_ms(6);
  bit(1, 2, 1, "warning following error");
  host_.wait_ms(10);
  const auto& s = host_.samples(1);
  const auto over = std::find_if(s.begin(), s.end(),
                                 [](const MotorHost::Sample& x) { return std::fabs(x.commanded - x.actual) > 300; });
  killed(1, "following error", over == s.end() ? -1 : over->tick);
  const bool early = over != s.end() && host_.disabled_at(1, s.front().tick) < over->tick;
  report().step("following error: not before Ixx11", !early, "");
  bit(1, 2, 2, "fatal following error");
  bit(1, 1, 18, "open loop");
  enabled("following error, Ixx24 bits 22 and 21: this motor alone", {2, 3, 4});
  host_.axis(1).cut(0);
}

// Motor 2 holds half of its torque. The sum of motion:1.4, taken from the words that it wrote, passes Ixx58.
void Limits::integrated_current() {
  constexpr double kContinuous = 8000, kLimit = 4;
  host_.say({"I224=$C00001 I211=0"});
  host_.axis(2).set_load(0.5);
  host_.wait_ms(30);  // until it holds
  host_.say({fmt::format("I257={} I258={}", kContinuous, kLimit)});
  host_.record();
  host_.wait_ms(20);
  double sum = 0;
  Tick cause = -1;
  for (const MotorHost::Sample& x : host_.samples(2)) {
    sum = std::max(0.0, sum + (x.output * x.output - kContinuous * kContinuous) / (32768.0 * 32768.0));
    if (sum > kLimit && cause < 0) cause = x.tick;
  }
  // It may have begun a few cycles before record().
  const Tick off = host_.disabled_at(2, 0);
  report().step(
      "I2T: AENA of motor 2", cause >= 0 && off >= 0 && std::fabs(ms(off - cause)) <= kReaction + 1,
      cause < 0 ? fmt::format("the sum came to {:.2f} only, output {}", sum, host_.samples(2).back().output)
                : fmt::format("{:.2f} ms after the sum passed Ixx58, expected up to {}", ms(off - cause), kReaction));
  bit(2, 2, 5, "I2T fault");
  bit(2, 2, 3, "amplifier fault");
  host_.axis(2).set_load(0);
  enabled("I2T: this motor alone", {3, 4});
}

void Limits::kill_all() {
  host_.say({"I258=0 I211=32000"});
  host_.close_all();
  enabled("J/ to all", {1, 2, 3, 4});
  host_.record();
  const Tick sent = host_.now();
  host_.bench().link.control(0x0B);  // ^K
  host_.wait_ms(2);
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) killed(motor, "^K", sent);
  host_.close_all();
}

// Motor 4 ignores its fault input, motor 3's fault takes all motors away.
void Limits::fault() {
  using plant::Amplifier;
  host_.say({"I424=$900001 I324=$800001"});
  host_.axis(4).trip(Amplifier::Fault::kOverTemperature);
  host_.wait_ms(4);
  enabled("fault input of motor 4 ignored", {1, 2, 3, 4});
  host_.record();
  const Tick cause = host_.now();
  host_.axis(3).trip(Amplifier::Fault::kOverTemperature);
  host_.wait_ms(4);
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) killed(motor, "amplifier fault of motor 3", cause);
  bit(3, 2, 3, "amplifier fault");
  bit(1, 2, 3, "amplifier fault", false);
  bit(3, 1, 19, "amplifier enabled", false);
}

void Limits::run() {
  if (host_.motors() < 4) return report().fail("channels", "expected four");
  host_.set_up();
  host_.variables(92, 3);
  host_.close_all();
  ends();
  following_error();
  integrated_current();
  kill_all();
  fault();
}

}  // namespace

Bench limits_bench() {
  return {
      "limits",
      "end switches, software limits, following error, I2T, amplifier fault, ^K: reaction, ramp, status",
      {"the scoreboard is told that Ixx15 is half of what it is", "positive end switch: ramp of Ixx15", "counts off"},
      [](BenchContext& b) { Limits(b).run(); },
      kAServoIc,
      axes};
}

}  // namespace brick
