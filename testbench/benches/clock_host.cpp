#include "testbench/benches/clock_host.h"

#include <fmt/format.h>

namespace brick {

namespace {
constexpr Tick kAnswer = ns_to_ticks(1'000'000);  // a line sent and acknowledged
}

ClockHost::ClockHost(BenchContext& bench) : bench_(bench) {
  while (direction_variable(source_) != bench.clock_variable(7)) ++source_;
  bench.bus.watch(select_pins(pin::kPhase, pin::kServo, pin::kSourceConflict), [this](Tick t, const BoardOutputs&,
                                                                                      const BoardOutputs& o) {
    checker_.pins(t, o.get(pin::kPhase) != 0, o.get(pin::kServo) != 0, o.get(pin::kSourceConflict) != 0);
  });
  const BoardOutputs& o = bench.machine.outputs();
  checker_.pins(now(), o.get(pin::kPhase) != 0, o.get(pin::kServo) != 0, false);
  bench.bus.wait(settings_[source_].servo() + settings_[source_].phase());  // the checker knows where the edges are
  checker_.run(now(), settings_[source_]);
}

ClockHost::~ClockHost() { bench_.bus.watch({}, nullptr); }

std::int64_t ClockHost::source_signal() {
  const Signals& signals = bench_.machine.signals();
  const auto id = signals.find("clock.source");
  return id ? static_cast<std::int64_t>(signals.value(*id)) : -1;
}

void ClockHost::settle(const ClockSetting& from, const ClockSetting& to) {
  bench_.bus.wait(ClockChecker::settling(from, to));
  checker_.run(now(), to);
}

void ClockHost::program(unsigned ic, const ClockSetting& s) {
  const unsigned first = direction_variable(ic) - 7;
  const ClockSetting from = settings_[ic];
  if (ic == source_) checker_.change(now(), s);
  bench_.ask(
      fmt::format("I{}={} I{}={} I{}={}", first, s.max_count, first + 1, s.phase_divider, first + 2, s.servo_divider));
  settings_[ic] = s;
  if (ic == source_) settle(from, s);
}

void ClockHost::move(unsigned ic, const std::string& line, Tick hand_over) {
  const ClockSetting from = settings_[source_];
  checker_.move(now(), settings_[ic], hand_over);
  bench_.ask(line);
  source_ = ic;
  settle(from, settings_[ic]);
}

void ClockHost::stop(const std::string& line) {
  checker_.stop(now());
  bench_.ask(line);
}

void ClockHost::start(unsigned ic, const std::string& line) {
  checker_.start(now(), settings_[ic], kAnswer);
  bench_.ask(line);
  source_ = ic;
  settle(settings_[ic], settings_[ic]);
}

void ClockHost::restarted(unsigned ic) {
  source_ = ic;
  checker_.ignore();
  bench_.bus.wait(ClockChecker::settling(settings_[ic], settings_[ic]));
  checker_.run(now(), settings_[ic]);
}

void ClockHost::check(const std::string& name, unsigned falls) {
  checker_.finish(now());
  const auto& found = checker_.violations();
  const ClockChecker::Counts& counts = checker_.counts();
  const unsigned phase = counts.phase_falls - counted_.phase_falls, servo = counts.servo_falls - counted_.servo_falls;
  std::string text = fmt::format("{} falls of PHASE, {} of SERVO", phase, servo);
  if (phase < falls) text += fmt::format(", expected {} or more of PHASE", falls);
  if (found.size() > judged_)
    text += fmt::format("; {} violations, the first: {}", found.size() - judged_, found[judged_].text);
  bench_.report.step(name, phase >= falls && found.size() == judged_, text);
  bench_.report.cover(fmt::format("falls of PHASE, source {}", source_), phase);
  bench_.report.cover(fmt::format("falls of SERVO, source {}", source_), servo);
  judged_ = found.size();
  counted_ = counts;
}

void ClockHost::shortest_levels() {
  const ShortestLevels& shortest = checker_.shortest_levels();
  bench_.report.step("shortest levels while the source moves", shortest.kept(2), shortest.text());
}

void ClockHost::verdict(const std::string& name, unsigned periods) {
  const ClockSetting& s = settings_[source_];
  bench_.bus.wait(s.servo() * (periods - 1));
  const Tick phase = next_fall(pin::kPhase), phase_period = next_fall(pin::kPhase) - phase;
  const Tick servo = next_fall(pin::kServo), servo_period = next_fall(pin::kServo) - servo;
  checker_.finish(now());
  const std::size_t fresh = checker_.violations().size() - judged_;
  const auto source = source_signal();
  const bool good =
      fresh == 0 && phase_period == s.phase() && servo_period == s.servo() && source == direction_variable(source_);
  std::string text = fmt::format("source {}, PHASE {} ticks ({:.4f} kHz), SERVO {} ({:.4f} kHz)", source, phase_period,
                                 117'964.8 / static_cast<double>(phase_period), servo_period,
                                 117'964.8 / static_cast<double>(servo_period));
  if (!good)
    text += fmt::format("; expected {}, {}, {}, 0 violations but {}", direction_variable(source_), s.phase(), s.servo(),
                        fresh);
  if (fresh > 0) text += ", the first: " + checker_.violations()[judged_].text;
  bench_.report.step(name, good, text);
  judged_ = checker_.violations().size();
  counted_ = checker_.counts();
}

}  // namespace brick
