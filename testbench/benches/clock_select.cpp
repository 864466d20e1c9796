// clock-select: a seed-chosen half of the board's ICs as the source of PHASE and SERVO, moved there by one command line
// in either order, one by I19, SAVE and $$$ (testbench/unit/system/clock_moves_test.cpp has all of them). clock-faults:
// two sources, none, a missing IC, a MACROGATE, and the clocks from outside (jumper E1). Each IC has its own I7m00,
// I7m01, I7m02, so its clocks tell it apart. Every edge is judged by testbench/checkers/clock_checker.h.
#include <algorithm>
#include <cstdlib>
#include <random>

#include <fmt/format.h>

#include "systemc/core/clock_delays.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/clock_host.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = kPwmClockHz / 1000;
// $$$ writes every register of every IC between the inputs and the output; longer without an edge and the watchdog
// trips (servo-ic:10/4).
constexpr Tick kRestart = 25 * kMillisecond;
constexpr Tick kSurelyInTime = 20 * kMillisecond;
constexpr Tick kSync = kNetDelay + kPinDelay;  // a follower acts so much later than the IC that drives the net

class SelectBench {
 public:
  explicit SelectBench(BenchContext& b) : b_(b), random_(b.seed * 104'729), host_(b) {
    for (unsigned ic = 0; ic < kClockIcs; ++ic) {
      if ((b.board.fitted >> ic & 1) != 0) fitted_.push_back(ic);
      if ((clock_ics(b.board) >> ic & 1) != 0) sources_.push_back(ic);
    }
  }

  void sources() {
    begin();
    directions("directions, factory", 3);
    own_settings();
    by_one_line();
    in_step();
    by_i19();
    host_.shortest_levels();
  }

  void faults() {
    begin();
    own_settings();
    by_i19();
    two_sources();
    no_source();
    missing_ic();
    macrogate();
    external_clocks();
    host_.shortest_levels();
  }

 private:
  void begin() {
    b_.report.equal<std::int64_t>("ICs fitted", static_cast<std::int64_t>(fitted_.size()),
                                  __builtin_popcount(b_.board.fitted));
    host_.verdict("factory setting");
  }

  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }

  // Clocks that the CPU can serve, different for each IC.
  ClockSetting any_setting() {
    for (;;) {
      const ClockSetting s{2500 + pick(2500), pick(3), pick(4)};
      if (s.servo() > 14'000 && s.servo() < 40'000) return s;
    }
  }

  // `count` ICs that could be the source and are not, in any order.
  std::vector<unsigned> some(std::size_t count) {
    std::vector<unsigned> order = sources_;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[pick(static_cast<unsigned>(i))]);
    order.erase(std::remove(order.begin(), order.end(), host_.source()), order.end());
    order.resize(std::min(order.size(), count));
    return order;
  }

  std::string both(unsigned to, unsigned from, bool new_first) const {
    const std::string on = fmt::format("I{}=0", direction_variable(to)),
                      off = fmt::format("I{}=3", direction_variable(from));
    return new_first ? on + " " + off : off + " " + on;
  }

  // Every direction variable: 0 on the source, `inputs` on the others (1 on a MACROGATE), 0 where there is no IC.
  void directions(const std::string& name, unsigned inputs) {
    directions(name, inputs, b_.board.macro_gate, b_.board.fitted);
  }
  void directions(const std::string& name, unsigned inputs, std::uint32_t gates, std::uint32_t present) {
    Comparison same;
    for (const unsigned ic : fitted_) {
      const bool gate = ic >= kFirstMacroIc && (gates >> (ic - kFirstMacroIc) & 1) != 0;
      const unsigned expected = ic == host_.source() || (present >> ic & 1) == 0 ? 0 : gate ? 1 : inputs;
      const std::string variable = fmt::format("I{}", direction_variable(ic)), answer = host_.ask(variable);
      same.judged(variable, answer == std::to_string(expected) ? "" : fmt::format("{}, expected {}", answer, expected));
    }
    b_.report.step(name, same, 2,
                   fmt::format("I{}=0, {} others are inputs", direction_variable(host_.source()), fitted_.size() - 1));
  }

  // CLK-2, CLK-6: variables of ICs that are not the source have no effect.
  void own_settings() {
    for (const unsigned ic : fitted_) host_.program(ic, any_setting());
    if (b_.negative) {  // the divider of the IC that becomes the source next, behind the checker's back
      for (const unsigned ic : fitted_)
        host_.ask(fmt::format("I{}={}", direction_variable(ic) - 5, host_.setting(ic).servo_divider + 1));
    }
    host_.verdict("own I7m00..02 in every IC");
  }

  // I19-2: live, by one line as the manual demands, in both orders of writing.
  void by_one_line() {
    bool new_first = (b_.seed & 1) != 0;
    const auto order = some(sources_.size() / 2);
    for (const unsigned ic : order) {
      const std::string line = both(ic, host_.source(), new_first);
      new_first = !new_first;
      host_.move(ic, line);
      host_.verdict(line);
    }
    directions("directions after the last move", 3);
    b_.report.equal<std::int64_t>("odd high levels, one each hand-over", host_.checker().counts().odd_highs,
                                  static_cast<std::int64_t>(order.size()));
  }

  // A follower with the same I7m00 has its turnarounds where the phase clock has them, five ticks later. It shows when
  // it becomes the source: the clocks go on in step.
  void in_step() {
    const ClockSetting same{4000, 0, 1};
    for (const unsigned ic : fitted_)
      if (ic != host_.source()) host_.program(ic, same);
    host_.program(host_.source(), same);
    b_.bus.wait(16 * same.phase());  // outside the window only each fourth edge moves a turnaround
    Comparison behind;
    for (const unsigned ic : some(1 + sources_.size() / 4)) {
      b_.bus.wait(6 * same.phase() + pick(static_cast<unsigned>(same.phase())));
      const Tick before = host_.checker().last_phase_fall();
      host_.move(ic, both(ic, host_.source(), pick(2) != 0));
      const Tick offset = (host_.checker().last_phase_fall() - before) % same.half();
      behind.equal(fmt::format("I{}, ticks behind the old source", direction_variable(ic)),
                   offset > same.half() / 2 ? offset - same.half() : offset, kSync);
    }
    b_.report.step("followers in step when they take over", behind, 1,
                   fmt::format("{} of them, {} ticks behind the old source", behind.made(), kSync));
    host_.verdict("same I7m00..02 in every IC");
  }

  // I19-1, I19-2: a number until SAVE and reset.
  void by_i19() {
    for (const unsigned ic : some(1)) {
      host_.program(ic, any_setting());
      const std::string i19 = fmt::format("I19={}", direction_variable(ic));
      host_.expect(i19 + " I19", std::to_string(direction_variable(ic)));
      host_.verdict(i19 + " alone");
      host_.expect("SAVE", "");
      host_.check("SAVE");
      saved_ = ic;
      host_.move(ic, "$$$", kRestart);
      host_.verdict(i19 + ", SAVE, $$$");
      directions("directions, " + i19, 3);
      problems("none");
    }
  }

  // A pin is taken with an own rise while the net is high: at least one of the rises of as many periods as it takes the
  // two clocks to slip past each other is. A period before the first, one until they disagree.
  static Tick until_both_drive(Tick net, Tick own) {
    const Tick slip = std::max<Tick>(1, std::min(own % net, net - own % net));
    return (net / slip + 4) * (own + net);
  }

  // servo-ic:7.2: the lowest-numbered IC wins, and the run has an error to show.
  void two_sources() {
    const unsigned lowest = sources_[0], other = sources_[1 + pick(static_cast<unsigned>(sources_.size()) - 1)];
    if (host_.source() != lowest) host_.move(lowest, both(lowest, host_.source(), true));
    host_.verdict("source is the lowest-numbered IC");
    host_.checker().allow_conflict(true);
    host_.ask(fmt::format("I{}=0", direction_variable(other)));
    b_.bus.wait_pin(pin::kSourceConflict, 1,
                    until_both_drive(host_.setting(lowest).phase(), host_.setting(other).phase()));
    b_.report.equal<std::int64_t>(
        fmt::format("clock.conflict, I{} and I{} are 0", direction_variable(lowest), direction_variable(other)),
        b_.machine.outputs().get(pin::kSourceConflict), 1);
    host_.verdict("lowest-numbered of two sources wins");
    const auto errors = b_.machine.take_run_errors();
    const bool named = errors.size() == 1 &&
                       errors[0].find(fmt::format("(I{})", direction_variable(lowest))) != std::string::npos &&
                       errors[0].find(fmt::format("(I{})", direction_variable(other))) != std::string::npos;
    b_.report.step("error of the run", named, errors.empty() ? "none, expected one that names both" : errors[0]);
    host_.ask(fmt::format("I{}=3", direction_variable(other)));
    b_.bus.wait(ClockChecker::release(host_.setting(other)));
    host_.checker().allow_conflict(false);
    b_.report.equal<std::int64_t>("clock.conflict, one source again", b_.machine.outputs().get(pin::kSourceConflict),
                                  0);
    host_.verdict("one source again");
  }

  void problems(const std::string& expected) {
    b_.report.equal<std::string>("problems in ???", b_.problems(), expected);
  }

  void idle(const std::string& name) {
    const BoardOutputs& out = b_.machine.outputs();
    b_.report.equal<std::string>(name,
                                 fmt::format("PHASE={} SERVO={} clock.source={} source_ic={}", out.get(pin::kPhase),
                                             out.get(pin::kServo), host_.source_signal(), out.get(pin::kPhaseSource)),
                                 "PHASE=1 SERVO=1 clock.source=0 source_ic=31");
  }

  void no_source() {
    const std::string variable = fmt::format("I{}", direction_variable(host_.source()));
    host_.stop(variable + "=3");
    b_.bus.wait(2 * kMillisecond + 10 * host_.setting(host_.source()).phase());
    idle("no source");
    problems("no phase clock");
    host_.check("nothing moves without a source", 0);
    host_.start(host_.source(), variable + "=0");
    host_.verdict("source again");
    problems("none");
  }

  bool restart() {
    host_.checker().ignore();
    b_.machine.reset();
    const bool up = b_.link.connect(HostLink::kBootTime);
    if (!up) b_.report.fail("controller answers", "nothing after the reset line");
    return up;
  }

  // The IC that the SAVEd I19 names is pulled out. The watchdog trips 25 ms after the last SERVO (servo-ic:10); a board
  // with many ICs may take as long to start.
  void missing_ic() {
    const unsigned ic = saved_;
    const Tick begin = host_.now();
    if (!restart()) return;
    const bool in_time = host_.now() - begin < kSurelyInTime;
    b_.machine.inputs().fitted = b_.board.fitted & ~(1u << ic);
    b_.machine.apply();
    host_.checker().ignore();
    b_.machine.reset();
    const bool up = b_.link.connect(HostLink::kBootTime);
    b_.report.step(fmt::format("IC of I{} missing: the controller answers", direction_variable(ic)),
                   up || (!in_time && b_.bus.tripped()),
                   up        ? "while the watchdog waits for SERVO"
                   : in_time ? "nothing after the reset line"
                             : "no: it starts for longer than the watchdog waits for SERVO");
    if (!up) return;
    host_.expect("I19", std::to_string(direction_variable(ic)));
    idle(fmt::format("IC of I{} missing", direction_variable(ic)));
    problems("configuration error, no phase clock");
  }

  // Jumper E3 repairs it. Re-initialisation passes a MACROGATE over: with servo IC 0 missing too the next in the order
  // is servo IC 1.
  void macrogate() {
    constexpr unsigned kServoIc1 = 1;
    constexpr std::uint32_t kNeeded = 1u << kServoIc1 | 1u << kFirstMacroIc;
    const std::uint32_t all = b_.board.fitted;
    const bool gate = (all & kNeeded) == kNeeded;
    const std::uint32_t present = gate ? all & ~1u : all;
    const bool macro_ic_0 = (clock_ics(b_.board) >> kFirstMacroIc & 1) != 0;
    const unsigned first = gate ? kServoIc1 : (all & 1) != 0 ? 0 : macro_ic_0 ? kFirstMacroIc : sources_[0];
    b_.machine.inputs().fitted = present;
    b_.machine.inputs().macro_gate = b_.board.macro_gate | (gate ? 1u : 0u);
    b_.machine.apply();
    b_.machine.set_jumper_e3(true);
    if (!restart()) return;
    host_.forget_settings();
    host_.restarted(first);
    host_.verdict(gate ? "re-initialised, MACRO IC 0 a MACROGATE" : "re-initialised");
    host_.expect("I19", std::to_string(direction_variable(first)));
    directions("directions, re-initialised", 3, b_.machine.inputs().macro_gate, present);
    if (gate) host_.expect("I6807=3 I6807", "1");
    problems("none");
  }

  // Jumper E1: the clocks come from the connector, every IC is an input, dividers have no effect.
  void external_clocks() {
    const std::string variable = fmt::format("I{}", direction_variable(host_.source()));
    host_.stop(variable + "=3");
    b_.bus.wait(ClockChecker::release(host_.setting(host_.source())));
    HostInputs& in = b_.machine.inputs();
    in.ext_clock = true;
    b_.machine.apply();
    b_.bus.wait(2 * kSync);
    b_.report.equal<std::int64_t>("clock.source_ic, jumper E1", b_.machine.outputs().get(pin::kPhaseSource), 30);
    const ClockSetting outside{4000, 0, 1};
    host_.checker().start(host_.now(), outside, 1000);
    const unsigned before = host_.checker().counts().phase_falls;
    constexpr unsigned kPeriods = 40;
    const Tick origin = host_.now() + 1000;
    for (unsigned i = 0; i < kPeriods; ++i) {
      b_.bus.advance_to(origin + i * outside.phase());
      in.ext_phase = true;
      b_.machine.apply();
      b_.bus.advance_to(origin + i * outside.phase() + outside.high());
      in.ext_phase = false;
      in.ext_servo = i % 2 == 0;
      b_.machine.apply();
      if (i == 4) host_.checker().run(host_.now(), outside);
    }
    constexpr Tick kThrough = 3;  // a synchroniser and the flip-flop of the net (servo-ic:7.3/1)
    b_.bus.wait(kThrough);
    b_.report.equal<std::int64_t>("PHASE falls", host_.checker().counts().phase_falls - before, kPeriods);
    b_.report.equal<std::int64_t>("the last one three ticks after its pin", host_.checker().last_phase_fall(),
                                  origin + (kPeriods - 1) * outside.phase() + outside.high() + kThrough);
    host_.check(fmt::format("clocks from outside, {} ticks", outside.phase()));
    problems("none");
    host_.checker().ignore();
    in.ext_clock = false;
    in.ext_phase = in.ext_servo = true;
    b_.machine.apply();
    b_.bus.wait(2 * kSync);
    host_.start(host_.source(), variable + "=0");
    host_.verdict("own clocks again");
  }

  BenchContext& b_;
  std::mt19937_64 random_;
  ClockHost host_;
  std::vector<unsigned> fitted_, sources_;
  unsigned saved_ = 0;  // IC that the SAVEd I19 names
};

}  // namespace

// covers: I19-1 I19-2 CLK-2 CLK-6
Bench clock_select_bench() {
  return {"clock-select",
          "half of the ICs as the source of phase and servo clock, by one line and by I19, SAVE, $$$",
          {"servo dividers one higher than the checker is told", "own I7m00..02 in every IC",
           "violations but *SERVO does not fall"},
          [](BenchContext& b) { SelectBench(b).sources(); },
          kTwoIcs,
          nullptr,
          "all-ics"};
}

// covers: I19-1 I19-2 I19-3 CLK-2 CLK-6
Bench clock_faults_bench() {
  return {"clock-faults",
          "two sources of the clocks, none, a missing IC, a MACROGATE, clocks from outside (E1)",
          {"servo dividers one higher than the checker is told", "own I7m00..02 in every IC",
           "violations but *SERVO does not fall"},
          [](BenchContext& b) { SelectBench(b).faults(); },
          kTwoIcs,
          nullptr,
          "turbo-pmac2-pc"};
}

}  // namespace brick
