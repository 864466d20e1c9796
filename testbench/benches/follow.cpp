// follow: motors that follow a shaft turned by a hand at ratios of their own, some of them jogging at the same time,
// and a program whose time is that of the shaft from its index on. Judged by the master position word and by where the
// motors stand: counts of the shaft x Ixx07 / Ixx08 (firmware:3.1, motion:1.2); the program by the counts from the
// index, that very count being 0 (motion:2.2, methods $9, $B, $A).
#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/program_profile.h"

namespace brick {
namespace {

constexpr int kShaft = 800;                      // counts
constexpr int kStart = 3300, kIndex = 4002;      // where the shaft stands at first; its index begins
constexpr double kRealTime = 32;                 // counts/ms of the shaft that are 100 %
constexpr double kScale = 96;                    // Ixx08
constexpr double kOnTheWay = 25, kAtRest = 1.5;  // counts of following error

class Follow {
 public:
  explicit Follow(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  double master(unsigned motor) { return static_cast<double>(host_.d(0x8D + 0x80 * (motor - 1))) / MotorHost::kUnits; }
  void turn(const std::string& name, int counts, double ms, const std::vector<double>& jogs);
  void triggered();

  MotorHost host_;
  std::vector<double> factors_;  // Ixx07 of motors 2, 3, 4
};

std::vector<plant::AxisParameters> axes() {
  std::vector<plant::AxisParameters> axes(4, dac_axis());
  axes[0].drive = plant::Drive::kHand;
  axes[0].start = kStart;
  return axes;
}

// The shaft turns; motors jog by `jogs` meanwhile.
void Follow::turn(const std::string& name, int counts, double ms, const std::vector<double>& jogs) {
  host_.wait_ms(3);
  host_.record();
  host_.wait_ms(2);
  std::vector<double> from, masters;
  for (unsigned motor = 2; motor <= host_.motors(); ++motor) {
    from.push_back(host_.samples(motor).back().turned);
    masters.push_back(master(motor));
  }
  const double shaft = host_.samples(1).back().actual;
  host_.axis(1).turn(counts, static_cast<Tick>(ms * kTicksPerMs));
  std::string line;
  for (std::size_t i = 0; i < jogs.size(); ++i) line += fmt::format("#{}J:{} ", i + 2, jogs[i]);
  if (!line.empty()) host_.expect(line, "");
  host_.wait_ms(ms + 45);
  const double turned = host_.samples(1).back().actual - shaft;
  report().step(name + ": shaft", std::fabs(turned - counts) < 1, fmt::format("{:.2f}, expected {}", turned, counts));
  Comparison words, places, errors;
  for (unsigned motor = 2; motor <= host_.motors(); ++motor) {
    const double factor = factors_[motor - 2] * (host_.bench().negative ? 1.01 : 1);
    const double expected = turned * factor / kScale;
    const double word = master(motor) - masters[motor - 2];
    words.judged(fmt::format("#{}", motor), std::fabs(word - expected) <= std::fabs(factor) / kScale / 16 + 0.001
                                                ? ""
                                                : fmt::format("{:.4f}, expected {:.4f}", word, expected));
    const double jog = motor - 2 < jogs.size() ? jogs[motor - 2] : 0;
    const double way = host_.samples(motor).back().turned - from[motor - 2];
    places.judged(fmt::format("#{}", motor), std::fabs(way - expected - jog) <= kAtRest + 1
                                                 ? ""
                                                 : fmt::format("{:.2f} counts, expected {:.2f}", way, expected + jog));
    // On the way it is where the shaft is, when nothing else moves it.
    if (jog != 0) continue;
    const auto& s = host_.samples(motor);
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double there = from[motor - 2] + (host_.samples(1)[i].actual - shaft) * factor / kScale;
      errors.judged(fmt::format("#{} sample {}", motor, i),
                    std::fabs(s[i].turned - there) <= kOnTheWay
                        ? ""
                        : fmt::format("{:.1f} counts, expected {:.1f}", s[i].turned, there));
    }
  }
  report().step(name + ": master position", words, host_.motors() - 1, "counts of the shaft x Ixx07 / Ixx08");
  report().step(name + ": ways of the motors", places, host_.motors() - 1, "within 2.5 counts");
  if (errors.made() > 0)
    report().step(name + ": with the shaft all the way", errors, 60, fmt::format("{} samples", errors.made()));
}

// Lines 5 and 6 of the table: frozen, armed, then the shaft's counts from the captured one on.
void Follow::triggered() {
  const auto entry = [this](unsigned method) {
    return fmt::format("I8004=${:X}", method << 20 | 1u << 19 | host_.base(0));
  };
  for (unsigned motor = 2; motor <= 4; ++motor) host_.say({fmt::format("I{}06=0", motor)});
  host_.say({fmt::format("I{}=1", host_.i_channel(0, 2)), "I5113=0 I5190=1000 I5192=0 I5194=8388607 I8006=0",
             fmt::format("I8005={}", 16'384 / kRealTime), entry(9) + " I5193=$3506"});
  host_.expect("&1#3->1X", "");
  host_.expect("OPEN PROG 1 CLEAR LINEAR INC TA10 TS2 TM15 X300 CLOSE", "");
  host_.record();
  host_.wait_ms(1);
  host_.expect("&1B1R", "");
  host_.axis(1).turn(50, static_cast<Tick>(50 / 25.0 * kTicksPerMs));
  host_.wait_ms(4);
  host_.say({entry(11)});
  host_.axis(1).turn(30, static_cast<Tick>(30 / 25.0 * kTicksPerMs));
  host_.wait_ms(3);
  const auto& s = host_.samples(3);
  const auto& shaft = host_.samples(1);
  report().step("before the index: no program time goes by", s.back().commanded == s.front().commanded, "");
  report().equal("armed", host_.ask("I8004"), entry(11).substr(6));
  host_.axis(1).turn(900, static_cast<Tick>(900 / 45.0 * kTicksPerMs));
  host_.settle(40, 3);
  report().equal("its digit has changed", host_.ask("I8004"), entry(10).substr(6));
  const VelocityProfile path = linear_profile(s.front().commanded, {{300, 15}}, {10, 10}, 2);
  // Pins that were moved onto the encoder's while the counter ran may have counted once.
  const double index = kIndex - std::round(shaft.front().turned - shaft.front().actual);
  report().equal("captured position", host_.captured(1).value_or(0), static_cast<std::uint32_t>(index));
  double worst = 0;
  unsigned judged = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double t = std::max(0.0, (shaft[i].actual - index) / kRealTime);
    worst = std::max(worst, std::fabs(s[i].commanded - path.position(t)));
    judged += t > 0 && t < path.end();
  }
  // 1/32 count of the shaft is 1/51 count of the motor.
  report().step("path from the very count of the index", judged > 30 && worst < 0.1,
                fmt::format("{:.3f} counts off, expected up to 0.1; {} servo interrupts", worst, judged));
  host_.say({"I5193=$2000"});
}

void Follow::run() {
  if (host_.motors() < 4) return report().fail("channels", "expected four");
  host_.set_up();
  factors_ = {96, -48, static_cast<double>(60 + host_.pick(60))};
  std::vector<std::string> words;
  for (unsigned motor = 2; motor <= 4; ++motor)
    words.push_back(fmt::format("I{0}05=$3501 I{0}06=1 I{0}07={1} I{0}92=3", motor, factors_[motor - 2]));
  host_.say(words);
  for (unsigned motor = 2; motor <= 4; ++motor) host_.expect(fmt::format("#{}J/", motor), "");
  turn("up", kShaft, 40, {});
  turn("down, and jogs", -kShaft / 2, 15, {300, 0, -250});
  // Offset mode: the position that commands count from goes with the master.
  host_.say({"I206=3"});
  host_.wait_ms(3);
  const double offset = host_.samples(2).back().turned;
  host_.expect("#2J:100", "");
  host_.wait_ms(40);
  report().step("offset mode: a jog of 100 counts",
                std::fabs(host_.samples(2).back().turned - offset - 100) <= kAtRest + 1,
                fmt::format("{:.2f} counts", host_.samples(2).back().turned - offset));
  report().equal("offset mode in ?", host_.status_bit(2, 1, 5), true);
  report().equal("following in ?", host_.status_bit(2, 1, 4), true);
  host_.say({"I206=0"});
  host_.record();
  host_.axis(1).turn(200, static_cast<Tick>(5 * kTicksPerMs));
  host_.wait_ms(15);
  const double still = host_.samples(2).back().turned - host_.samples(2).front().turned;
  report().step("Ixx06 = 0: stays", std::fabs(still) <= kAtRest, fmt::format("{:.2f} counts, expected 0", still));
  triggered();
}

}  // namespace

Bench follow_bench() {
  return {"follow",
          "motors that follow a shaft, at ratios of their own, jogging meanwhile",
          {"the scoreboard is told that Ixx07 is a hundredth higher", "up: master position", "expected"},
          [](BenchContext& b) { Follow(b).run(); },
          kAServoIc,
          axes};
}

}  // namespace brick
