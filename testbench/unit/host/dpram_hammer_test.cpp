// Both sides at the same and at neighbouring words, at every offset of one access to the other, and at random for a
// long time: what is read is old or new, nothing is lost, and who waits is who came later. Judged by
// testbench/checkers/dpram_scoreboard.h; times in ticks.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "testbench/checkers/dpram_scoreboard.h"
#include "testbench/unit/host/dpram_bench.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

struct Met {
  unsigned busy_cpu = 0, busy_host = 0, ties = 0, tears = 0;
};

// Two actors that begin accesses of their own and obey /TA and BUSY.
class Hammer : public DpramBench {
 public:
  explicit Hammer(unsigned seed) : random(seed) { both.lazy = seed % 2 != 0; }

  struct Plan {
    unsigned word = 0;
    bool read = true;
    Tick at = -1, hold = 0;   // begins at this tick; rests this long when it may end
    std::uint16_t value = 0;  // written, 0: the next of all; or read
    Tick from = 0, ready = 0;
    bool running = false, decided = false;
  };
  static Plan plan(unsigned word, bool read, Tick at, Tick hold, std::uint16_t value = 0) {
    Plan p;
    p.word = word, p.read = read, p.at = at, p.hold = hold, p.value = value;
    return p;
  }
  std::mt19937 random;
  DpramScoreboard scoreboard;
  Met met;
  Plan cpu, host;
  bool blind = false;  // negative control: the host takes no notice of BUSY
  std::uint16_t next_value = 1;

  // One tick. A done access has at <= now and running false.
  void step() {
    const Tick now = both.now();
    if (!cpu.running && cpu.at == now) start_cpu();
    if (now % kTicksPerRef == 0) {
      both.in.mem_wr = false;
      if (!host.running && host.at == now) start_host();
      if (host.running && now > host.from && !host.decided && (blind || !host_busy())) {
        host.decided = true;
        host.ready = now;
        if (host.read) host.value = static_cast<std::uint16_t>(both.get("mem_rdata"));
      }
      if (host.decided && now >= host.ready + host.hold) end_host();
    }
    if (cpu.running && now > cpu.from && !cpu_wait()) {
      if (!cpu.decided) {
        cpu.decided = true;
        cpu.ready = now;
        if (cpu.read) cpu.value = static_cast<std::uint16_t>(both.get("cpu_rdata"));
      }
      if (now >= cpu.ready + cpu.hold) {
        cpu_end();
        cpu.running = cpu.decided = false;
        told(cpu);
      }
    }
    const bool cpu_before = cpu_busy(), host_before = host_busy();
    both.tick();
    met.busy_cpu += !cpu_before && cpu_busy();
    if (!host_before && host_busy()) {
      ++met.busy_host;
      // The host's first edge is the third of the CPU's strobe: a tie, which the CPU has won.
      met.ties += both.now() == host.from + kTicksPerRef && both.now() == cpu.from + kAccess;
      EXPECT_FALSE(cpu_busy()) << "both wait at tick " << both.now();
    }
  }

 private:
  void start_cpu() {
    if (cpu.value == 0) cpu.value = next_value++;
    if (cpu.read)
      cpu_start_read(cpu.word);
    else
      cpu_start_write(cpu.word, cpu.value);
    cpu.from = both.now();
    cpu.running = true;
  }
  void start_host() {
    if (host.value == 0) host.value = next_value++;
    host_start(host.word, host.read);
    host.from = both.now();
    host.running = true;
  }
  void end_host() {
    both.in.mem_sel = false;
    both.in.mem_wr = !host.read;
    both.in.mem_wdata = host.value;
    both.in.mem_be = 3;
    host.running = host.decided = false;
    told(host);
  }
  void told(const Plan& p) {
    if (p.read)
      scoreboard.read(p.word, p.value, p.from, both.now());
    else
      scoreboard.write(p.word, p.value, p.from, both.now());
  }
};

TEST(DpramHammer, EveryOffsetOfOneAccessToTheOther) {
  Hammer h(2);
  unsigned conflicts = 0;
  for (int offset = -45; offset <= 45; ++offset)
    for (unsigned kind = 0; kind < 4; ++kind)
      for (const unsigned word : {8u, 9u}) {
        const Tick base = next_ref_edge(h.both.now()) + 48;
        const bool cpu_reads = (kind & 1) != 0, host_reads = (kind & 2) != 0, conflict = word == 8 && kind != 3;
        h.cpu = Hammer::plan(word, cpu_reads, base + offset, 3);
        h.host = Hammer::plan(8, host_reads, base, 24);
        const Met before = h.met;
        while (h.both.now() < base + 140) h.step();
        ASSERT_FALSE(h.cpu.running || h.host.running) << "offset " << offset;
        // The CPU is decided at the third edge after its fall, the host at the first of clk_ref; both go on for some
        // 8 and 27 ticks.
        const bool host_waits = h.met.busy_host != before.busy_host, cpu_waits = h.met.busy_cpu != before.busy_cpu;
        const int cpu_at = offset + 3, host_at = 3;
        EXPECT_FALSE(host_waits && cpu_waits) << offset;
        if (!conflict) {
          EXPECT_FALSE(host_waits || cpu_waits) << offset << " kind " << kind;
        } else if (cpu_at > host_at && cpu_at < host_at + 24) {
          EXPECT_TRUE(cpu_waits) << offset << " kind " << kind;
        } else if (cpu_at <= host_at && cpu_at > host_at - 6) {
          EXPECT_TRUE(host_waits) << offset << " kind " << kind;
        }
        conflicts += host_waits || cpu_waits;
      }
  EXPECT_THAT(h.scoreboard.judge(), ::testing::IsEmpty());
  EXPECT_EQ(h.met.ties, 3u) << "offset 0, each kind but two reads";
  EXPECT_GE(conflicts, 3u * (23 + 6));
  EXPECT_LOCKSTEP(h.both);
}

void random_accesses(Hammer& h, int accesses, unsigned words) {
  const auto pick = [&h](unsigned below) { return static_cast<unsigned>(h.random() % below); };
  for (int done = 0; done < accesses;) {
    const Tick now = h.both.now();
    if (!h.cpu.running && h.cpu.at < now) {
      h.cpu = Hammer::plan(8 + pick(words), pick(2) != 0, now + pick(3) * pick(12), pick(4));
      ++done;
    }
    if (!h.host.running && h.host.at < now) {
      const Tick at = next_ref_edge(now) + kTicksPerRef * (pick(3) == 0 ? pick(12) : 0);
      h.host = Hammer::plan(8 + pick(words), pick(2) != 0, at, kTicksPerRef * pick(9));
      ++done;
    }
    h.step();
  }
}

TEST(DpramHammer, RandomAccessesAreOldOrNew) {
  Met sum;
  DpramScoreboard::Counts counts;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Hammer h(random_seed(seed));
    random_accesses(h, 4000, 1 + seed % 3);
    EXPECT_THAT(h.scoreboard.judge(), ::testing::IsEmpty()) << seed;
    EXPECT_LOCKSTEP(h.both);
    const auto c = h.scoreboard.counts();
    counts.reads += c.reads, counts.writes += c.writes, counts.met += c.met;
    sum.busy_cpu += h.met.busy_cpu, sum.busy_host += h.met.busy_host, sum.ties += h.met.ties;
  }
  RecordProperty("busy_cpu", static_cast<int>(sum.busy_cpu));
  EXPECT_GE(counts.reads, 12'000u);
  EXPECT_GE(counts.writes, 12'000u);
  EXPECT_GE(counts.met, 3000u);
  EXPECT_GE(sum.busy_cpu, 2000u);
  EXPECT_GE(sum.busy_host, 1000u);
  EXPECT_GE(sum.ties, 100u);
}

// A host that goes on while BUSY: its write is lost, which the scoreboard must see.
TEST(DpramHammer, AHostThatTakesNoNoticeOfBusyIsFound) {
  Hammer h(3);
  h.blind = true;
  random_accesses(h, 2000, 1);
  EXPECT_THAT(h.scoreboard.judge(), ::testing::ElementsAre(::testing::HasSubstr("word 8: read ")));
  EXPECT_LOCKSTEP(h.both);
}

// Items of 32 bits, $nnnnnnnn with both halves alike. The host reads low, then high: every half is old or new, and now
// and then they are of different age.
TEST(DpramHammer, ItemsOf32BitsTear) {
  Hammer h(5);
  unsigned items = 0, torn = 0;
  std::uint16_t low = 0;
  std::uint16_t tag = 0;
  for (int half = 0; items < 1500;) {
    const Tick now = h.both.now();
    if (!h.cpu.running && h.cpu.at < now) {
      tag = static_cast<std::uint16_t>(tag + (half == 0));
      h.cpu = Hammer::plan(8 + static_cast<unsigned>(half), false, now + 2 + h.random() % 5, 2, tag);
      half = 1 - half;
    }
    if (!h.host.running && h.host.at < now) {
      const bool high = h.host.word == 8;
      if (h.host.word == 8) low = h.host.value;
      if (h.host.word == 9) {
        ++items;
        torn += h.host.value != low;
        ASSERT_LE(static_cast<std::uint16_t>(h.host.value - low + 1), 4u) << "halves of neighbouring items";
      }
      const Tick at = next_ref_edge(now) + kTicksPerRef * (h.random() % 3);
      h.host = Hammer::plan(high ? 9 : 8, true, at, kTicksPerRef * 2);
    }
    h.step();
  }
  EXPECT_GE(torn, 50u);
  EXPECT_GE(items - torn, 100u);
  EXPECT_LOCKSTEP(h.both);
}

}  // namespace
}  // namespace brick
