// breq-rotary: a host feeds rotary motion programs and sees the buffer request in every way there is: the BREQ pin, the
// interrupt line, the interrupt controller's registers, `??` and `PR`, at several settings of I16 and I17 and with two
// coordinate systems. Every edge of BREQ is judged by the scoreboard of the rules
// (testbench/checkers/breq_scoreboard.h).
#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/breq_fall.h"
#include "testbench/benches/breq_host.h"
#include "testbench/benches/breq_rise.h"

namespace brick {
namespace {

constexpr Tick kServo = 4 * (2 * 6527 + 3);  // default servo period in ticks
constexpr Tick kPatience = 40 * kServo;      // no line of these programs takes longer
constexpr unsigned kLines = 200;

struct Limits {
  unsigned i16, i17;
};
constexpr Limits kSettings[] = {{5, 10}, {1, 2}, {3, 3}, {0, 5}, {10, 20}};

std::string name(Limits l) { return fmt::format("I16={} I17={}", l.i16, l.i17); }

// Two buffers, the highest coordinate system first; a real-time interrupt at every servo interrupt (I8=0) and moves of
// the least time (no acceleration, high feedrate), so that a line takes about half a millisecond.
void prepare(BreqHost& host) {
  for (const char* command :
       {"DELETE GATHER", "I8=0 P1=0 P2=0", "I5187=0 I5188=0 I5189=1000000", "I5287=0 I5288=0 I5289=1000000",
        "&2DEFINE ROTARY 400", "&1DEFINE ROTARY 1600", "&2INC B0", "&1INC B0"})
    host.must(command);
  host.open();
}

// BREQ-1, BREQ-2, BREQ-3: the program stands still, so L is the number of lines sent and every answer is exact.
void fill(BreqHost& host, Limits limits) {
  host.set_limits(limits.i16, limits.i17);
  for (unsigned i = 0; i < limits.i17 + 2; ++i) {
    host.line(host.motion_line());
    host.settle();
    host.check();
  }
  host.verdict("filling, " + name(limits), {limits.i17 + 2, limits.i17 - 1, 1, 0, 3 * limits.i17});
}

// BREQ-4: longer lines, so that little moves while the host asks, and sends two more lines between the two points.
void hysteresis(BenchContext& b, BreqHost& host, Limits limits) {
  host.set_limits(limits.i16, limits.i17);
  for (unsigned i = 0; i < limits.i17; ++i) host.line("DWELL2");
  host.settle();
  host.check();
  host.run();
  unsigned extra = 0;
  for (unsigned look = 0; look < 40 * limits.i17 && host.scoreboard().expect_full(); ++look) {
    const unsigned lines = host.lines_ahead();
    const bool between = lines >= limits.i16 && lines + 1 < limits.i17;  // and still below I17 with the new line
    if (extra < 2 && between && host.scoreboard().expect_full()) {
      host.line("DWELL2");
      host.settle();
      host.check();
      ++extra;
    }
    b.bus.wait(kServo / 2);
  }
  host.check();
  b.report.step("execution ends Full, " + name(limits), !host.scoreboard().expect_full() && extra == 2,
                fmt::format("{} lines sent between the two points, {} ahead now", extra, host.lines_ahead()));
  host.stop();
  host.verdict("hysteresis, " + name(limits), {limits.i17 + 2, limits.i17 - 1, 1, 1, limits.i17});
}

// I16=0: L < 0 never comes true, so only CLEAR ends Full (host-bus:5.7).
void never_raised(BenchContext& b, BreqHost& host) {
  host.set_limits(0, 2);
  for (unsigned i = 0; i < 3; ++i) host.line("DWELL0");
  host.run();
  for (unsigned look = 0; look < 40 && host.lines_ahead() > 0; ++look) b.bus.wait(kServo / 2);
  b.bus.wait(2 * kServo);
  host.check();
  const unsigned left = host.lines_ahead();
  b.report.step("I16=0, buffer run empty", left == 0 && host.scoreboard().expect_full() && !host.scoreboard().level(),
                fmt::format("{} lines ahead, Full=1 and BREQ=0 until CLEAR", left));
  host.stop();
  host.clear();
  host.check();
  host.verdict("I16=0", {3, 1, 1, 0, 3});
}

// BREQ-5 by interrupt: edge mode, one line for each interrupt, as host-bus:5.8 tells a host to do.
void by_interrupt(BenchContext& b, BreqHost& host, Limits limits) {
  host.set_limits(limits.i16, limits.i17);
  const std::string before = host.ask("P1");
  host.enable_interrupt();
  host.line(host.motion_line());
  bool running = false;
  const unsigned first = host.interrupts();
  unsigned sent = 1, raised = host.scoreboard().counts().raised_by_execution;
  while (sent < kLines) {
    if (!host.wait_interrupt(running ? kPatience : BreqScoreboard::kSettled)) {
      if (running) break;
      host.settle();
      host.check();
      host.run();
      running = true;
      continue;
    }
    const unsigned now_raised = host.scoreboard().counts().raised_by_execution;
    if (now_raised != raised || host.random(8) == 0)
      host.lines_ahead();  // at once: exactly I16-1 when execution raised it
    if (host.random(8) == 0) host.full();
    raised = now_raised;
    b.bus.wait(host.random(4000));
    host.line(host.motion_line());
    ++sent;
  }
  b.report.equal<std::int64_t>("lines sent, one for each interrupt", sent, kLines);
  for (unsigned look = 0; look < 400 && host.lines_ahead() > 0; ++look) b.bus.wait(kServo);
  b.bus.wait(4 * kServo);
  const long executed = std::strtol(host.ask("P1").c_str(), nullptr, 10) - std::strtol(before.c_str(), nullptr, 10);
  b.report.equal<std::int64_t>("lines executed", executed, kLines);
  host.check();
  host.stop();
  b.report.cover(fmt::format("by interrupts, {}, interrupts", name(limits)), host.interrupts() - first);
  host.verdict(fmt::format("by interrupts, {}", name(limits)), {kLines, 100, 10, 10, 20});
}

// BREQ-5 without interrupt: the host asks before each line. The program starts when the buffer is first found full.
void by_polling(BenchContext& b, BreqHost& host, const std::string& way, const std::function<bool()>& ready) {
  constexpr unsigned kCount = 24;
  host.set_limits(3, 6);
  unsigned sent = 0;
  bool running = false;
  for (const Tick limit = b.bus.now() + kCount * kPatience; sent < kCount && b.bus.now() < limit;) {
    if (ready()) {
      host.line("P1=P1+1 DWELL1");
      ++sent;
    } else if (!running) {
      host.run();
      running = true;
    }
    b.bus.wait(BreqScoreboard::kSettled + host.random(4000));
  }
  b.report.equal<std::int64_t>("lines sent by polling " + way, sent, kCount);
  host.stop();
  host.settle();
  host.check();
  host.verdict("polling " + way, {kCount, 5, 2, 2, kCount});  // full more than once
}

// A host that goes by PR keeps the two points itself: stops at I17 lines, goes on below I16.
std::function<bool()> ready_by_lines(BreqHost& host) {
  return [&host, full = false]() mutable {
    const unsigned lines = host.lines_ahead();
    full = full ? lines >= 3 : lines >= 6;
    return !full;
  };
}

// BREQ-7: the pin shows the coordinate system that the host addresses; the others keep their state.
void two_systems(BenchContext& b, BreqHost& host) {
  host.set_limits(2, 4);
  for (unsigned i = 0; i < 4; ++i) host.line("DWELL0");
  host.settle();
  for (unsigned i = 1; i <= 4; ++i) {
    host.select(1);
    host.check();
    host.line("DWELL0");
    host.settle();
    host.check();
    b.report.step(fmt::format("&1 full, &2 with {} lines", i), host.scoreboard().level() == (i < 4),
                  i < 4 ? "BREQ=1" : "BREQ=0");
    host.select(0);
    host.check();
  }
  host.verdict("two coordinate systems, filled in turn", {8, 6, 2, 0, 24});
  host.run();
  host.select(1);
  b.bus.wait(8 * kServo);  // &1 runs empty and leaves Full while the pin shows &2
  host.settle();
  host.check();
  b.report.step("&2 still full", host.scoreboard().expect_full() && !host.scoreboard().level(), "BREQ=0");
  host.select(0);
  host.check();
  b.report.step("&1 ran empty unseen", !host.scoreboard().expect_full() && host.scoreboard().level(), "BREQ=1");
  host.stop();
  host.verdict("two coordinate systems, &1 running", {0, 0, 0, 0, 6});
}

// host-bus:5.7/6: within its limits, and 2 us by the CPU's cycle counter, which tasks that interrupt can only lengthen.
void pulses(BenchContext& b, const BreqScoreboard& s) {
  constexpr Tick kBuilt = ns_to_ticks(2'000);
  static_assert(kBuilt >= BreqScoreboard::kShortestPulse);
  const bool some = s.counts().pulses >= kLines;
  b.report.step("BREQ pulse",
                some && s.shortest_pulse() >= kBuilt && s.longest_pulse() <= BreqScoreboard::kLongestPulse,
                fmt::format("{} pulses of {} to {} ticks; expected {} or more of {} to {}", s.counts().pulses,
                            s.shortest_pulse(), s.longest_pulse(), kLines, kBuilt, BreqScoreboard::kLongestPulse));
}

void run(BenchContext& b) {
  std::mt19937_64 pace(b.seed * 7919);
  b.bus.set_pace([&pace] { return static_cast<unsigned>(pace() % 4 == 0 ? pace() % 6 : 0); });
  BreqHost host(b, kServo);
  prepare(host);
  for (const Limits limits : kSettings) fill(host, limits);
  for (const Limits limits : {Limits{5, 10}, Limits{2, 6}}) hysteresis(b, host, limits);
  never_raised(b, host);
  two_systems(b, host);
  by_polling(b, host, "??", [&] { return !host.full(); });
  by_polling(b, host, "PR", ready_by_lines(host));
  by_polling(b, host, "the status register", [&] { return host.signal(); });
  by_interrupt(b, host, {5, 10});
  measure_rise_times(b, host);
  measure_fall_times(b, host);
  pulses(b, host.scoreboard());
  b.bus.set_pace(nullptr);
}

}  // namespace

// covers: BREQ-1 BREQ-2 BREQ-3 BREQ-4 BREQ-5 BREQ-7
Bench breq_rotary_bench() {
  return {"breq-rotary",
          "200 lines by interrupt and by polling; every edge of BREQ against the rules of I16 and I17",
          {"the controller's I17 is one higher than the scoreboard is told", "filling, I16=5 I17=10",
           "expected: stays low from I17=10 on (rule 3)"},
          run,
          without_8259(kAnyBoard)};
}

}  // namespace brick
