// watchdog: trips by each cause, with all outputs in use, and looks at the amplifiers' end of them. 5 V that are no
// longer good trip at once; clocks that stop, 25 ms after the last edge of SERVO, although strobes come and PHASE
// cannot start a DAC word any more. A servo frequency that is too high takes the CPU time of the tasks below it: the
// real-time task still runs, the background does not, its counter (I40) falls below zero, the strobe ends, and the
// circuit trips 25 ms later. Nothing tells the board that it is overloaded: the cost of the tasks in CPU cycles, wait
// states included, is more than the servo period leaves. Those settings are SAVEd, so the reset line does not help.
// Judged by testbench/checkers/watchdog_scoreboard.h.
#include <array>
#include <cstdlib>
#include <memory>
#include <random>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "testbench/benches/benches.h"
#include "testbench/benches/output_watch.h"
#include "testbench/benches/watchdog_probe.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = kPwmClockHz / 1000;
constexpr Tick kPatience = 80 * kMillisecond;
constexpr unsigned kWdo = 9;  // as a source of lines 5, 6, 7 of the interrupt controller (BoardConfig::line_select)

Tick servo_period(unsigned i7000) { return 2 * static_cast<Tick>(i7000) + 3; }  // dividers of one

// Lines of the interrupt controller to which the board connects WDO.
unsigned wdo_lines(const BoardConfig& board) {
  unsigned lines = 0;
  for (unsigned n = 0; n < 3; ++n)
    if ((board.line_select >> 4 * n & 0xF) == kWdo) lines |= 0x20u << n;
  return lines;
}

long number(BenchContext& b, const std::string& line) { return std::strtol(b.ask(line).c_str(), nullptr, 10); }

// The factory's rates: every third servo interrupt a strobe, the counter never far below I40.
void idle(BenchContext& b, WatchdogScoreboard& scoreboard) {
  constexpr Tick kServo = 4 * (2 * 6527 + 3);
  b.bus.wait(3 * kServo);  // tasks that the log-on delayed
  const unsigned before = scoreboard.strobes();
  b.bus.wait(15 * kServo);
  const long strobes = scoreboard.strobes() - before;
  b.report.step("strobes in 15 servo periods, I8=2", strobes == 5, fmt::format("{}, expected 5", strobes));
  const long lowest = number(b, "RX$25"), now = number(b, "RY$25");
  b.report.step("counter and its lowest value, I40=0",
                now <= 4095 && now >= 4095 - 6 && lowest <= now && lowest > 4095 - 60,
                fmt::format("Y:$25={} X:$25={}, expected 4095 at reload", now, lowest));
}

unsigned starving_i7000(BenchContext& b, std::mt19937_64& random) {
  const WatchdogLoad load = watchdog_load(b.link);
  const unsigned i7000 = load.starving_i7000(0) + static_cast<unsigned>(random() % 16);
  b.report.step("load in CPU cycles", load.sensible(),
                fmt::format("phase and servo {}, real-time {}: I7000={} leaves the background nothing", load.servo,
                            load.real_time, i7000));
  return i7000;
}

// A quarter of that rate leaves all tasks their time: commands are answered as ever.
void bearable(BenchContext& b, unsigned i7000) {
  const unsigned slower = 4 * i7000;
  b.expect(fmt::format("I7000={}", slower), "");
  b.bus.wait(kMillisecond);
  b.report.equal<std::string>(
      fmt::format("VERSION at {:.1f} kHz servo", 117'964.8 / static_cast<double>(servo_period(slower))),
      b.ask("VERSION"), "1.947");
}

constexpr Tick kOutputs = kMillisecond / 2;  // several PWM and phase periods at all the rates here

// Every output of the servo ICs in use: each channel enabled, EQU set, and A, B, C as PWM, DAC with PWM, or PWM with
// PFM in turn.
void outputs_on(BenchContext& b, std::mt19937_64& random, OutputWatch& outputs) {
  unsigned mode = static_cast<unsigned>(random() % 4), modes[2][kChannels] = {};
  for (unsigned ic = 0; ic < 2; ++ic)
    for (unsigned n = 0; n < kChannels && (b.board.fitted >> ic & 1) != 0; ++n) {
      const unsigned word = regs::kGateIcs[ic].base + 8 * n;
      modes[ic][n] = mode = (mode + 1) % 4;  // I7mn6
      const unsigned command =
          1 + static_cast<unsigned>(random() % 60);  // of A, and negative of B: all four switches have their time
      b.ask(
          fmt::format("I{}={} M1->X:${:X},14 M2->X:${:X},12 M3->X:${:X},11 M1=1 M2=1 M3=1 WY${:X},${:X},${:X},$100000",
                      7000 + 100 * ic + 10 * (n + 1) + 6, mode, word + 5, word + 5, word + 5, word + 2, command << 8,
                      (0x10000 - command) << 8));
    }
  b.bus.wait(kOutputs);
  outputs.begin();
  b.bus.wait(kOutputs);
  std::string missing;
  using namespace motor_pin;
  for (unsigned ic = 0; ic < 2; ++ic)
    for (unsigned n = 0; n < kChannels && (b.board.fitted >> ic & 1) != 0; ++n) {
      const bool dac = (modes[ic][n] & 1) != 0, pfm = (modes[ic][n] & 2) != 0;
      const auto expect_high = [&](const MotorField& pin) {
        if (!outputs.was_high(ic, pin, n)) missing += fmt::format(" {}.ch{}.{}", servo_ic_scope(ic), n + 1, pin.name);
      };
      for (const MotorField* pin :
           {&kAena, &kEqu, dac ? &kDac : &kPwmATop, dac ? &kDacB : &kPwmBBot, pfm ? &kPfmPulse : &kPwmCTop})
        expect_high(*pin);
      for (const bool second : {false, true})
        if (dac && outputs.dac(ic).value(n, second) == 0)
          missing += fmt::format(" {}.ch{} DAC {}", servo_ic_scope(ic), n + 1, second ? 'B' : 'A');
    }
  b.report.step("outputs of all channels in use", missing.empty(),
                missing.empty() ? "AENA, EQU, PWM, DAC, PFM" : "dead:" + missing);
}

// A few ticks after the trip amplifiers, switches and pulses are off, DAC lines left out; 2 ms after the trip every DAC
// has got zero, from PHASE or from the circuit itself, and nothing moves any more.
void outputs_off(BenchContext& b, OutputWatch& outputs) {
  constexpr Tick kAtOnce = 3 * kTicksPerRef, kDacsBy = 2 * kMillisecond;
  const Tick trip = b.bus.now();
  std::array<std::uint64_t, 2> updates{outputs.dac(0).updates(), outputs.dac(1).updates()};
  b.bus.wait(kAtOnce);
  Comparison off;
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    for (unsigned n = 0; n < kChannels && (b.board.fitted >> ic & 1) != 0; ++n)
      for (const MotorField* pin :
           {&motor_pin::kAena, &motor_pin::kEqu, &motor_pin::kPfmPulse, &motor_pin::kPwmATop, &motor_pin::kPwmABot,
            &motor_pin::kPwmBTop, &motor_pin::kPwmBBot, &motor_pin::kPwmCTop, &motor_pin::kPwmCBot})
        off.equal(fmt::format("{}.ch{}.{}", servo_ic_scope(ic), n + 1, pin->name),
                  b.machine.motor_outputs(ic).get(*pin, n), 0);
  b.report.step(fmt::format("AENA, EQU, PFM, PWM {} ticks after the trip", kAtOnce), off, 9 * 2 * kChannels,
                fmt::format("{} pins are off", off.made()));
  const BoardOutputs& out = b.machine.outputs();
  b.report.equal<std::string>("relay and lamp", fmt::format("{} {}", out.get(pin::kWdRelay), out.get(pin::kWdLed)),
                              "0 1");

  b.bus.advance_to(trip + kDacsBy);
  Comparison zero;
  for (unsigned ic = 0; ic < 2; ++ic)
    for (unsigned n = 0; n < kChannels && (b.board.fitted >> ic & 1) != 0; ++n)
      for (const bool second : {false, true})
        zero.equal(fmt::format("{} DAC {}{}", servo_ic_scope(ic), n + 1, second ? 'B' : 'A'),
                   outputs.dac(ic).value(n, second), 0);
  for (unsigned ic = 0; ic < 2; ++ic) updates[ic] = outputs.dac(ic).updates() - updates[ic];
  b.report.step("DACs 2 ms after the trip", zero, 4 * kChannels,
                fmt::format("{} DACs hold 0, {} and {} words since", zero.made(), updates[0], updates[1]));
  outputs.begin();
  b.bus.wait(kOutputs);
  b.report.equal<std::string>("AENA, EQU, PWM, DAC, PFM that are on", outputs.alive(), "");
}

void dead(BenchContext& b) {
  const BoardOutputs& out = b.machine.outputs();
  b.report.equal<std::string>("watchdog.tripped and line WDO",
                              fmt::format("{} {}", out.get(pin::kWdTripped), out.get(pin::kWdo)), "1 1");
  const HostBus::Pic pic = b.bus.read_pic();
  const unsigned lines = wdo_lines(b.board);
  b.report.equal<std::string>(
      "interrupt controller, lines of WDO",
      fmt::format("IST={:02X} SIG={:02X} IRQ={}", pic.ist, pic.sig & lines, out.get(pin::kIsaIrq)),
      fmt::format("IST={0:02X} SIG={0:02X} IRQ={1}", lines, lines != 0 ? 1 : 0));
  b.link.poll();  // the acknowledge of the last line may wait
  const std::uint64_t instructions = b.machine.instructions();
  unsigned taken = 0;
  while (taken < 4 && b.bus.put_char('V', kMillisecond / 10)) ++taken;
  b.report.step("host port takes no more characters", taken <= 2, fmt::format("{} in its registers", taken));
  unsigned answers = 0;
  for (int look = 0; look < 20; ++look) {
    answers += b.bus.port_status() & HostBus::kRxdf;
    b.bus.wait(kMillisecond / 10);
  }
  b.report.equal<std::int64_t>("characters that the host gets in 2 ms", answers, 0);
  b.report.equal<std::int64_t>("instructions since", static_cast<std::int64_t>(b.machine.instructions() - instructions),
                               0);
  b.report.equal<std::int64_t>("latched while SERVO goes on", b.machine.outputs().get(pin::kWdTripped), 1);
  b.report.equal<std::string>("IPOS, EROR, F1ER",
                              fmt::format("{} {} {}", out.get(pin::kIpos), out.get(pin::kEror), out.get(pin::kF1er)),
                              "0 0 0");
}

// The reset line, without settings that would trip it again.
void recover(BenchContext& b, WatchdogProbe& probe) {
  b.machine.reset();
  b.bus.wait(kMillisecond / 100);
  probe.reset();
  const BoardOutputs& out = b.machine.outputs();
  b.report.equal<std::string>(
      "reset line: tripped, relay, lamp",
      fmt::format("{} {} {}", out.get(pin::kWdTripped), out.get(pin::kWdRelay), out.get(pin::kWdLed)), "0 1 0");
  b.report.step("the controller answers", b.link.connect(kPatience), "");
}

// Two flip-flops and the latch on clk_ref: the third edge after the fall.
void supply(BenchContext& b, std::mt19937_64& random, WatchdogProbe& probe) {
  OutputWatch outputs(b.machine, b.board.fitted);
  outputs_on(b, random, outputs);
  b.bus.wait(static_cast<Tick>(random() % (3 * kTicksPerRef)));
  const Tick fall = b.bus.now();
  b.machine.inputs().pwr_good = false;
  b.machine.apply();
  b.bus.wait_pin(pin::kWdTripped, 1, kMillisecond);
  const Tick took = b.bus.now() - fall;
  b.report.step("trip, 5 V not good", took > 2 * kTicksPerRef && took <= 3 * kTicksPerRef,
                fmt::format("{} ticks, expected {} to {}", took, 2 * kTicksPerRef + 1, 3 * kTicksPerRef));
  outputs_off(b, outputs);
  b.machine.inputs().pwr_good = true;
  b.machine.apply();
  b.bus.wait(kMillisecond);
  b.report.equal<std::int64_t>("latched when 5 V are good again", b.machine.outputs().get(pin::kWdTripped), 1);
  recover(b, probe);
}

// No IC drives the clocks any more.
void clocks_stop(BenchContext& b, std::mt19937_64& random, WatchdogProbe& probe, WatchdogScoreboard& scoreboard) {
  OutputWatch outputs(b.machine, b.board.fitted);
  outputs_on(b, random, outputs);
  b.bus.wait(static_cast<Tick>(random() % 100'000));
  b.ask("I7007=3 I7107=3");
  const unsigned strobes = scoreboard.strobes();
  const std::uint64_t words = outputs.dac(0).updates();
  b.bus.wait(20 * kMillisecond);
  b.report.equal<std::int64_t>("DAC words of IC 0 without PHASE in 20 ms",
                               static_cast<std::int64_t>(outputs.dac(0).updates() - words), 0);
  b.bus.wait_pin(pin::kWdTripped, 1, kPatience);
  const double ms = static_cast<double>(b.bus.now() - probe.last_servo_edge()) / static_cast<double>(kMillisecond);
  b.report.step("trip, no edge of SERVO", ms >= 24.97 && ms <= 25.001,
                fmt::format("{:.3f} ms after the last, expected 24.97 to 25.00; {} strobes meanwhile", ms,
                            scoreboard.strobes() - strobes));
  b.report.step("strobed all the time", scoreboard.strobes() - strobes >= 10,
                fmt::format("{}", scoreboard.strobes() - strobes));
  outputs_off(b, outputs);
  recover(b, probe);
}

void verdict(BenchContext& b, WatchdogScoreboard& scoreboard, const std::string& name) {
  scoreboard.judge(true);
  b.report.step(name, scoreboard.violations().empty(),
                scoreboard.violations().empty() ? scoreboard.summary() : scoreboard.violations().front());
}

// Start-up itself has CPU time as long as interrupts are off; then the same happens as before.
void restart(BenchContext& b, WatchdogProbe& probe, WatchdogScoreboard& scoreboard, unsigned i40) {
  b.machine.reset();
  b.bus.wait(kMillisecond / 100);
  probe.reset();
  b.report.equal<std::int64_t>("reset line ends the trip", b.machine.outputs().get(pin::kWdTripped), 0);
  b.report.step("no answer after the reset", !b.link.connect(kPatience), "the SAVEd settings starve it again");
  scoreboard.judge(true);
  b.report.step("strobes until I40 ran out", scoreboard.strobes() > i40 / WatchdogScoreboard::kRealTimeTask,
                fmt::format("{}", scoreboard.strobes()));
  b.report.step("trips again", scoreboard.violations().empty(),
                scoreboard.violations().empty() ? scoreboard.summary() : scoreboard.violations().front());
}

void run(BenchContext& b) {
  std::mt19937_64 random(b.seed * 7919);
  WatchdogScoreboard scoreboard;
  WatchdogProbe probe(b.bus, scoreboard);
  idle(b, scoreboard);
  supply(b, random, probe);
  clocks_stop(b, random, probe, scoreboard);

  const unsigned i7000 = starving_i7000(b, random), i40 = 300 + static_cast<unsigned>(random() % 200);
  // The same set-up on servo IC 1, SAVEd as the source of the next start.
  b.expect(fmt::format("I8=0 I7002=0 I40={} I19=7107 I7100={} I7101=0 I7102=0 SAVE", i40, i7000), "");
  bearable(b, i7000);

  auto outputs = std::make_unique<OutputWatch>(b.machine, b.board.fitted);
  outputs_on(b, random, *outputs);

  b.bus.write_pic_edge_level(0);
  b.bus.clear_pic();
  b.bus.write_pic_mask(static_cast<std::uint8_t>(wdo_lines(b.board)));
  if (b.negative) b.ask(fmt::format("I40={}", 3 * i40));
  probe.expect_starvation(servo_period(i7000), WatchdogScoreboard::counter_of(i40));
  b.link.send(fmt::format("I7000={}", i7000));
  if (b.bus.wait_pin(pin::kWdTripped, 1, kPatience)) outputs_off(b, *outputs);
  verdict(b, scoreboard,
          fmt::format("trip, servo {:.1f} kHz, I40={}", 117'964.8 / static_cast<double>(servo_period(i7000)), i40));
  if (scoreboard.tripped_at() < 0) return;
  dead(b);
  outputs.reset();  // the restart has none

  restart(b, probe, scoreboard, i40);
}

}  // namespace

// covers: WDT-1
Bench watchdog_bench() {
  return {"watchdog",
          "trips when 5 V fail, when the clocks stop and when the background starves by too high a servo frequency; "
          "DACs, amplifiers, relay, lamp",
          {"the controller's I40 is three times what the scoreboard is told", "trip, servo * kHz, I40=*",
           "I40 and 25 ms: tripped at"},
          run,
          without_8259(kServoIcs01)};
}

}  // namespace brick
