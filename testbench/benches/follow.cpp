// follow: motors that follow a shaft turned by a hand at ratios of their own, some of them jogging at the same time.
// Judged by the master position word and by where the motors stand: counts of the shaft x Ixx07 / Ixx08
// (firmware:3.1, motion:1.2).
#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"

namespace brick {
namespace {

constexpr int kShaft = 800;                      // counts
constexpr double kScale = 96;                    // Ixx08
constexpr double kOnTheWay = 25, kAtRest = 1.5;  // counts of following error

class Follow {
 public:
  explicit Follow(BenchContext& b) : host_(b, axes()) {}
  void run();

 private:
  static std::vector<plant::AxisParameters> axes();
  BenchReport& report() { return host_.report(); }
  double master(unsigned motor) { return static_cast<double>(host_.d(0x8D + 0x80 * (motor - 1))) / MotorHost::kUnits; }
  void turn(const std::string& name, int counts, double ms, const std::vector<double>& jogs);

  MotorHost host_;
  std::vector<double> factors_;  // Ixx07 of motors 2, 3, 4
};

std::vector<plant::AxisParameters> Follow::axes() {
  std::vector<plant::AxisParameters> axes(4, dac_axis());
  axes[0].drive = plant::Drive::kHand;
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
}

}  // namespace

Bench follow_bench() {
  return {"follow",
          "motors that follow a shaft, at ratios of their own, jogging meanwhile",
          {"the scoreboard is told that Ixx07 is a hundredth higher", "up: master position", "expected"},
          [](BenchContext& b) { Follow(b).run(); },
          kAServoIc};
}

}  // namespace brick
