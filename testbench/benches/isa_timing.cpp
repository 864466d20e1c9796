// isa-timing: the host bus at its pins (host-bus:3.4). Hosts of 16 and of 8 bits, at usual times, slowly and at the
// limit of every rule at once, read and write the I/O block and the memory window while the CPU is in the same words;
// RESETDRV; addresses that are nobody's; and hosts that keep no rule, each of which must be named and leave the machine
// working. Judged by testbench/checkers/isa_checker.h; the cross of kind, width and IOCHRDY is counted.
#include <iterator>
#include <map>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rtl/regs/brick_regs.hpp"
#include "testbench/benches/benches.h"
#include "testbench/benches/isa_malformed.h"

namespace brick {
namespace {

constexpr std::uint32_t kShared = 0x40;  // host offset of the words that both sides use: Y:$060010, X:$060010
constexpr std::uint32_t kDpramY = 0x060010;
constexpr unsigned kRounds = 40, kExercises = 3;  // of each width
static_assert(2 * kExercises * kRounds < 0x100);  // the host counts on, with the low byte alone in the 8-bit ones

// What the rounds of one width make at least. Of 16 bits: two writes and two reads of the RAM, one of each in the words
// that the CPU uses, and a read of nobody's memory, which is three of 8 bits. Of 8 bits: three writes and three reads,
// one of each in those words. Of both: five reads and five writes of the host port. The CPU is in each of its two words
// for a sixth of the time; as many accesses as one in sixteen must meet it, and the last exercise goes on until they
// do.
constexpr unsigned kN = kExercises * kRounds, kMet = kN / 16;
constexpr unsigned kIoReads = 2 * 5 * kN, kIoWrites = kIoReads, kIo = kIoReads + kIoWrites;
constexpr unsigned kWideReads = 2 * kN, kWideWrites = kWideReads, kWide = kWideReads + kWideWrites;
constexpr unsigned kNobodys = 3 * kN, kNarrowReads = 3 * kN, kNarrowWrites = 3 * kN;
constexpr unsigned kNarrow = kNobodys + kNarrowReads + kNarrowWrites, kAll = kIo + kWide + kNarrow;
constexpr unsigned kRam = kWide + kNarrowReads + kNarrowWrites;  // IOCHRDY is low at the start of each
constexpr unsigned kAnswered = kIoReads + kWideReads + kNarrowReads;

// The CPU reads the host's word in this time: a hundred of its accesses of 44 clocks at most, every second a read.
constexpr Tick kSeen = ns_to_ticks(60'000);

// How often each rule of the checker is judged at least; `at_limit`: the host that is at the limits decides its margin.
struct Activity {
  IsaChecker::Rule rule;
  unsigned least;
  bool at_limit = false;
};
constexpr Activity kActivity[] = {
    {IsaChecker::kT1, kIo, true},
    {IsaChecker::kT2, kIo + kNarrow, true},
    {IsaChecker::kT3, kAll, true},
    {IsaChecker::kT4, kIoReads + 2 * kN},  // not those that the CPU may stretch, here and in t14
    {IsaChecker::kT5, kAnswered},
    {IsaChecker::kT5Off, kAnswered},
    {IsaChecker::kT6, kIoWrites + kWideWrites + kNarrowWrites, true},
    {IsaChecker::kT7, kIoWrites, true},
    {IsaChecker::kT8, kRam},
    {IsaChecker::kT9, kRam, true},
    {IsaChecker::kT10, kRam},
    {IsaChecker::kT11, kAll, true},
    {IsaChecker::kT12, kWide + kNobodys, true},
    {IsaChecker::kT13, kWide, true},
    {IsaChecker::kT14, kN},
    {IsaChecker::kT15, kWideWrites + kNarrowWrites, true},
    {IsaChecker::kT16, kN},  // LA comes back from nobody's memory
    {IsaChecker::kT18, kWide + kNarrow, true},
    {IsaChecker::kH1, kIoReads},
    {IsaChecker::kH2, kIoReads},
    {IsaChecker::kH3, 2 * kN},  // ISR, ISR
    {IsaChecker::kH4, kIoWrites},
    {IsaChecker::kH5, 4 * kN},  // ICR, ICR, +5
    {IsaChecker::kH6, 4 * kN},  // +5, +5; IVR, ICR
    {IsaChecker::kOneCommand, kAll},
    {IsaChecker::kAddressStands, kAll},
    {IsaChecker::kRoomInTx, 8},    // VERSION and its carriage return
    {IsaChecker::kWholeCycle, 2},  // RESETDRV and the reset at the end
    {IsaChecker::kOursOnly, kAnswered},
};
static_assert(std::size(kActivity) == IsaChecker::kRules);

// The cross of kind, width and whether IOCHRDY had the host wait.
struct Cycles {
  IsaChecker::Kind kind;
  bool wide, waited;
  unsigned least;
};
constexpr Cycles kCross[] = {
    {IsaChecker::kIoRead, false, false, kIoReads},
    {IsaChecker::kIoWrite, false, false, kIoWrites},
    {IsaChecker::kMemoryRead, false, false, kNobodys + kNarrowReads - kN},
    {IsaChecker::kMemoryRead, false, true, kMet},
    {IsaChecker::kMemoryRead, true, false, kN},
    {IsaChecker::kMemoryRead, true, true, kMet},
    {IsaChecker::kMemoryWrite, false, false, kNarrowWrites - kN},
    {IsaChecker::kMemoryWrite, false, true, kMet},
    {IsaChecker::kMemoryWrite, true, false, kN},
    {IsaChecker::kMemoryWrite, true, true, kMet},
};

// The CPU in two words of the RAM: it counts up in one, and reads the other, in which the host counts.
class Contender final : public BusMaster {
 public:
  Contender(Machine& machine, std::uint64_t seed) : machine_(machine), random_(seed) {
    machine_.attach_bus_master(this);
  }
  ~Contender() override { machine_.attach_bus_master(nullptr); }
  Contender(const Contender&) = delete;
  Contender& operator=(const Contender&) = delete;

  std::uint16_t written() const { return count_; }  // the last of them may be under way
  std::uint32_t seen() const { return seen_; }      // the last that it has read of the host
  unsigned reads() const { return reads_; }
  unsigned backwards() const { return backwards_; }  // reads that are older than the one before

  std::optional<Access> next() override {
    const auto idle = static_cast<unsigned>(random_() % 12);
    if (random_() % 2 == 0) return Access{false, kDpramY, true, ++count_, idle};
    return Access{true, kDpramY, false, 0, idle};
  }
  void done(const Access& access, std::uint32_t data) override {
    if (access.write) return;
    ++reads_;
    backwards_ += data < seen_ ? 1 : 0;
    seen_ = data;
  }

 private:
  Machine& machine_;
  std::mt19937_64 random_;
  std::uint16_t count_ = 0;
  std::uint32_t seen_ = 0;
  unsigned reads_ = 0, backwards_ = 0;
};

class IsaTimingBench {
 public:
  explicit IsaTimingBench(BenchContext& b) : b_(b), isa_(b.timing.isa()), random_(b.seed) {}

  void run() {
    malformed_hosts(b_);
    resetdrv();
    nobodys_addresses();
    {
      bus().dpram_write(kShared + 2, 0);  // the CPU does not read yet
      Contender cpu(b_.machine, b_.seed + 1);
      isa::HostTimes tight = isa::kTight;
      if (b_.negative) tight.io.command_high -= isa::ns(1);
      for (const unsigned width : {16u, 8u}) {
        set_width(width);
        exercise(cpu, width, "usual times", isa::kTypical);
        exercise(cpu, width, "slow", isa::kSlow);
        exercise(cpu, width, "at the limits", tight);
        meet_cpu(width);
      }
      // It begins an access in 44 clocks at most, every second a read; the host in two cycles.
      b_.report.step(
          "words that the CPU read", cpu.backwards() == 0 && cpu.reads() >= kAll / 2,
          fmt::format("{}, at least {}, {} of them older than the one before", cpu.reads(), kAll / 2, cpu.backwards()));
      b_.bus.wait(kSeen);
      b_.report.equal<std::int64_t>("the last that it read of the host", cpu.seen(), counter_);
    }
    set_width(b_.board.slot8 ? 8 : 16);
    b_.bus.set_times(isa::kTypical);
    b_.machine.reset();
    b_.report.step("the firmware is back", b_.link.connect(HostLink::kBootTime), "after a reset");
    rules();
    cross();
    if (b_.negative) isa_.ledger().forget();  // the step has said it
  }

 private:
  std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

  // A slot of eight bits has neither LA nor SBHE#.
  void set_width(unsigned bits) {
    b_.bus.drive_at(b_.machine.now_fs() + isa::ns(500), [bits](HostInputs& in) { in.slot8 = bits == 8; });
    b_.bus.wait(24);
    b_.bus.set_width(bits);
  }

  void exercise(Contender& cpu, unsigned width, const std::string& times, const isa::HostTimes& host) {
    b_.bus.set_times(host);
    Comparison same;
    std::map<std::uint32_t, std::uint16_t> words;
    for (unsigned i = 0; i < kRounds; ++i) {
      const std::uint32_t offset = 0x80 + 2 * draw((2 * b_.board.dpram_words - 0x80) / 2);
      words[offset] = static_cast<std::uint16_t>(random_());
      bus().dpram_write(offset, words[offset]);
      if (width == 16) {  // two cycles of eight bits would tear
        // LA leaves the block of the window, so that it moves with the next cycle.
        same.word("nobody's memory", bus().read_memory(bus().window() ^ 1u << 17, 3), 0xFFFF);
        bus().dpram_write(kShared + 2, ++counter_);
        const std::uint16_t before = finished(cpu), shared = bus().dpram_read(kShared);
        same.within("word that the CPU writes", shared, before, cpu.written());
      } else {
        bus().io_write(regs::host_io::kPage, 0);
        bus().write_memory(bus().window() + kShared + 2, ++counter_, 1);
        const std::uint16_t before = finished(cpu);
        const auto shared = static_cast<std::uint8_t>(bus().read_memory(bus().window() + kShared, 1));
        same.within("low byte of the word that the CPU writes, counted from what it had written",
                    static_cast<std::uint8_t>(shared - before), 0, cpu.written() - before);
      }
      const auto& [where, value] = *std::next(words.begin(), draw(static_cast<std::uint32_t>(words.size())));
      same.word(fmt::format("offset ${:04X}", where), bus().dpram_read(where), value);
      const auto byte = static_cast<std::uint8_t>(random_());
      bus().io_write(regs::host_io::kIvr, byte);
      same.word("IVR", bus().io_read(regs::host_io::kIvr), byte);
      port();
    }
    b_.report.step(fmt::format("host of {} bits, {}", width, times), same, (width == 16 ? 4 : 3) * kRounds,
                   fmt::format("{} words and bytes", same.made()));
  }
  // What the CPU has written for certain; 0 is what stood there before.
  static std::uint16_t finished(const Contender& cpu) {
    return static_cast<std::uint16_t>(std::max<int>(cpu.written() - 1, 0));
  }
  // By the host at the limits, so that one of its cycles ends with row 9 too; its narrow ones are long enough without.
  void meet_cpu(unsigned width) {
    constexpr unsigned kMost = 64 * kMet;
    const bool wide = width == 16;
    const auto met = [&](IsaChecker::Kind kind) { return isa_.cycles(kind, wide, 1) >= kMet; };
    const auto at_limit = [&] {
      return !wide || isa_.ledger().row(IsaChecker::kT9, IsaChecker::kMemory16).margin < isa::ns(1);
    };
    bus().io_write(regs::host_io::kPage, 0);
    unsigned tries = 0;
    for (; tries < kMost && !(met(IsaChecker::kMemoryRead) && met(IsaChecker::kMemoryWrite) && at_limit()); ++tries) {
      bus().write_memory(bus().window() + kShared + 2, counter_, wide ? 3 : 1);
      bus().read_memory(bus().window() + kShared, wide ? 3 : 1);
    }
    b_.report.step(fmt::format("host of {} bits meets the CPU", width), tries < kMost,
                   fmt::format("{} accesses more", 2 * tries));
  }

  // Both kinds of bytes of the host port, twice each, so that the distances of host-bus:3.3 are there. Both ways of the
  // port may be full: the CPU does not look.
  void port() {
    for (const auto& r : {regs::host_io::kIsr, regs::host_io::kIsr, regs::host_io::kData6, regs::host_io::kData6})
      bus().io_read(r);
    for (const auto& r : {regs::host_io::kIcr, regs::host_io::kIcr, regs::host_io::kData5, regs::host_io::kData5})
      bus().io_write(r, 0);
    if (b_.machine.outputs().get(pin::kTxde) != 0) bus().io_write(regs::host_io::kData7, 0);
  }
  HostBus& bus() { return b_.bus; }

  // host-bus:3.8
  void resetdrv() {
    Comparison same;
    bus().io_write(regs::host_io::kIvr, 0x55);
    bus().write_pic_mask(0xFF);
    bus().write_pic_edge_level(0xFF);
    bus().io_write(regs::host_io::kPage, 3);
    for (const bool level : {true, false}) {
      bus().drive_at(b_.machine.now_fs() + isa::ns(1000), [=](HostInputs& in) { in.isa_resetdrv = level; });
      bus().wait(120);
    }
    same.word("IVR", bus().io_read(regs::host_io::kIvr), 0x0F);
    same.word("MSK", bus().io_read(regs::host_io::kPicMask), 0);
    same.word("ELR", bus().io_read(regs::host_io::kPicEdgeLevel), 0);
    same.word("ISR", bus().port_status(), 0x06);
    const bool flat = b_.machine.inputs().window_flat;
    same.word("page", bus().io_read(regs::host_io::kPage), flat ? 0xFF : 0xFC);
    b_.report.step("RESETDRV", same, 5, "host port, interrupt controller and page as after power-on");
    b_.expect("VERSION", "1.947");
  }

  void nobodys_addresses() {
    Comparison same;
    // A slot of eight bits has 1 MiB.
    const std::uint32_t size = b_.board.window_flat ? 0x10000 : 0x4000, end = b_.board.slot8 ? 1u << 20 : 1u << 24;
    const unsigned decoded = b_.board.io_decode16 ? 12 : 10;  // bits of an I/O address that a card looks at
    unsigned addresses = decoded - 4;
    for (unsigned bit = 4; bit < decoded; ++bit)
      same.word("I/O", bus().read_io((bus().io_base() + 2) ^ 1u << bit), 0xFF);
    for (std::uint32_t bit = size; bit < end; bit <<= 1, ++addresses)
      same.word("memory", bus().read_memory(bus().window() ^ bit, 3), 0xFFFF);
    b_.report.step("addresses that are nobody's", same, addresses, fmt::format("{} read as ones", same.made()));
  }

  // A row for each rule: evaluated as often as the rounds make it, kept, and at the limit where the host decides.
  void rules() {
    const TimingLedger& ledger = isa_.ledger();
    for (const Activity& activity : kActivity) {
      TimingRow worst;
      std::uint64_t evaluations = 0, violations = 0;
      for (unsigned region = 0; region < ledger.regions().size(); ++region) {
        const TimingRow& row = ledger.row(activity.rule, region);
        evaluations += row.evaluations;
        violations += row.violations;
        if (row.evaluations > 0 && row.margin < worst.margin) worst = row;
      }
      const TimingRule& r = ledger.rules()[activity.rule];
      const bool reached = !activity.at_limit || worst.margin < isa::ns(1);
      std::string text = fmt::format("{}: {} times, at least {}", r.text, evaluations, activity.least);
      if (evaluations > 0 && r.kind != TimingRule::Kind::kHolds)
        text += fmt::format(", worst {}, {} {} required", timing_text(worst.measured),
                            r.kind == TimingRule::Kind::kMost ? "at most" : "at least", timing_text(worst.required));
      if (!reached) text += "; expected to be at its limit";
      b_.report.cover(r.id, evaluations, activity.least);
      b_.report.step(r.id, evaluations >= activity.least && violations == 0 && reached, text);
    }
  }

  void cross() {
    constexpr const char* kKinds[] = {"I/O read", "I/O write", "memory read", "memory write"};
    for (const Cycles& c : kCross) {
      const std::uint64_t cycles = isa_.cycles(c.kind, c.wide ? 1 : 0, c.waited ? 1 : 0);
      b_.report.reached(fmt::format("{}, {} bits{}", kKinds[c.kind], c.wide ? 16 : 8, c.waited ? ", made to wait" : ""),
                        cycles, c.least);
    }
  }

  BenchContext& b_;
  IsaChecker& isa_;
  std::mt19937_64 random_;
  std::uint16_t counter_ = 0;  // what the CPU reads; it never starts anew
};

}  // namespace

Bench isa_timing_bench() {
  return {"isa-timing",
          "host bus at its pins: every rule at its limit, 8 and 16 bits, IOCHRDY, RESETDRV, hosts that keep no rule",
          {"the host ends I/O commands 1 ns too early", "t2", "529.000 ns"},
          [](BenchContext& b) { IsaTimingBench(b).run(); },
          without_8259(kAnyBoard),
          nullptr,
          "turbo-pmac2-pc"};
}

}  // namespace brick
