// dpram: the host goes through its window as fast as its bus allows while the firmware reads and writes the same words,
// so that the two meet at every phase. Every access of either side, taken at its pins, goes to
// testbench/checkers/dpram_scoreboard.h, which knows what a word may read and nothing of clocks. BUSY of either side,
// ties and torn 32-bit items are counted and have a minimum. Firmware and host meet by chance; what must have been
// there is made by the last steps: accesses of the CPU at an even pace, and one of the host at every tick of their
// period.
#include <functional>
#include <random>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/cpu/port_a.h"
#include "testbench/benches/benches.h"
#include "testbench/checkers/dpram_scoreboard.h"

namespace brick {
namespace {

// Two words of one PMAC address, Y first, and those of the next; nothing automatic uses them.
constexpr std::uint32_t kAddress = 0x060400, kWord = 2 * (kAddress - regs::kDpramBase);
constexpr unsigned kPlaces = 4;

class Sides {
 public:
  explicit Sides(BenchContext& b) : b_(b), random_(b.seed * 104729 + 1), before_(b.machine.on_bus_cycle) {
    b.bus.watch(select_pins(pin::kBusyHost, pin::kBusyCpu),
                [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) { edge(t, before, after); });
    b.machine.on_bus_cycle = [this](const PortACycle& c) {
      if (before_) before_(c);
      cycle(c);
    };
  }
  ~Sides() {
    b_.bus.watch({}, nullptr);
    b_.machine.on_bus_cycle = before_;
  }
  Sides(const Sides&) = delete;
  Sides& operator=(const Sides&) = delete;

  DpramScoreboard scoreboard;
  unsigned cpu_accesses = 0, host_accesses = 0;
  Tick strobe = 0, period = 0;  // of the CPU's last access, and from the one before

  struct Met {
    unsigned busy_cpu = 0, busy_host = 0, ties = 0;
  };
  const Met& met() const { return met_; }

  unsigned random(unsigned below) { return static_cast<unsigned>(random_() % below); }
  // Never the same value twice: what a read showed then tells which write it was.
  std::uint16_t next() { return ++value_; }
  bool host_may_write() const { return value_ < 0xF000; }  // the rest is the firmware's

  std::uint16_t host_read(unsigned place) {
    const TimeFs from = tick_to_fs(b_.bus.now());
    const std::uint16_t value = b_.bus.dpram_read(2 * (kWord + place));
    scoreboard.read(place, value, from, tick_to_fs(b_.bus.now()));
    ++host_accesses;
    return value;
  }
  void host_write(unsigned place, std::uint16_t value) {
    const TimeFs from = tick_to_fs(b_.bus.now());
    b_.bus.dpram_write(2 * (kWord + place), value);
    // The negative control: one write in eight is told with a wrong value.
    const bool lie = b_.negative && ++lies_ % 8 == 0;
    scoreboard.write(place, static_cast<std::uint16_t>(lie ? value ^ 0x8000 : value), from, tick_to_fs(b_.bus.now()));
    ++host_accesses;
  }

 private:
  void cycle(const PortACycle& c) {
    const std::uint32_t place = 2 * (c.address - regs::kDpramBase) + (c.x ? 1 : 0) - kWord;
    if (c.on_chip || c.address < regs::kDpramBase || place >= kPlaces) return;
    ++cpu_accesses;
    const Tick low = fs_to_tick(c.strobe_low + b_.machine.skew().of_strobe(c.write));  // at the board
    period = low - strobe;
    strobe = low;
    if (c.write)
      scoreboard.write(place, static_cast<std::uint16_t>(c.data), c.strobe_low, c.strobe_high);
    else
      scoreboard.read(place, static_cast<std::uint16_t>(c.data), c.strobe_low, c.strobe_high);
    // The host's first edge was the third of this strobe, and the host it was who had to wait.
    met_.ties += host_waits_since_ == low + 2;
  }
  void edge(Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    met_.busy_cpu += before.get(pin::kBusyCpu) == 0 && after.get(pin::kBusyCpu) != 0;
    if (before.get(pin::kBusyHost) == 0 && after.get(pin::kBusyHost) != 0) {
      ++met_.busy_host;
      host_waits_since_ = t;
    }
  }

  BenchContext& b_;
  std::mt19937_64 random_;
  std::function<void(const PortACycle&)> before_;  // who looks at the cycles beside us
  Met met_;
  std::uint16_t value_ = 0;
  unsigned lies_ = 0;
  Tick host_waits_since_ = -1;
};

// The firmware works on a line while the host does what it likes, until the answer is there.
template <class Host>
void meanwhile(BenchContext& b, const std::string& line, Host host) {
  if (!b.link.send(line)) {
    b.report.fail("line to the controller", line + " was not taken");
    return;
  }
  while ((b.bus.port_status() & HostBus::kRxdf) == 0)
    for (int i = 0; i < 40; ++i) host();
  b.link.finish();
}

// M1 to M4 are the four words, M5 a 32-bit item of the first two.
void both_sides(BenchContext& b, Sides& sides) {
  std::string words;
  for (unsigned place = 0; place < kPlaces; ++place)
    words += fmt::format("M{}->{}:${:06X},0,24 ", place + 1, place % 2 == 0 ? 'Y' : 'X', kAddress + place / 2);
  b.expect(words + fmt::format("M5->DP:${:06X}", kAddress), "");
  for (unsigned place = 0; place < kPlaces; ++place) sides.host_write(place, sides.next());

  for (int round = 0; round < 16; ++round) {
    const unsigned busy = sides.random(kPlaces);  // most accesses of a round meet here
    const auto place = [&] { return sides.random(4) != 0 ? busy : sides.random(kPlaces); };
    std::string line;
    while (line.size() < 230) {
      const unsigned m = place() + 1;
      line += sides.random(2) == 0 ? fmt::format("P1=M{} ", m) : fmt::format("M{}={} ", m, sides.next());
    }
    meanwhile(b, line, [&] {
      const unsigned at = place();
      if (sides.random(2) == 0 || !sides.host_may_write())
        sides.host_read(at);
      else
        sides.host_write(at, sides.next());
    });
  }
  for (unsigned place = 0; place < kPlaces; ++place) sides.host_read(place);

  const std::vector<std::string> wrong = sides.scoreboard.judge();
  const DpramScoreboard::Counts n = sides.scoreboard.counts();
  b.report.step("every word old or new, none lost", wrong.empty(),
                wrong.empty() ? fmt::format("{} reads, {} writes, {} reads met a write", n.reads, n.writes, n.met)
                              : wrong.front());
}

// Items with both halves alike, written by the firmware only; the host reads the low half, then the high one.
unsigned tears(BenchContext& b, Sides& sides) {
  unsigned torn = 0, items = 0;
  for (int round = 0; round < 6; ++round) {
    std::string line;
    while (line.size() < 230) line += fmt::format("M5={} ", sides.next() * 0x10001u);
    meanwhile(b, line, [&] {
      const std::uint16_t low = sides.host_read(0), high = sides.host_read(1);
      ++items;
      torn += low != high;
    });
  }
  const std::vector<std::string> wrong = sides.scoreboard.judge();
  b.report.step("halves of 32-bit items old or new", wrong.empty(),
                wrong.empty() ? fmt::format("{} items read", items) : wrong.front());
  return torn;
}

// The CPU's place taken by accesses to one word, at a clock of two ticks, one every kEven clocks: a whole number of the
// host side's three ticks, so that all stand alike to it. A slot is a CPU clock: three of them put the strobe to each
// tick of the host side's clock, whatever the delay of its pin (--skew).
class EvenPace final : public BusMaster {
 public:
  static constexpr unsigned kSlots = kTicksPerRef;

  EvenPace(Machine& machine, Sides& sides, bool writes, unsigned slot)
      : machine_(machine), sides_(sides), writes_(writes), slot_(slot) {
    machine_.attach_bus_master(this);
  }
  ~EvenPace() override { machine_.attach_bus_master(nullptr); }
  EvenPace(const EvenPace&) = delete;
  EvenPace& operator=(const EvenPace&) = delete;

  std::optional<Access> next() override {
    constexpr unsigned kTwoTicks = 5, kEven = 45;  // I52, whose 3 wait states are those of the clock before, too
    if (!clock_set_) return Access{true, regs::cpu_bus::kPctl.address, true, kTwoTicks, 0};
    return Access{false, kAddress, writes_, writes_ ? sides_.next() : 0u, 0, slot_, kEven};
  }
  void done(const Access&, std::uint32_t) override { clock_set_ = true; }

 private:
  Machine& machine_;
  Sides& sides_;
  bool writes_;
  unsigned slot_;
  bool clock_set_ = false;
};

// The host begins its access at each tick of the CPU's period, off the grid of its own clock: either has to wait for
// the other. The host is decided at every third tick only, so both come with the same edge in one slot of the three.
void every_distance(BenchContext& b, Sides& sides, bool cpu_writes, unsigned slot) {
  constexpr Tick kUndisturbed = 400;  // several periods
  const Sides::Met before = sides.met();
  isa::HostTimes any_time = isa::kTypical;
  any_time.grid = isa::ns(1);
  b.bus.set_times(any_time);
  Tick distances = 0;
  {
    const EvenPace cpu(b.machine, sides, cpu_writes, slot);
    b.bus.wait(kUndisturbed);
    for (const Tick period = sides.period; distances < period; ++distances) {
      b.bus.wait(kUndisturbed);
      const Tick last = sides.strobe;
      b.bus.advance_to(last + (b.bus.now() - last) / period * period + period + distances);
      if (cpu_writes)
        sides.host_read(0);
      else
        sides.host_write(0, sides.next());
    }
  }
  b.bus.set_times(isa::kTypical);
  const Sides::Met met = sides.met();
  const std::vector<std::string> wrong = sides.scoreboard.judge();
  const auto detail =
      fmt::format("{} distances: BUSY of the CPU {} times, of the host {} times, {} ties", distances,
                  met.busy_cpu - before.busy_cpu, met.busy_host - before.busy_host, met.ties - before.ties);
  b.report.step(fmt::format("the CPU {}, slot {}, the host comes at every tick", cpu_writes ? "writes" : "reads", slot),
                wrong.empty() && met.busy_cpu > before.busy_cpu && met.busy_host > before.busy_host,
                wrong.empty() ? detail : wrong.front());
}

void run(BenchContext& b) {
  Sides sides(b);
  both_sides(b, sides);
  const unsigned torn = tears(b, sides);
  const unsigned by_chance = sides.met().ties;
  for (const bool cpu_writes : {false, true})
    for (unsigned slot = 0; slot < EvenPace::kSlots; ++slot) every_distance(b, sides, cpu_writes, slot);
  const unsigned ties = sides.met().ties - by_chance;
  b.machine.reset();
  b.report.step("the firmware is back", b.link.connect(HostLink::kBootTime), "after a reset");
  b.report.reached("accesses of the CPU", sides.cpu_accesses, 400);
  b.report.reached("accesses of the host", sides.host_accesses, 5000);
  b.report.reached("ties, won by the CPU", ties, 2);  // a slot of either direction
  b.report.reached("torn 32-bit items", torn, 3);
}

}  // namespace

Bench dpram_bench() {
  return {"dpram",
          "host and firmware at the same words of the dual-ported RAM: old or new, BUSY, ties, torn items",
          {"one host write in eight is told to the scoreboard with a wrong value", "every word old or new, none lost",
           "which nobody has written there"},
          run,
          kASlotOf16Bits};
}

}  // namespace brick
