// interrupts: every source on every line of the interrupt controller, by edge and by level; masks; an edge at every
// alignment to a clear; the least pulse; random lines and writes, judged edge by edge by
// testbench/checkers/interrupt_scoreboard.h. Lines pass two flip-flops and an edge detector: SIG shows a change 6 ticks
// after its pin, the interrupt 9. On a board with an 8259 see interrupts_8259.cpp.
#include "systemc/machine/board_family.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/interrupt_host.h"
#include "testbench/checkers/interrupt_scoreboard.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = kPwmClockHz / 1000;
constexpr unsigned kClear = 8, kMask = 10, kEdgeLevel = 11;
// When a write takes place whose command ends at this tick: two edges of the synchroniser, the next clk_ref that sees
// the end, one more (docs/isa_slave.md).
constexpr Tick write_tick(Tick end) { return ((end + 2) / kTicksPerRef + 2) * kTicksPerRef; }
static_assert(write_tick(0) == 6 && write_tick(1) == 9 && write_tick(2) == 9 && write_tick(3) == 9);
constexpr Tick kSigAfter = 2 * kTicksPerRef, kIrqAfter = 3 * kTicksPerRef;  // a pin that moves at an edge of clk_ref
constexpr Tick kIrqLow = 4 * kTicksPerRef;

class Interrupts : public InterruptHost {
 public:
  explicit Interrupts(BenchContext& context) : InterruptHost(context) {
    const BoardOutputs pins = select_pins(pin::kPicIst, pin::kPicSig, pin::kPicMsk, pin::kPicElr, pin::kIsaIrq,
                                          pin::kIpos, pin::kBreq, pin::kEror, pin::kF1er, pin::kHreq, pin::kWdo);
    b.bus.watch(pins, [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
      changes_.push_back({t, before, after});
    });
  }
  ~Interrupts() { b.bus.watch({}, nullptr); }
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  void run() {
    writes_take_place();
    for (unsigned n = 0; n < kFixed.size(); ++n) fixed_line(n);
    for (const unsigned source : sources()) chosen_lines(source);
    alignments();
    leftovers();
    pulses();
    std::uint64_t taken = 0;  // until chance has taken enough of them
    for (unsigned round = 0; round < 100 && taken < kLeastTaken; ++round) taken += random_traffic();
    b.report.reached("edges taken at random", taken, kLeastTaken);
    watchdog();
  }

 private:
  struct Change {
    Tick tick;
    BoardOutputs before, after;
  };
  std::uint32_t out(const PinField& f) const { return b.machine.outputs().get(f); }
  std::string shown() const {
    return fmt::format("IST={:02X} SIG={:02X} IRQ={}", out(pin::kPicIst), out(pin::kPicSig), out(pin::kIsaIrq));
  }
  // Tick of the last change of a pin since `from`; -1: none.
  Tick moved(const PinField& f, Tick from) const {
    for (auto c = changes_.rbegin(); c != changes_.rend() && c->tick >= from; ++c)
      if (c->before.get(f) != c->after.get(f)) return c->tick;
    return -1;
  }
  // Tick of the first change of IRQ to this level, after the tick of a write; -1: none.
  Tick edge(unsigned level, Tick from) const {
    for (const Change& c : changes_)
      if (c.tick >= from && c.before.get(pin::kIsaIrq) != level && c.after.get(pin::kIsaIrq) == level) return c.tick;
    return -1;
  }
  void set(std::uint8_t mask, std::uint8_t edge_level) {
    b.bus.write_pic_mask(0);
    b.bus.write_pic_edge_level(edge_level);
    b.bus.clear_pic();
    b.bus.write_pic_mask(mask);
    b.bus.wait(40);
    changes_.clear();
  }
  void clear() {
    b.bus.clear_pic();
    b.bus.wait(40);
  }

  // When a write takes place after its command has ended, for each phase to clk_ref: seen at the mask's pins.
  void writes_take_place() {
    set(0, 0);
    Comparison same;
    for (Tick phase = 0; phase < kTicksPerRef; ++phase) {
      const Tick end = (b.bus.now() / kTicksPerRef + 40) * kTicksPerRef + phase;
      std::vector<std::pair<Tick, Edit>> edits;
      add_write(edits, end, kMask, static_cast<std::uint8_t>(0x10 << phase));
      play(std::move(edits));
      b.bus.wait(60);
      const Tick at = moved(pin::kPicMsk, end);
      same.equal(fmt::format("ticks after a command that ends at phase {}", phase), at - end, write_tick(end) - end);
    }
    b.report.step("writes take place", same, kTicksPerRef, "6, 8, 7 ticks after the command at the phases of clk_ref");
  }

  // IR0 to IR4.
  void fixed_line(unsigned n) {
    const PinField* pins[] = {&pin::kIpos, &pin::kBreq, &pin::kEror, &pin::kF1er, &pin::kHreq};
    const auto bit = static_cast<std::uint8_t>(1u << n);
    set(0xFF, 0);
    Comparison same;
    const auto state = [&](const std::string& when, const std::string& expected) {
      same.equal(when, shown(), expected);
    };
    const std::string on = fmt::format("IST={0:02X} SIG={0:02X} IRQ=1", bit),
                      high = fmt::format("IST=00 SIG={:02X} IRQ=0", bit), off = "IST=00 SIG=00 IRQ=0",
                      latched = fmt::format("IST={:02X} SIG=00 IRQ=1", bit);
    const auto raise = [&] {
      const Tick from = b.bus.now();
      drive_fixed(n, true);
      b.bus.wait(40);
      const Tick line = moved(*pins[n], from);
      same.equal("SIG after its pin", moved(pin::kPicSig, from) - line, kSigAfter);
      same.equal("IRQ after its pin", moved(pin::kIsaIrq, from) - line, kIrqAfter);
    };
    raise();
    state("rise", on);
    clear();
    state("cleared while high", high);
    drive_fixed(n, false);
    b.bus.wait(40);
    state("fall", off);
    raise();
    drive_fixed(n, false);
    b.bus.wait(40);
    state("rise and fall", latched);
    b.bus.write_pic_mask(static_cast<std::uint8_t>(~bit));
    b.bus.write_pic_mask(0xFF);
    b.bus.wait(40);
    state("masked for a moment", off);

    set(0xFF, bit);
    raise();
    state("level", on);
    clear();
    state("level, cleared while high", on);
    b.bus.write_pic_mask(static_cast<std::uint8_t>(~bit));
    b.bus.wait(40);
    state("level, masked", high);
    b.bus.write_pic_mask(0xFF);
    drive_fixed(n, false);
    b.bus.wait(40);
    state("level, fall", off);
    b.report.step(fmt::format("IR{} {}", n, kFixed[n]), same, 15,
                  "edge and level: SIG 6, interrupt 9 ticks after the pin");
  }

  // One source on all three lines: two by edge and one by level, then the other way round.
  void chosen_lines(unsigned source) {
    Comparison same;
    select(source, source, source);
    const auto state = [&](const std::string& when, unsigned ist, unsigned sig) {
      same.equal(when, shown(), fmt::format("IST={:02X} SIG={:02X} IRQ={}", ist, sig, ist != 0 ? 1 : 0));
    };
    for (const unsigned level : {0x40u, 0xA0u}) {
      const unsigned edge = 0xE0 & ~level, masked = 0x20u << pick(3);
      set(0xE0, static_cast<std::uint8_t>(level));
      drive(source, true);
      state("high", 0xE0, 0xE0);
      clear();
      state("cleared while high", level, 0xE0);
      drive(source, false);
      state("low", 0, 0);
      b.bus.write_pic_mask(static_cast<std::uint8_t>(0xE0 & ~masked));
      drive(source, true);
      state("high, one masked", 0xE0 & ~masked, 0xE0);
      b.bus.write_pic_mask(0xE0);
      b.bus.wait(40);
      state("no longer masked", (0xE0 & ~masked) | (masked & level), 0xE0);
      drive(source, false);
      state("low again", edge & ~masked, 0);
    }
    set(0xE0, 0xE0);
    for (unsigned line = 0; line < 3 && source >= kSourceMi1; ++line) {  // and on each of them alone
      const unsigned other = pick(2) == 0 ? 0 : kSourceMi1 + (source - kSourceMi1 + 1) % 4;
      select(line == 0 ? source : other, line == 1 ? source : other, line == 2 ? source : other);
      drive(source, true);
      state("alone", 0x20u << line, 0x20u << line);
      drive(source, false);
    }
    b.report.step(fmt::format("IR5, IR6, IR7 from {}", kInterruptSources[source]), same, 12, "by edge and by level");
  }

  // A rise of MI1, and a clear that takes place from 5 clocks before to 5 after the detector has it, at every tick. The
  // negative control makes the write cycle end a clock later.
  void alignments() {
    select(kSourceMi1, 0, 0);
    Comparison same;
    unsigned kept = 0, cleared = 0;
    for (Tick lead = -15; lead <= 15; ++lead) {
      set(0x20, 0);
      const Tick rise = b.bus.now() + 150 + pick(3), end = rise + lead;
      std::vector<std::pair<Tick, Edit>> edits;
      add_write(edits, b.negative ? end + kTicksPerRef : end, kClear, 0);
      edits.emplace_back(rise, [](HostInputs& in) { in.mi1 = true; });
      play(std::move(edits));
      b.bus.advance_to(rise + 60);
      const Tick sampled = (rise / kTicksPerRef + 1) * kTicksPerRef, detected = sampled + 2 * kTicksPerRef;
      const Tick written = write_tick(end);
      const bool keeps = detected >= written;
      ++(keeps ? kept : cleared);
      same.equal(fmt::format("rise at {}, clear at {}: IST", detected - rise, written - rise), out(pin::kPicIst),
                 keeps ? 0x20u : 0u);
      drive(kSourceMi1, false);
    }
    b.report.step("an edge that meets a clear is kept", same, 31,
                  fmt::format("{} alignments: {} kept, {} cleared", same.made(), kept, cleared));
    b.report.reached("edges that a clear leaves", kept, 5);
    b.report.reached("edges that a clear takes", cleared, 5);
  }

  // host-bus:3.5/2: MI1 has interrupted and is cleared; MI2 rises from 5 clocks before the clear to 5 after it.
  // Whatever the clear leaves, or comes later, raises IRQ anew, after it has been low for long enough. Then a level
  // that stays.
  void leftovers() {
    select(kSourceMi1, kSourceMi1 + 1, 0);
    Comparison same;
    unsigned left = 0;
    const auto judge = [&](const std::string& when, Tick written, Tick rise) {
      same.equal(when + ": IRQ falls", edge(0, written), written);
      same.equal(when + ": IRQ rises", edge(1, written), rise);
    };
    const Tick place = pick(3);  // of the rise in its clock: three of the clears meet it then
    for (Tick lead = -15; lead <= 15; ++lead) {
      set(0x60, 0);
      drive(kSourceMi1, true);
      const Tick rise = (b.bus.now() / kTicksPerRef + 50) * kTicksPerRef + place, end = rise + lead;
      std::vector<std::pair<Tick, Edit>> edits;
      add_write(edits, end, kClear, 0);
      edits.emplace_back(rise, [](HostInputs& in) { in.mi2 = true; });
      play(std::move(edits));
      b.bus.advance_to(rise + 60);
      const Tick detected = (rise / kTicksPerRef + 3) * kTicksPerRef;
      const Tick written = write_tick(end);
      left += detected == written ? 1 : 0;
      judge(fmt::format("rise at {}", detected - written), written,
            detected < written ? -1 : std::max(detected, written + kIrqLow));
      drive(kSourceMi1, false);
      drive(kSourceMi1 + 1, false);
    }
    for (Tick phase = 0; phase < kTicksPerRef; ++phase) {
      set(0x20, 0x20);
      drive(kSourceMi1, true);
      const Tick end = (b.bus.now() / kTicksPerRef + 40) * kTicksPerRef + phase;
      std::vector<std::pair<Tick, Edit>> edits;
      add_write(edits, end, kClear, 0);
      play(std::move(edits));
      b.bus.advance_to(end + 60);
      const Tick written = write_tick(end);
      judge("a level stays", written, written + kIrqLow);
      drive(kSourceMi1, false);
    }
    b.report.step("what a clear leaves raises IRQ anew", same, 68,
                  fmt::format("{} ticks low at least; {} rises met the clear", kIrqLow, left));
    b.report.reached("a rise met the clear", left, 3);
  }

  // host-bus:4.1/8: one clk_ref is always enough; less is when an edge falls into it.
  void pulses() {
    Comparison same;
    unsigned seen = 0;
    for (Tick width = 1; width <= 2 * kTicksPerRef; ++width)
      for (Tick phase = 0; phase < kTicksPerRef; ++phase) {
        set(0x20, 0);
        const Tick rise = (b.bus.now() / kTicksPerRef + 10) * kTicksPerRef + phase, fall = rise + width;
        play({{rise, [](HostInputs& in) { in.mi1 = true; }}, {fall, [](HostInputs& in) { in.mi1 = false; }}});
        b.bus.wait(40);
        const bool sampled = fall / kTicksPerRef > rise / kTicksPerRef;
        seen += sampled ? 1 : 0;
        same.equal(fmt::format("{} ticks at phase {}: IST", width, phase), out(pin::kPicIst), sampled ? 0x20u : 0u);
      }
    b.report.step("least pulse", same, 18, fmt::format("{} of {} pulses seen; 3 ticks are enough", seen, same.made()));
  }

  // Three lines from outside move at any tick, mask, mode and clears come at any tick: every edge of clk_ref is judged.
  static constexpr unsigned kLeastTaken = 30;
  std::uint64_t random_traffic() {  // returns the edges that the scoreboard has taken
    constexpr unsigned kWrites = 150;
    select(kSourceMi1, kSourceMi1 + 1, kSourceMi1 + 2);
    set(0, 0);
    std::vector<std::pair<Tick, Edit>> edits;
    std::vector<std::pair<Tick, InterruptScoreboard::Write>> writes;  // by the edge at which they take place
    std::vector<std::pair<Tick, unsigned>> toggles;                   // line, by the tick
    const Tick begin = (b.bus.now() / kTicksPerRef + 1) * kTicksPerRef;
    Tick end = begin + 200;
    for (unsigned i = 0; i < kWrites; ++i, end += 110 + pick(100)) {
      const unsigned offset = pick(3) == 0 ? kEdgeLevel : pick(2) == 0 ? kMask : kClear;
      const auto value = static_cast<std::uint8_t>(pick(8) << 5);
      add_write(edits, end, offset, value);
      writes.push_back({write_tick(end), {offset == kMask, offset == kEdgeLevel, offset == kClear, value}});
    }
    for (Tick t = begin + 50; t < end; t += 1 + pick(60)) {
      const unsigned line = pick(3);
      toggles.emplace_back(t, line);
      edits.emplace_back(t, [line](HostInputs& in) { in.*kOutside[line] = !(in.*kOutside[line]); });
    }
    play(std::move(edits));
    b.bus.advance_to(end + 30);

    InterruptScoreboard scoreboard;
    Comparison same;
    std::uint8_t lines = 0;
    std::size_t toggle = 0, write = 0, change = 0;
    BoardOutputs now = changes_.empty() ? b.machine.outputs() : changes_.front().before;
    for (Tick t = begin; t < end + 20; t += kTicksPerRef) {
      for (; toggle < toggles.size() && toggles[toggle].first < t; ++toggle)
        lines = static_cast<std::uint8_t>(lines ^ 0x20u << toggles[toggle].second);
      InterruptScoreboard::Write at;
      if (write < writes.size() && writes[write].first == t) at = writes[write++].second;
      const InterruptScoreboard::Shown expected = scoreboard.edge(lines, at);
      for (; change < changes_.size() && changes_[change].tick <= t; ++change) now = changes_[change].after;
      same.equal(fmt::format("tick {}: IST, SIG, IRQ", t),
                 fmt::format("{:02X} {:02X} {}", now.get(pin::kPicIst), now.get(pin::kPicSig), now.get(pin::kIsaIrq)),
                 fmt::format("{:02X} {:02X} {:d}", expected.ist, expected.sig, expected.irq));
    }
    b.report.step(
        "random lines and writes", same, 5000,
        fmt::format("{} edges of clk_ref, {} writes, {} edges taken", same.made(), write, scoreboard.edges()));
    for (unsigned i = 0; i < 3; ++i) drive(kSourceMi1 + i, false);
    return scoreboard.edges();
  }

  // WDO on each line: the clocks stop, because they are to come from outside (E1) and nobody makes them.
  void watchdog() {
    select(kSourceWdo, kSourceWdo, kSourceWdo);
    set(0xE0, 0x40);
    b.machine.inputs().ext_clock = true;
    b.machine.apply();
    const bool tripped = b.bus.wait_pin(pin::kWdo, 1, 30 * kMillisecond);
    const Tick trip = b.bus.now();
    b.bus.wait(40);
    b.report.step("IR5, IR6, IR7 from WDO", tripped && shown() == "IST=E0 SIG=E0 IRQ=1", shown());
    b.report.equal<Tick>("SIG after the trip, ticks", moved(pin::kPicSig, trip) - trip, kSigAfter);
    clear();
    b.report.equal<std::string>("cleared while tripped", shown(), "IST=40 SIG=E0 IRQ=1");
    b.machine.take_run_errors();  // the board's own source of the clocks is told of
  }

  std::vector<Change> changes_;
};

}  // namespace

// covers: BREQ-5 CARD-1
Bench interrupts_bench() {
  return {
      "interrupts",
      "every source of every interrupt line, edge and level, masks, clears at every alignment; on an 8259 its modes",
      {"the clear comes a clock later, the vectors of an 8259 are eight higher, than the bench is told",
       "an edge that meets a clear is kept", "IST: 0, expected 32"},
      [](BenchContext& b) {
        if (b.board.pic_8259)
          interrupts_8259(b);
        else
          Interrupts(b).run();
      }};
}

}  // namespace brick
