// jog-home: jogs and homing searches of motors with speeds and accelerations of their own. Judged at each servo
// interrupt by the profiles of motion:4.1 and motion:4.2 in double precision (testbench/checkers/jog_profile.h), at the
// end by the exact target, and after homing by where the motor stands against what the channel captured.
#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/jog_profile.h"

namespace brick {
namespace {

constexpr std::int64_t kLowFlag = 1400, kFastFlag = 2200, kTrigger = 400;  // counts at which home switches close
constexpr std::int64_t kIndex = 2;                                         // where the encoder's index is high
constexpr double kSlow = 4;                                                // counts/ms
constexpr double kStill = 3;                                               // ms without a step: it has ended

class JogHome {
 public:
  explicit JogHome(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  std::string all(const std::string& form);  // form for motors 1 to n, % stands for the number
  void limits();
  void target(unsigned motor, const std::string& name, double counts);
  void jogs();
  void on_the_way();
  void searches();
  void judge_search(unsigned motor, const std::string& name, std::optional<std::uint32_t> captured, std::int64_t place,
                    double offset, double moved);
  std::vector<double> slow_lag();

  MotorHost host_;
  std::vector<JogLimits> limits_;
  double before_jogs_ = 0;  // of motor 4
};

std::vector<plant::AxisParameters> axes() {
  std::vector<plant::AxisParameters> axes(4, dac_axis());
  axes[0].switches = {{kHmfl, -1'000'000, kLowFlag}};
  axes[2].switches = {{kHmfl, kFastFlag, 1'000'000}};
  axes[3].switches = {{kHmfl, kTrigger, 1'000'000}};
  return axes;
}

void JogHome::limits() {
  limits_ = {{4, 0, 5, 32}, {4, 0, 5, 32}, {4, 16, 4, 20}, {4, 0, 4, 25}};
  std::vector<std::string> words;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    const JogLimits& l = limits_[motor - 1];
    words.push_back(fmt::format("I{0}19={1} I{0}20={2} I{0}21={3} I{0}22={4} I{0}92=10", motor, l.acceleration, l.time,
                                l.rounding, l.speed));
    if (host_.bench().negative) limits_[motor - 1].rounding += 1;
  }
  host_.say(words);
}

void JogHome::target(unsigned motor, const std::string& name, double counts) {
  report().equal(fmt::format("{}: units of 1/3072 count from the target", name),
                 std::llround((host_.samples(motor).back().commanded - counts) * MotorHost::kUnits), 0LL);
}

// Moves from rest to rest: long, too short for their speed, given an acceleration time, absolute.
void JogHome::jogs() {
  const char* const kLines[] = {"J:900", "J:90", "J=500", "J:-3"};
  const double ways[] = {900, 90, 500, -3};
  host_.record();
  std::string line;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) line += fmt::format("#{}{} ", motor, kLines[motor - 1]);
  const Tick sent = host_.now();
  host_.expect(line, "");
  const Tick taken = host_.now();
  host_.settle(200, kStill);
  before_jogs_ = host_.samples(host_.motors()).front().commanded;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    const JogLimits l = limits_[motor - 1];
    const double from = host_.samples(motor).front().commanded;
    const double to = ways[motor - 1] + (motor == 3 ? 0 : from);  // J= is absolute
    const double duration = jog_profile(from, to, l).end();
    const auto fit = host_.fit(
        motor,
        [&](double start) -> MotorHost::Path {
          return [p = jog_profile(start, to, l)](double t) { return p.position(t); };
        },
        duration);
    report_fit(report(), fmt::format("#{}{}: profile", motor, kLines[motor - 1]), fit, 30);
    target(motor, fmt::format("#{}{}", motor, kLines[motor - 1]), to);
    // Ixx92 = 10 ms, to a servo cycle, between the command and the profile. It was taken at some instant in between.
    const Tick first = host_.samples(motor).front().tick;
    const auto since = [&](Tick t) { return fit.begin - static_cast<double>(t - first) / kTicksPerMs; };
    report().step(fmt::format("#{}{}: begins after Ixx92", motor, kLines[motor - 1]),
                  since(sent) >= 10 - host_.period() && since(taken) <= 10 + 5,
                  fmt::format("{:.2f} ms after the line was sent, {:.2f} ms after its acknowledgement, expected 10",
                              since(sent), since(taken)));
  }
}

// Motor 1: J+ and J/. 2: J+ turned to J-. 3: another target on the way. 4: the variable target, and back.
void JogHome::on_the_way() {
  if (host_.motors() < 4) return;
  const double start3 = host_.samples(3).back().commanded, start4 = host_.samples(4).back().commanded;
  host_.record();
  host_.say({all("I%92=3")});
  host_.expect("M1->L:$257 M1=140", "");
  host_.expect("#1J+ #2J+ #3J=1100 #4J=*", "");
  host_.wait_ms(22);
  const std::size_t turn = host_.last(1);
  host_.expect("#1J/ #2J- #3J=1300 #4J=", "");
  host_.wait_ms(26);
  host_.expect("#2J/", "");
  host_.settle(200, kStill);
  const auto profile = [](const VelocityProfile& p) -> MotorHost::Path {
    return [p](double t) { return p.position(t); };
  };
  {
    const JogLimits l = limits_[0];
    report_fit(report(), "#1J+: profile",
               host_.fit(
                   1, [&](double p) { return profile(jog_to_speed(p, 0, l.speed, l)); }, 15),
               30);
    report_fit(
        report(), "#1J/: profile",
        host_.fit(
            1, [&](double p) { return profile(jog_to_speed(p, l.speed, 0, l)); }, l.time_for(l.speed), turn, l.speed),
        20);
  }
  {
    const JogLimits l = limits_[1];
    report_fit(report(), "#2J- while it jogs up: profile",
               host_.fit(
                   2, [&](double p) { return profile(jog_to_speed(p, l.speed, -l.speed, l)); }, l.time_for(2 * l.speed),
                   turn, l.speed),
               40);
  }
  {
    const JogLimits l = limits_[2];
    report_fit(report(), "#3J= on the way at full speed: profile as if it had been told at once",
               host_.fit(
                   3, [&](double p) { return profile(jog_profile(p, 1300, l)); }, jog_profile(start3, 1300, l).end()),
               100);
    target(3, "#3J=1300 on the way", 1300);
  }
  {
    const JogLimits l = limits_[3];
    report_fit(report(), "#4J=*: profile",
               host_.fit(
                   4, [&](double p) { return profile(jog_profile(p, 140, l)); }, jog_profile(start4, 140, l).end()),
               30);
    target(4, "#4J=, back to where the jogs began", before_jogs_);
  }
}

// Mean difference of the reported position and the encoder's while the motors turn slowly: exact to a part of a count.
std::vector<double> JogHome::slow_lag() {
  host_.say({all(fmt::format("I%22={}", kSlow))});
  host_.record();
  host_.expect(all("#%J:60"), "");
  host_.settle(100, kStill);
  std::vector<double> lags;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    const auto& s = host_.samples(motor);
    double sum = 0;
    unsigned count = 0;
    for (std::size_t i = 1; i < s.size(); ++i) {
      if (std::fabs((s[i].commanded - s[i - 1].commanded) / host_.period() - kSlow) > 0.01) continue;
      sum += s[i].actual - s[i].turned;
      ++count;
    }
    lags.push_back(count == 0 ? 0 : sum / count);
  }
  host_.say({all("I%22=32")});
  return lags;
}

void JogHome::judge_search(unsigned motor, const std::string& name, std::optional<std::uint32_t> captured,
                           std::int64_t place, double offset, double moved) {
  report().equal(name + ": home complete in ?", host_.status_bit(motor, 2, 10), true);
  if (!captured) return report().fail(name + ": captured position", "nobody has read it");
  const auto at = static_cast<std::int32_t>(*captured << 8) >> 8;
  report().equal(name + ": captured position", std::int64_t{at}, place);
  report().step(name + ": zero is the captured count and Ixx26", std::fabs(moved + at + offset) < 0.25,
                fmt::format("{:.3f} counts, expected {:.3f}", moved, -at - offset));
}

// 1: home flag, downwards, Ixx26; 2: index, downwards; 3: flag at 100 counts/ms; 4: jog until the trigger.
void JogHome::searches() {
  if (host_.motors() < 4) return;
  host_.say({fmt::format("I{}=2 I{}=0 I{}=1 I{}=2 I{}=0 I{}=2 I{}=0", host_.i_channel(0, 2), host_.i_channel(0, 3),
                         host_.i_channel(1, 2), host_.i_channel(2, 2), host_.i_channel(2, 3), host_.i_channel(3, 2),
                         host_.i_channel(3, 3)),
             "I123=-32 I126=-800 I223=-32 I226=0 I323=100 I326=160 I319=10 I320=0 I321=5"});
  std::vector<double> moved = slow_lag();
  // Pins that are moved onto the encoder's while the counter runs may count once.
  const auto power_on = [&moved](unsigned motor) { return std::llround(moved[motor - 1]); };
  const std::int64_t places[] = {kLowFlag - 1 + power_on(1), kIndex + power_on(2), kFastFlag + power_on(3)};
  host_.record();
  host_.expect("#1HM #2HM #3HM #4J:2000^-20", "");
  report().equal("searches end", host_.settle(200, kStill), true);
  for (unsigned motor = 1; motor <= 3; ++motor) target(motor, fmt::format("#{}HM", motor), 0);
  std::vector<std::optional<std::uint32_t>> captured;
  for (unsigned motor = 1; motor <= 4; ++motor) captured.push_back(host_.captured(motor));
  if (captured[3])
    target(4, "#4J^: trigger and distance", static_cast<std::int32_t>(*captured[3] << 8 >> 8) - 20);
  else
    report().fail("#4J^: trigger and distance", "nobody has read the captured position");
  const std::vector<double> after = slow_lag();
  for (unsigned motor = 1; motor <= 4; ++motor) moved[motor - 1] = after[motor - 1] - moved[motor - 1];
  judge_search(1, "#1HM, flag, downwards", captured[0], places[0], -50, moved[0]);
  judge_search(2, "#2HM, index, downwards", captured[1], places[1], 0, moved[1]);
  judge_search(3, "#3HM, flag, 100 counts/ms", captured[2], places[2], 10, moved[2]);
}

std::string JogHome::all(const std::string& form) {
  std::string text;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    for (const char c : form) text += c == '%' ? std::to_string(motor) : std::string(1, c);
    text += ' ';
  }
  return text;
}

void JogHome::run() {
  host_.set_up();
  limits();
  host_.close_all();
  jogs();
  on_the_way();
  searches();
}

}  // namespace

Bench jog_home_bench() {
  return {"jog-home",
          "jogs and homing searches: profiles at each servo interrupt, exact targets, captured positions",
          {"the scoreboard is told that Ixx21 is a millisecond longer", "#1J:900: profile", "counts off"},
          [](BenchContext& b) { JogHome(b).run(); },
          kAServoIc,
          axes};
}

}  // namespace brick
