#include "testbench/benches/breq_fall.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <fmt/format.h>

namespace brick {
namespace {

// What is reached, with a margin; what is aimed at is printed with it.
constexpr Tick kWorst = ns_to_ticks(65'000), kMedian = ns_to_ticks(24'000);
constexpr const char* kGoal = "goal 20 and 50 us";
constexpr unsigned kLines = 40;
constexpr Tick kPause = ns_to_ticks(450'000);  // up to a servo period: lines come at any time of the tasks
constexpr Tick kPatience = ns_to_ticks(20'000'000);

struct Load {
  const char *name, *setup;
};
// A new move each servo interrupt, so that moves are planned all the time; and blended moves at the factory settings of
// the tasks.
constexpr Load kLoads[] = {{"I8=0, moves of 0.5 ms", "I8=0 I5187=0 I5188=0 I5189=1000000"},
                           {"I8=2, moves of 4 ms", "I8=2 I5187=4 I5188=0 I5189=1000000"}};

double microseconds(Tick t) { return static_cast<double>(t) * 78'125.0 / 9216.0 / 1000.0; }

std::string constant(BreqHost& host) {
  const std::string sign = host.random(3) == 0 ? "-" : "";
  switch (host.random(4)) {
    case 0:
      return sign + std::to_string(host.random(10));
    case 1:
      return sign + std::to_string(host.random(1'000'000));
    case 2:
      return fmt::format("{}{}.{}", sign, host.random(100), 5 * host.random(2));
    default:
      return fmt::format("{}{}.{:03}", sign, host.random(10'000), host.random(1000));
  }
}

std::string axes(BreqHost& host, unsigned count) {
  static const std::string letters = "XYZUVWABC";
  const bool blanks = host.random(2) == 0;
  std::string line;
  for (unsigned i = 0; i < count; ++i) line += letters[i] + constant(host) + (blanks && i + 1 < count ? " " : "");
  return line;
}

std::string expressions(BreqHost& host) {
  return fmt::format("P1=P1+1 X(P1*{}.5-{}) Y(SQRT(P{}*2))", host.random(9), host.random(9), host.random(9));
}

std::string longest(BreqHost& host) {
  std::string line = "X(P1";
  while (line.size() < 250) line += fmt::format("+{}", host.random(9));
  return line + ")";
}

std::string text(std::vector<Tick> times) {
  std::sort(times.begin(), times.end());
  const Tick median = times[times.size() / 2];
  return fmt::format("{} lines: {:.2f} us at the median ({} ticks), {:.2f} us at worst ({} ticks)", times.size(),
                     microseconds(median), median, microseconds(times.back()), times.back());
}

class Measurement {
 public:
  Measurement(BenchContext& b, BreqHost& host) : b_(b), host_(host) {}

  // Sends lines while such lines are executed, one whenever BREQ is high.
  std::vector<Tick> run(const std::function<std::string()>& line, unsigned i16 = 60, unsigned i17 = 100) {
    std::vector<Tick> times;
    host_.set_limits(i16, i17);
    host_.line(line());
    host_.line(line());
    host_.run();
    for (unsigned i = 0; i < kLines; ++i) {
      if (!b_.bus.wait_pin(pin::kBreq, 1, kPatience)) break;
      b_.bus.wait(host_.random(kPause));
      host_.line(line());
      if (host_.fall_time() >= 0) times.push_back(host_.fall_time());
    }
    host_.stop();
    return times;
  }

  void step(const std::string& name, const std::vector<Tick>& times, bool judged) {
    const bool some = times.size() >= kLines / 2;
    const bool in_time = some && (!judged || *std::max_element(times.begin(), times.end()) <= kWorst);
    std::string detail = some ? text(times) : fmt::format("{} lines, expected {} at least", times.size(), kLines / 2);
    if (!in_time && some) detail += fmt::format(", expected {:.0f} us at most", microseconds(kWorst));
    b_.report.step("T_FALL, " + name, in_time, detail + (judged ? "" : "; not judged"));
    if (judged) all_.insert(all_.end(), times.begin(), times.end());
  }

  void verdict() {
    std::sort(all_.begin(), all_.end());
    const bool good = !all_.empty() && all_[all_.size() / 2] <= kMedian && all_.back() <= kWorst;
    b_.report.step("T_FALL, lines of up to eight axes with constants", good,
                   all_.empty()
                       ? "none seen"
                       : text(all_) + fmt::format("; {} {:.0f} and {:.0f} us, {}", good ? "limits" : "expected",
                                                  microseconds(kMedian), microseconds(kWorst), kGoal));
  }

 private:
  BenchContext& b_;
  BreqHost& host_;
  std::vector<Tick> all_;
};

}  // namespace

void measure_fall_times(BenchContext& b, BreqHost& host) {
  Measurement measured(b, host);
  for (const Load& load : kLoads) {
    host.must("CLOSE");
    host.must(load.setup);
    host.open();
    for (const unsigned count : {1u, 2u, 4u, 6u, 8u})
      measured.step(fmt::format("{} {}, {}", count, count == 1 ? "axis" : "axes", load.name),
                    measured.run([&] { return axes(host, count); }), true);
    measured.step(fmt::format("expressions, {}", load.name), measured.run([&] { return expressions(host); }), false);
    measured.step(fmt::format("255 characters, {}", load.name), measured.run([&] { return longest(host); }, 3, 4),
                  false); /* some 130 words each */
  }
  measured.verdict();
  host.verdict("lines while T_FALL was measured", {14 * kLines, 14 * kLines / 2, 0, 0, 0});
}

}  // namespace brick
