#include "testbench/benches/breq_fall.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "testbench/checkers/fall_limits.h"

namespace brick {
namespace {

constexpr TimeFs kMicrosecond = FallLimits::kMicrosecond;
constexpr Tick kServo = 4 * (2 * 6527 + 3);       // default servo period
constexpr unsigned kLines = 40, kLongLines = 24;  // of 255 characters, 9 ms each
constexpr Tick kPause = ns_to_ticks(450'000);     // up to a servo period: lines come at any time of the tasks
constexpr Tick kPatience = ns_to_ticks(20'000'000);

struct Load {
  const char *name, *setup;
  unsigned i8;
  bool enabled;  // motors: T_FALL is from the port then (motion:1.6/3)
};
// A new move each servo interrupt, so that moves are planned all the time; blended moves at the factory settings of the
// tasks; and four brush motors whose loops are closed, which stand.
constexpr Load kLoads[] = {
    {"I8=0, moves of 0.5 ms", "I8=0 I5187=0 I5188=0 I5189=1000000", 0, false},
    {"I8=2, moves of 4 ms", "I8=2 I5187=4 I5188=0 I5189=1000000", 2, false},
    {"four current loops",
     "I182,4,100=$78006 I183,4,100=$78001 I196,4,100=1 I124,4,100=$120000 I101,4,100=1 "
     "I100,4,100=1 I8008=0",  // the budgets are those of eight entries in the conversion table (motion:1.6)
     2, true},
};

double microseconds(TimeFs t) { return static_cast<double>(t) / static_cast<double>(kMicrosecond); }

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

std::string text(const std::vector<Fall>& falls) {
  const auto whole =
      std::max_element(falls.begin(), falls.end(), [](const Fall& a, const Fall& b) { return a.whole < b.whole; });
  return fmt::format("{} lines net: {:.2f} us at the median, {:.2f} us at worst of {:.0f}; with the tasks {:.2f} us",
                     falls.size(), microseconds(FallLimits::median(falls)), microseconds(FallLimits::worst(falls).net),
                     microseconds(FallLimits::worst(falls).most), microseconds(whole->whole));
}

class Measurement {
 public:
  Measurement(BenchContext& b, BreqHost& host) : b_(b), host_(host) {}

  // Sends lines while such lines are executed, one whenever BREQ is high.
  std::vector<Fall> run(const std::function<std::string()>& line, bool of_axes) {
    host_.set_limits(60, 100);
    return send(line, of_axes, kLines);
  }
  std::vector<Fall> run_long(const std::function<std::string()>& line) {
    host_.set_limits(3, 4);  // some 130 words each
    return send(line, false, kLongLines);
  }

  // BREQ was high, so each line took it low.
  void step(const std::string& name, const std::vector<Fall>& falls, unsigned lines = kLines) {
    b_.report.step("T_FALL, " + name, FallLimits::keeps(falls, lines),
                   falls.size() != lines ? fmt::format("{} lines, expected {}", falls.size(), lines) : text(falls));
  }

  void of_axes(const std::string& name, const std::vector<Fall>& falls) {
    step(name, falls);
    all_.insert(all_.end(), falls.begin(), falls.end());
  }

  // Own times since the last call.
  void tasks(const Load& load) {
    const TimeFs slice = tick_to_fs(kServo) * (load.i8 + 1) / 2;  // docs/firmware.md
    const auto cycles = [this](TimeFs t) { return static_cast<std::uint64_t>(t / b_.machine.cpu_period()); };
    const struct {
      const char* name;
      unsigned task;
      std::uint64_t most;
    } limits[] = {{"phase", TaskTimes::kPhase, FallLimits::kPhaseCycles},
                  {"servo", TaskTimes::kServo, FallLimits::kServoCycles},
                  {"real-time", TaskTimes::kRealTime, cycles(slice)}};
    for (const auto& l : limits) {
      const TaskTimes::Runs runs = host_.tasks().runs(l.task);
      b_.report.step(
          fmt::format("{} task, {}", l.name, load.name),
          FallLimits::keeps_cycles(runs.count, cycles(runs.longest), l.most),
          fmt::format("{} cycles of its own at most, of {}; {} times", cycles(runs.longest), l.most, runs.count));
    }
    host_.tasks().forget_runs();
  }

  unsigned sent() const { return sent_; }

  void verdict() {
    const bool some = !all_.empty();
    const bool good = FallLimits::keeps(all_, all_.size()) && FallLimits::keeps_median(all_);
    b_.report.step("T_FALL, lines of up to eight axes with constants", good,
                   some ? fmt::format("{}; {} {:.0f} and {:.0f} us", text(all_), good ? "limits" : "expected",
                                      microseconds(FallLimits::kMedian), microseconds(FallLimits::kWorst))
                        : "none seen");
  }

 private:
  std::vector<Fall> send(const std::function<std::string()>& line, bool of_axes, unsigned lines) {
    std::vector<Fall> falls;
    sent_ += lines;
    host_.line(line());
    host_.line(line());
    host_.run();
    for (unsigned i = 0; i < lines; ++i) {
      if (!b_.bus.wait_pin(pin::kBreq, 1, kPatience)) break;
      b_.bus.wait(host_.random(kPause));
      const std::string sent = line();
      host_.line(sent);
      if (const auto time = host_.fall_time())
        falls.push_back({time->whole, time->net, FallLimits::of_line(of_axes, sent.size())});
    }
    host_.stop();
    return falls;
  }

  BenchContext& b_;
  BreqHost& host_;
  unsigned sent_ = 0;
  std::vector<Fall> all_;
};

}  // namespace

void measure_fall_times(BenchContext& b, BreqHost& host) {
  Measurement measured(b, host);
  for (const Load& load : kLoads) {
    host.must("CLOSE");
    host.must(load.setup);
    if (load.enabled) host.must("#1J/#2J/#3J/#4J/");
    host.measure_from_port(load.enabled);
    host.open();
    host.tasks().forget_runs();
    for (const unsigned count : {1u, 2u, 4u, 6u, 8u}) {
      const std::string name = fmt::format("{} {}, {}", count, count == 1 ? "axis" : "axes", load.name);
      const std::vector<Fall> falls = measured.run([&] { return axes(host, count); }, true);
      if (load.enabled)
        measured.step(name, falls);
      else
        measured.of_axes(name, falls);
    }
    if (!load.enabled) {
      measured.step(fmt::format("expressions, {}", load.name), measured.run([&] { return expressions(host); }, false));
      measured.step(fmt::format("255 characters, {}", load.name), measured.run_long([&] { return longest(host); }),
                    kLongLines);
    }
    measured.tasks(load);
  }
  host.must("CLOSE");
  for (unsigned motor = 1; motor <= 4; ++motor)
    b.report.step(fmt::format("motor {} enabled until now", motor),
                  (std::stoul(host.ask(fmt::format("#{}?", motor)).substr(0, 6), nullptr, 16) >> 19 & 1) != 0,
                  "bit 19 of ?");
  host.must("#1K#2K#3K#4K");
  host.must("I100,32,100=* I101,32,100=* I183,32,100=* I196,4,100=* I124,4,100=*");
  measured.verdict();
  host.verdict("lines while T_FALL was measured", {measured.sent(), measured.sent() / 2, 0, 0, 0});
}

}  // namespace brick
