// dpram-reporting: reports in the dual-ported RAM, read by a host that keeps the handshake, at every phase to the
// firmware that writes them. What a set has to show is what commands report, or, while a PLC changes it all the time,
// what two numbers of one block have to be to each other; nothing here knows when the firmware writes. The rules are
// those of host-bus:6.4 and host-bus:6.5.
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "rtl/regs/dpram_map.h"
#include "testbench/benches/benches.h"
#include "testbench/host/dpram_reports.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = ns_to_ticks(1'000'000);
constexpr unsigned kMotors = 8;
constexpr unsigned kSlow = 100;  // periods of the bus before each cycle

class ReportingBench {
 public:
  explicit ReportingBench(BenchContext& bench)
      : b_(bench), ram_(bench.bus), reports_(ram_, !bench.negative), random_(bench.seed * 17 + 3) {}
  void run();

 private:
  unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }
  std::int64_t some_position() { return static_cast<std::int64_t>(random_() % (std::uint64_t{1} << 40)) - (1LL << 39); }
  void motors(const std::string& on, const std::string& off);
  void motors_in_motion(const std::string& on, const std::string& off, const char* name);
  void busy_host();
  void systems();

  BenchContext& b_;
  BusDpram ram_;
  DpramReports reports_;
  std::mt19937_64 random_;
};

std::string number(double value) { return fmt::format("{:.10g}", value); }

// P, V, F and ? of each motor, from registers that are written by M-variables as a servo loop would: of motors that are
// not activated, since a loop writes its own. Positions are reported to 1/32 count.
void ReportingBench::motors(const std::string& on, const std::string& off) {
  const std::uint32_t mask = 1U << pick(kMotors) | 1U << pick(kMotors) | 1U << pick(kMotors);
  for (unsigned motor = 0; motor < kMotors; ++motor) {
    const unsigned at = 0x80 * (motor + 1);
    b_.ask(fmt::format("M{}->D:${:X}", 10 + motor, at + 0x08));
    b_.ask(fmt::format("M{}->D:${:X}", 20 + motor, at + 0x0B));
    b_.ask(fmt::format("M{}->D:${:X}", 30 + motor, at + 0x4C));
    b_.ask(fmt::format("M{}->X:${:X},0,24,S", 40 + motor, at + 0x1D));
    b_.ask(fmt::format("I{}00=0 M{}={} M{}={} M{}={} M{}={}", motor + 1, 10 + motor, some_position(), 20 + motor,
                       some_position(), 30 + motor, some_position(), 40 + motor,
                       static_cast<int>(pick(1U << 24)) - (1 << 23)));
  }
  reports_.choose_motors(mask);
  b_.expect(on, "");
  b_.bus.wait(20 * kMillisecond);
  const auto set = reports_.read_motors(20 * kMillisecond);
  b_.expect(off, "");
  Comparison compared;
  if (!set) b_.report.fail("set of motors", "none was ready");
  std::size_t place = 0;
  for (unsigned motor = 0; set && motor < kMotors; ++motor) {
    if ((mask >> motor & 1) == 0) continue;
    const MotorReport& m = set->motors[place++];
    const std::string name = fmt::format("#{}", motor + 1);
    // To the nearest 1/32, whichever is taken halfway between two; with three decimals, so within one of the last.
    const auto same = [&](const char* command, double value) {
      const double reported = std::stod(b_.ask(name + command)), exact = value / (96 * 32);  // Ixx08 = Ixx09 = 96
      compared.judged(name + command, std::abs(reported - exact) <= 1.0 / 64 + 0.001
                                          ? ""
                                          : number(exact) + ", expected " + number(reported));
    };
    same("P", static_cast<double>(m.position - m.master + m.bias));
    same("V", m.velocity);
    same("F", static_cast<double>(m.following_error));
    compared.equal(name + "?", fmt::format("{:06X}{:06X}", m.servo_status, m.status), b_.ask(name + "?"));
  }
  b_.report.step("motors, " + on, compared, 4, fmt::format("mask {:02X}: P, V, F and ? as commands report them", mask));
}

// PLC 0 moves a motor at each real-time interrupt. Its commanded position stays 0, so the following error in a block is
// the negative of the position in it, whichever it is; a block of two ages shows two.
void ReportingBench::motors_in_motion(const std::string& on, const std::string& off, const char* name) {
  b_.ask("M1->D:$8B M10=0");
  b_.expect("OPEN PLC 0 CLEAR", "");
  b_.expect("P1=P1+1 M1=P1*16777217", "");
  b_.expect("CLOSE I8=0 I5=3 ENABLE PLC 0", "");
  reports_.choose_motors(1);
  b_.expect(on, "");
  b_.bus.wait(20 * kMillisecond);
  Comparison compared;
  std::int64_t before = 0;
  std::uint32_t timer = 0;
  unsigned changes = 0;
  if (b_.negative) b_.bus.set_pace([this] { return pick(kSlow); });  // in a block whose end is of another age
  for (int i = 0; i < 250; ++i) {
    b_.bus.wait(pick(30'000));
    const auto set = reports_.read_motors(20 * kMillisecond);
    if (!set) {
      compared.judged(fmt::format("read {}", i), "no set was ready");
      break;
    }
    const MotorReport& m = set->motors[0];
    compared.equal(fmt::format("read {}, following error", i), m.following_error, -m.position);
    compared.equal(fmt::format("read {}, low half of the position", i), m.position & 0xFFFFFF, m.position >> 24);
    compared.within(fmt::format("read {}, position after the one before", i), m.position, before, INT64_MAX);
    compared.within(fmt::format("read {}, timer", i), set->timer, timer, 0xFFFFFF);
    changes += m.position != before;
    before = m.position;
    timer = set->timer;
  }
  b_.bus.set_pace(nullptr);
  b_.expect(off + " DISABLE PLC 0", "");
  b_.report.step(name, compared, 1000, fmt::format("250 sets at random phases, {} of them new", changes));
  b_.report.step(std::string(name) + ": sets that were new", changes >= 30, std::to_string(changes));
}

void ReportingBench::busy_host() {
  b_.expect("I47=1 I48=1 M1=5", "");
  b_.bus.wait(5 * kMillisecond);
  ram_.write(DPRAM_MOTOR_HOST_BUSY, DPRAM_HOST_BUSY);
  b_.bus.wait(2 * kMillisecond);
  b_.expect("M1=6", "");
  b_.bus.wait(5 * kMillisecond);
  b_.report.equal("position while the host is busy", reports_.fixed_long(DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_POSITION),
                  std::int64_t{5});
  ram_.write(DPRAM_MOTOR_HOST_BUSY, 0);
  b_.bus.wait(2 * kMillisecond);
  b_.report.equal("and when it is not", reports_.fixed_long(DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_POSITION),
                  std::int64_t{6});
  b_.expect("I48=0", "");
}

// Three rotary programs that stand in the middle: ??, %, PR, PE and the targets.
void ReportingBench::systems() {
  for (unsigned cs = 3; cs >= 1; --cs) b_.expect(fmt::format("&{}DEF ROT 100 B0", cs), "");
  b_.expect("OPEN ROT", "");
  for (unsigned cs = 1; cs <= 3; ++cs) {
    b_.expect(fmt::format("&{}LIN ABS F{} TA{} TS0", cs, 100 * cs, 10 * cs), "");
    for (unsigned line = 0; line < 5 + cs; ++line)
      b_.expect(fmt::format("X{}Y{}", pick(1000), -static_cast<int>(pick(1000))), "");
  }
  b_.expect("CLOSE", "");
  b_.expect("I5194=8388607 I5195=8388607 I5294=8388607 I5295=8388607 I5394=8388607 I5395=8388607", "");
  for (unsigned cs = 1; cs <= 3; ++cs) b_.expect(fmt::format("&{}%{}", cs, 20 * cs), "");
  for (unsigned cs = 1; cs <= 3; ++cs) b_.expect(fmt::format("&{}R", cs), "");
  b_.bus.wait(30 * kMillisecond);
  for (unsigned cs = 1; cs <= 3; ++cs) b_.expect(fmt::format("&{}H", cs), "");
  b_.bus.wait(5 * kMillisecond);
  reports_.choose_systems(3);
  b_.expect("I50=2 I49=1", "");
  b_.bus.wait(20 * kMillisecond);
  const auto set = reports_.read_systems(50 * kMillisecond);
  b_.expect("I49=0", "");
  if (!set) {
    b_.report.fail("set of coordinate systems", "none was ready");
    return;
  }
  Comparison compared;
  const auto hex = [](std::uint32_t word) { return fmt::format("{:06X}", word); };
  compared.equal("???", hex(set->global[0]) + hex(set->global[1]), b_.ask("???"));
  for (unsigned cs = 1; cs <= 3; ++cs) {
    const SystemReport& s = set->systems[cs - 1];
    const std::string name = fmt::format("&{}", cs);
    compared.equal(name + "??", hex(s.status[0]) + hex(s.status[1]) + hex(s.status[2]), b_.ask(name + "??"));
    compared.equal(name + "PR", std::to_string(s.lines), b_.ask(name + "PR"));
    compared.equal(name + "PE", fmt::format("P0:{}", s.executing), b_.ask(name + "PE"));
    compared.equal(name + "F", number(s.feed_rate), number(100 * cs));
    compared.equal(name + " time base", s.time_base, b_.numbers(fmt::format("RX${:X}", 0x2002 + 0x100 * (cs - 1)))[0]);
    for (unsigned axis = 0; axis < 9; ++axis) {
      const std::string at = fmt::format("RL${:X}", 0x2041 + 0x100 * (cs - 1) + axis);
      compared.equal(name + " " + at, number(s.targets[axis]), number(std::stod(b_.ask(at))));
    }
    b_.expect(name + "A", "");
  }
  b_.report.step("coordinate systems", compared, 43, "three that stand in the middle, as commands report them");
}

void ReportingBench::run() {
  reports_.clear_handshakes();
  motors("I47=1 I48=1", "I48=0");
  motors("I50=2 I57=1", "I57=0");
  motors_in_motion("I50=1 I57=1", "I57=0", "a motor that moves, by the background");
  motors_in_motion("I47=1 I48=1", "I48=0", "a motor that moves, by the servo task");
  busy_host();
  systems();
}

}  // namespace

Bench dpram_reporting_bench() {
  return {
      "dpram-reporting",
      "motors and coordinate systems in the dual-ported RAM: values as commands report them, coherent at every phase",
      {"the host reads whenever it likes", "a motor that moves, by the background", "read *"},
      [](BenchContext& b) { ReportingBench(b).run(); },
      kASlotOf16Bits};
}

}  // namespace brick
