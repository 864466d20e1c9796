#include "testbench/unit/accesses/bus_activity.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "systemc/machine/machine.h"

namespace brick {

namespace {

constexpr std::uint32_t kAllLines = ~0u;

// Inputs that the host and the user drive.
struct InputPin {
  const char* name;
  unsigned width;
  std::uint32_t (*get)(const BoardInputs&);
};
constexpr InputPin kInputs[] = {{"LA", 7, [](const BoardInputs& in) { return std::uint32_t{in.isa_la}; }},
                                {"SA", 20, [](const BoardInputs& in) { return in.isa_sa; }},
                                {"SD of the host", 16, [](const BoardInputs& in) { return std::uint32_t{in.isa_sd}; }},
                                {"IOR#", 1, [](const BoardInputs& in) { return std::uint32_t{in.isa_ior_n}; }},
                                {"IOW#", 1, [](const BoardInputs& in) { return std::uint32_t{in.isa_iow_n}; }},
                                {"MEMR#", 1, [](const BoardInputs& in) { return std::uint32_t{in.isa_memr_n}; }},
                                {"MEMW#", 1, [](const BoardInputs& in) { return std::uint32_t{in.isa_memw_n}; }},
                                {"AEN", 1, [](const BoardInputs& in) { return std::uint32_t{in.isa_aen}; }},
                                {"SBHE#", 1, [](const BoardInputs& in) { return std::uint32_t{in.isa_sbhe_n}; }},
                                {"RESETDRV", 1, [](const BoardInputs& in) { return std::uint32_t{in.isa_resetdrv}; }},
                                {"MI1", 1, [](const BoardInputs& in) { return std::uint32_t{in.mi1}; }},
                                {"MI2", 1, [](const BoardInputs& in) { return std::uint32_t{in.mi2}; }},
                                {"AXEXP0", 1, [](const BoardInputs& in) { return std::uint32_t{in.axexp0}; }},
                                {"AXEXP1", 1, [](const BoardInputs& in) { return std::uint32_t{in.axexp1}; }},
                                {"control panel", 16, [](const BoardInputs& in) { return std::uint32_t{in.jpan}; }},
                                {"5 V good", 1, [](const BoardInputs& in) { return std::uint32_t{in.pwr_good}; }},
                                {"reset", 1, [](const BoardInputs& in) { return std::uint32_t{in.rst_n}; }}};

// A14 is 0, A17 and A18 are 1 in every region that has pins; AA0 and AA3 select memories that have none here
// (host-bus:1.1).
enum PortAPin { kA, kX, kAa, kRd, kWr, kD, kPortAPins };
struct CpuPin {
  const char* name;
  unsigned width;
  std::uint32_t can_move;
};
constexpr std::array<CpuPin, kPortAPins> kCpu{{{"A", 19, 0x1BFFF},
                                               {"X", 1, kAllLines},
                                               {"AA", 4, 0b0110},
                                               {"/RD", 1, kAllLines},
                                               {"/WR", 1, kAllLines},
                                               {"D of the CPU", 24, kAllLines}}};
constexpr std::size_t kFirstInput = pin::kAll.size(), kFirstCpu = kFirstInput + std::size(kInputs);

// They take a reset, a collision of host and CPU in one word, or a card of its own.
constexpr const char* kRare[] = {
    "RESETDRV",       "5 V good",         "reset",           "control panel",   "host.wdo",
    "watchdog.relay", "watchdog.tripped", "watchdog.led",    "dpram.busy_host", "dpram.busy_cpu",
    "clock.conflict", "ISA t16",          "ISA whole-cycle", "ISA room-in-tx"};

// Rules that a region does not have. All others are evaluated in every region.
struct NotInRegion {
  const char *rule, *region, *why;
};
constexpr const char* kDpram = "dual-ported RAM AA2";
constexpr const char *kIo = "I/O", *kWide = "memory of 16 bits", *kNarrow = "memory of 8 bits";
constexpr NotInRegion kNotInRegion[] = {{"Port A w2", kDpram, "its strobes are taken on clk_pwm (host-bus:2.6/9)"},
                                        {"Port A s1", kDpram, "its strobes are taken on clk_pwm (host-bus:2.6/9)"},
                                        {"ISA t1", kWide, "row of I/O"},
                                        {"ISA t1", kNarrow, "row of I/O"},
                                        {"ISA t2", kWide, "t13 instead"},
                                        {"ISA t4", kWide, "t14 instead"},
                                        {"ISA t7", kWide, "t15 instead"},
                                        {"ISA t7", kNarrow, "t15 instead"},
                                        {"ISA t8", kIo, "only the RAM holds IOCHRDY"},
                                        {"ISA t9", kIo, "only the RAM holds IOCHRDY"},
                                        {"ISA t10", kIo, "only the RAM holds IOCHRDY"},
                                        {"ISA t12", kIo, "I/O has no LA"},
                                        {"ISA t13", kIo, "row of 16 bits"},
                                        {"ISA t13", kNarrow, "row of 16 bits"},
                                        {"ISA t14", kIo, "row of 16 bits"},
                                        {"ISA t14", kNarrow, "row of 16 bits"},
                                        {"ISA t15", kIo, "t7 instead"},
                                        {"ISA t16", kIo, "I/O has no MEMCS16#"},
                                        {"ISA t16", kNarrow, "MEMCS16# says 16 bits"},
                                        {"ISA t18", kIo, "t1 instead"},
                                        {"ISA h1", kWide, "strobe of the host port"},
                                        {"ISA h1", kNarrow, "strobe of the host port"},
                                        {"ISA h2", kWide, "strobe of the host port"},
                                        {"ISA h2", kNarrow, "strobe of the host port"},
                                        {"ISA h3", kWide, "strobe of the host port"},
                                        {"ISA h3", kNarrow, "strobe of the host port"},
                                        {"ISA h4", kWide, "strobe of the host port"},
                                        {"ISA h4", kNarrow, "strobe of the host port"},
                                        {"ISA h5", kWide, "strobe of the host port"},
                                        {"ISA h5", kNarrow, "strobe of the host port"},
                                        {"ISA h6", kWide, "strobe of the host port"},
                                        {"ISA h6", kNarrow, "strobe of the host port"},
                                        {"ISA room-in-tx", kWide, "register of the host port"},
                                        {"ISA room-in-tx", kNarrow, "register of the host port"}};

bool has(const std::string& rule, const std::string& region) {
  return std::none_of(std::begin(kNotInRegion), std::end(kNotInRegion),
                      [&](const NotInRegion& n) { return rule == n.rule && region == n.region; });
}

std::uint64_t least(const std::string& name, std::uint64_t accesses) {
  const bool rare = std::find(std::begin(kRare), std::end(kRare), name) != std::end(kRare);
  return std::max<std::uint64_t>(1, accesses / (rare ? 50'000 : 10'000));
}

}  // namespace

BusActivity::BusActivity() {
  for (const PinField& f : pin::kAll) add(std::string(f.name), f.hex ? f.width : 1, kAllLines);
  for (const InputPin& p : kInputs) add(p.name, p.width, kAllLines);
  for (const CpuPin& p : kCpu) add(p.name, p.width, p.can_move);
}

void BusActivity::add(const std::string& name, unsigned width, std::uint32_t can_move) {
  pins_.push_back({name, can_move, std::vector<std::uint64_t>(width)});
}

void BusActivity::moved(std::size_t index, std::uint32_t lines) {
  for (; lines != 0; lines &= lines - 1) ++pins_[index].moves[static_cast<unsigned>(__builtin_ctz(lines))];
}

void BusActivity::watch(Machine& machine) {
  inputs_ = {};
  cycle_.reset();
  machine.on_outputs = [this](Tick, const BoardOutputs& before, const BoardOutputs& after) { outputs(before, after); };
  machine.on_bus_cycle = [this](const PortACycle& c) { cycle(c); };
  machine.on_host_bus = [this, judge = machine.on_host_bus](TimeFs time, const BoardInputs& in,
                                                            const BoardOutputs& out) {
    judge(time, in, out);
    inputs(std::exchange(inputs_, in), in);
  };
}

void BusActivity::inputs(const BoardInputs& before, const BoardInputs& after) {
  for (std::size_t i = 0; i < std::size(kInputs); ++i)
    if (const std::uint32_t lines = kInputs[i].get(before) ^ kInputs[i].get(after)) moved(kFirstInput + i, lines);
}

void BusActivity::outputs(const BoardOutputs& before, const BoardOutputs& after) {
  for (std::size_t i = 0; i < pin::kAll.size(); ++i) {
    const PinField& f = pin::kAll[i];
    if (const std::uint32_t lines = before.get(f) ^ after.get(f)) moved(i, f.hex ? lines : 1);
  }
}

// Strobe and select fall and rise again in each cycle.
void BusActivity::cycle(const PortACycle& c) {
  if (c.on_chip) return;  // moves no pin
  if (cycle_) moved(kFirstCpu + kA, cycle_->address ^ c.address);
  if (cycle_) moved(kFirstCpu + kX, cycle_->x != c.x ? 1 : 0);
  for (int i = 0; i < 2; ++i) moved(kFirstCpu + kAa, c.aa), moved(kFirstCpu + (c.write ? kWr : kRd), 1);
  if (c.write) moved(kFirstCpu + kD, written_ ^ c.data), written_ = c.data;
  cycle_ = c;
}

void BusActivity::finish(const TimingBook& book) {
  for (const TimingLedger* ledger : book.ledgers()) {
    for (unsigned rule = 0; rule < ledger->rules().size(); ++rule)
      for (unsigned region = 0; region < ledger->regions().size(); ++region)
        rules_[ledger->bus() + " " + ledger->rules()[rule].id][ledger->regions()[region]] +=
            ledger->row(rule, region).evaluations;
    for (const TimingViolation& v : ledger->violations()) violations_.push_back(book.text(*ledger, v));
  }
  ta_moves_.seen += book.port_a().ta_moves().seen;
  ta_moves_.missed += book.port_a().ta_moves().missed;
}

std::vector<std::string> BusActivity::lacks(std::uint64_t accesses) const {
  std::vector<std::string> names;
  const auto judge = [&](const std::string& name, const std::string& what, bool can, std::uint64_t seen) {
    const std::uint64_t expected = least(name, accesses);
    if (can && seen < expected) names.push_back(fmt::format("{}: {} of {}", what, seen, expected));
    if (!can && seen > 0) names.push_back(fmt::format("{}: {}, expected none", what, seen));
  };
  for (const Pin& p : pins_)
    for (unsigned line = 0; line < p.moves.size(); ++line) {
      const bool bus = p.moves.size() > 1;
      judge(p.name, bus ? fmt::format("{}.{}", p.name, line) : p.name, (p.can_move >> line & 1) != 0, p.moves[line]);
    }
  for (const auto& [rule, regions] : rules_)
    for (const auto& [region, evaluations] : regions)
      judge(rule, fmt::format("{}, {}", rule, region), has(rule, region), evaluations);
  return names;
}

std::string BusActivity::text() const {
  std::string text;
  for (const Pin& p : pins_) text += fmt::format("{}: {}\n", p.name, fmt::join(p.moves, " "));
  for (const auto& [rule, regions] : rules_) {
    text += rule + ":";
    for (const auto& [region, evaluations] : regions)
      if (has(rule, region)) text += fmt::format(" {} {};", region, evaluations);
    text.back() = '\n';
  }
  return text;
}

}  // namespace brick
