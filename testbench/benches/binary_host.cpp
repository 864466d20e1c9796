#include "testbench/benches/binary_host.h"

#include <algorithm>

#include <fmt/format.h>

#include "rtl/regs/dpram_map.h"

namespace brick {

namespace {

constexpr Tick kSettled = ns_to_ticks(60'000), kPatience = ns_to_ticks(200'000'000);
constexpr std::uint32_t kAreaItems = 64;
constexpr unsigned kRealTime = 1;  // cpu.task

}  // namespace

BinaryHost::BinaryHost(BenchContext& context) : context_(context), random_(context.seed * 7723 + 5) {
  for (unsigned cs = 1; cs <= BinaryScoreboard::kSystems; ++cs) rotaries_.emplace_back(context_.bus, cs);
  context_.bus.watch(select_pins(pin::kBreq), [this](Tick now, const BoardOutputs&, const BoardOutputs& after) {
    scoreboard_.edge(now, after.get(pin::kBreq) != 0);
  });
  context_.machine.on_bus_cycle = [this](const PortACycle& c) { cycle(c); };
}

BinaryHost::~BinaryHost() {
  context_.bus.watch({}, nullptr);
  context_.machine.on_bus_cycle = nullptr;
}

void BinaryHost::cycle(const PortACycle& c) {
  constexpr std::uint32_t kEnd = DPRAM_ROTARY_HEADERS + BinaryScoreboard::kSystems * DPRAM_ROTARY_STRIDE;
  if (c.on_chip || !c.write || c.address < regs::kDpramBase) return;
  const std::uint32_t offset =
      DPRAM_ITEM_BYTES * (c.address - regs::kDpramBase) + (c.x ? std::uint32_t{DPRAM_WORD_BYTES} : 0);
  if (offset < DPRAM_ROTARY_HEADERS || offset >= kEnd) return;
  const unsigned cs = (offset - DPRAM_ROTARY_HEADERS) / DPRAM_ROTARY_STRIDE;
  const std::uint32_t word = (offset - DPRAM_ROTARY_HEADERS) % DPRAM_ROTARY_STRIDE;
  const Tick now = fs_to_tick(c.strobe_high);
  if (word == DPRAM_ROTARY_PMAC_INDEX)
    scoreboard_.pmac_index(cs, c.data & 0xFFFF, context_.machine.task() == kRealTime, now);
  else
    scoreboard_.status(cs, c.data & 0xFFFF, now);
}

std::string BinaryHost::ask(const std::string& command) const { return context_.ask(command); }

void BinaryHost::open(unsigned systems, unsigned words, unsigned items) {
  for (unsigned cs = systems; cs >= 1; --cs) {
    context_.expect(fmt::format("&{}DEFINE ROTARY {}", cs, words), "");
    const std::uint32_t size = items != 0 ? items : 2 * (10 + random(kAreaItems / 2 - 9));
    rotaries_[cs - 1].define(kAreaItems * (cs - 1), size);
    scoreboard_.defined(cs - 1, words);
  }
  context_.expect("&1", "");
  context_.expect("OPEN BINARY ROTARY", "");
  show(0);
  for (unsigned cs = systems; cs >= 1; --cs) rotaries_[cs - 1].enable();
}

void BinaryHost::show(unsigned cs) {
  context_.bus.wait(kSettled);
  scoreboard_.shown(cs, context_.machine.outputs().get(pin::kBreq) != 0);
}

void BinaryHost::close() {
  scoreboard_.closed();
  for (BinaryRotary& rotary : rotaries_) rotary.disable();
  context_.expect("CLOSE", "");
  context_.expect("DELETE ALL TEMPS", "");
}

void BinaryHost::select(unsigned cs) {
  settle();
  scoreboard_.unjudged();
  context_.ask(fmt::format("&{}", cs + 1));
  show(cs);
}

bool BinaryHost::send(unsigned cs, const std::vector<std::string>& lines) {
  std::vector<BinaryLine> made;
  unsigned items = 0;
  for (const std::string& text : lines) {
    made.push_back(binary_line(text));
    items += static_cast<unsigned>(2 * made.back().commands.size());
  }
  BinaryRotary& rotary = rotaries_[cs];
  if (items + 4 > rotary.size()) return false;
  bool any = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (rotary.stage(made[i].commands) != BinaryResult::kOk) break;
    any = true;
    // The negative control: one line in eight is told with another text.
    const bool lie = context_.negative && ++lies_ % 8 == 0;
    scoreboard_.line(cs, lie ? "P8191=1" : lines[i], static_cast<unsigned>(made[i].commands.size()),
                     rotary.host_index());
  }
  if (!any) return false;
  scoreboard_.advanced(cs, context_.bus.now());
  rotary.commit();
  return true;
}

void BinaryHost::settle() {
  const Tick limit = context_.bus.now() + kPatience;
  while (!scoreboard_.all_copied() && context_.bus.now() < limit) context_.bus.wait(ns_to_ticks(20'000));
  if (!scoreboard_.all_copied()) context_.report.fail("lines are copied", "some wait after 200 ms, expected none");
  context_.bus.wait(kSettled);
  scoreboard_.settled(context_.bus.now());
}

std::string BinaryHost::random_line() {
  static const std::vector<std::string> statements = {"X{}",          "Y-{}.5", "Z{}", "A{}", "F1{}",  "P{}=-3",
                                                      "P5{:03}=2.25", "M{}==7", "G{}", "N{}", "TM2{}", "C{}"};
  std::string line;
  for (unsigned i = 0, count = 1 + random(3); i < count; ++i)
    line += fmt::format(fmt::runtime(statements[random(static_cast<unsigned>(statements.size()))]), 1 + random(900));
  return line;
}

bool BinaryHost::verdict(const std::string& step, unsigned least_lines) {
  const std::vector<std::string>& found = scoreboard_.violations();
  const unsigned lines = scoreboard_.counts().lines - judged_;
  const bool passed = found.size() == reported_ && lines >= least_lines;
  const std::string detail =
      found.size() != reported_ ? found[reported_] : fmt::format("{} lines, expected {} or more", lines, least_lines);
  reported_ = found.size();
  judged_ = scoreboard_.counts().lines;
  return context_.report.step(step, passed, passed ? fmt::format("{} lines", lines) : detail);
}

}  // namespace brick
