// bus-timing: every rule of the CPU's bus (host-bus:2.2, host-bus:2.5, host-bus:2.6) in each region: by the firmware at
// three CPU clocks, and by bus cycles in the CPU's place at every clock of I52 with the wait states of host-bus:2.5 and
// all greater ones, read and write, with and without the host at the dual-ported RAM's other side. The cross of these
// is counted. With --bcr it stays at the one clock and the wait states given, there at every phase of the two clocks.
#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/checkers/timing_traffic.h"

namespace brick {
namespace {

using Region = PortATiming::Region;

constexpr unsigned kCellAccesses = 6, kForcedAccesses = 800, kShared = 8, kSharedRounds = 60;
constexpr std::uint64_t kLeastEvaluations = 200;
constexpr unsigned kSkewedMultipliers = 16;  // I52 = 15: above, host-bus:2.5 promises nothing with --skew
constexpr unsigned kFaultyClock = 8, kFaultyWaitStates = 2;  // of the negative control

// host-bus:2.5, rows 2, 3 and 5, by I52 + 1.
unsigned factory_wait_states(Region region, unsigned n) {
  const unsigned row = n <= 8 ? 0 : n <= 10 ? 1 : n <= 16 ? 2 : n <= 24 ? 3 : 4;
  constexpr std::array<unsigned, 5> kGateIcs{8, 10, 16, 24, 31}, kDpram{3, 4, 7, 7, 7}, kDefault{15, 15, 31, 31, 31};
  if (region == Region::kDpram) return n <= 5 ? 4 : kDpram[row];
  return region == Region::kGateIcs ? kGateIcs[row] : kDefault[row];
}

class BusTimingBench {
 public:
  explicit BusTimingBench(BenchContext& b) : b_(b) {
    b.machine.on_bus_cycle = [this](const PortACycle& c) { count(c); };
  }
  ~BusTimingBench() { b_.machine.on_bus_cycle = nullptr; }

  void run() {
    firmware();
    if (!b_.forced_wait_states)
      for (const unsigned i52 : {15u, 31u}) {
        if (i52 >= multipliers()) break;
        b_.expect(fmt::format("I52={} I37=$030400 SAVE", i52), "");
        b_.expect("$$$", "");
        firmware();
      }
    bus_master();
    verdict();
    b_.machine.reset();
    b_.report.step("controller answers after a reset", b_.link.connect(HostLink::kBootTime), "");
  }

 private:
  // Words of each region, read and written by the firmware as the host asks.
  void firmware() {
    const std::string clock = b_.ask("I52");
    for (unsigned i = 0; i < 4; ++i) {
      b_.ask(fmt::format("WY$060C0{},${:X}", i, 0x5A50 + i));
      b_.ask(fmt::format("WX$060C0{},${:X}", i, 0xA5A0 + i));
    }
    const std::string words = b_.ask("RHY$060C00,4");
    b_.report.equal<std::string>(fmt::format("firmware at I52 = {}, dual-ported RAM", clock), words,
                                 "5A50 5A51 5A52 5A53");
    if ((b_.board.fitted & 1) == 0) return;
    b_.ask("WX$78006,$123456 WX$7800E,$654321");
    b_.report.equal<std::string>(fmt::format("firmware at I52 = {}, gate IC", clock),
                                 b_.ask("RHX$78006") + " " + b_.ask("RHX$7800E"), "123456 654321");
  }

  void bus_master() {
    forced_clock_ = std::max(1u, clock_);
    BusTraffic traffic(b_.machine, b_.seed);
    const auto host = [this] {
      b_.bus.dpram_write(BusTraffic::kSharedOffset, static_cast<std::uint16_t>(++host_accesses_));
      b_.bus.dpram_read(BusTraffic::kSharedOffset);
    };
    const auto exercise = [&](Region region, unsigned n, unsigned ws) {
      traffic.set_clock(n);
      traffic.set_wait_states(region, ws);  // forced ones act all the same
      if (b_.forced_wait_states)
        for (unsigned made = 0; made < kForcedAccesses;) made += traffic.every_phase(region);
      else
        traffic.exercise(region, kCellAccesses);
      forced_[region] = wait_states_;
      // The host makes /TA wait until both a read and a write have seen it.
      for (unsigned round = 0; region == Region::kDpram && round < kSharedRounds && !stretched(n, ws); ++round)
        traffic.share(kShared, host);
      const std::string problem = traffic.verify(region);
      if (problem.empty()) return;
      if (wrong_++ == 0)
        first_wrong_ =
            fmt::format("I52 = {}, {} wait states: {}", n - 1, b_.forced_wait_states ? forced_[region] : ws, problem);
    };
    for (unsigned r = 0; r < PortATiming::kRegions; ++r) {
      const auto region = static_cast<Region>(r);
      if (!traffic.has(region)) continue;
      if (b_.forced_wait_states) {
        exercise(region, forced_clock_, 1);
        continue;
      }
      for (unsigned n = 1; n <= multipliers(); ++n)
        for (unsigned ws = factory_wait_states(region, n); ws <= BusTraffic::most_wait_states(region); ++ws)
          exercise(region, n, ws);
      if (b_.negative && region == Region::kGateIcs) exercise(region, kFaultyClock, kFaultyWaitStates);
    }
  }

  void verdict() {
    if (!b_.forced_wait_states)
      for (unsigned r = 0; r < PortATiming::kRegions; ++r) cross(static_cast<Region>(r));
    const TimingLedger& ledger = b_.timing.port_a().ledger();
    for (unsigned rule = 0; rule < PortATiming::kRules; ++rule) activity(ledger, rule);
    b_.report.step("every word of the bus cycles is right", wrong_ == 0 && cycles_ > kLeastEvaluations,
                   wrong_ == 0 ? fmt::format("{} cycles, {} by the host meanwhile", cycles_, 2 * host_accesses_)
                               : fmt::format("{} times not, the first at {}", wrong_, first_wrong_));
    const PortATiming::TaMoves& moves = b_.timing.port_a().ta_moves();
    b_.report.step("/TA moved inside its window", b_.forced_wait_states || (moves.seen > 0 && moves.missed > 0),
                   fmt::format("{} times seen, {} not", moves.seen, moves.missed));
  }

  // Every clock, number of wait states and direction of a region, and for the RAM with and without /TA.
  void cross(Region region) {
    unsigned cells = 0, reached = 0, ta_cells = 0, with_ta = 0;
    std::uint64_t cycles = 0;
    std::string missing;
    for (unsigned n = 1; n <= multipliers(); ++n)
      for (unsigned ws = factory_wait_states(region, n); ws <= BusTraffic::most_wait_states(region); ++ws)
        for (const bool write : {false, true})
          for (const bool ta : {false, true}) {
            if (ta && region != Region::kDpram) continue;
            const auto found = cross_.find({region, write, ws, n, ta});
            const std::uint64_t times = found == cross_.end() ? 0 : found->second;
            ++cells;
            if (ta) ++ta_cells;
            cycles += times;
            if (times > 0) {
              ++reached;
              if (ta) ++with_ta;
            } else if (missing.empty() && needed(region, n, ws, write, ta))
              missing = fmt::format("; none for I52 = {}, {} wait states, {}{}", n - 1, ws, write ? "write" : "read",
                                    ta ? ", /TA" : "");
          }
    const std::string& name = b_.timing.port_a().ledger().regions()[region];
    b_.report.step(fmt::format("cross of direction, wait states, clock and /TA, {}", name),
                   missing.empty() && (region != Region::kDpram || 3 * with_ta >= 2 * ta_cells),
                   fmt::format("{} of {} cells, {} with /TA, {} cycles{}", reached, cells, with_ta, cycles, missing));
  }

  // Where the CPU looks at /TA late enough for the RAM alone (host-bus:6.9/8) no cycle need be with it; sooner, none
  // need be without. Where it looks late, at slow clocks with many wait states, a host's command of 240 ns may never
  // reach so far: of the cells with /TA two in three must be reached.
  bool needed(Region region, unsigned n, unsigned ws, bool write, bool ta) const {
    if (region != Region::kDpram) return true;
    const PinSkew& skew = b_.machine.skew();
    const TimeFs pads = skew.on() ? skew.of_strobe(write) + PinSkew::kOutput : 0;
    const TimeFs ready = isa::ns(write ? 27 : 35) + pads;
    const unsigned quarters = 4 * ws + (write ? ws <= 3 ? 0 : -2 : 1);  // rows 102, 116
    return !ta && PortATiming::quarters(quarters - 1, n) - 2 * kFsPerNs >= ready;
  }
  unsigned multipliers() const { return b_.machine.skew().on() ? kSkewedMultipliers : BusTraffic::kMultipliers; }

  void activity(const TimingLedger& ledger, unsigned rule) {
    std::string detail;
    bool enough = true;
    std::uint64_t violations = 0;
    for (unsigned region = 0; region < PortATiming::kRegions; ++region) {
      const TimingRow& row = ledger.row(rule, region);
      const bool applies = ((rule != PortATiming::kS1 && rule != PortATiming::kW2) || region != Region::kDpram) &&
                           (region != Region::kGateIcs || b_.board.fitted != 0) && formed(rule, region);
      if (!applies && row.violations == 0) continue;
      enough = enough && (!applies || row.evaluations >= kLeastEvaluations);
      violations += row.violations;
      detail += fmt::format("{}{} {}", detail.empty() ? "" : ", ", ledger.regions()[region], row.evaluations);
      if (ledger.rules()[rule].kind != TimingRule::Kind::kHolds && row.evaluations > 0)
        detail += fmt::format(" (margin {})", timing_text(row.margin));
      if (row.violations > 0) detail += fmt::format(", VIOLATED {} times", row.violations);
    }
    b_.report.step("rule " + ledger.rules()[rule].id, enough && violations == 0, detail);
  }

  // A row need not have a form for the wait states that are forced (host-bus:2.2).
  bool formed(unsigned rule, unsigned region) const {
    if (!b_.forced_wait_states || rule > PortATiming::k119) return true;
    return PortATiming::required(static_cast<PortATiming::Rule>(rule), {forced_clock_, forced_[region], 0}).has_value();
  }

  void count(const PortACycle& c) {
    if (c.on_chip) return;
    clock_ = c.multiplier;
    wait_states_ = c.wait_states;
    ++cycles_;
    ++cross_[{PortATiming::region(c.aa), c.write, c.wait_states, c.multiplier, c.stretched > 0}];
  }
  bool stretched(unsigned n, unsigned ws) const {
    return cross_.count({Region::kDpram, false, ws, n, true}) > 0 &&
           cross_.count({Region::kDpram, true, ws, n, true}) > 0;
  }

  BenchContext& b_;
  std::map<std::tuple<unsigned, bool, unsigned, unsigned, bool>, std::uint64_t> cross_;
  std::uint64_t cycles_ = 0, host_accesses_ = 0;
  unsigned wrong_ = 0;
  std::string first_wrong_;
  unsigned clock_ = 0, wait_states_ = 0;  // of the last cycle
  unsigned forced_clock_ = 1;             // --bcr: the firmware's
  std::array<unsigned, PortATiming::kRegions> forced_{};
};

void run(BenchContext& b) { BusTimingBench(b).run(); }

}  // namespace

// covers: CARD-5
Bench bus_timing_bench() {
  return {"bus-timing",
          "every rule of the CPU's bus in each region, read and write, at every clock and number of wait states",
          {"gate ICs with 2 wait states at I52 = 7", "rule 104", "VIOLATED"},
          run};
}

}  // namespace brick
