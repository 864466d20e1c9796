// breq-select: whose buffer request the pin shows. Sixteen coordinate systems with buffers that are idle, have room or
// are full, by seed; `&n`, I2, I59 and the control panel's FPDn/ select among them. Pin, lamp, status register and
// interrupt are judged by testbench/checkers/selection_scoreboard.h, the longest times printed. On boards without a
// panel its inputs and I2 must do nothing.
#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rtl/regs/brick_regs.hpp"
#include "testbench/benches/benches.h"
#include "testbench/checkers/selection_scoreboard.h"

namespace brick {
namespace {

using Buffer = SelectionScoreboard::Buffer;
constexpr Tick kPhase = 2 * 6527 + 3;  // default phase period; a servo period is 4 of them, here 1 but in the end
constexpr Tick kMicrosecond = ns_to_ticks(1000);
constexpr std::uint8_t kBreqLine = 0x02;
constexpr unsigned kLeastEdges = 24;
constexpr unsigned kSystems = SelectionScoreboard::kSystems;

class BreqSelect {
 public:
  explicit BreqSelect(BenchContext& context) : b_(context), random_(context.seed), scoreboard_(context.board.jpan, 0) {
    BoardOutputs pins = select_pins(pin::kBreq, pin::kBrldN, pin::kCtrl0, pin::kPhase);
    b_.bus.watch(pins, [this](Tick now, const BoardOutputs& before, const BoardOutputs& after) {
      if (before.get(pin::kPhase) != 0 && after.get(pin::kPhase) == 0) scoreboard_.phase_fell(now);
      if (before.get(pin::kCtrl0) != after.get(pin::kCtrl0)) scoreboard_.executed(now);
      if (before.differs(after, select_pins(pin::kBreq, pin::kBrldN)))
        scoreboard_.edge(now, after.get(pin::kBreq) != 0, after.get(pin::kBrldN) != 0);
    });
    judge_ = b_.machine.on_task;
    b_.machine.on_task = [this](TimeFs time) {
      constexpr unsigned kRealTime = 1;  // cpu.task
      if (judge_) judge_(time);
      const unsigned task = b_.machine.task();
      if (task == kRealTime && task_ < kRealTime) scoreboard_.real_time_began(fs_to_tick(time));
      task_ = task;
    };
  }
  ~BreqSelect() {
    b_.bus.watch({}, nullptr);
    b_.machine.on_task = judge_;
  }
  BreqSelect(const BreqSelect&) = delete;
  BreqSelect& operator=(const BreqSelect&) = delete;

  void run() {
    prepare();
    by_host("&n, I2=1", 1, 40);
    among_tasks();
    if (!b_.board.jpan) in_motion();
    i2(0);
    if (b_.board.jpan) {
      for (unsigned group = 0; group < 4; ++group) by_panel(group, group < 2 ? 16 : 8);
      by_host("&n moves nothing, I2=0", 0, 8);
      i59(0);
      i2(1);
      in_motion();
      i2(0);
      groups_by_panel();
      other_buffers();
    } else {
      by_host("&n, I2=0", 0, 24);
      by_panel(0, 12);
    }
    i2(1);
    scoreboard_.nothing(b_.bus.now());
    for (unsigned n = 0; n < 6; ++n) panel(pick(16));
    verdict("FPDn/ moves nothing, I2=1", 6);
    default_rate();
    if (b_.board.jpan) init();
    std::string times =
        fmt::format("T_CS {:.2f} us of 10, {:.2f} of 30 with tasks that interrupted",
                    microseconds(scoreboard_.longest_host()), microseconds(scoreboard_.longest_interrupted()));
    if (b_.board.jpan)
      times += fmt::format("; T_FPD a real-time interrupt period and {:.2f} us of 100",
                           microseconds(scoreboard_.longest_panel()));
    b_.report.step("longest times", true, times);
    activity();
  }

 private:
  unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }
  static double microseconds(Tick ticks) { return static_cast<double>(ticks) / 117.9648; }

  // Buffers are defined from the highest system down. C.S. 1 gets one that is never opened.
  void prepare() {
    std::array<Buffer, kSystems>& states = states_;
    for (unsigned cs = 1; cs < kSystems; ++cs) states[cs] = static_cast<Buffer>(cs % 3);
    std::shuffle(states.begin() + 1, states.begin() + 8, random_);  // each group of the panel has some of each
    std::shuffle(states.begin() + 8, states.end(), random_);
    b_.ask("DELETE GATHER");
    b_.ask("I68=15 I16=1 I17=2");
    rates(0, 0);
    b_.ask("I8008=0");  // 32 entries of the conversion table alone take longer than T_CS (host-bus:5.7/9)
    for (unsigned cs = kSystems; cs-- > 0;)
      if (states[cs] != Buffer::kIdle) b_.ask(fmt::format("&{}DEFINE ROTARY 20", cs + 1));
    b_.ask("OPEN ROTARY");
    for (unsigned cs = 0; cs < kSystems; ++cs) {
      if (states[cs] == Buffer::kIdle) continue;
      b_.ask(fmt::format("&{}", cs + 1));
      const unsigned lines = states[cs] == Buffer::kReady ? 1 : 2 + pick(2);
      for (unsigned line = 0; line < lines; ++line) b_.ask("DWELL1");
    }
    b_.ask("CLOSE &1");
    b_.expect("DEFINE ROTARY 20", "");
    for (unsigned cs = 0; cs < kSystems; ++cs) scoreboard_.buffer(cs, states[cs]);
    real_time(kPhase);
    b_.bus.write_pic_edge_level(0);
    b_.bus.write_pic_mask(kBreqLine);
    b_.bus.clear_pic();
    scoreboard_.nothing(b_.bus.now());
    settle();
    const auto count = [&](Buffer state) { return std::count(states.begin(), states.end(), state); };
    b_.report.step("sixteen coordinate systems", count(Buffer::kReady) == 5 && count(Buffer::kFull) == 5,
                   fmt::format("{} idle, {} with room, {} full", count(Buffer::kIdle), count(Buffer::kReady),
                               count(Buffer::kFull)));
  }

  // The servo divider is that of the IC that makes the clocks.
  void rates(unsigned i8, unsigned servo_divider) {
    b_.ask(fmt::format("I8={} I{}={}", i8, b_.clock_variable(2), servo_divider));
  }

  void real_time(Tick period) {
    real_time_ = period;
    scoreboard_.real_time_period(period);
  }

  // Waits for as long as the cause may take; then pin, SIG and the latched interrupt must agree.
  void settle() {
    const bool before = level_;
    b_.bus.wait(std::max(scoreboard_.limit(), 2 * kMicrosecond));
    const std::uint8_t ist = b_.bus.read_pic_status(), sig = b_.bus.read_pic_signals();
    level_ = b_.machine.outputs().get(pin::kBreq) != 0;
    scoreboard_.settled(b_.bus.now(), level_, (sig & kBreqLine) != 0);
    const bool rose = level_ && !before;
    if (((ist & kBreqLine) != 0) != rose && first_wrong_ist_.empty())
      first_wrong_ist_ = fmt::format("tick {}: IST={:02X} after BREQ {:d} to {:d}", b_.bus.now(), ist, before, level_);
    if (rose) ++interrupts_;
    b_.bus.clear_pic();
  }

  void address(unsigned cs) {
    scoreboard_.host(cs, b_.bus.now());
    const bool wrong = b_.negative && !b_.board.jpan && scoreboard_.i2() == 0;
    select_by(fmt::format("#1&{}", (wrong ? cs + 1 : cs) % kSystems + 1));  // after a number `&` would be an operator
  }

  void i2(unsigned value) {
    scoreboard_.i2(value, b_.bus.now());
    select_by(fmt::format("I2={}", value));
  }

  void i59(unsigned value) {
    scoreboard_.i59(value, b_.bus.now());
    select_by(fmt::format("I59={}", value));
  }

  // The command stands behind another one that turns CTRL0 over: that edge is the beginning of its time.
  void select_by(const std::string& command) {
    const Tick begin = b_.bus.now();
    b_.ask(fmt::format("WX$70012,{} {}", 1 - b_.machine.outputs().get(pin::kCtrl0), command));
    lead_ = scoreboard_.execution() - begin;
    settle();
  }

  void drive_panel(std::uint32_t low) {  // 1 = pulled low
    b_.machine.inputs().jpan = static_cast<std::uint16_t>(~low);
    b_.machine.apply();
  }

  // At any time within the real-time interrupt's period. The negative control gives the panel the next number, and on
  // a board without a panel the host.
  void panel(unsigned number, std::uint32_t others = 0) {
    b_.bus.wait(pick(static_cast<unsigned>(real_time_)));
    scoreboard_.panel(number, b_.bus.now());
    drive_panel((b_.negative ? number + 1 : number) << regs::jpan::inputs::kFpd.lsb | others);
    settle();
  }

  void by_host(const std::string& step, unsigned i2_value, unsigned times) {
    const bool moves = i2_value != 0 || !b_.board.jpan;
    const auto next = [&](unsigned i) {
      if (!moves) return pick(kSystems);
      if (i < kSystems) return i;
      for (;;)  // from one with room to one without, or back: an edge of BREQ
        if (const unsigned cs = pick(kSystems); (states_[cs] == Buffer::kReady) == (i % 2 == 0)) return cs;
    };
    for (unsigned i = 0; i < times; ++i) address(next(i));
    verdict(step, times, moves ? times - kSystems - 1 : 0);
  }

  // One of the systems that the panel can name in group 0, but C.S. 1.
  unsigned some(Buffer state) const {
    return static_cast<unsigned>(std::find(states_.begin() + 1, states_.begin() + 8, state) - states_.begin());
  }

  // PHASE falls as `&n` is executed: the beginning of its transmission is set by how long the last one of its kind
  // took.
  void among_tasks() {
    constexpr unsigned kTimes = 32, kLeast = 16;
    constexpr Tick kAhead = 3 * kMicrosecond;
    const unsigned before = scoreboard_.interrupted();
    address(some(Buffer::kReady));
    std::array<Tick, 2> leads{lead_, lead_};
    for (unsigned i = 0; i < kTimes; ++i) {
      const Tick fall = b_.next_fall(pin::kPhase, 2 * kPhase);
      b_.bus.wait((kPhase - (leads[i % 2] + kAhead) % kPhase + fall - b_.bus.now()) % kPhase);
      address(some(i % 2 == 0 ? Buffer::kFull : Buffer::kReady));
      leads[i % 2] = lead_;
    }
    const unsigned met = scoreboard_.interrupted() - before;
    b_.report.step("&n and tasks meet", met >= kLeast, fmt::format("{} of {}, at least {}", met, kTimes, kLeast));
    verdict("&n among tasks", kTimes, kTimes);
  }

  // C.S. 1 runs moves of four axes one after the other, and the real-time task calculates most of the time.
  void in_motion() {
    constexpr unsigned kMoves = 220, kTimes = 16, kPanel = 10, kUndisturbed = kTimes / 4;
    constexpr Tick kCalculation = 200 * kMicrosecond;
    constexpr unsigned kPause = 1000 * kMicrosecond;  // at most, so that the program gets on
    const unsigned ready = some(Buffer::kReady), full = some(Buffer::kFull);
    std::string long_line = "P1=SIN(1)";
    for (unsigned i = 0; i < 12; ++i) long_line += "+SIN(1)";
    rates(0, 1);
    real_time(2 * kPhase);
    address(full);
    for (const char* line : {"&1DELETE ROTARY", "DEFINE ROTARY 3000", "I5187=0 I5188=0 I5189=1000000", "INC B0"})
      b_.expect(line, "");
    b_.ask("OPEN ROTARY");
    for (unsigned i = 0; i < kMoves; ++i)
      b_.ask(fmt::format("X{} Y{} Z{} A{}", 1 + pick(99), 1 + pick(99), 1 + pick(99), 1 + pick(99)));
    b_.ask("CLOSE");
    b_.ask("R");
    back_to(full);
    scoreboard_.calculation(kCalculation);
    const unsigned before = scoreboard_.undisturbed();
    for (unsigned i = 0; i < kTimes; ++i) {
      b_.bus.wait(pick(kPause));
      address(i % 2 == 0 ? ready : full);
    }
    verdict("&n while a program runs", kTimes, kTimes);
    // PHASE falls every 13,057 ticks, and T_CS is 1,180: one in nine meets it.
    const unsigned judged = scoreboard_.undisturbed() - before;
    b_.report.step("&n that no task met while a program runs", judged >= kUndisturbed,
                   fmt::format("{} of {}, at least {}, each within 10 us", judged, kTimes, kUndisturbed));
    if (b_.board.jpan) {
      panel(full + 1);
      i2(0);
      for (unsigned i = 0; i < kPanel; ++i) {  // while the background has a long line to do
        b_.link.send(long_line);
        panel(1 + (i % 2 == 0 ? ready : full));
        b_.link.finish();
      }
      i2(1);
      verdict("FPDn/ while a program runs", kPanel, kPanel);
    }
    scoreboard_.calculation(0);
    const std::vector<long> left = b_.numbers("&1PR");
    const bool ran = left.size() == 1 && left[0] > 0 && left[0] < kMoves - kTimes;
    b_.report.step("a program that ran all the time", ran, fmt::format("{} of {} lines left", left, kMoves));
    b_.ask("A");
    b_.bus.wait(2 * real_time_);
    b_.expect("DELETE ROTARY", "");
    b_.expect("DEFINE ROTARY 20", "");
    rates(0, 0);
    real_time(kPhase);
    back_to(full);
  }

  // Another system was addressed, and the pin with it; from here on it is judged again.
  void back_to(unsigned cs) {
    b_.ask(fmt::format("&{}", cs + 1));
    b_.bus.clear_pic();
    seen_ += scoreboard_.take_counts();
    scoreboard_.nothing(b_.bus.now());
    settle();
  }

  // All numbers, in any order; of the later groups half of them.
  void by_panel(unsigned group, unsigned numbers) {
    i59(group);
    std::array<unsigned, 16> order{};
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random_);
    if (numbers < order.size())  // those that select come first, so that a buffer with room is among them
      std::stable_partition(order.begin(), order.end(), [](unsigned n) { return n >= 1 && n <= 8; });
    for (unsigned i = 0; i < numbers; ++i) panel(order[i]);
    verdict(fmt::format("FPDn/, I59={}", group), numbers, b_.board.jpan ? 1 : 0);
  }

  // host-bus:5.6/2: with none selected four inputs set the group.
  void groups_by_panel() {
    using namespace regs::jpan::inputs;
    const std::uint32_t inputs[] = {kHome.mask(), kPrejog.mask(), kStart.mask(), kStep.mask()};
    for (unsigned group = 0; group < 4; ++group) {
      panel(0);
      panel(0, inputs[group]);
      b_.expect("I59", std::to_string(group));
      panel(0);
      scoreboard_.i59(group, b_.bus.now());
      settle();
      panel(1 + pick(8));
    }
    verdict("HOME/, PREJ/, STRT/, STEP/ set I59", 16);
  }

  // What enters another system's buffer does not move the pin; it shows when that one is selected.
  void other_buffers() {
    i59(0);
    panel(1 + static_cast<unsigned>(std::find(states_.begin(), states_.end(), Buffer::kFull) - states_.begin()));
    unsigned filled = 0;
    b_.ask("OPEN ROTARY");
    scoreboard_.buffer(0, Buffer::kReady);
    for (unsigned cs = 1; cs < kSystems; ++cs) {
      scoreboard_.nothing(b_.bus.now());
      b_.ask(fmt::format("&{}", cs + 1));
      const Reply reply = b_.link.command("DWELL1");
      settle();
      if (reply.error) continue;  // none there
      scoreboard_.host(cs, b_.bus.now());
      scoreboard_.buffer(cs, Buffer::kFull);
      settle();
      ++filled;
    }
    b_.ask("CLOSE &1");
    scoreboard_.host(0, b_.bus.now());
    settle();
    for (const unsigned number : {2u, 3u, 5u, 8u}) panel(number);
    verdict(fmt::format("lines of {} others move nothing", filled), 2 * kSystems);
  }

  void default_rate() {
    rates(2, 3);
    real_time(3 * 4 * kPhase);
    b_.bus.wait(real_time_);
    if (b_.board.jpan) i2(0);
    for (unsigned i = 0; i < 6; ++i) panel(i % 2 == 0 ? 2 + pick(7) : 0);
    verdict("FPDn/, I8=2", 6);
    if (b_.board.jpan) i2(1);
  }

  // host-bus:5.6/6.
  void init() {
    const auto pull = [this](Tick ticks) {
      b_.machine.inputs().jpan_init_n = false;
      b_.machine.apply();
      b_.bus.wait(ticks);
    };
    const auto release = [this] {
      b_.machine.inputs().jpan_init_n = true;
      b_.machine.apply();
    };
    b_.bus.watch({}, nullptr);
    pull(kMicrosecond / 2);
    release();
    b_.bus.wait(10 * kMicrosecond);
    b_.report.equal<std::string>("INIT/ low for 0.5 us, I16", b_.ask("I16"), "1");
    pull(3 * kMicrosecond);
    const std::uint64_t instructions = b_.machine.instructions();
    b_.bus.wait(200 * kMicrosecond);
    b_.report.equal<std::int64_t>("instructions while INIT/ is low",
                                  static_cast<std::int64_t>(b_.machine.instructions() - instructions), 0);
    b_.report.equal<std::string>(
        "BREQ, BRLD/, PIC mask",
        fmt::format("{} {} {}", b_.machine.outputs().get(pin::kBreq), b_.machine.outputs().get(pin::kBrldN),
                    b_.machine.outputs().get(pin::kPicMsk)),
        "0 1 0");
    release();
    b_.report.step("INIT/ released", b_.link.connect(HostLink::kBootTime), "the firmware answers");
    b_.report.equal<std::string>("I16 is what was SAVEd", b_.ask("I16"), "5");
  }

  void verdict(const std::string& step, unsigned causes, unsigned edges = 0) {
    const SelectionScoreboard::Counts c = scoreboard_.take_counts();
    seen_ += c;
    std::string detail = fmt::format("{} selections: {} idle, {} with room, {} full, {} none; {} edges of BREQ",
                                     c.causes, c.idle, c.ready, c.full, c.none, c.edges);
    const bool enough = c.causes >= causes && c.edges >= edges;
    if (!enough) detail += fmt::format("; expected {} selections, {} edges or more", causes, edges);
    const auto& violations = scoreboard_.violations();
    const bool good = violations.size() == reported_;
    if (!good)
      detail += fmt::format("; {} violations, the first: {}", violations.size() - reported_, violations[reported_]);
    reported_ = violations.size();
    if (!first_wrong_ist_.empty()) detail += "; " + first_wrong_ist_;
    b_.report.step(step, good && enough && first_wrong_ist_.empty(), detail);
    first_wrong_ist_.clear();
  }

  // Each state of a buffer was selected, and both edges of pin and interrupt were there to be judged.
  void activity() {
    const bool panel = b_.board.jpan;
    b_.report.cover("selections of an idle system", seen_.idle);
    b_.report.cover("selections of one with room", seen_.ready);
    b_.report.cover("selections of a full one", seen_.full);
    if (panel) b_.report.cover("selections of none", seen_.none);
    b_.report.cover("edges of BREQ", seen_.edges, kLeastEdges);
    const bool each = seen_.idle > 0 && seen_.ready > 0 && seen_.full > 0 && (seen_.none > 0) == panel;
    b_.report.step(
        "what the scoreboard has judged", each && seen_.edges >= kLeastEdges && interrupts_ >= kLeastEdges / 3,
        fmt::format("{} selections: {} idle, {} with room, {} full, {} none; {} edges of BREQ{}, {} interrupts",
                    seen_.causes, seen_.idle, seen_.ready, seen_.full, seen_.none, seen_.edges,
                    panel ? " and BRLD/" : "", interrupts_));
  }

  BenchContext& b_;
  std::mt19937_64 random_;
  SelectionScoreboard scoreboard_;
  SelectionScoreboard::Counts seen_;  // in all
  std::array<Buffer, kSystems> states_{};
  Tick real_time_ = kPhase;
  Tick lead_ = 0;  // from the beginning of a command's transmission to its execution, the last time
  bool level_ = false;
  unsigned interrupts_ = 0;
  std::string first_wrong_ist_;
  std::size_t reported_ = 0;
  unsigned task_ = 0;
  std::function<void(TimeFs)> judge_;  // who sees the tasks beside us
};

}  // namespace

// covers: BREQ-6 BREQ-7
Bench breq_select_bench() {
  return {"breq-select",
          "whose BREQ the host sees: &n, I2, I59 and the panel's FPDn/ over sixteen buffers; lamp, INIT/",
          {"the panel's number, or `&n` on a board without a panel, is one higher than the scoreboard is told",
           "FPDn/, I59=0", "is selected (&*I2=0, I59=0"},
          [](BenchContext& b) { BreqSelect(b).run(); },
          without_8259(kAnyBoard),
          nullptr,
          "turbo-pmac-pci"};
}

}  // namespace brick
