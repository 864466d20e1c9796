// plc: PLC programs as a user loads them, judged from outside: by the outputs CTRL0 and CTRL1 that they turn over,
// against the falls of SERVO, by variables that the host reads, and by the bytes that they send. The rules are those of
// firmware:4.3, firmware:6.7, firmware:7.2 and firmware:8.1; nothing here knows how the firmware does it.
#include <algorithm>
#include <cstdlib>
#include <random>

#include <fmt/format.h>

#include "testbench/benches/benches.h"

namespace brick {
namespace {

constexpr Tick kServo = 4 * (2 * 6527 + 3);  // default servo period in ticks
constexpr Tick kMillisecond = ns_to_ticks(1'000'000);
constexpr Tick kQuiet = 5 * kMillisecond;

struct Turn {  // of an output
  Tick at;
  unsigned servo_falls;  // until then
};

class PlcBench {
 public:
  explicit PlcBench(BenchContext& bench) : b_(bench), random_(bench.seed) {
    b_.bus.watch(select_pins(pin::kServo, pin::kCtrl0, pin::kCtrl1),
                 [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
                   if (before.get(pin::kServo) != 0 && after.get(pin::kServo) == 0) ++servo_falls_;
                   for (unsigned i = 0; i < 2; ++i) {
                     const PinField& pin = i == 0 ? pin::kCtrl0 : pin::kCtrl1;
                     if (before.get(pin) != after.get(pin)) turns_[i].push_back({t, servo_falls_});
                   }
                 });
  }
  ~PlcBench() { b_.bus.watch({}, nullptr); }
  PlcBench(const PlcBench&) = delete;
  PlcBench& operator=(const PlcBench&) = delete;

  void run();

 private:
  using Lines = std::vector<std::string>;

  void must(const std::string& line) {
    const std::string answer = b_.ask(line);
    if (!answer.empty()) b_.report.fail(line, answer + ", expected an acknowledgement");
  }
  void load(unsigned number, const Lines& lines) {
    must(fmt::format("OPEN PLC {} CLEAR", number));
    for (const std::string& line : lines) must(line);
    must("CLOSE");
  }
  void clear() {
    must("DISABLE PLC 0..31 I5=3");
    b_.bus.wait(2 * kServo * 3);
    turns_[0].clear();
    turns_[1].clear();
  }
  unsigned pick(unsigned from, unsigned to) { return from + static_cast<unsigned>(random_() % (to - from + 1)); }
  // What the controller sends without being asked, until it is quiet.
  std::string bytes() {
    std::string text;
    while (const auto c = b_.bus.get_char(kQuiet)) text += static_cast<char>(*c);
    return text;
  }
  std::string printable(const std::string& text) {
    std::string shown;
    for (const char c : text) shown += c < ' ' ? fmt::format("<{:02X}>", c) : std::string(1, c);
    return shown;
  }

  void rate(unsigned i8);
  void gates();
  void order();
  void loops();
  void control();
  void texts();
  void commands();
  void timer();
  void control_d();
  void over_run();
  void endless();

  BenchContext& b_;
  std::mt19937_64 random_;
  unsigned servo_falls_ = 0;
  std::vector<Turn> turns_[2];
};

// PLC 0 turns CTRL0 over in every scan: I8+1 falls of SERVO lie between two of its edges.
void PlcBench::rate(unsigned i8) {
  constexpr unsigned kIntervals = 12;
  clear();
  must(fmt::format("I8={}", i8));
  load(0, {"P1=1-P1", "M1=P1"});
  must("ENABLE PLC 0");
  b_.bus.wait(4 * (i8 + 1) * kServo);  // the first interrupts after a change of I8
  turns_[0].clear();
  b_.bus.wait((kIntervals + 4) * (i8 + 1) * kServo);
  const unsigned expected = i8 + 1 + (b_.negative ? 1 : 0);
  Comparison same;
  for (std::size_t i = 1; i < turns_[0].size(); ++i)
    same.equal(fmt::format("falls of SERVO before edge {}", i), turns_[0][i].servo_falls - turns_[0][i - 1].servo_falls,
               expected);
  b_.report.step(fmt::format("PLC 0 at every real-time interrupt, I8={}", i8), same, kIntervals,
                 fmt::format("{} edges of CTRL0", turns_[0].size()));
  must("DISABLE PLC 0 I8=2");
}

// I5 bit 0: PLC 0, bit 1: the others.
void PlcBench::gates() {
  clear();
  load(0, {"P1=P1+1"});
  load(4, {"P2=P2+1"});
  must("ENABLE PLC 0,4");
  for (unsigned i5 = 0; i5 <= 3; ++i5) {
    must(fmt::format("I5={}", i5));
    must("P1=0 P2=0");
    b_.bus.wait(30 * kServo);
    const std::vector<long> counts = b_.numbers("P1 P2");
    const bool right = counts.size() == 2 && (counts[0] >= 9) == ((i5 & 1) != 0) &&
                       (counts[0] == 0) == ((i5 & 1) == 0) && (counts[1] >= 9) == ((i5 & 2) != 0) &&
                       (counts[1] == 0) == ((i5 & 2) == 0);
    b_.report.step(
        fmt::format("I5={}", i5), right,
        counts.size() == 2 ? fmt::format("{} scans of PLC 0, {} of PLC 4", counts[0], counts[1]) : "no numbers");
  }
}

// Each PLC adds its number to a list.
void PlcBench::order() {
  constexpr unsigned kScans = 60;
  clear();
  std::vector<unsigned> numbers;
  for (unsigned n = 1 + pick(0, 2); n < 32; n += pick(1, 9)) numbers.push_back(n);
  std::string list;
  for (auto n = numbers.rbegin(); n != numbers.rend(); ++n) {  // not in the order of their scans
    load(*n, {fmt::format("IF(P200<{})", kScans), "P200=P200+1", fmt::format("P(200+P200)={}", *n), "ENDIF"});
    list += (list.empty() ? "" : ",") + std::to_string(*n);
  }
  must("P200=0");
  must("ENABLE PLC " + list);
  b_.bus.wait(25 * kMillisecond);
  const std::vector<long> scans = b_.numbers(fmt::format("P201..{}", 200 + kScans));
  Comparison same;
  const auto first = scans.empty() ? numbers.end() : std::find(numbers.begin(), numbers.end(), scans[0]);
  if (first == numbers.end()) same.judged("first scan", "none of the PLCs");
  for (std::size_t i = 0; i < scans.size() && first != numbers.end(); ++i)
    same.equal(fmt::format("scan {}", i + 1), scans[i],
               numbers[(static_cast<std::size_t>(first - numbers.begin()) + i) % numbers.size()]);
  b_.report.step("order of scans", same, kScans, fmt::format("{} PLCs: {}", numbers.size(), list));
}

// A loop gives way each time it goes back: another PLC is scanned as often as the loop goes round.
void PlcBench::loops() {
  clear();
  load(3, {"P10=0", "P13=P13+1", "WHILE(P12=0)", "P10=P10+1", "ENDWHILE", "P14=P14+1", "DISABLE PLC 3"});
  load(6, {"P11=P11+1", "P15=P10-P11"});
  must("P10..14=0");
  must("ENABLE PLC 3,6");
  b_.bus.wait(20 * kMillisecond);
  must("DISABLE PLC 6");
  must("P12=1");
  b_.bus.wait(5 * kMillisecond);
  const std::vector<long> counts = b_.numbers("P11 P13 P14 P15");
  const bool right =
      counts.size() == 4 && counts[0] >= 20 && counts[1] == 1 && counts[2] == 1 && std::abs(counts[3]) <= 1;
  b_.report.step("a loop gives way and is gone on with", right,
                 counts.size() == 4
                     ? fmt::format("{} scans of the other PLC, {} fewer than turns of the loop; begun {}, "
                                   "ended {}",
                                   counts[0], counts[3], counts[1], counts[2])
                     : "no numbers");
}

void PlcBench::control() {
  clear();
  load(2, {"P1=P1+1"});
  load(5, {"IF(P5=1)", "DISABLE PLC 2", "ENDIF", "IF(P5=2)", "ENABLE PLC 2", "ENDIF", "IF(P5=3)", "PAUSE PLC 2",
           "ENDIF", "IF(P5=4)", "RESUME PLC 2", "ENDIF", "P5=0"});
  must("P1=0 P5=0 M5002->Y:$3102,22");
  must("ENABLE PLC 5");
  const auto runs = [this](const std::string& what, bool expected) {
    b_.bus.wait(10 * kServo);
    const std::vector<long> before = b_.numbers("P1 M5002");
    b_.bus.wait(20 * kServo);
    const std::vector<long> after = b_.numbers("P1 M5002");
    const bool known = before.size() == 2 && after.size() == 2;
    const bool does = known && after[0] > before[0], shown = known && after[1] == 0;
    b_.report.step(
        what, known && does == expected && shown == expected,
        known ? fmt::format("{} scans, Y:$3102 bit 22 is {}", after[0] - before[0], after[1]) : "no numbers");
  };
  runs("disabled when it has been entered", false);
  for (const auto& [line, expected] :
       {std::pair{"ENABLE PLC 2", true}, {"PAUSE PLC 2", false}, {"RESUME PLC 2", true}, {"DISABLE PLC 1..3", false}}) {
    must(line);
    runs(line, expected);
  }
  const Lines statements = {"DISABLE", "ENABLE", "PAUSE", "RESUME"};
  for (const unsigned i : {2u, 3u, 4u, 1u}) {
    must(fmt::format("P5={}", i));
    runs(statements[i - 1] + " as a statement", i % 2 == 0);
  }
}

void PlcBench::texts() {
  struct Form {
    const char *settings, *before, *after;
  };
  const Form forms[] = {{"I62=0 I64=0", "", "\r"}, {"I62=0 I64=1", "\x02", "\r"}, {"I62=1 I64=0", "", ""}};
  Comparison same;
  for (const Form& form : forms) {
    std::string text;
    for (unsigned i = pick(1, 60); i > 0; --i) {
      const char c = static_cast<char>(pick(' ', '~'));
      text += c == '"' ? '\'' : c;
    }
    clear();
    load(1, {"SEND\"" + text + "\"", "SENDP\"2\"", "DISABLE PLC 1"});
    must(form.settings);
    must("ENABLE PLC 1");
    same.equal(form.settings, printable(bytes()),
               printable(form.before + text + form.after + form.before + "2" + form.after));
    must("I62=0 I64=0");
  }
  b_.report.step("SEND", same, 3, "three forms of a line");
  std::string many;
  load(1, {"P1=P1+1", "SEND\"line\"", "IF(P1=30)", "DISABLE PLC 1", "ENDIF"});
  must("P1=0");
  must("ENABLE PLC 1");
  for (unsigned i = 0; i < 30; ++i) many += "line\r";
  b_.report.equal<std::string>("30 lines, none lost", printable(bytes()), printable(many));
}

void PlcBench::commands() {
  clear();
  must("&3 #2");
  load(1, {"CMD\"P3=7 P4=P3*2\"", "CMD\"P3\"", "CMDP\"P4\"", "ADDRESS#5&2", "CMDP\"#\"", "CMD\"Q7=9\"", "CMD\"UUU\"",
           "DISABLE PLC 1"});
  must("ENABLE PLC 1");
  b_.report.equal<std::string>("replies of COMMAND", printable(bytes()), "14<0D>5<0D><07>ERR003<0D>");
  b_.expect("P3", "7");
  b_.expect("&2Q7", "9");
  b_.expect("#", "2");
  must("&1 #1");
}

// CTRL1 is high while a timer runs down.
void PlcBench::timer() {
  const unsigned cycles = pick(20, 60);
  clear();
  load(8, {"M1=2", fmt::format("I5111={}", cycles), "WHILE(I5111>0)", "ENDWHILE", "M1=0", "DISABLE PLC 8"});
  must("ENABLE PLC 8");
  b_.bus.wait((cycles + 20) * kServo);
  if (turns_[1].size() != 2)
    return b_.report.fail("timer", fmt::format("{} edges of CTRL1, expected 2", turns_[1].size()));
  Comparison same;
  same.within("falls of SERVO", turns_[1][1].servo_falls - turns_[1][0].servo_falls, cycles, cycles + 1);
  b_.report.step("timer I5111 holds a loop", same, 1, fmt::format("{} servo cycles", cycles));
}

void PlcBench::control_d() {
  clear();
  load(0, {"P1=1-P1", "M1=P1"});
  load(9, {"P2=P2+1"});
  must("I8=0 ENABLE PLC 0,9");
  b_.bus.wait(10 * kServo);
  b_.bus.put_char(0x04, kMillisecond);
  const Tick given = b_.bus.now();
  b_.bus.wait(10 * kMillisecond);
  const std::vector<long> first = b_.numbers("P2");
  b_.bus.wait(10 * kMillisecond);
  const std::vector<long> then = b_.numbers("P2");
  const Tick last = turns_[0].empty() ? 0 : turns_[0].back().at;
  b_.report.step("^D", turns_[0].size() >= 8 && last <= given + kMillisecond && first == then && !then.empty(),
                 fmt::format("{} edges of CTRL0, the last {:.0f} us after it", turns_[0].size(),
                             std::max(0.0, 1000.0 * static_cast<double>(last - given) / kMillisecond)));
  must("I8=2");
}

// One scan that takes longer than a real-time interrupt may. The first digits of ??? are the error bits of X:$6, those
// behind them tell the board's type.
void PlcBench::over_run() {
  clear();
  must("WX$6,0");
  const std::string before = b_.ask("???");
  b_.report.step("no error bit is set", before.size() == 12 && before.compare(0, 6, "000000") == 0, before);
  load(0, {"P9=0", "WHILE(P9<300)", "P9=P9+1", "ENDWHILE", "DISABLE PLC 0"});
  must("I8=0 ENABLE PLC 0");
  b_.bus.wait(25 * kMillisecond);
  b_.expect("P9", "300");
  b_.expect("???", "400000" + before.substr(std::min<std::size_t>(6, before.size())));  // bit 9: the last task
  must("WX$6,0 I8=2");
  b_.expect("???", before);
}

// What trips the real controller trips this one (firmware:8.3).
void PlcBench::endless() {
  clear();
  load(0, {"WHILE(1=1)", "ENDWHILE"});
  b_.link.send("ENABLE PLC 0");
  const Tick given = b_.bus.now();
  const bool tripped = b_.bus.wait_pin(pin::kWdTripped, 1, 40 * kMillisecond);
  b_.report.step("an endless loop of PLC 0 trips the watchdog", tripped && b_.bus.now() - given > 20 * kMillisecond,
                 fmt::format("{:.1f} ms after it began", static_cast<double>(b_.bus.now() - given) / kMillisecond));
  b_.machine.power_cycle();
  b_.report.step("power up", b_.link.connect(HostLink::kBootTime), "answers");
}

void PlcBench::run() {
  must("M1->X:$70012,24");
  for (const unsigned i8 : {0u, 2u, pick(3, 7)}) rate(i8);
  gates();
  order();
  loops();
  control();
  texts();
  commands();
  timer();
  control_d();
  over_run();
  endless();
}

}  // namespace

Bench plc_bench() {
  return {"plc",
          "PLC programs: scans of PLC 0 and of the others, I5, loops, control, SEND, COMMAND, timers, over-run",
          {"the bench is told that I8 is one higher than it is", "PLC 0 at every real-time interrupt, I8=0",
           "1, expected 2"},
          [](BenchContext& b) { PlcBench(b).run(); }};
}

}  // namespace brick
