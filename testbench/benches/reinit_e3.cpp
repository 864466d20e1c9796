// reinit-e3: settings are SAVEd with which the controller cannot live, so that neither power nor reset line helps.
// Powered up with jumper E3 it starts with the factory's settings and answers; `$$$***` gives the same. Expected values
// are the data sheet's (servo-ic:3, servo-ic:7, servo-ic:14/16, servo-ic:14/17; firmware:2), periods are arithmetic.
#include <fmt/format.h>

#include "testbench/benches/benches.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = kPwmClockHz / 1000;
constexpr Tick kPatience = 80 * kMillisecond;
constexpr std::uint32_t kMacroIc0 = 1u << 18;

// Three ways to SAVE oneself out of the controller, by seed.
struct Fault {
  const char* name;
  const char* settings;
};
constexpr std::uint32_t kServoIc9Starred = 1u << 17;  // of I7957
constexpr Fault kFaults[] = {
    {"the clocks should come from an IC that is not there", "I19=7957"},
    {"servo clock so fast that the background starves", "I8=0 I7100=300 I7101=0 I7102=0 I19=7107"},
    {"phase clock so fast that all tasks starve", "I7100=20 I7101=0 I7102=3 I19=7107"},
};

// Things that a user leaves behind in variables and memory.
void leave_traces(BenchContext& b) {
  b.expect("I16=3 I17=21 I8=7 I40=500 I100=1 I5187=77", "");
  b.expect("P7=11 Q5=22 M9->X:$10000,0,24", "");
  b.expect("&1DEFINE ROTARY 200", "");
  b.expect("WX$10000,$123456", "");
}

void check_defaults(BenchContext& b, const std::string& variables) {
  b.expect("I19 I7007 I7107", "7007|0|3");
  b.expect("I6807", (b.board.fitted & kMacroIc0) != 0 ? "3" : "0");  // an absent IC's variables read 0
  // Clock words: direction in bits 21..20 and 17..16, dividers, hardware clocks 2258 = $8D2; PWM word: I7000 = 6527 =
  // $197F, I7004 = 15.
  b.expect("RHX$78004", "3008D2");
  b.expect("RHX$78104", "3038D2");
  b.expect("RHX$7801C", "197F0F");
  b.expect("I7000..7004", "6527|0|3|2258|15");
  b.expect("I7100..7104", "6527|0|3|2258|15");
  b.expect("I8 I16 I17 I40 I52", "2|5|10|0|7");
  b.expect("I100 I5187", "1|0");
  b.expect("P7 Q5 M9->", variables);
  b.expect("RX$10000", "0");
  const std::string open = b.ask("OPEN ROTARY");
  b.report.step("no rotary buffer is left", open.rfind("ERR", 0) == 0, open);
  b.report.equal<std::string>("problems in ???", b.problems(), "none");
}

void check_clocks(BenchContext& b) {
  constexpr Tick kPhase = 2 * 6527 + 3, kServo = 4 * kPhase;
  for (const auto& [pin, period] : {std::pair{pin::kPhase, kPhase}, std::pair{pin::kServo, kServo}}) {
    const Tick before = b.next_fall(pin, 2 * kServo);
    b.report.equal<std::int64_t>(fmt::format("{} period, ticks", pin.name), b.next_fall(pin, 2 * kServo) - before,
                                 period);
  }
}

void run(BenchContext& b) {
  // A board that has every IC lacks the first fault.
  const bool whole = (b.board.fitted & kServoIc9Starred) != 0;
  const Fault& fault = kFaults[whole ? 1 + b.seed % 2 : b.seed % 3];
  leave_traces(b);
  b.expect(fmt::format("{} SAVE", fault.settings), "");
  b.machine.power_cycle();
  b.bus.wait_pin(pin::kWdTripped, 1, kPatience);
  b.report.equal<std::int64_t>(std::string("the SAVEd settings trip the watchdog: ") + fault.name,
                               b.machine.outputs().get(pin::kWdTripped), 1);
  b.report.step("no answer", !b.link.command("VERSION").complete, "none expected");

  b.machine.set_jumper_e3(!b.negative);
  b.machine.power_cycle();
  const Tick power = b.bus.now();
  const bool up = b.link.connect(kPatience);
  b.report.equal<std::int64_t>("watchdog.tripped with jumper E3", b.machine.outputs().get(pin::kWdTripped), 0);
  b.report.step("answers with jumper E3", up,
                fmt::format("{:.1f} ms after power-up", static_cast<double>(b.bus.now() - power) / kMillisecond));
  if (!up) return;
  check_defaults(b, "0|0|*");
  check_clocks(b);

  b.machine.set_jumper_e3(false);
  leave_traces(b);
  b.expect("I6802=1 I7102=1 I6807=0 I7007=3", "");
  b.report.step("$$$***", b.link.command("$$$***").complete, "answers");
  check_defaults(b, "11|22|X:$10000,24");  // it leaves those (firmware:5.10/2)
  check_clocks(b);
}

}  // namespace

// covers: WDT-2
Bench reinit_e3_bench() {
  return {"reinit-e3",
          "SAVEd settings that stop the controller; power-up with jumper E3, and $$$***, restore the defaults",
          {"the jumper is not put in", "watchdog.tripped with jumper E3", "1, expected 0"},
          run,
          kServoIcs01};
}

}  // namespace brick
