// time-base: programs that run slower than told, slow down, stop and go on, or follow a shaft turned by a hand. The
// path stays the one of firmware:7.5 in program time; how program time goes on with each servo interrupt is judged by
// firmware:2.1 (I10 x % / 100, slewed by Isx94) and, from outside, by the counts of the shaft (motion:2.2, method $4).
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/program_profile.h"

namespace brick {
namespace {

constexpr double kSpeed = 20;  // counts/ms of the moves
constexpr double kShaft = 32;  // counts/ms that are 100 %: the real-time frequency

class TimeBase {
 public:
  explicit TimeBase(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  void load(double distance, double time, bool more = false);
  void constant(double percent);
  void slewed();
  void held();
  void limit();
  void from_a_shaft();
  void way(const std::string& name, double counts);

  MotorHost host_;
};

std::vector<plant::AxisParameters> axes() {
  std::vector<plant::AxisParameters> axes(2, dac_axis());
  axes[1].drive = plant::Drive::kHand;
  return axes;
}

// One move: TA 10, TS 2.
void TimeBase::load(double distance, double time, bool more) {
  host_.expect("OPEN PROG 1 CLEAR", "");
  host_.expect(fmt::format("LINEAR INC TA10 TS2 TM{}", time), "");
  host_.expect(fmt::format("X{}", distance), "");
  if (more) host_.expect("TM10", "");
  for (unsigned i = 0; more && i < 2; ++i) host_.expect("X1", "");
  host_.expect("CLOSE", "");
}

void TimeBase::way(const std::string& name, double counts) {
  const auto& s = host_.samples(1);
  report().equal(name + ": way in units of 1/3072 count",
                 std::llround((s.back().commanded - s.front().commanded) * MotorHost::kUnits),
                 std::llround(counts * MotorHost::kUnits));
}

void TimeBase::constant(double percent) {
  load(200, 10);
  host_.expect(fmt::format("&1%{}", percent), "");
  host_.record();
  host_.expect("&1B1R", "");
  host_.settle(150, 4);
  const double rate = percent / 100 * (host_.bench().negative ? 1.01 : 1);
  const auto make = [rate](double from) -> MotorHost::Path {
    return [p = linear_profile(from, {{200, 10}}, {10, 10}, 2), rate](double t) { return p.position(t * rate); };
  };
  report_fit(report(), fmt::format("%{}: path", percent), host_.fit(1, make, 20 / rate), 20);
  way(fmt::format("%{}", percent), 200);
}

// At constant speed the way of each servo cycle shows what program time it took.
void TimeBase::slewed() {
  constexpr double kSlew = 150'000;  // Isx94, 2^-23 ms a cycle
  load(600, 30);
  host_.expect("&1%100", "");
  host_.wait_ms(1);
  host_.say({fmt::format("I5194={}", kSlew)});
  host_.record();
  host_.expect("&1B1R", "");
  host_.wait_ms(17);
  const std::size_t before = host_.last(1);
  host_.expect("&1%50", "");
  host_.settle(250, 4);
  const auto& s = host_.samples(1);
  const auto begins = host_.departs(1, before - 3);
  Comparison compared;
  const double full = host_.period(), step = kSlew / 8'388'608;
  for (std::size_t i = begins.value_or(s.size()); i < s.size() && i < *begins + 20; ++i) {
    const double took = (s[i].commanded - s[i - 1].commanded) / kSpeed;
    const double expected = std::max(0.5 * full, full - step * static_cast<double>(i - *begins + 1));
    compared.judged(fmt::format("servo cycle {} of the slew", i - *begins + 1),
                    std::fabs(took - expected) < 1e-4
                        ? ""
                        : fmt::format("{:.5f} ms of program time, expected {:.5f}", took, expected));
  }
  report().step("from 100 % to 50 % by Isx94", compared, 20, "program time of each servo cycle");
  way("from 100 % to 50 %", 600);
}

void TimeBase::held() {
  host_.say({"I5194=8388607 I5195=8388607"});
  load(300, 15, true);  // there is still something to calculate when it is held
  host_.expect("&1%100", "");
  host_.wait_ms(1);
  host_.record();
  host_.expect("&1B1R", "");
  host_.wait_ms(12);
  host_.expect("&1H", "");
  host_.wait_ms(6);
  const auto& s = host_.samples(1);
  const double stood = s.back().commanded - s.front().commanded;
  report().step("H: stands on the way", stood > 10 && stood < 290 && s.back().commanded == s[s.size() - 5].commanded,
                fmt::format("{:.1f} of 300 counts", stood));
  host_.expect("&1R", "");
  host_.settle(150, 4);
  way("H and R", 302);
}

// 2^23 / I10 x 100 % = 225.865 % is the most.
void TimeBase::limit() {
  host_.expect("&1%225.8", "");
  host_.wait_ms(1);  // what `%` reports is slewed there
  const double reply = std::strtod(host_.ask("&1%").c_str(), nullptr);
  report().step("%225.8 is below the limit", std::fabs(reply - 225.8) < 0.01,
                fmt::format("{:.4f}, expected 225.8", reply));
  const std::string answer = host_.ask("&1%226");
  const double most = std::strtod(host_.ask("&1%").c_str(), nullptr);
  report().step("%226 is above it", most < 100 / host_.period() + 1e-4,
                fmt::format("{}, then {:.4f}, expected {:.4f} at most", answer, most, 100 / host_.period()));
  host_.expect("&1%100", "");
}

// Line 3 of the table differentiates line 2, the shaft; its result is the program time of a cycle.
void TimeBase::from_a_shaft() {
  host_.say({fmt::format("I8002=$403502 I8003={} I8004=0 I5193=$3504", 131'072 / kShaft)});
  load(300, 15);
  host_.record();
  host_.expect("&1B1R", "");
  host_.wait_ms(6);
  report().step("shaft at rest: no program time goes by",
                host_.samples(1).back().commanded == host_.samples(1).front().commanded, "");
  host_.axis(2).turn(400, static_cast<Tick>(400 / 25.0 * kTicksPerMs));  // 78 %
  host_.wait_ms(17);
  host_.axis(2).turn(500, static_cast<Tick>(500 / 45.0 * kTicksPerMs));
  host_.settle(100, 4);
  // The path over the counts of the shaft. Where it began is the one thing that is not known.
  const auto& s = host_.samples(1);
  const auto& shaft = host_.samples(2);
  const VelocityProfile path = linear_profile(s.front().commanded, {{300, 15}}, {10, 10}, 2);
  double worst = 1e9;
  std::size_t judged = 0;
  const auto middle =
      std::find_if(s.begin(), s.end(), [&](const auto& x) { return x.commanded > s.front().commanded + 150; }) -
      s.begin();
  if (static_cast<std::size_t>(middle) < s.size()) {
    const auto at = static_cast<std::size_t>(middle);
    const double zero = shaft[at].actual - kShaft * path.time_at(s[at].commanded, 0, path.end());
    worst = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double t = (shaft[i].actual - zero) / kShaft;
      worst = std::max(worst, std::fabs(s[i].commanded - path.position(std::max(t, 0.0))));
      judged += t > 0 && t < path.end();
    }
  }
  // A thirty-second of a count of the shaft is 1/51 count of the motor.
  report().step("path over the counts of the shaft", judged > 40 && worst < 0.15,
                fmt::format("{:.3f} counts off, expected up to 0.15; {} servo interrupts", worst, judged));
  way("by the shaft", 300);
  host_.say({"I5193=$2000"});
}

void TimeBase::run() {
  if (host_.motors() < 2) return report().fail("channels", "expected two");
  host_.set_up();
  host_.expect("&1#1->1X", "");
  host_.say({"I5113=0 I5190=1000 I5192=0 I5194=8388607 I192=3"});
  host_.expect("#1J/", "");
  host_.wait_ms(5);
  constant(100);
  constant(75);
  constant(200);
  slewed();
  held();
  limit();
  from_a_shaft();
}

}  // namespace

Bench time_base_bench() {
  return {"time-base",
          "program time: %, its slew, hold and resume, a shaft as the time base; the path stays",
          {"the scoreboard is told a rate that is a hundredth higher", "%100: path", "counts off"},
          [](BenchContext& b) { TimeBase(b).run(); },
          kAServoIc,
          axes};
}

}  // namespace brick
