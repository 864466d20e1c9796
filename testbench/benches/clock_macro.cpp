// clock-macro: a MACRO IC makes the clocks of the whole board (I6807, 6857, 6907, 6957 = 0), with the manual's example
// of 6.67 kHz phase and 3.33 kHz servo, every kind of divider, I10, and the rates of the software behind the clocks: a
// phase and a servo interrupt at each fall, a real-time interrupt every I8+1 servo interrupts. Every edge is judged by
// testbench/checkers/clock_checker.h.
#include <random>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/clock_host.h"

namespace brick {
namespace {

constexpr ClockSetting kExample{8846, 0, 1};  // 117964.8 / (2 x 8846 + 3) = 6.6666 kHz, I6802 = 6.67 / 3.33 - 1 = 1

// Entries into the interrupt tasks, as cpu.task shows them (3 phase, 2 servo, 1 real-time).
class TaskEntries {
 public:
  explicit TaskEntries(Machine& machine) : cpu_(machine.cpu()), machines_(cpu_.on_trap) {
    cpu_.on_trap = [this](std::uint32_t cause, std::uint32_t pc, Cycle cycle) {
      machines_(cause, pc, cycle);
      if (cause == (kInterrupt | kIrqPhase)) ++phase;
      if (cause == (kInterrupt | kIrqServo)) ++servo;
      if (cause == (kInterrupt | kIrqRealTime)) ++real_time;
    };
  }
  ~TaskEntries() { cpu_.on_trap = machines_; }
  TaskEntries(const TaskEntries&) = delete;
  TaskEntries& operator=(const TaskEntries&) = delete;

  unsigned phase = 0, servo = 0, real_time = 0;

 private:
  static constexpr std::uint32_t kInterrupt = 0x8000'0000;
  Cpu& cpu_;
  decltype(Cpu::on_trap) machines_;
};

class MacroBench {
 public:
  explicit MacroBench(BenchContext& b) : b_(b), random_(b.seed * 15'485'863), host_(b) {}

  void run() {
    for (unsigned ic = kFirstMacroIc; ic < kClockIcs; ++ic)
      if ((clock_ics(b_.board) >> ic & 1) != 0) macros_.push_back(ic);
    b_.report.step("MACRO ICs that can make the clocks", !macros_.empty(), std::to_string(macros_.size()));
    if (macros_.empty()) return;
    // Servo clocks of up to 29 kHz leave no time for a conversion table of all channels, nor for motors.
    host_.expect("I8000=0 I100=0", "");
    for (const unsigned ic : macros_) source(ic);
    if (moved_) host_.shortest_levels();
    ranges();
    for (const unsigned i8 : {0u, 2u, 3 + pick(4)}) rates(i8);
  }

 private:
  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }
  std::string variable(unsigned ic, unsigned offset) const {
    return fmt::format("I{}", direction_variable(ic) - 7 + offset);
  }

  // CLK-1, CLK-2, CLK-5: no effect before, the example's clocks after the move.
  void source(unsigned ic) {
    const std::string name = fmt::format("MACRO IC {}", ic - kFirstMacroIc);
    if (ic != host_.source()) {
      host_.program(ic, kExample);
      host_.verdict(name + " programmed, not the source");
      moved_ = true;
      host_.move(ic, fmt::format("{}=0 I{}=3", variable(ic, 7), direction_variable(host_.source())));
    } else {
      host_.program(ic, kExample);
    }
    if (b_.negative && ic == macros_.back()) host_.ask(variable(ic, 2) + "=2");
    host_.verdict(name + ", 6.67 kHz phase and 3.33 kHz servo");
    servo_time(ic);
  }

  // CLK-4: I10 = 640/9 (2 I6800 + 3)(I6801 + 1)(I6802 + 1) = 8388608 / servo kHz, rounded. Both by what the controller
  // has in its variables and by the servo period T at the pin: 8388608 / (117964.8 / T) = 640 T / 9.
  void servo_time(unsigned ic) {
    const std::string limit = variable(ic, 0), phase = variable(ic, 1), servo = variable(ic, 2);
    const std::string line = fmt::format("I10=640*(2*{}+3)*({}+1)*({}+1)/9", limit, phase, servo);
    host_.expect(line, "");
    const auto read = b_.numbers(fmt::format("{} {} {} I10", limit, phase, servo));
    if (read.size() != 4)
      return b_.report.fail("I6800..6802 and I10", fmt::format("{} numbers, expected 4", read.size()));
    const auto nearest = [](std::int64_t ticks) { return (640 * ticks + 4) / 9; };
    b_.report.equal<std::int64_t>("I10 by the formula", read[3],
                                  nearest((2 * read[0] + 3) * (read[1] + 1) * (read[2] + 1)));
    const Tick patience = 4 * host_.setting(ic).servo(), before = b_.next_fall(pin::kServo, patience);
    const Tick period = b_.next_fall(pin::kServo, patience) - before;
    b_.report.equal<std::int64_t>(fmt::format("I10 by the servo period of {} ticks", period), read[3], nearest(period));
  }

  // CLK-3: integer ratios, changed while the clocks run.
  void ranges() {
    const unsigned ic = host_.source();
    for (const unsigned servo : {0u, 15u, 1 + pick(14)}) {
      host_.program(ic, {(servo == 0 ? 4000 : 2000) + pick(500), 0, servo});
      host_.verdict(fmt::format("{}={}", variable(ic, 2), servo), 1);
    }
    for (const unsigned phase : {15u, 1 + pick(14)}) {
      host_.program(ic, {300 + pick(200), phase, 1});
      host_.verdict(fmt::format("{}={}", variable(ic, 1), phase), 1);
    }
    host_.program(ic, kExample);
    host_.verdict("back to the example");
  }

  // servo-ic:7.4. The window begins and ends half a phase period after a fall, when all interrupts of the fall have
  // been taken.
  void rates(unsigned i8) {
    constexpr unsigned kRealTime = 3;
    const ClockSetting& s = host_.setting(host_.source());
    host_.expect(fmt::format("I8={} I8", i8), std::to_string(i8));
    b_.bus.wait((i8 + 2) * s.servo());  // the counter has seen the new I8
    b_.bus.wait_pin(pin::kPhase, 0, 2 * s.phase());
    b_.bus.wait_pin(pin::kPhase, 1, 2 * s.phase());
    const TaskEntries entries(b_.machine);
    const auto& edges = host_.checker().counts();
    const unsigned phase = edges.phase_falls, servo = edges.servo_falls;
    b_.bus.wait(kRealTime * (i8 + 1) * s.servo());
    const unsigned servo_falls = edges.servo_falls - servo;
    b_.report.equal<std::int64_t>("phase interrupts", entries.phase, edges.phase_falls - phase);
    b_.report.equal<std::int64_t>("servo interrupts", entries.servo, kRealTime * (i8 + 1));
    b_.report.equal<std::int64_t>("falls of SERVO", servo_falls, kRealTime * (i8 + 1));
    b_.report.equal<std::int64_t>(fmt::format("real-time interrupts, I8={}", i8), entries.real_time, kRealTime);
    host_.check("clocks meanwhile", kRealTime * (i8 + 1));
  }

  BenchContext& b_;
  std::mt19937_64 random_;
  ClockHost host_;
  bool moved_ = false;  // the source, which it cannot on a board with one IC that makes clocks
  std::vector<unsigned> macros_;
};

}  // namespace

// covers: CLK-1 CLK-2 CLK-3 CLK-4 CLK-5 I19-2
Bench clock_macro_bench() {
  return {"clock-macro",
          "a MACRO IC as the source: 6.67 / 3.33 kHz, dividers, I10, rates of the interrupt tasks",
          {"servo divider of the last MACRO IC behind the checker's back",
           "MACRO IC *, 6.67 kHz phase and 3.33 kHz servo", "violations but *SERVO does not fall"},
          [](BenchContext& b) { MacroBench(b).run(); },
          kAMacroIc,
          nullptr,
          "all-ics"};
}

}  // namespace brick
