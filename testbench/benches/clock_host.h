// A host that programs the clocks, moves their source and keeps the clock checker informed: what the two clock benches
// share. The expected numbers are those of the formulas (ClockSetting); the checker sees every edge whatever the host
// does meanwhile.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/bench.h"
#include "testbench/checkers/clock_checker.h"

namespace brick {

constexpr unsigned kClockIcs = 22, kFirstMacroIc = 18;

// Number of the clock-direction variable of IC `index` (as in BoardInputs::fitted), servo-ic:7.1: 7007, ... 7907, 7257,
// ... 7957, 6807, ... 6957. I7m00, I7m01, I7m02 are 7, 6 and 5 below.
constexpr unsigned direction_variable(unsigned index) {
  return index < 10              ? 7007 + 100 * index
         : index < kFirstMacroIc ? 7257 + 100 * (index - 10)
                                 : 6807 + 50 * (index - kFirstMacroIc);
}

class ClockHost {
 public:
  explicit ClockHost(BenchContext& bench);
  ~ClockHost();
  ClockHost(const ClockHost&) = delete;
  ClockHost& operator=(const ClockHost&) = delete;

  ClockChecker& checker() { return checker_; }
  unsigned source() const { return source_; }
  const ClockSetting& setting(unsigned ic) const { return settings_.at(ic); }

  std::string ask(const std::string& line) { return bench_.ask(line); }
  void expect(const std::string& line, const std::string& answer) { bench_.expect(line, answer); }
  std::int64_t source_signal();  // clock.source
  Tick now() const { return bench_.bus.now(); }

  // I7m00, I7m01, I7m02 in one line. On the source the clocks change, on another IC nothing happens.
  void program(unsigned ic, const ClockSetting& s);
  // `line` makes `ic` the source; waits until every edge must be exact again.
  void move(unsigned ic, const std::string& line, Tick hand_over = ClockChecker::kHandOver);
  void stop(const std::string& line);  // ... leaves none
  void start(unsigned ic, const std::string& line);
  void restarted(unsigned ic);                    // after a reset line: `ic` drives with its factory setting
  void forget_settings() { settings_.fill({}); }  // factory defaults in all ICs

  // Runs `periods` servo periods and reports source, both periods as measured, and what the checker found since the
  // last verdict.
  void verdict(const std::string& name, unsigned periods = 2);
  void check(const std::string& name, unsigned falls = 2);  // the checker's part alone; so many of PHASE at least
  void shortest_levels();  // both levels of both nets, each seen twice or more while the source moved

 private:
  Tick next_fall(const PinField& pin) {
    return bench_.next_fall(pin, 4 * settings_[source_].servo() + ClockChecker::kHandOver);
  }
  void settle(const ClockSetting& from, const ClockSetting& to);

  BenchContext& bench_;
  ClockChecker checker_;
  std::array<ClockSetting, kClockIcs> settings_{};
  unsigned source_ = 0;
  std::size_t judged_ = 0;  // violations
  ClockChecker::Counts counted_;
};

}  // namespace brick
