// Each line ends with a write of a word in the dual-ported RAM, which is seen on the CPU's bus as the line is
// calculated: what testbench/checkers/rise_checker.h goes by. One line is calculated in a real-time interrupt; the long
// ones take more than one.
#include "testbench/benches/breq_rise.h"

#include <algorithm>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "testbench/checkers/rise_checker.h"

namespace brick {
namespace {

constexpr std::uint32_t kMark = 0x060FF0;  // the last words of the smallest RAM
constexpr unsigned kDrains = 12;           // at each load
constexpr unsigned kBackground = 0;        // cpu.task
constexpr Tick kPatience = ns_to_ticks(60'000'000), kLook = ns_to_ticks(500'000);

std::string marked_line(BreqHost& host) {
  switch (host.random(4)) {
    case 0:
      return "M70=1 DWELL0";
    case 1:
      return fmt::format("X{}.{} Y{} M70=1", host.random(3), host.random(1000), host.random(3));
    case 2:
      return fmt::format("X(SQRT({})+SIN({})) M70=1", host.random(9), host.random(90));
    default: {
      std::string line = "X(P1";
      for (unsigned i = 0; i < 12; ++i) line += fmt::format("+SIN({})", host.random(90));
      return line + ") M70=1";
    }
  }
}

// Tells the checker what passes on the CPU's bus and when the background goes on.
class Watch {
 public:
  Watch(BenchContext& b, RiseChecker& checker)
      : machine_(b.machine), cycle_(machine_.on_bus_cycle), task_(machine_.on_task) {
    machine_.on_bus_cycle = [this, &checker](const PortACycle& c) {
      if (cycle_) cycle_(c);
      if (!c.on_chip && c.write && !c.x && c.address == kMark) checker.calculated(c.strobe_high);
    };
    machine_.on_task = [this, &checker](TimeFs time) {
      if (task_) task_(time);
      if (machine_.task() == kBackground) checker.background(time);
    };
  }
  ~Watch() {
    machine_.on_bus_cycle = cycle_;
    machine_.on_task = task_;
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  Machine& machine_;
  std::function<void(const PortACycle&)> cycle_;
  std::function<void(TimeFs)> task_;
};

}  // namespace

void measure_rise_times(BenchContext& b, BreqHost& host) {
  unsigned lines_sent = 0;
  for (const char* load : {"I8=0", "I8=2"}) {
    Comparison same;
    TimeFs longest = 0;
    host.must("CLOSE");
    host.must(fmt::format("{} M70->Y:${:X},0,16", load, kMark));
    host.open();
    for (unsigned drain = 0; drain < kDrains; ++drain) {
      const unsigned i17 = 2 + host.random(9), i16 = 1 + host.random(i17), lines = i17 + host.random(3);
      host.set_limits(i16, i17);
      for (unsigned i = 0; i < lines; ++i) host.line(marked_line(host));
      host.settle();
      lines_sent += lines;
      RiseChecker checker(lines, i16);
      {
        const Watch watch(b, checker);
        const unsigned before = host.scoreboard().counts().raised_by_execution;
        host.run();
        for (const Tick limit = b.bus.now() + kPatience; !checker.all_calculated() && b.bus.now() < limit;)
          b.bus.wait(kLook);
        b.bus.wait(kLook);
        for (unsigned i = before; i < host.scoreboard().counts().raised_by_execution; ++i)
          checker.rose(tick_to_fs(host.scoreboard().raised_at()));
      }
      host.stop();
      const std::string difference = checker.difference();
      same.judged(fmt::format("{} lines, I16={} I17={}", lines, i16, i17), difference);
      if (difference.empty()) longest = std::max(longest, checker.time());
    }
    b.report.step(fmt::format("T_RISE, {}", load), same, kDrains,
                  fmt::format("{} buffers, {:.2f} us at most from the line, within its real-time interrupt",
                              same.made(), static_cast<double>(longest) / (1000.0 * kFsPerNs)));
  }
  host.must("CLOSE");
  host.must("I8=0 M70->*");
  host.open();
  host.verdict("lines while T_RISE was measured", {lines_sent, 2 * kDrains, 2 * kDrains, 2 * kDrains, 0});
}

}  // namespace brick
