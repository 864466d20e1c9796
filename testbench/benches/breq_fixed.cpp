// breq-fixed: a host enters a motion program and a PLC, and sees BREQ and Fixed Buffer Full by the pin, the interrupt
// controller and `???`. Every edge of BREQ is judged by the scoreboard of the rules
// (testbench/checkers/fixed_scoreboard.h).
#include <random>

#include <fmt/format.h>

#include "systemc/machine/board_family.h"
#include "testbench/benches/benches.h"
#include "testbench/checkers/fixed_scoreboard.h"

namespace brick {
namespace {

// Words of user memory, firmware:1.10; a Geo PMAC's end below its device registers, servo-ic:11.4.
unsigned memory(const BenchContext& b) { return (b.board.ssi_kind & kSsiGeoPmac) != 0 ? 24'320 : 26'624; }
constexpr std::uint8_t kBreqBit = 0x02;
constexpr Tick kSettled = ns_to_ticks(60'000);
constexpr Tick kNoInterrupt = ns_to_ticks(100'000);

struct Line {
  const char* text;
  unsigned words;  // one a value, an operand, an operator; firmware:4.4
};
constexpr Line kMotion[] = {{"X1 Y2", 2}, {"X1000Y1200Z1400A1600", 4}, {"P1=1", 1}, {"X(P1*2)", 4}, {"DWELL5", 1}};
constexpr Line kLogic[] = {{"P1=1", 1}, {"P2000=P1+1", 4}, {"M1=0", 1}, {"Q5=3", 1}, {"P3=P1", 2}};

class FixedHost {
 public:
  explicit FixedHost(BenchContext& b) : b_(b), random_(b.seed) {
    b_.bus.watch(select_pins(pin::kBreq), [this](Tick now, const BoardOutputs&, const BoardOutputs& after) {
      if (judged_) board_.edge(now, after.get(pin::kBreq) != 0);
    });
  }
  // Rules of rotary buffers are judged by breq-rotary: what they show at the end is where the fixed ones begin.
  void judge(bool on) {
    judged_ = on;
    board_.shown(b_.machine.outputs().get(pin::kBreq) != 0);
  }
  ~FixedHost() { b_.bus.watch({}, nullptr); }

  bool accepted(const std::string& command) {
    const Reply reply = b_.link.command(command);
    return reply.complete && !reply.error;
  }
  void must(const std::string& command) {
    if (!accepted(command)) b_.report.fail(command, "refused, expected: done");
  }
  // Pin, status register and ??? when the pin shows its final state.
  void settle() {
    b_.bus.wait(kSettled);
    const bool pin = b_.machine.outputs().get(pin::kBreq) != 0, sig = (b_.bus.read_pic_signals() & kBreqBit) != 0;
    const std::string status = b_.ask("???");
    if (status.size() != 12) return b_.report.fail("???", "`" + status + "`, expected 12 hex digits");
    board_.settled(b_.bus.now(), pin, sig, (std::stoul(status.substr(6), nullptr, 16) >> 11 & 1) != 0);
  }
  // The controller is told one word more with the negative control.
  void set_i18(unsigned words) {
    board_.i18(words);
    must(fmt::format("I18={}", b_.negative ? words + 1 : words));
  }
  void does(const std::string& command) {  // a cause that the scoreboard knows already
    must(command);
    settle();
  }
  bool verdict(const std::string& step, unsigned lines, unsigned pulses, unsigned stays_low, unsigned quiet) {
    const FixedScoreboard::Counts c = board_.counts();
    const auto& violations = board_.violations();
    const unsigned seen[] = {c.lines - counted_.lines, c.pulses - counted_.pulses, c.stays_low - counted_.stays_low,
                             c.quiet - counted_.quiet};
    counted_ = c;
    const char* names[] = {"lines", "pulses of BREQ", "BREQ stays low", "commands that move nothing"};
    for (unsigned i = 0; i < 4; ++i) b_.report.cover(names[i], seen[i]);
    const bool enough = seen[0] >= lines && seen[1] >= pulses && seen[2] >= stays_low && seen[3] >= quiet;
    std::string detail = fmt::format("{} lines, {} pulses, {} that stay low, {} commands that move nothing", seen[0],
                                     seen[1], seen[2], seen[3]);
    if (!enough) detail += fmt::format("; expected at least {}, {}, {}, {}", lines, pulses, stays_low, quiet);
    const bool good = violations.size() == reported_;
    if (!good) detail += "; " + violations[reported_];
    reported_ = violations.size();
    return b_.report.step(step, good && enough, detail);
  }
  FixedScoreboard& board() { return board_; }
  unsigned random(unsigned below) { return static_cast<unsigned>(random_() % below); }
  BenchContext& bench() { return b_; }

 private:
  BenchContext& b_;
  FixedScoreboard board_;
  std::mt19937_64 random_;
  FixedScoreboard::Counts counted_;
  std::size_t reported_ = 0;
  bool judged_ = true;
};

constexpr unsigned kOneWord = 2;  // index of a line of one word in either table
struct Kind {
  const char *name, *open;
  const Line* lines;
};
constexpr Kind kKinds[] = {{"PROG", "OPEN PROG 7", kMotion}, {"PLC", "OPEN PLC 3", kLogic}};

// I18-2: words in by lines of different lengths until three lines more than I18 allows.
void fill(FixedHost& host, const Kind& kind, unsigned free) {
  const unsigned i18 = free - 12 - host.random(20);
  host.set_i18(i18);
  host.board().opened(free);
  host.does(kind.open);
  unsigned lines = 0, beyond = 0;
  for (unsigned open = free; beyond < 4; ++lines) {
    const Line& line = kind.lines[open > i18 + 5 ? host.random(5) : kOneWord];  // no value is stepped over
    open -= line.words;
    host.board().line(line.words);
    host.does(line.text);
    if (host.board().expect_full()) ++beyond;
  }
  host.verdict(fmt::format("{}, filling", kind.name), 6, 2, 1, 3);
  host.board().nothing();
  if (host.accepted("X")) host.bench().report.fail("X", "accepted, expected an error: it has no value");
  host.settle();
  host.verdict(fmt::format("{}, a line that is refused moves nothing", kind.name), 0, 0, 0, 1);
  host.board().opened(free);
  host.does("CLEAR");
  host.board().line(1);
  host.does("P1=1");
  host.verdict(fmt::format("{}, CLEAR, and a line", kind.name), 1, 1, 0, 0);
  host.board().opened(free);
  host.does("CLEAR");
  host.board().closed();
  host.does("CLOSE");
  host.verdict(fmt::format("{}, CLOSE", kind.name), 0, 0, 0, 1);
}

// Edge mode: a line for each interrupt, as host-bus:5.8 tells; none comes once the buffer is full.
void by_interrupt(FixedHost& host, const Kind& kind, unsigned free) {
  BenchContext& b = host.bench();
  constexpr unsigned kRoom = 20;
  host.set_i18(free - kRoom);
  b.bus.write_pic_edge_level(0x00);
  b.bus.clear_pic();
  b.bus.write_pic_mask(kBreqBit);
  host.board().opened(free);
  host.must(kind.open);
  unsigned interrupts = 0;
  while (interrupts <= kRoom && b.bus.wait_pin(pin::kIsaIrq, 1, kNoInterrupt)) {
    if (b.bus.read_pic_status() != kBreqBit)
      b.report.fail("interrupt status", fmt::format("IST={:02X}, expected 02", b.bus.read_pic_status()));
    b.bus.clear_pic();
    ++interrupts;
    host.settle();
    host.board().line(1);
    host.must("P1=1");
  }
  host.settle();
  b.report.equal<unsigned>(fmt::format("{}, interrupts: one for OPEN and each line up to I18 words", kind.name),
                           interrupts, kRoom);  // the 20th line leaves I18 words: none follows
  b.bus.write_pic_mask(0);
  host.board().opened(free);
  host.does("CLEAR");
  host.board().closed();
  host.does("CLOSE");
  host.verdict(fmt::format("{}, a line for each interrupt", kind.name), kRoom, kRoom - 1, 1, 0);
}

// Rings full and with room, addressed and executed: the open PLC owns the pin.
void ownership(FixedHost& host) {
  constexpr unsigned kRing = 50;
  BenchContext& b = host.bench();
  host.judge(false);
  for (const char* command :
       {"I16=1 I17=3 I18=10", "&2DEFINE ROTARY 50", "&1DEFINE ROTARY 50", "&2B0", "&1B0", "OPEN ROTARY"})
    host.must(command);
  for (int i = 0; i < 3; ++i) host.must("DWELL20");
  host.must("CLOSE");
  b.bus.wait(kSettled);
  host.judge(true);
  host.board().i18(10);
  host.board().rotary(false);
  host.board().closed();
  host.settle();
  host.verdict("no fixed buffer: the full rotary one is shown", 0, 0, 0, 1);
  host.must("R");
  host.board().opened(memory(b) - 2 * kRing);
  host.does("OPEN PLC 3");
  for (const char* command : {"&2", "&1", "&3", "&1"}) {
    host.board().nothing();
    host.does(command);
  }
  host.board().nothing();
  b.bus.wait(ns_to_ticks(70'000'000));  // three DWELLs: the ring runs empty, and is not full any more
  host.settle();
  b.report.equal<std::string>("lines left in the rotary buffer", b.ask("PR"), "0");
  host.verdict("PLC open, &n, and a rotary program that runs", 0, 0, 0, 5);
  host.board().rotary(true);
  host.board().closed();
  host.does("CLOSE");
  host.board().opened(memory(b) - 2 * kRing);
  host.does("OPEN PLC 3");
  host.board().nothing();
  host.does("&3");  // it has no rotary buffer
  host.board().rotary(false);
  host.board().closed();
  host.does("CLOSE");
  host.verdict("CLOSE: the addressed rotary buffer is shown, or none", 0, 0, 0, 3);
}

void run(BenchContext& b) {
  FixedHost host(b);
  host.must("DELETE GATHER");
  for (const Kind& kind : kKinds) fill(host, kind, memory(b));
  for (const Kind& kind : kKinds) by_interrupt(host, kind, memory(b));
  ownership(host);
}

}  // namespace

// covers: I18-2
Bench breq_fixed_bench() {
  return {"breq-fixed",
          "a motion program and a PLC entered line by line; every edge of BREQ against the rules of I18",
          {"the controller's I18 is one higher than the scoreboard is told", "PROG, filling",
           "expected: 2 edges of it, high at the end"},
          run,
          without_8259(kAnyBoard)};
}

}  // namespace brick
